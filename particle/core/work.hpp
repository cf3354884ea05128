#pragma once
// Work that loads and prescribed motion do on a body, for the energy balance.

#include "particle/core/boundary.hpp"

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

}  // namespace concord::particle
