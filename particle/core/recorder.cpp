#include "particle/core/recorder.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace concord::particle {
namespace {

const std::array<const char*, 3> axes{"x", "y", "z"};

/// Column of history.csv of a quantity's entry: NAME_x_m for vectors in metres.
std::string history_name(const scene::Quantity& q, const std::string& entry) {
  switch (q.kind) {
    case scene::QuantityKind::point:
    case scene::QuantityKind::average:
      return entry + "_m";
    case scene::QuantityKind::reaction:
      return entry + "_N";
    case scene::QuantityKind::maximum:
      break;
  }
  if (q.field == "velocity") return entry + "_m_s";
  if (q.field == "von_mises" || q.field == "pressure" || q.field == "kirchhoff_mises")
    return entry + "_Pa";
  if (q.field == "plastic_strain") return entry;
  return entry + (q.field == "unbalanced_force" ? "_N" : "_m");
}

}  // namespace

Recorder::Recorder(const scene::Problem& problem, ForceModel& model,
                   const Constraints& constraints, const Executor& executor,
                   const std::filesystem::path& folder, bool frames)
    : m_problem(problem), m_model(model), m_constraints(constraints), m_executor(executor),
      m_free(constraints.dofs().empty() && ExternalLoads(problem, model.body()).none()) {
  const Body& body = model.body();
  for (const scene::Quantity& q : problem.quantities) {
    if (!q.group.empty()) (void)body.mesh.group_nodes(q.group, q.where);
  }
  if (folder.empty()) return;
  std::vector<std::string> columns{"t_s"};
  State zero;
  const Column nothing(body.X.size(), 0.0);
  zero.u = zero.v = zero.unbalanced = nothing;
  std::size_t k = 0;
  const auto entries = quantities(zero);
  for (const scene::Quantity& q : problem.quantities) {
    const std::size_t count = q.kind == scene::QuantityKind::maximum ? 1 : body.dim;
    for (std::size_t i = 0; i < count; ++i)
      columns.push_back(history_name(q, entries[k++].first));
  }
  for (const char* name : {"kinetic_energy_J", "internal_energy_J", "stabilisation_energy_J",
                           "external_work_J", "energy_balance_J"}) {
    columns.emplace_back(name);
  }
  if (model.constitution().plastic()) columns.emplace_back("plastic_work_J");
  for (const char* axis : axes)
    columns.push_back(fmt::format("linear_momentum_{}_kg_m_s", axis));
  for (const char* axis : axes)
    columns.push_back(fmt::format("angular_momentum_{}_kg_m2_s", axis));
  m_history = scene::HistoryWriter(folder / "history.csv", columns);
  if (!frames) return;
  m_frames = scene::FrameWriter(folder);
}

Vec3 Recorder::at(std::span<const double> column, Index a) const {
  Vec3 r = Vec3::Zero();
  if (column.empty()) return r;
  const Body& body = m_model.body();
  for (int i = 0; i < body.dim; ++i)
    r[i] = column[static_cast<std::size_t>(a) * body.stride + i];
  return r;
}

Balance Recorder::balance(const State& state) {
  const Body& body = m_model.body();
  Balance b;
  const Energies e = m_model.energies(state.u, m_executor);
  b.internal = e.internal;
  b.plastic = e.plastic;
  b.stabilisation = e.stabilisation;
  b.external_work = state.external_work;
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 v = at(state.v, a), x = body.position(a) + at(state.u, a);
    b.kinetic += 0.5 * body.m[a] * v.squaredNorm();
    b.linear += body.m[a] * v;
    b.angular += body.m[a] * x.cross(v);
    b.linear_scale += body.m[a] * v.norm();
    b.angular_scale += body.m[a] * x.norm() * v.norm();
  }
  return b;
}

void Recorder::row(const State& state) {
  const Balance b = balance(state);
  if (!m_any) m_first = b;
  m_any = true;
  m_largest_energy = std::max(m_largest_energy, b.stored() + std::abs(b.external_work));
  m_energy_change = std::max(m_energy_change, std::abs(b.total() - m_first.total()));
  m_linear_change = std::max(m_linear_change, (b.linear - m_first.linear).norm());
  m_angular_change = std::max(m_angular_change, (b.angular - m_first.angular).norm());
  m_linear_scale = std::max(m_linear_scale, b.linear_scale);
  m_angular_scale = std::max(m_angular_scale, b.angular_scale);
  if (!m_history.active()) return;
  std::vector<double> values{state.t};
  for (const auto& [name, value] : quantities(state)) values.push_back(value);
  for (const double e : {b.kinetic, b.internal, b.stabilisation, b.external_work, b.total()})
    values.push_back(e);
  if (m_model.constitution().plastic()) values.push_back(b.plastic);
  for (int i = 0; i < 3; ++i) values.push_back(b.linear[i]);
  for (int i = 0; i < 3; ++i) values.push_back(b.angular[i]);
  m_history.append(values);
}

std::vector<double> Recorder::values(const std::string& field, const State& state) {
  const Body& body = m_model.body();
  std::vector<double> result(body.n);
  if (field == "von_mises" || field == "pressure" || field == "kirchhoff_mises" ||
      field == "plastic_strain") {
    std::vector<Mat3> H(body.n);
    m_model.gradients(state.u, H);
    if (field == "plastic_strain") return plastic_strains(H);
    Stresses s = stresses(H);
    return std::move(field == "pressure"    ? s.pressure
                     : field == "von_mises" ? s.von_mises
                                            : s.kirchhoff_mises);
  }
  std::vector<char> prescribed(body.n, 0);
  for (const PrescribedDof& dof : m_constraints.dofs()) prescribed[dof.particle] = 1;
  const bool all = std::count(prescribed.begin(), prescribed.end(), 0) == 0;
  for (Index a = 0; a < body.n; ++a) {
    if (field == "displacement")
      result[a] = at(state.u, a).norm();
    else if (field == "velocity")
      result[a] = at(state.v, a).norm();
    else if (field == "unbalanced_force")
      result[a] = prescribed[a] && !all ? 0.0 : at(state.unbalanced, a).norm();
    else
      result[a] =
          (at(state.u, a) - (*m_problem.exact_displacement)(body.position(a), state.t)).norm();
  }
  return result;
}

double Recorder::maximum(const scene::Quantity& q, const State& state) {
  const Body& body = m_model.body();
  const std::vector<double> field = values(q.field, state);
  std::vector<char> inside(body.n, q.group.empty() ? 1 : 0);
  if (!q.group.empty()) {
    for (const Index node : body.mesh.group_nodes(q.group, q.where))
      inside[body.particle[node]] = 1;
  }
  double largest = -1e300;
  for (Index a = 0; a < body.n; ++a) {
    if (!inside[a] || (q.interior_only && body.triangulation.on_boundary[a])) continue;
    if (std::isnan(field[a])) return field[a];
    largest = std::max(largest, field[a]);
  }
  return largest == -1e300 ? 0.0 : largest;
}

std::vector<std::pair<std::string, double>> Recorder::quantities(const State& state) {
  const Body& body = m_model.body();
  std::vector<std::pair<std::string, double>> result;
  const auto add_vector = [&](const std::string& name, const Vec3& value) {
    for (int i = 0; i < body.dim; ++i) result.emplace_back(name + "_" + axes[i], value[i]);
  };
  for (const scene::Quantity& q : m_problem.quantities) {
    switch (q.kind) {
      case scene::QuantityKind::point: {
        // The particle there if there is one; else the linear combination over the nearest
        // simplex is left to the field: probes between particles take the nearest particle's
        // first-order expansion.
        Index nearest = 0;
        double distance = 1e300;
        for (Index a = 0; a < body.n; ++a) {
          const double d = (body.position(a) - q.at).squaredNorm();
          if (d < distance) distance = d, nearest = a;
        }
        Vec3 u = at(state.u, nearest);
        if (distance > 1e-18 * body.h * body.h) {
          std::vector<Mat3> H(body.n);
          m_model.gradients(state.u, H);
          u += H[nearest] * (q.at - body.position(nearest));
        }
        add_vector(q.name, u);
        break;
      }
      case scene::QuantityKind::average: {
        Vec3 sum = Vec3::Zero();
        double area = 0;
        for (const auto& [a, share] : ExternalLoads::group_areas(body, q.group, q.where)) {
          sum += share * at(state.u, a);
          area += share;
        }
        add_vector(q.name, sum / area);
        break;
      }
      case scene::QuantityKind::reaction: {
        // The constraint force that keeps the group moving as prescribed: R = m a - f on
        // prescribed components.
        std::vector<char> inside(body.n, 0);
        for (const Index node : body.mesh.group_nodes(q.group, q.where))
          inside[body.particle[node]] = 1;
        Vec3 R = Vec3::Zero();
        for (const PrescribedDof& dof : m_constraints.dofs()) {
          if (!inside[dof.particle]) continue;
          R[dof.component] -= at(state.unbalanced, dof.particle)[dof.component];
          R[dof.component] +=
              body.m[dof.particle] * at(state.acceleration, dof.particle)[dof.component];
        }
        add_vector(q.name, R);
        break;
      }
      case scene::QuantityKind::maximum:
        result.emplace_back(q.name, maximum(q, state));
        break;
    }
  }
  return result;
}

Recorder::Stresses Recorder::stresses(std::span<const Mat3> H) const {
  Stresses s;
  for (Index a = 0; a < static_cast<Index>(H.size()); ++a) {
    const Mat3 F = Mat3::Identity() + H[a];
    const Mat3 P = m_model.constitution().stress(a, H[a]);
    const Mat3 sigma = scene::cauchy_stress(P, F);
    s.von_mises.push_back(scene::von_mises(sigma));
    s.pressure.push_back(scene::pressure(sigma));
    s.kirchhoff_mises.push_back(scene::von_mises(P * F.transpose()));
  }
  return s;
}

std::vector<double> Recorder::plastic_strains(std::span<const Mat3> H) const {
  std::vector<double> result;
  for (Index a = 0; a < static_cast<Index>(H.size()); ++a)
    result.push_back(m_model.constitution().plastic_strain(a, H[a]));
  return result;
}

void Recorder::frame(const State& state) {
  if (!m_frames.active()) return;
  const Body& body = m_model.body();
  std::vector<Vec3> x(body.n);
  std::vector<double> u, v, error;
  std::vector<Mat3> H(body.n);
  m_model.gradients(state.u, H);
  const Stresses stress = stresses(H);
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 u_a = at(state.u, a), v_a = at(state.v, a);
    x[a] = body.position(a) + u_a;
    u.insert(u.end(), {u_a[0], u_a[1], u_a[2]});
    v.insert(v.end(), {v_a[0], v_a[1], v_a[2]});
  }
  std::vector<scene::FrameField> fields{{"displacement", 3, u},
                                        {"velocity", 3, v},
                                        {"von_mises", 1, stress.von_mises},
                                        {"pressure", 1, stress.pressure},
                                        {"kirchhoff_mises", 1, stress.kirchhoff_mises},
                                        {"volume", 1, body.V}};
  std::vector<double> plastic;
  if (m_model.constitution().plastic()) {
    plastic = plastic_strains(H);
    fields.push_back({"plastic_strain", 1, plastic});
  }
  if (m_problem.exact_displacement) {
    error = values("displacement_error", state);
    fields.push_back({"displacement_error", 1, error});
  }
  m_frames.write(state.t, x, fields);
}

void Recorder::add_invariants(scene::Result& result, bool dissipative) const {
  if (!m_any) return;
  if (!dissipative && m_largest_energy > 0)
    result.invariants["energy_drift"] = m_energy_change / m_largest_energy;
  if (!m_free || m_linear_scale == 0) return;
  result.invariants["linear_momentum_drift"] = m_linear_change / m_linear_scale;
  result.invariants["angular_momentum_drift"] = m_angular_change / m_angular_scale;
}

scene::Samples Recorder::samples(const State& state) {
  const Body& body = m_model.body();
  scene::Samples s;
  std::vector<Mat3> H(body.n);
  m_model.gradients(state.u, H);
  for (Index a = 0; a < body.n; ++a) {
    s.X.push_back(body.position(a));
    s.u.push_back(at(state.u, a));
    if (!m_problem.is_static) s.v.push_back(at(state.v, a));
    s.F.push_back(Mat3::Identity() + H[a]);
  }
  s.weight = body.V;
  return s;
}

}  // namespace concord::particle
