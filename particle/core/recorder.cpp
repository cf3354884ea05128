#include "particle/core/recorder.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace concord::particle {

Recorder::Recorder(const scene::Problem& problem, ForceModel& model,
                   const Constraints& constraints, const Executor& executor,
                   const std::filesystem::path& folder, bool frames, bool dissipative,
                   bool resumes)
    : m_problem(problem), m_model(model), m_executor(executor),
      m_quantities(problem, model, constraints), m_free(constraints.dofs().empty()),
      m_dissipative(dissipative), m_folder(folder), m_write_frames(frames && !folder.empty()) {
  if (const Fracturing* fracturing = model.fracturing())
    m_crack.emplace(problem, model.body(), constraints, *fracturing);
  else if (Hourglass(model.body()).defined())
    m_hourglass.emplace(model.body());
  const ExternalLoads loads(problem, model);
  m_steady = !loads.depend_on_time();
  m_unloaded = loads.none();
  if (folder.empty() || resumes) return;
  scene::writing(history_file(), [&] {
    m_history = scene::HistoryWriter(history_file(), columns());
    m_history_bytes = file_size(history_file());
  });
}

std::vector<std::string> Recorder::columns() const {
  std::vector<std::string> names{"t_s"};
  names.insert(names.end(), m_quantities.columns().begin(), m_quantities.columns().end());
  names.insert(names.end(),
               {"kinetic_energy_J", "internal_energy_J", "stabilisation_energy_J"});
  if (m_model.constitution().plastic()) names.emplace_back("plastic_work_J");
  if (m_dissipative) names.emplace_back("viscous_dissipation_J");
  if (m_crack) names.emplace_back("fracture_energy_J");
  names.insert(names.end(), {"external_work_J", "energy_balance_J"});
  for (const char axis : {'x', 'y', 'z'})
    names.push_back(fmt::format("linear_momentum_{}_kg_m_s", axis));
  for (const char axis : {'x', 'y', 'z'})
    names.push_back(fmt::format("angular_momentum_{}_kg_m2_s", axis));
  if (m_crack) {
    const std::vector<std::string> last = CrackQuantities::columns();
    names.insert(names.end(), last.begin(), last.end());
  }
  if (m_hourglass) names.insert(names.end(), {"nonaffine_energy_share", "checkerboard"});
  return names;
}

std::span<const Mat3> Recorder::gradients(const State& state) {
  m_H.resize(m_model.body().bulk);
  m_model.gradients(state.u, m_H);
  return m_H;
}

/// Kinetic energy, momenta and their scales.
void Recorder::add_motion(const State& state, Balance& b) const {
  if (state.v.empty()) return;
  const Body& body = m_model.body();
  for (Index a = 0; a < body.bulk; ++a) {
    const Vec3 v = column_vector(state.v, body, a);
    const Vec3 x = body.position(a) + column_vector(state.u, body, a), p = body.m[a] * v;
    const double speed = v.norm();
    b.kinetic += 0.5 * body.m[a] * speed * speed;
    b.linear += p;
    b.angular += x.cross(p);
    b.linear_scale += body.m[a] * speed;
    b.angular_scale += body.m[a] * x.norm() * speed;
  }
}

Balance Recorder::balance(const State& state) {
  Balance b;
  const Energies e = m_model.energies(state.u, m_executor);
  b.internal = e.internal;
  b.plastic = e.plastic;
  b.stabilisation = e.stabilisation;
  b.dissipation = state.dissipation;
  b.released = state.released;
  b.external_work = state.external_work;
  add_motion(state, b);
  return b;
}

void Recorder::follow(const Balance& b, const Vec3& impulse) {
  m_account.largest_energy =
      std::max(m_account.largest_energy, b.stored() + std::abs(b.external_work));
  m_account.largest_work = std::max(m_account.largest_work, std::abs(b.external_work));
  m_account.energy_change =
      std::max(m_account.energy_change, std::abs(b.total() - m_account.first.total()));
  m_account.linear_change =
      std::max(m_account.linear_change, (b.linear - m_account.first.linear - impulse).norm());
  m_account.angular_change =
      std::max(m_account.angular_change, (b.angular - m_account.first.angular).norm());
  m_account.linear_scale = std::max(m_account.linear_scale, b.linear_scale);
  m_account.angular_scale = std::max(m_account.angular_scale, b.angular_scale);
}

void Recorder::follow(const Balance& b, const Roughness& roughness) {
  const double E = m_problem.material.E, energy = b.internal + b.plastic;
  m_account.share = roughness.nonaffine_energy_share(E, energy);
  m_account.checkerboard = roughness.checkerboard();
  m_account.share_max = std::max(m_account.share_max, m_account.share);
  m_account.checkerboard_max = std::max(m_account.checkerboard_max, m_account.checkerboard);
  m_account.nonaffine_sum += roughness.nonaffine_energy(E);
  m_account.energy_sum += roughness.nonaffine_energy(E) + energy;
}

void Recorder::row(const State& state) {
  const Account before = m_account;
  try {
    add_row(state);
  } catch (...) {
    m_account = before;
    throw;
  }
}

void Recorder::add_row(const State& state) {
  const Balance b = balance(state);
  if (!m_account.any) m_account.first = b;
  m_account.last = b;
  m_account.any = true;
  const std::span<const Mat3> H = gradients(state);
  follow(b, state.impulse);
  if (m_hourglass) follow(b, m_hourglass->measure(state.u, H));
  if (m_crack) m_account.crack_toll.add(m_crack->advance_share(), {b.dissipation, b.released});
  if (!m_history.active()) return;
  m_values.assign(1, state.t);
  m_quantities.append(state, H, m_values);
  m_values.insert(m_values.end(), {b.kinetic, b.internal, b.stabilisation});
  if (m_model.constitution().plastic()) m_values.push_back(b.plastic);
  if (m_dissipative) m_values.push_back(b.dissipation);
  if (m_crack) m_values.push_back(b.released);
  m_values.insert(m_values.end(), {b.external_work, b.total() - m_account.first.total()});
  m_values.insert(m_values.end(), b.linear.begin(), b.linear.end());
  m_values.insert(m_values.end(), b.angular.begin(), b.angular.end());
  if (m_crack) m_crack->append(m_values);
  if (m_hourglass) m_values.insert(m_values.end(), {m_account.share, m_account.checkerboard});
  try {
    scene::writing(history_file(), [&] { m_history.append(m_values); });
    std::error_code gone;  // someone may have moved it away
    const std::uintmax_t bytes = file_size(history_file(), gone);
    if (!gone) m_history_bytes = bytes;
  } catch (const scene::OutputError&) {
    m_history = {};  // what it still holds goes first
    scene::cut_back(history_file(), m_history_bytes);
    throw;
  }
}

std::vector<std::pair<std::string, double>> Recorder::quantities(const State& state) {
  std::vector<double> values;
  m_quantities.append(state, gradients(state), values);
  std::vector<std::pair<std::string, double>> result;
  for (std::size_t k = 0; k < values.size(); ++k)
    result.emplace_back(m_quantities.names()[k], values[k]);
  return result;
}

void Recorder::frame(const State& state) {
  if (!m_write_frames) return;
  const Body& body = m_model.body();
  std::vector<Vec3> x(body.bulk), u(body.bulk), v(body.bulk);
  for (Index a = 0; a < body.bulk; ++a) {
    u[a] = column_vector(state.u, body, a);
    v[a] = column_vector(state.v, body, a);
    x[a] = body.position(a) + u[a];
  }
  const auto flat = [](const std::vector<Vec3>& values) {
    return std::span<const double>(values.front().data(), 3 * values.size());
  };
  const std::span<const double> volumes(body.V.data(), body.bulk);
  const std::span<const Mat3> H = gradients(state);
  std::vector<std::string> names{"von_mises", "pressure", "kirchhoff_mises"};
  if (m_model.constitution().plastic()) names.emplace_back("plastic_strain");
  std::vector<std::vector<double>> values;
  for (const std::string& name : names) values.push_back(material_field(m_model, H, name));
  if (m_problem.exact_displacement) {
    names.emplace_back("displacement_error");
    values.push_back(m_quantities.displacement_error(state));
  }
  std::vector<scene::FrameField> fields{
      {"displacement", 3, flat(u)}, {"velocity", 3, flat(v)}, {"volume", 1, volumes}};
  for (std::size_t k = 0; k < names.size(); ++k) fields.push_back({names[k], 1, values[k]});
  std::vector<double> intact;
  if (m_crack) {
    intact.resize(body.bulk);
    m_model.fracturing()->intact_share(intact);
    fields.push_back({"intact_share", 1, intact});
  }
  scene::add_frame(m_folder, m_frames, state.t, x, fields);
}

void Recorder::add_invariants(scene::Result& result, bool damped) const {
  if (!m_account.any) return;
  if (m_account.largest_energy > 0)
    result.invariants["energy_drift"] = m_account.energy_change / m_account.largest_energy;
  if (damped || !m_free || m_account.linear_scale == 0) return;
  if (m_steady)
    result.invariants["linear_momentum_drift"] =
        m_account.linear_change / m_account.linear_scale;
  if (m_unloaded)
    result.invariants["angular_momentum_drift"] =
        m_account.angular_change / m_account.angular_scale;
}

void Recorder::add_hourglass(scene::Result& result) const {
  if (!m_account.any || !m_hourglass) return;
  result.quantities["nonaffine_energy_share"] = m_account.share;
  result.quantities["nonaffine_energy_share_max"] = m_account.share_max;
  if (m_account.energy_sum > 0)
    result.quantities["nonaffine_energy_share_mean"] =
        m_account.nonaffine_sum / m_account.energy_sum;
  result.quantities["checkerboard"] = m_account.checkerboard;
  result.quantities["checkerboard_max"] = m_account.checkerboard_max;
}

void Recorder::add_cracks(scene::Result& result) {
  if (!m_account.any || !m_crack) return;
  for (const auto& [name, value] : m_crack->quantities()) result.quantities[name] = value;
  if (m_account.largest_work > 0)
    result.quantities["energy_residual"] = m_account.energy_change / m_account.largest_work;
  const double lost = m_account.last.dissipation + m_account.last.released;
  if (lost > 0) result.quantities["dissipated_share"] = lost / (lost + m_account.last.stored());
  if (const std::optional<CrackCost> cost = m_account.crack_toll.paid()) {
    for (const auto& [name, value] : m_crack->toughness(*cost)) result.quantities[name] = value;
  }
  if (m_folder.empty()) return;
  const std::filesystem::path file = m_folder / "crack.csv";
  scene::writing(file, [&] { m_crack->write(file); });
}

scene::Samples Recorder::samples(const State& state) {
  const Body& body = m_model.body();
  scene::Samples s;
  const std::span<const Mat3> H = gradients(state);
  for (Index a = 0; a < body.bulk; ++a) {
    s.X.push_back(body.position(a));
    s.u.push_back(column_vector(state.u, body, a));
    if (!m_problem.is_static) s.v.push_back(column_vector(state.v, body, a));
    s.F.push_back(Mat3::Identity() + H[a]);
  }
  s.weight.assign(body.V.begin(), body.V.begin() + body.bulk);
  return s;
}

}  // namespace concord::particle
