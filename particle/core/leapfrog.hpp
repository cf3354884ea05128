#pragma once
// The one explicit integrator of all particle methods: leapfrog (central differences).

#include "particle/core/checkpoint.hpp"
#include "particle/core/recorder.hpp"
#include "particle/core/rest_regions.hpp"
#include "particle/core/stable_step.hpp"
#include "particle/core/work.hpp"

#include <functional>
#include <optional>

namespace concord::particle {

struct LeapfrogOptions {
  double end_time = 0;  ///< [s]
  double dt_factor =
      0.8;  ///< time step over the critical one, 2/omega_max (reduced for viscosity)
  double dt_fixed = 0;   ///< > 0: this step instead [s]
  double damping = 0;    ///< mass-proportional damping rate c [1/s]: force -c m v
  int frames = 0;        ///< field frames over the run, besides the first
  int history_rows = 0;  ///< history rows over the run, besides the first
  /// omega_max is asked for again when the largest |H| of any particle changed by this much
  /// since the last estimate. |H|: the largest stretch of an edge of the triangulation, or the
  /// norm of the model's own gradients where particles lie inside the body: simplices do not
  /// reach its faces then, and one layer has none. And when something has broken since; until
  /// then the step is at once cut to what Fracturing::stiffened() allows. A fixed step that is
  /// above the critical one of what a break has left ends the run.
  double reestimate_at = 0.05;
  /// Regions still exactly at rest are left out, by models that can (RestRegions); the same
  /// bits.
  bool rest_regions = true;
  std::function<void(double, const std::string&)> progress;
  /// > 0: loads and prescribed displacements are those of min(t / ramp_time, 1): static
  /// problems by damped dynamics.
  double ramp_time = 0;
  /// > 0: stop after the ramp when the unbalanced force falls below this times the largest
  /// internal force (both norms).
  double stop_at_residual = 0;
  /// Where the run saves itself, and goes on from; nullptr: nowhere.
  Checkpoints* checkpoints = nullptr;
};

struct LeapfrogOutcome {
  long steps = 0;
  double dt = 0;              ///< last step [s]
  double t = 0;               ///< time reached [s]
  double loop_s = 0;          ///< wall time of the loop without output, over all resumes
  bool settled = false;       ///< stopped by stop_at_residual
  double particle_steps = 0;  ///< particles whose forces were computed, summed over the steps
  std::vector<long> resumed_at;  ///< steps after which the run has been resumed
};

/// v_{n+1/2} = v_{n-1/2} + dt f(u_n)/m, u_{n+1} = u_n + dt v_{n+1/2}: second order, symplectic
/// for constant dt. With damping c, v_{n+1/2} = ((1 - c dt/2) v_{n-1/2} + dt f/m) / (1 + c
/// dt/2). Velocities reported are those at full steps.
class Leapfrog {
 public:
  /// Starts from the problem's initial displacement and velocity. References must outlive the
  /// object.
  Leapfrog(const scene::Problem& problem, ForceModel& model, const Constraints& constraints,
           const ExternalLoads& loads, const Executor& executor, double ramp_time = 0);

  /// Runs to the end time, writing to `recorder`. Throws SolveError (det F <= 0, NaN) with
  /// step, time and particle, and Interrupted, both after writing the last good state (if the
  /// failed step can be undone). What is written is finite. Throws OutputError when a file
  /// cannot be written, and InputError for a checkpoint of another run.
  /// With checkpoints: saves itself when their time has come, when interrupted, and where rows
  /// and frames cannot be written.
  /// `outcome` is current whenever it throws.
  void run(const LeapfrogOptions& options, Recorder& recorder, LeapfrogOutcome& outcome);

  const Column& displacement() const { return m_u; }
  /// Before run(): starts from this displacement instead of the problem's.
  void start_from(const Column& u) { m_u = u; }

  /// The state at the last force evaluation, velocity brought to the same instant.
  State state();

 private:
  double load_time() const { return load_time(m_t); }
  double load_time(double t) const { return m_ramp > 0 ? std::min(t / m_ramp, 1.0) : t; }
  class Schedule;
  static constexpr long look_every =
      64;  ///< steps between looks at the deformation (for omega_max) and the residual
  void evaluate();
  void advance_forces(double dt);
  void step(double dt);
  void follow_rest();
  void move_all();
  /// body(begin, end) over the particles that are worked on.
  template <class Body> void for_awake(const Body& body) const;
  bool step_back();
  std::optional<BadState> not_finite() const;
  void check_finite();
  void start();
  void advance(const LeapfrogOptions& options, Recorder& recorder, LeapfrogOutcome& outcome);
  void keep(scene::Checkpoint& state, Recorder& recorder, LeapfrogOutcome& outcome);
  void save(const LeapfrogOptions& options, Recorder& recorder, LeapfrogOutcome& outcome);
  void save_unwritten(const LeapfrogOptions& options, Recorder& recorder,
                      LeapfrogOutcome& outcome);
  void write(Recorder& recorder, bool row, bool frame);
  void kick(double dt, double damping);
  void drift(double dt);
  double critical_step(double dt_factor);
  double step_for(double omega, double dt_factor) const;
  void follow_breaks();
  double largest_gradient();
  long dead() const;
  bool settled(double fraction);

  const scene::Problem& m_problem;
  ForceModel& m_model;
  Fracturing* m_fracturing;  ///< nullptr where nothing can break
  const Constraints& m_constraints;
  const ExternalLoads& m_loads;
  const Executor& m_executor;
  double m_ramp;
  std::vector<double> m_inverse_mass;
  Column m_u, m_v, m_f;  ///< displacement, half-step velocity, total force on all components
  Column m_v_full, m_acceleration;     ///< for output
  std::vector<Mat3> m_H;               ///< where particles lie inside: for largest_gradient()
  std::optional<RestRegions> m_rest;   ///< while some particles are left out
  std::vector<ParticleRange> m_awake;  ///< particles that are worked on
  Index m_awake_count = 0;
  ExternalWork m_work;
  Dissipation m_dissipation;
  double m_t = 0, m_dt_last = 0, m_damping = 0;
  bool m_in_step = false;                 ///< a step has begun and its state has not been taken
  double m_row_at = -1, m_frame_at = -1;  ///< times last written
  bool m_row_due = false, m_frame_due = false;  ///< of the present state, and not yet written
  long m_next_row = 1, m_next_frame = 1;        ///< numbers, of those at even times
  double m_dt = 0;                              ///< longest step now [s]; 0: not asked for yet
  double m_gradient = 0;                        ///< largest, when it was asked for
  long m_dead = 0;                              ///< simplices gone, when it was asked for
  double m_dt_factor = 0;                       ///< 0: the step is fixed
  double m_critical = 0;                        ///< critical step that a fixed one exceeds [s]
};

}  // namespace concord::particle
