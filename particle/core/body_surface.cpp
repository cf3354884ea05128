#include "particle/core/body_surface.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace concord::particle {
namespace {

/// Solid angle (3D, Van Oosterom & Strackee 1983) or angle (2D) of a facet seen from x.
double seen_angle(int dim, std::span<const Vec3> X, const Index* v, const Vec3& x) {
  if (dim == 2) {
    const Vec3 a = X[v[0]] - x, b = X[v[1]] - x;
    return std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
  }
  const Vec3 a = X[v[0]] - x, b = X[v[1]] - x, c = X[v[2]] - x;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * std::atan2(a.dot(b.cross(c)), denominator);
}

}  // namespace

Vec3 facet_area(int dim, std::span<const Vec3> X, const Index* v) {
  if (dim == 2) {
    const Vec3 e = X[v[1]] - X[v[0]];
    return {e[1], -e[0], 0};
  }
  return 0.5 * (X[v[1]] - X[v[0]]).cross(X[v[2]] - X[v[0]]);
}

BodySurface::BodySurface(const scene::Mesh& mesh, std::span<const Index> number,
                         std::span<const Vec3> X)
    : m_dim(mesh.dim), m_X(X) {
  std::vector<Index> entity;
  const int m = mesh.nodes_per_facet;
  const auto add = [&](std::size_t f, std::initializer_list<int> corners) {
    for (const int c : corners) m_facets.push_back(number[mesh.facets[f * m + c]]);
    entity.push_back(mesh.facet_entity[f]);
  };
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    if (m_dim == 2) {
      add(f, {0, 1});
    } else {
      add(f, {0, 1, 2});
      if (m == 4) add(f, {0, 2, 3});
    }
  }
  collect_faces(entity);
  const Vec3 origin = X.empty() ? Vec3::Zero() : X[0];  // near the body: fewer digits lost
  for (std::size_t f = 0; f < entity.size(); ++f) {
    const Index* v = &m_facets[f * m_dim];
    const Vec3 A = facet_area(m_dim, X, v);
    m_volume += (X[v[0]] - origin).dot(A) / m_dim;  // divergence theorem
    m_area += A.norm();
    if (m_dim == 3 && !mesh.entities[entity[f]].flat) m_slack += 0.25 * A.norm() * mesh.h;
  }
}

void BodySurface::collect_faces(const std::vector<Index>& entity) {
  m_slot.assign(m_X.size(), -1);
  for (const Index v : m_facets) m_slot[v] = 0;
  Index slots = 0;
  for (Index& slot : m_slot)
    if (slot == 0) slot = slots++;
  m_begin.assign(slots + 1, 0);
  for (const Index v : m_facets) ++m_begin[m_slot[v] + 1];
  for (Index s = 0; s < slots; ++s) m_begin[s + 1] += m_begin[s];
  std::vector<Face> all(m_facets.size());  // a facet and corner each
  std::vector<Index> next(m_begin.begin(), m_begin.end() - 1);
  for (std::size_t f = 0; f < entity.size(); ++f) {
    const Index* v = &m_facets[f * m_dim];
    const Vec3 A = facet_area(m_dim, m_X, v);
    for (int k = 0; k < m_dim; ++k) all[next[m_slot[v[k]]]++] = {entity[f], A};
  }
  for (Index s = 0; s < slots; ++s) {
    const auto first = static_cast<std::ptrdiff_t>(m_faces.size());
    for (Index k = m_begin[s]; k < next[s]; ++k) {
      const auto known =
          std::find_if(m_faces.begin() + first, m_faces.end(),
                       [&](const Face& face) { return face.entity == all[k].entity; });
      if (known == m_faces.end())
        m_faces.push_back(all[k]);
      else
        known->normal += all[k].normal;
    }
    std::sort(m_faces.begin() + first, m_faces.end(),
              [](const Face& p, const Face& q) { return p.entity < q.entity; });
    m_begin[s] = static_cast<Index>(first);
  }
  m_begin[slots] = static_cast<Index>(m_faces.size());
}

std::span<const BodySurface::Face> BodySurface::faces_at(Index a) const {
  const Index slot = m_slot[a];
  if (slot < 0) return {};
  return std::span(m_faces).subspan(m_begin[slot], m_begin[slot + 1] - m_begin[slot]);
}

bool BodySurface::share_a_face(const Index* v, int count) const {
  const auto first = faces_at(v[0]);
  return std::any_of(first.begin(), first.end(), [&](const Face& face) {
    return std::all_of(v + 1, v + count, [&](Index w) {
      const auto others = faces_at(w);
      return std::any_of(others.begin(), others.end(),
                         [&](const Face& other) { return other.entity == face.entity; });
    });
  });
}

Index BodySurface::entity_of(const Index* facet) const {
  const Vec3 A = facet_area(m_dim, m_X, facet).normalized();
  Index best = -1;
  double best_match = -2;
  for (const Face& candidate : faces_at(facet[0])) {
    int points = 0;
    Vec3 N = Vec3::Zero();
    for (int k = 0; k < m_dim; ++k) {
      for (const Face& face : faces_at(facet[k])) {
        if (face.entity != candidate.entity) continue;
        ++points;
        N += face.normal.normalized();
      }
    }
    if (points < m_dim) continue;
    const double match = std::abs(N.normalized().dot(A));
    if (match > best_match + 1e-9) {
      best_match = match;
      best = candidate.entity;
    }
  }
  return best;
}

double BodySurface::winding_number(const Vec3& x) const {
  double angle = 0;
  for (std::size_t f = 0; f < m_facets.size(); f += m_dim)
    angle += seen_angle(m_dim, m_X, &m_facets[f], x);
  return angle / (m_dim == 3 ? 4 * std::numbers::pi : 2 * std::numbers::pi);
}

}  // namespace concord::particle
