#pragma once
// What goes into a body and what is lost in it, for the energy balance: work of loads and
// prescribed motion, work taken by viscosity and damping.

#include "particle/core/boundary.hpp"
#include "particle/core/force_model.hpp"

#include <span>
#include <vector>

namespace concord::particle {

/// External work since the start. Constant loads have a potential: their work is f.(u - u_0),
/// asked for when needed. Only time-dependent loads and moving constraints are followed step by
/// step, on the particles that they touch, by the trapezoidal rule: W += (F_n + F_{n+1})/2 .
/// (u_{n+1} - u_n), with F = -f_internal on prescribed components. Where neither exists,
/// nothing is stored and a step costs nothing.
class ExternalWork {
 public:
  ExternalWork(const Body& body, const Constraints& constraints, const ExternalLoads& loads);

  bool follows_steps() const { return !m_dofs.empty(); }
  /// Sets the reference state: displacement u with total force f at load time t.
  void start(double t, std::span<const double> u, std::span<const double> f);
  /// Adds the work of the step that led to u, f at load time t.
  void step(double t, std::span<const double> u, std::span<const double> f);
  /// Work so far at u [J]; v: velocities, whose kinetic energy on prescribed components is work
  /// of the constraint too (empty in static runs).
  double total(std::span<const double> u, std::span<const double> v) const;
  /// Sum of the loads that never change [N]: their impulse in t is this times t.
  Vec3 constant_resultant() const;
  /// Saved or restored (checkpoint.hpp).
  void keep(scene::Checkpoint& state);

 private:
  void forces(double t, std::span<const double> f, std::vector<double>& out);

  const Body& m_body;
  const Constraints& m_constraints;
  const ExternalLoads& m_loads;
  std::vector<std::size_t> m_dofs;  ///< entries of a column that are followed
  std::vector<char> m_prescribed;   ///< of these
  std::vector<double> m_u, m_force, m_next_force;
  Column m_constant, m_varying, m_start_u;
  double m_work = 0;
};

/// Work that artificial viscosity and mass damping have taken [J], as the leapfrog takes it: a
/// kick of duration dt by f_n changes the kinetic energy by dt f_n.w, w = (v_{n-1/2} +
/// v_{n+1/2})/2, so D += dt (c m w - f_visc(u_n, v_{n-1/2})).w, without any error of its own.
/// f_visc is what the forces change by when v is set to zero: a second evaluation a step, in
/// viscous runs alone; models whose bonds can break keep it by itself. Where there is neither,
/// nothing is stored and a step costs nothing.
class Dissipation {
 public:
  Dissipation(ForceModel& model, const Constraints& constraints, const ExternalLoads& loads,
              const Executor& executor)
      : m_model(model), m_constraints(constraints), m_loads(loads), m_executor(executor) {}

  /// `rate`: of mass damping, c [1/s].
  void start(double rate);
  bool active() const { return m_viscous || m_rate > 0; }
  /// Before a kick: velocity v_{n-1/2}, and the total force f at u and load time t.
  void before(double t, std::span<const double> u, std::span<const double> v,
              std::span<const double> f);
  /// Work taken by a kick of duration dt since before(), that ends with velocity v [J].
  double taken(double dt, std::span<const double> v) const;
  /// The same, added up.
  void add(double dt, std::span<const double> v) { m_work += taken(dt, v); }
  double work() const { return m_work; }
  /// Saved, or restored after start().
  void keep(scene::Checkpoint& state);

 private:
  double kept_power(std::span<const double> v) const;

  ForceModel& m_model;
  const Constraints& m_constraints;
  const ExternalLoads& m_loads;
  const Executor& m_executor;
  bool m_viscous = false;
  double m_rate = 0, m_work = 0;
  Column m_rest, m_force;          ///< no velocity, and f_visc: with viscosity
  Column m_v;                      ///< v_{n-1/2}
  std::span<const double> m_kept;  ///< f_visc of a model that keeps it by itself (Fracturing)
  double m_kept_power = 0;         ///< m_kept.v_{n-1/2} [W]
};

}  // namespace concord::particle
