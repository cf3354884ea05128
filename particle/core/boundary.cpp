#include "particle/core/boundary.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace concord::particle {
namespace {

/// Area vector (outward) of a boundary facet, thickness included [m^2].
Vec3 facet_area(const Body& body, Index facet) {
  const Index* v = &body.triangulation.boundary[static_cast<std::size_t>(facet) * body.dim];
  if (body.dim == 2) {
    const Vec3 e = body.position(v[1]) - body.position(v[0]);
    return Vec3(e[1], -e[0], 0) * body.thickness;
  }
  return 0.5 * (body.position(v[1]) - body.position(v[0]))
                   .cross(body.position(v[2]) - body.position(v[0]));
}

/// Which components a condition prescribes on its group.
std::array<bool, 3> prescribed_components(const scene::BoundaryCondition& bc,
                                          const Body& body) {
  using scene::BoundaryKind;
  std::array<bool, 3> yes{false, false, false};
  switch (bc.kind) {
    case BoundaryKind::fixed:
      yes = {true, true, true};
      break;
    case BoundaryKind::symmetric:
      yes[body.mesh.group_axis(bc.group, bc.where)] = true;
      break;
    case BoundaryKind::antisymmetric:
      yes = {true, true, true};
      yes[body.mesh.group_axis(bc.group, bc.where)] = false;
      break;
    case BoundaryKind::displacement:
      for (int i = 0; i < 3; ++i)
        yes[i] = bc.value_from_exact || bc.value.component[i].has_value();
      break;
    case BoundaryKind::traction:
      break;
  }
  for (int i = body.dim; i < 3; ++i) yes[i] = false;
  return yes;
}

double prescribed_value(const scene::Problem& problem, const Body& body,
                        const PrescribedDof& dof, double t) {
  const scene::BoundaryCondition& bc = problem.boundaries[dof.condition];
  if (bc.kind != scene::BoundaryKind::displacement) return 0;
  return problem.boundary_value(bc, body.position(dof.particle), t, dof.normal)[dof.component];
}

}  // namespace

Constraints::Constraints(const scene::Problem& problem, const Body& body)
    : m_problem(problem), m_body(body) {
  std::map<std::pair<Index, int>, PrescribedDof> all;
  const double tolerance = 1e-12 * problem.reference_length;
  for (std::size_t k = 0; k < problem.boundaries.size(); ++k) {
    const scene::BoundaryCondition& bc = problem.boundaries[k];
    if (bc.kind == scene::BoundaryKind::traction) continue;
    const std::array<bool, 3> components = prescribed_components(bc, body);
    for (const Index node : body.mesh.group_nodes(bc.group, bc.where)) {
      for (int i = 0; i < body.dim; ++i) {
        if (!components[i]) continue;
        const PrescribedDof dof{body.particle[node], i, static_cast<Index>(k), Vec3::Zero()};
        const auto [it, fresh] = all.try_emplace({dof.particle, i}, dof);
        if (fresh) continue;
        for (const double share : {0.0, 0.5, 1.0}) {
          const double t = share * problem.end_time;
          const double first = prescribed_value(problem, body, it->second, t);
          const double second = prescribed_value(problem, body, dof, t);
          if (std::abs(first - second) <= tolerance) continue;
          throw InputError(bc.where, "boundary",
                           fmt::format("groups \"{}\" and \"{}\" prescribe different "
                                       "displacements ({:.6g} m and {:.6g} m, "
                                       "component {}) where they meet",
                                       problem.boundaries[it->second.condition].group, bc.group,
                                       first, second, "XYZ"[i]),
                           "conditions that agree on shared points, or \"free\" for the "
                           "component in one of them");
        }
      }
    }
  }
  m_dofs.reserve(all.size());
  for (const auto& [key, dof] : all) {
    m_dofs.push_back(dof);
    const scene::BoundaryCondition& bc = problem.boundaries[dof.condition];
    if (bc.kind != scene::BoundaryKind::displacement || m_moving) continue;
    for (const double share : {0.0, 0.37, 1.0})
      m_moving |= value(dof, share * problem.end_time) != 0;
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

std::vector<Index> group_boundary_facets(const Body& body, const std::string& group,
                                         const SourcePosition& where) {
  (void)body.mesh.group_facets(
      group, where);  // reports a missing group, or one of the wrong dimension
  const std::vector<Index>& entities = body.mesh.groups.at(group).entities;
  std::vector<Index> facets;
  const std::vector<Index>& entity = body.triangulation.boundary_entity;
  for (std::size_t f = 0; f < entity.size(); ++f) {
    if (std::find(entities.begin(), entities.end(), entity[f]) != entities.end())
      facets.push_back(static_cast<Index>(f));
  }
  return facets;
}

std::vector<std::pair<Index, double>> ExternalLoads::group_areas(const Body& body,
                                                                 const std::string& group,
                                                                 const SourcePosition& where) {
  std::map<Index, double> area;
  for (const Index f : group_boundary_facets(body, group, where)) {
    const double share = facet_area(body, f).norm() / body.dim;
    for (int k = 0; k < body.dim; ++k)
      area[body.triangulation.boundary[static_cast<std::size_t>(f) * body.dim + k]] += share;
  }
  return {area.begin(), area.end()};
}

ExternalLoads::ExternalLoads(const scene::Problem& problem, const Body& body)
    : m_problem(problem), m_body(body) {
  const bool body_force = problem.body_force && !problem.body_force->is_zero();
  m_varying_body = body_force && problem.body_force->depends_on_time();
  if (!problem.gravity.isZero() || (body_force && !m_varying_body)) {
    m_constant_dense.assign(body.X.size(), 0.0);
    for (Index a = 0; a < body.n; ++a) {
      Vec3 load = body.m[a] * problem.gravity;
      if (body_force && !m_varying_body)
        load += body.V[a] * (*problem.body_force)(body.position(a), 0);
      for (int i = 0; i < body.dim; ++i)
        m_constant_dense[static_cast<std::size_t>(a) * body.stride + i] = load[i];
    }
  }
  std::map<Index, Vec3> constant;
  for (std::size_t k = 0; k < problem.boundaries.size(); ++k) {
    const scene::BoundaryCondition& bc = problem.boundaries[k];
    if (bc.kind != scene::BoundaryKind::traction) continue;
    const bool varying = bc.value_from_exact || bc.value.depends_on_time();
    std::vector<Entry> entries;
    for (const Index f : group_boundary_facets(body, bc.group, bc.where)) {
      const Vec3 A = facet_area(body, f);
      for (int v = 0; v < body.dim; ++v) {
        const Index a = body.triangulation.boundary[static_cast<std::size_t>(f) * body.dim + v];
        entries.push_back({a, static_cast<Index>(k), A.norm() / body.dim, A.normalized()});
      }
    }
    // One entry a particle and direction: facets of a plane face share their normal.
    std::sort(entries.begin(), entries.end(),
              [](const Entry& p, const Entry& q) { return p.particle < q.particle; });
    std::vector<Entry> merged;
    for (const Entry& e : entries) {
      const bool same =
          !merged.empty() && merged.back().particle == e.particle &&
          (!bc.value_from_exact || (merged.back().normal - e.normal).norm() < 1e-9);
      if (same)
        merged.back().area += e.area;
      else
        merged.push_back(e);
    }
    if (varying) {
      m_varying.insert(m_varying.end(), merged.begin(), merged.end());
    } else {
      for (const Entry& e : merged)
        constant.try_emplace(e.particle, Vec3::Zero()).first->second += traction(e, 0);
    }
  }
  m_constant.assign(constant.begin(), constant.end());
}

Vec3 ExternalLoads::traction(const Entry& e, double t) const {
  return e.area * m_problem.boundary_value(m_problem.boundaries[e.condition],
                                           m_body.position(e.particle), t, e.normal);
}

namespace {

void add_vector(const Body& body, Index a, const Vec3& load, std::span<double> f) {
  for (int i = 0; i < body.dim; ++i)
    f[static_cast<std::size_t>(a) * body.stride + i] += load[i];
}

}  // namespace

void ExternalLoads::add_constant(std::span<double> f) const {
  for (std::size_t k = 0; k < m_constant_dense.size(); ++k) f[k] += m_constant_dense[k];
  for (const auto& [a, load] : m_constant) add_vector(m_body, a, load, f);
}

void ExternalLoads::add_varying(double t, std::span<double> f) const {
  if (m_varying_body) {
    for (Index a = 0; a < m_body.n; ++a) {
      add_vector(m_body, a, m_body.V[a] * (*m_problem.body_force)(m_body.position(a), t), f);
    }
  }
  for (const Entry& e : m_varying) add_vector(m_body, e.particle, traction(e, t), f);
}

std::vector<Index> ExternalLoads::varying_particles() const {
  std::vector<Index> particles;
  if (m_varying_body) {
    for (Index a = 0; a < m_body.n; ++a) particles.push_back(a);
    return particles;
  }
  for (const Entry& e : m_varying) particles.push_back(e.particle);
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

}  // namespace concord::particle
