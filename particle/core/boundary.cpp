#include "particle/core/boundary.hpp"

#include "particle/core/inside_body.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace concord::particle {

std::array<bool, 3> prescribed_components(const scene::BoundaryCondition& bc,
                                          const scene::Mesh& mesh) {
  using scene::BoundaryKind;
  std::array<bool, 3> yes{false, false, false};
  switch (bc.kind) {
    case BoundaryKind::fixed:
      yes = {true, true, true};
      break;
    case BoundaryKind::symmetric:
      yes[mesh.group_axis(bc.group, bc.where)] = true;
      break;
    case BoundaryKind::antisymmetric:
      yes = {true, true, true};
      yes[mesh.group_axis(bc.group, bc.where)] = false;
      break;
    case BoundaryKind::displacement:
      for (int i = 0; i < 3; ++i)
        yes[i] = bc.value_from_exact || bc.value.component[i].has_value();
      break;
    case BoundaryKind::traction:
      break;
  }
  for (int i = mesh.dim; i < 3; ++i) yes[i] = false;
  return yes;
}

std::vector<char> points_of_group(const Body& body, const std::string& group,
                                  const SourcePosition& where) {
  std::vector<char> in(body.n, 0);
  const std::vector<Index> nodes = body.mesh.group_nodes(group, where);
  if (!body.inside()) {
    for (const Index node : nodes) in[body.particle[node]] = 1;
    return in;
  }
  const scene::Mesh::Group& members = body.mesh.groups.at(group);
  const auto has = [&](Index entity) {
    return std::find(members.entities.begin(), members.entities.end(), entity) !=
           members.entities.end();
  };
  if (members.dim == body.dim && is_whole_body(members, body.mesh))
    return std::vector<char>(body.n, 1);
  for (const SurfacePiece& piece : body.surface) {
    if (has(piece.entity)) in[piece.particle] = 1;
  }
  for (Index p = body.bulk; p < body.n; ++p) in[p] = has(body.boundary[p - body.bulk].entity);
  if (std::find(in.begin(), in.end(), 1) == in.end()) {
    throw InputError(where, "group",
                     fmt::format("\"{}\", which has no cell of a particle on it", group),
                     "a group of faces of the body (edges in the plane), or the whole body: "
                     "this method's particles lie inside");
  }
  return in;
}

namespace {

double prescribed_value(const scene::Problem& problem, const Body& body,
                        const PrescribedDof& dof, double t) {
  if (dof.condition < 0) return 0;
  const scene::BoundaryCondition& bc = problem.boundaries[dof.condition];
  if (bc.kind != scene::BoundaryKind::displacement) return 0;
  const scene::VectorExpression& u =
      bc.value_from_exact ? *problem.exact_displacement : bc.value;
  const auto& component = u.component[dof.component];
  return component ? (*component)(body.position(dof.particle), t) : 0.0;
}

}  // namespace

Constraints::Constraints(const scene::Problem& problem, const Body& body)
    : m_problem(problem), m_body(body) {
  body.inside() ? find_inside() : find_on_faces();
  for (const PrescribedDof& dof : m_dofs) {
    if (dof.condition < 0 || m_moving) continue;
    if (problem.boundaries[dof.condition].kind != scene::BoundaryKind::displacement) continue;
    for (const double share : {0.0, 0.37, 1.0})
      m_moving |= value(dof, share * problem.end_time) != 0;
  }
}

void Constraints::find_on_faces() {
  std::map<std::pair<Index, int>, PrescribedDof> all;
  const double tolerance = 1e-12 * m_problem.reference_length;
  for (std::size_t k = 0; k < m_problem.boundaries.size(); ++k) {
    const scene::BoundaryCondition& bc = m_problem.boundaries[k];
    if (bc.kind == scene::BoundaryKind::traction) continue;
    const std::array<bool, 3> components = prescribed_components(bc, m_body.mesh);
    for (const Index node : m_body.mesh.group_nodes(bc.group, bc.where)) {
      for (int i = 0; i < m_body.dim; ++i) {
        if (!components[i]) continue;
        const PrescribedDof dof{m_body.particle[node], i, static_cast<Index>(k), Vec3::Zero()};
        const auto [it, fresh] = all.try_emplace({dof.particle, i}, dof);
        if (fresh) continue;
        for (const double share : {0.0, 0.5, 1.0}) {
          const double t = share * m_problem.end_time;
          const double first = prescribed_value(m_problem, m_body, it->second, t);
          const double second = prescribed_value(m_problem, m_body, dof, t);
          if (std::abs(first - second) <= tolerance) continue;
          throw InputError(bc.where, "boundary",
                           fmt::format("groups \"{}\" and \"{}\" prescribe different "
                                       "displacements ({:.6g} m and {:.6g} m, "
                                       "component {}) where they meet",
                                       m_problem.boundaries[it->second.condition].group,
                                       bc.group, first, second, "XYZ"[i]),
                           "conditions that agree on shared points, or \"free\" for the "
                           "component in one of them");
        }
      }
    }
  }
  m_dofs.reserve(all.size());
  for (const auto& [key, dof] : all) m_dofs.push_back(dof);
}

void Constraints::find_inside() {
  const Conditions everywhere = conditions_everywhere(m_problem, m_body.mesh);
  for (Index a = 0; a < m_body.bulk; ++a) {
    for (int i = 0; i < m_body.dim; ++i) {
      if (everywhere[i] >= 0) m_dofs.push_back({a, i, everywhere[i], Vec3::Zero()});
    }
  }
  for (Index p = m_body.bulk; p < m_body.n; ++p) {
    const BoundaryPoint& point = m_body.boundary[p - m_body.bulk];
    for (int i = 0; i < m_body.dim; ++i) m_dofs.push_back({p, i, point.condition[i], point.N});
  }
}

double Constraints::value(const PrescribedDof& dof, double t) const {
  return prescribed_value(m_problem, m_body, dof, t);
}

void Constraints::impose(double t, std::span<double> u) const {
  for (const PrescribedDof& dof : m_dofs) {
    u[static_cast<std::size_t>(dof.particle) * m_body.stride + dof.component] =
        m_moving ? value(dof, t) : 0.0;
  }
}

void Constraints::clear(std::span<double> column) const {
  for (const PrescribedDof& dof : m_dofs) {
    column[static_cast<std::size_t>(dof.particle) * m_body.stride + dof.component] = 0.0;
  }
}

}  // namespace concord::particle
