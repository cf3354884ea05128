#pragma once
// Everything a run writes and reports: history, frames, invariants, final samples and field.

#include "fem_reference/internal_force.hpp"
#include "fem_reference/loads.hpp"
#include "fem_reference/quantities.hpp"
#include "scene/output.hpp"

#include <array>

namespace concord::fem {

/// Watches the states of one run. History rows and frames come at the first state at or after
/// their times.
///
/// history.csv names its columns as the particle methods do; energy_balance_J is T + W + D -
/// W_ext less its first value. There is no stabilisation energy and no hourglass number: these
/// elements are integrated in full and need none.
///
/// Invariants (dynamic runs and plastic static ones), maxima over the history rows:
///  energy_drift = |T + W + D - W_ext - (T + W)_0| / max(T + W + D), T kinetic, W strain
///  energy, D plastic work. In static runs W_ext is summed by the trapezoidal rule over the
///  load steps, whose error, of second order in the step, the drift then shows;
///  linear_momentum_drift = |p - p_0| / sqrt(2 m max T), p = sum M v;
///  angular_momentum_drift = |l - l_0| / (D sqrt(2 m max T)), l = sum x x M v, D the diagonal
///  of the body's box: both only for bodies without loads and prescribed displacements.
template <int dim> class Observer {
 public:
  Observer(const scene::Problem& problem, const scene::RunRequest& request,
           const Discretisation<dim>& discretisation, const NodalFields<dim>& fields,
           const Prescribed<dim>& prescribed, bool free_body, scene::Result& result);

  /// The operators of the integrator; to be set before start(). `mass` empty: statics.
  void connect(const InternalForce& force, MassProduct mass);
  void start(const State& state);
  /// Writes what is due, tells the progress, then asks whether to stop (throws Interrupted).
  void after_step(const State& state);
  /// Last row and frame where not yet written; samples, field and quantities into the result.
  /// After a failure (`sound` false) nothing is computed from the state any more.
  void finish(const State& state, bool sound);
  /// Time spent here so far [s], to be left out of the run's own.
  double seconds() const { return m_seconds; }

 private:
  void row(const State& state);
  void frame(const State& state);
  std::vector<std::string> columns() const;
  /// T + W + D - W_ext less its first value [J].
  double follow_energy(double total, double external_work);
  /// sum M v [kg m/s] and sum x x M v [kg m^2/s].
  std::array<Vec3, 2> momenta(const State& state, const State::Vector& Mv) const;
  void follow_momenta(const std::array<Vec3, 2>& momentum);

  const scene::Problem& m_problem;
  const scene::RunRequest& m_request;
  const Discretisation<dim>& m_discretisation;
  const NodalFields<dim>& m_fields;
  scene::Result& m_result;
  Quantities<dim> m_quantities;
  const InternalForce* m_force = nullptr;
  MassProduct m_mass;
  bool m_free_body;
  scene::HistoryWriter m_history;
  scene::FrameWriter m_frames;
  std::vector<Index> m_vtk_cells, m_vtk_offsets;
  std::vector<unsigned char> m_vtk_types;
  int m_rows_done = 0, m_frames_done = 0;
  double m_last_row = -1, m_last_frame = -1, m_seconds = 0;
  std::array<Vec3, 2> m_momentum_0, m_momentum_change{Vec3::Zero(), Vec3::Zero()};
  double m_energy_0 = 0, m_energy_change = 0, m_energy_scale = 0, m_kinetic_max = 0;
};

extern template class Observer<2>;
extern template class Observer<3>;

}  // namespace concord::fem
