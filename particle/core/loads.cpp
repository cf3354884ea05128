#include "particle/core/boundary.hpp"
#include "particle/core/sorted.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

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

void add_vector(const Body& body, Index a, const Vec3& load, std::span<double> f) {
  for (int i = 0; i < body.dim; ++i)
    f[static_cast<std::size_t>(a) * body.stride + i] += load[i];
}

bool varies(const scene::BoundaryCondition& bc) {
  return bc.value_from_exact || bc.value.depends_on_time();
}

}  // namespace

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

ExternalLoads::ExternalLoads(const scene::Problem& problem, const ForceModel& model)
    : m_problem(problem), m_body(model.body()) {
  const Body& body = m_body;
  const bool body_force = problem.body_force && !problem.body_force->is_zero();
  m_varying_body = body_force && problem.body_force->depends_on_time();
  if (!problem.gravity.isZero() || (body_force && !m_varying_body)) {
    m_constant_dense.assign(body.X.size(), 0.0);
    for (Index a = 0; a < body.bulk; ++a) {
      Vec3 load = body.m[a] * problem.gravity;
      if (body_force && !m_varying_body)
        load += body.V[a] * (*problem.body_force)(body.position(a), 0);
      add_vector(body, a, load, m_constant_dense);
    }
  }
  Sums constant;
  for (std::size_t k = 0; k < problem.boundaries.size(); ++k) {
    if (problem.boundaries[k].kind == scene::BoundaryKind::traction && !body.inside())
      add_facet_loads(static_cast<Index>(k), constant);
  }
  if (body.inside()) add_terms(model.load_terms(), constant);
  m_constant.assign(constant.begin(), constant.end());
}

/// A traction on the particles of the faces.
void ExternalLoads::add_facet_loads(Index condition, Sums& constant) {
  const scene::BoundaryCondition& bc = m_problem.boundaries[condition];
  const std::vector<Index>& boundary = m_body.triangulation.boundary;
  const int dim = m_body.dim;
  std::vector<Entry> entries;
  for (const Index f : group_boundary_facets(m_body, bc.group, bc.where)) {
    const Vec3 A = facet_area(m_body, f);
    for (int v = 0; v < dim; ++v) {
      const Index a = boundary[static_cast<std::size_t>(f) * dim + v];
      entries.push_back({a, condition, A.norm() / dim, A.normalized()});
    }
  }
  // One entry a particle and direction: facets of a plane face share their normal.
  std::sort(entries.begin(), entries.end(),
            [](const Entry& p, const Entry& q) { return p.particle < q.particle; });
  std::vector<Entry> merged;
  for (const Entry& e : entries) {
    const bool same = !merged.empty() && merged.back().particle == e.particle &&
                      (!bc.value_from_exact || (merged.back().normal - e.normal).norm() < 1e-9);
    if (same)
      merged.back().area += e.area;
    else
      merged.push_back(e);
  }
  if (varies(bc)) {
    m_varying.insert(m_varying.end(), merged.begin(), merged.end());
  } else {
    for (const Entry& e : merged)
      constant.try_emplace(e.particle, Vec3::Zero()).first->second += traction(e, 0);
  }
}

/// Tractions as a formulation spreads them.
void ExternalLoads::add_terms(const std::vector<LoadTerm>& terms, Sums& constant) {
  for (const LoadTerm& term : terms) {
    const scene::BoundaryCondition& bc = m_problem.boundaries[term.condition];
    if (varies(bc)) {
      m_terms.push_back(term);
    } else {
      constant.try_emplace(term.point, Vec3::Zero()).first->second +=
          term.M * m_problem.boundary_value(bc, term.X, 0, term.N);
    }
  }
}

Vec3 ExternalLoads::traction(const Entry& e, double t) const {
  return e.area * m_problem.boundary_value(m_problem.boundaries[e.condition],
                                           m_body.position(e.particle), t, e.normal);
}

void ExternalLoads::add_constant(std::span<double> f) const {
  for (std::size_t k = 0; k < m_constant_dense.size(); ++k) f[k] += m_constant_dense[k];
  for (const auto& [a, load] : m_constant) add_vector(m_body, a, load, f);
}

void ExternalLoads::add_varying(double t, std::span<double> f) const {
  if (m_varying_body) {
    for (Index a = 0; a < m_body.bulk; ++a)
      add_vector(m_body, a, m_body.V[a] * (*m_problem.body_force)(m_body.position(a), t), f);
  }
  for (const Entry& e : m_varying) add_vector(m_body, e.particle, traction(e, t), f);
  if (!m_terms.empty()) add_terms_at(t, f);
}

/// The traction is evaluated once for all terms of a piece.
void ExternalLoads::add_terms_at(double t, std::span<double> f) const {
  const LoadTerm* last = nullptr;
  Vec3 T = Vec3::Zero();
  for (const LoadTerm& term : m_terms) {
    if (last == nullptr || last->condition != term.condition || last->X != term.X ||
        last->N != term.N) {
      T = m_problem.boundary_value(m_problem.boundaries[term.condition], term.X, t, term.N);
      last = &term;
    }
    add_vector(m_body, term.point, term.M * T, f);
  }
}

std::vector<Index> ExternalLoads::varying_particles() const {
  std::vector<Index> particles;
  if (m_varying_body) {
    for (Index a = 0; a < m_body.bulk; ++a) particles.push_back(a);
  }
  for (const Entry& e : m_varying) particles.push_back(e.particle);
  for (const LoadTerm& term : m_terms) particles.push_back(term.point);
  sort_unique(particles);
  return particles;
}

}  // namespace concord::particle
