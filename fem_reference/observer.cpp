#include "fem_reference/observer.hpp"

#include "fem_reference/sampling.hpp"
#include "scene/interrupt.hpp"

#include <Eigen/Geometry>

#include <chrono>
#include <cmath>

namespace concord::fem {
namespace {

/// Adds the time until it dies to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : m_sum(sum) {}
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;
  ~Stopwatch() {
    m_sum += std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
  }

 private:
  double& m_sum;
  std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

/// Whether event k of `count` evenly spaced ones is due at t; half a billionth of the run
/// forgives round-off.
bool due(double t, double end, int done, int count) {
  return count > 0 && t >= end * (static_cast<double>(done) / count - 5e-10);
}

std::span<const double> flat(const std::vector<Vec3>& values) {
  return {values.front().data(), 3 * values.size()};
}

}  // namespace

template <int dim>
Observer<dim>::Observer(const scene::Problem& problem, const scene::RunRequest& request,
                        const Discretisation<dim>& discretisation,
                        const NodalFields<dim>& fields, const Prescribed<dim>& prescribed,
                        bool free_body, scene::Result& result)
    : m_problem(problem), m_request(request), m_discretisation(discretisation),
      m_fields(fields), m_result(result),
      m_quantities(problem, discretisation, fields, prescribed), m_free_body(free_body) {
  const scene::Mesh& mesh = discretisation.mesh();
  const std::vector<int> order = discretisation.cell_shape().vtk_order();
  m_vtk_offsets.push_back(0);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    for (const int k : order) m_vtk_cells.push_back(mesh.cells[c * mesh.nodes_per_cell + k]);
    m_vtk_offsets.push_back(static_cast<Index>(m_vtk_cells.size()));
    m_vtk_types.push_back(discretisation.cell_shape().vtk_type());
  }
}

template <int dim> void Observer<dim>::connect(const InternalForce& force, MassProduct mass) {
  m_force = &force;
  m_mass = std::move(mass);
}

template <int dim> std::vector<std::string> Observer<dim>::columns() const {
  std::vector<std::string> names{"t_s"};
  const auto add = [&names](const std::vector<std::string>& more) {
    names.insert(names.end(), more.begin(), more.end());
  };
  add(m_quantities.columns());
  if (m_mass) add({"kinetic_energy_J"});
  add({"internal_energy_J"});
  if (m_fields.plastic()) add({"plastic_work_J"});
  add({"external_work_J", "energy_balance_J"});
  if (!m_mass) return names;
  for (const char axis : {'x', 'y', 'z'})
    add({std::string("linear_momentum_") + axis + "_kg_m_s"});
  for (const char axis : {'x', 'y', 'z'})
    add({std::string("angular_momentum_") + axis + "_kg_m2_s"});
  return names;
}

template <int dim> void Observer<dim>::start(const State& state) {
  const Stopwatch watch(m_seconds);
  if (!m_request.out.empty()) {
    m_history = scene::HistoryWriter(m_request.out / "history.csv", columns());
    if (m_request.write_frames) m_frames = scene::FrameWriter(m_request.out);
  }
  row(state);
  m_rows_done = 1;
  if (m_problem.frames > 0) frame(state);
  m_frames_done = 1;
}

template <int dim> void Observer<dim>::after_step(const State& state) {
  const Stopwatch watch(m_seconds);
  const double end = m_problem.end_time;
  const bool every = m_problem.is_static;
  if (every || due(state.t, end, m_rows_done, m_problem.history_rows)) {
    row(state);
    while (due(state.t, end, m_rows_done, m_problem.history_rows)) ++m_rows_done;
    if (m_request.progress) {
      m_request.progress(end > 0 ? std::min(1.0, state.t / end) : 1.0,
                         "step " + std::to_string(state.step));
    }
  }
  if (due(state.t, end, m_frames_done, m_problem.frames)) {
    frame(state);
    while (due(state.t, end, m_frames_done, m_problem.frames)) ++m_frames_done;
  }
  scene::check_interrupt();
}

template <int dim> void Observer<dim>::row(const State& state) {
  m_last_row = state.t;
  std::vector<double> values{state.t};
  const std::vector<double> quantities = m_quantities.evaluate(state, m_mass);
  for (std::size_t k = 0; k < quantities.size(); ++k) {
    m_result.quantities[m_quantities.keys()[k]] = quantities[k];
    values.push_back(quantities[k]);
  }
  double total = 0;
  std::array<Vec3, 2> momentum{Vec3::Zero(), Vec3::Zero()};
  if (m_mass) {
    State::Vector Mv(state.v.size());
    m_mass(state.v, Mv);
    total = 0.5 * (state.v * Mv);
    values.push_back(total);
    m_kinetic_max = std::max(m_kinetic_max, total);
    momentum = momenta(state, Mv);
    follow_momenta(momentum);
  }
  values.push_back(m_force->energy(state.u));
  total += values.back();
  if (m_fields.plastic()) {
    values.push_back(m_fields.plastic_work());
    total += values.back();
    m_result.quantities["gauss_plastic_strain_max"] = m_fields.peak_plastic_strain();
  }
  values.push_back(state.external_work);
  values.push_back(follow_energy(total, state.external_work));
  if (m_mass) {
    for (const Vec3& p : momentum) values.insert(values.end(), p.begin(), p.end());
  }
  if (m_history.active()) m_history.append(values);
  m_result.t_end = state.t;
  m_result.steps = state.step;
}

template <int dim> double Observer<dim>::follow_energy(double total, double external_work) {
  const double energy = total - external_work;
  if (m_rows_done == 0) m_energy_0 = energy;
  m_energy_change = std::max(m_energy_change, std::abs(energy - m_energy_0));
  m_energy_scale = std::max(m_energy_scale, total);
  return energy - m_energy_0;
}

template <int dim>
std::array<Vec3, 2> Observer<dim>::momenta(const State& state, const State::Vector& Mv) const {
  std::array<Vec3, 2> momentum{Vec3::Zero(), Vec3::Zero()};
  const scene::Mesh& mesh = m_discretisation.mesh();
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Index node = static_cast<Index>(n);
    const Vec3 p = m_discretisation.node_value(Mv, node);
    momentum[0] += p;
    momentum[1] += (mesh.nodes[n] + m_discretisation.node_value(state.u, node)).cross(p);
  }
  return momentum;
}

template <int dim> void Observer<dim>::follow_momenta(const std::array<Vec3, 2>& momentum) {
  if (m_rows_done == 0) m_momentum_0 = momentum;
  for (int k = 0; k < 2; ++k) {
    const Vec3 change = momentum[k] - m_momentum_0[k];
    if (!(change.norm() <= m_momentum_change[k].norm())) m_momentum_change[k] = change;
  }
}

template <int dim> void Observer<dim>::frame(const State& state) {
  m_last_frame = state.t;
  if (!m_frames.active()) return;
  const std::vector<Vec3> u = m_discretisation.at_nodes(state.u);
  std::vector<Vec3> x = m_discretisation.mesh().nodes, v, error;
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (m_problem.exact_displacement) {
      error.push_back(u[n] - (*m_problem.exact_displacement)(x[n], state.t));
    }
    x[n] += u[n];
  }
  std::vector<std::string> names = m_fields.frame_fields();
  names.emplace_back("pressure");  // every material has it, and particle methods write it too
  std::vector<std::vector<double>> scalars;
  for (const std::string& name : names) scalars.push_back(m_fields.at_nodes(name, state.u));
  std::vector<scene::FrameField> fields{{"displacement", 3, flat(u)}};
  for (std::size_t k = 0; k < names.size(); ++k) fields.push_back({names[k], 1, scalars[k]});
  if (m_mass) {
    v = m_discretisation.at_nodes(state.v);
    fields.push_back({"velocity", 3, flat(v)});
  }
  if (!error.empty()) fields.push_back({"displacement_error", 3, flat(error)});
  m_frames.write(state.t, x, fields, m_vtk_cells, m_vtk_offsets, m_vtk_types);
}

template <int dim> void Observer<dim>::finish(const State& state, bool sound) {
  const Stopwatch watch(m_seconds);
  m_result.t_end = state.t;
  m_result.steps = state.step;
  if (sound) {
    if (m_last_row < state.t) row(state);
    if (m_last_frame < state.t) frame(state);
    m_result.samples =
        sample(m_discretisation, m_fields, m_problem.thickness, state.u, state.v);
    m_result.field = std::make_shared<MeshField>(m_discretisation.mesh(),
                                                 m_discretisation.at_nodes(state.u));
  }
  if ((m_mass || m_fields.plastic()) && m_energy_scale > 0) {
    m_result.invariants["energy_drift"] = m_energy_change / m_energy_scale;
  }
  if (!m_mass) return;
  const scene::Mesh& mesh = m_discretisation.mesh();
  Vec3 low = mesh.nodes.front(), high = low;
  for (const Vec3& X : mesh.nodes) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  State::Vector unit(state.v.size()), M_unit(state.v.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (m_discretisation.used(static_cast<Index>(n)))
      unit[m_discretisation.dof(static_cast<Index>(n), 0)] = 1;
  }
  m_mass(unit, M_unit);
  const double scale = std::sqrt(2 * (unit * M_unit) * m_kinetic_max);
  if (!m_free_body || !(scale > 0)) return;
  m_result.invariants["linear_momentum_drift"] = m_momentum_change[0].norm() / scale;
  m_result.invariants["angular_momentum_drift"] =
      m_momentum_change[1].norm() / (scale * (high - low).norm());
}

template class Observer<2>;
template class Observer<3>;

}  // namespace concord::fem
