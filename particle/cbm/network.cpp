#include "particle/cbm/network.hpp"

#include <algorithm>

namespace concord::particle::cbm {
namespace {

/// Rows of indices from (row, value) pairs, values in the order given.
void make_rows(Index rows, const std::vector<std::pair<Index, Index>>& pairs,
               std::vector<Index>& begin, std::vector<Index>& values) {
  begin.assign(rows + 1, 0);
  for (const auto& [row, value] : pairs) ++begin[row + 1];
  for (Index r = 0; r < rows; ++r) begin[r + 1] += begin[r];
  values.resize(pairs.size());
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  for (const auto& [row, value] : pairs) values[next[row]++] = value;
}

void sort_unique(std::vector<Index>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

Network::Network(const Body& body) : m_body(body) {
  find_bonds();
  m_alive.assign(m_edges.size(), 1);
  m_zeta.assign(4 * bonds(), 0.0);
  m_omega.assign(body.n, 0.0);
  m_inverse_omega.assign(body.n, 0.0);
  for (Index k = 0; k < static_cast<Index>(bonds()); ++k) rebuild_bond(k);
  for (Index a = 0; a < body.n; ++a) rebuild_volume(a);
}

void Network::find_bonds() {
  const std::vector<Index>& vertices = m_body.triangulation.simplices;
  const auto count = static_cast<Index>(m_body.triangulation.size());
  std::vector<std::pair<Index, Index>> edges, stars, incident;
  for (Index t = 0; t < count; ++t) {
    for (int i = 0; i < 3; ++i) {
      const Index a = vertices[3 * t + i], b = vertices[3 * t + (i + 1) % 3];
      edges.emplace_back(std::min(a, b), std::max(a, b));
      stars.emplace_back(a, t);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  make_rows(m_body.n, edges, m_begin, m_other);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    m_first.push_back(edges[k].first);
    incident.emplace_back(edges[k].first, static_cast<Index>(k));
    incident.emplace_back(edges[k].second, static_cast<Index>(k));
  }
  make_rows(m_body.n, stars, m_star_begin, m_star);
  make_rows(m_body.n, incident, m_incident_begin, m_incident);
  m_triangles.assign(edges.size(), {-1, -1});
  m_edges.resize(count);
  for (Index t = 0; t < count; ++t) {
    for (int i = 0; i < 3; ++i) {
      const Index k = edge(vertices[3 * t + i], vertices[3 * t + (i + 1) % 3]);
      m_edges[t][i] = k;
      m_triangles[k][m_triangles[k][0] < 0 ? 0 : 1] = t;
    }
  }
}

Index Network::edge(Index a, Index b) const {
  if (a > b) std::swap(a, b);
  const auto row = m_other.begin() + m_begin[a], end = m_other.begin() + m_begin[a + 1];
  return static_cast<Index>(std::lower_bound(row, end, b) - m_other.begin());
}

/// zeta_ip = sum over the bond's triangles of |t|/3 grad w_p, (5), (7), (9): X_t,i^-1 . X_ip is
/// the gradient of p's linear shape function.
void Network::rebuild_bond(Index bond) {
  Vec3 zeta_ab = Vec3::Zero(), zeta_ba = Vec3::Zero();
  for (const Index t : m_triangles[bond]) {
    if (t < 0 || !alive(t)) continue;
    const Index* vertices = &m_body.triangulation.simplices[3 * static_cast<std::size_t>(t)];
    std::array<Vec3, 3> X, g;
    for (int i = 0; i < 3; ++i) X[i] = m_body.position(vertices[i]);
    (void)volume_gradients(2, X, g);
    for (int i = 0; i < 3; ++i) {
      if (vertices[i] == m_other[bond]) zeta_ab += m_body.thickness / 3 * g[i];
      if (vertices[i] == m_first[bond]) zeta_ba += m_body.thickness / 3 * g[i];
    }
  }
  double* zeta = &m_zeta[4 * static_cast<std::size_t>(bond)];
  zeta[0] = zeta_ab[0], zeta[1] = zeta_ab[1], zeta[2] = zeta_ba[0], zeta[3] = zeta_ba[1];
}

/// Omega_i = sum |t|/3 (1).
void Network::rebuild_volume(Index particle) {
  double omega = 0;
  for (Index k = m_star_begin[particle]; k < m_star_begin[particle + 1]; ++k) {
    if (alive(m_star[k])) omega += m_body.thickness / 3 * m_body.simplex_volume(m_star[k]);
  }
  m_omega[particle] = omega;
  m_inverse_omega[particle] = omega > 0 ? 1 / omega : 0;
}

bool Network::connected(Index bond) const {
  return std::any_of(m_triangles[bond].begin(), m_triangles[bond].end(),
                     [&](Index t) { return t >= 0 && alive(t); });
}

std::vector<Index> Network::triangles_of(std::span<const Index> bonds) const {
  std::vector<Index> list;
  for (const Index k : bonds) {
    for (const Index t : m_triangles[k]) {
      if (t >= 0 && alive(t)) list.push_back(t);
    }
  }
  sort_unique(list);
  return list;
}

std::vector<Index> Network::vertices_of(std::span<const Index> triangles) const {
  std::vector<Index> list;
  for (const Index t : triangles) {
    const Index* v = &m_body.triangulation.simplices[3 * static_cast<std::size_t>(t)];
    list.insert(list.end(), v, v + 3);
  }
  sort_unique(list);
  return list;
}

std::vector<Index> Network::remove(std::span<const Index> triangles) {
  std::vector<Index> edges, loose;
  for (const Index t : triangles) {
    m_alive[t] = 0;
    edges.insert(edges.end(), m_edges[t].begin(), m_edges[t].end());
  }
  sort_unique(edges);
  for (const Index k : edges) {
    rebuild_bond(k);
    if (!connected(k)) loose.push_back(k);
  }
  for (const Index a : vertices_of(triangles)) rebuild_volume(a);
  return loose;
}

std::vector<Index> Network::crossing(const Vec3& from, const Vec3& to) const {
  const auto left = [](const Vec3& p, const Vec3& q, const Vec3& x) {
    return (q[0] - p[0]) * (x[1] - p[1]) - (q[1] - p[1]) * (x[0] - p[0]) >= 0;
  };
  std::vector<Index> list;
  for (Index k = 0; k < static_cast<Index>(bonds()); ++k) {
    const Vec3 a = m_body.position(m_first[k]), b = m_body.position(m_other[k]);
    if (left(from, to, a) != left(from, to, b) && left(a, b, from) != left(a, b, to))
      list.push_back(k);
  }
  return list;
}

}  // namespace concord::particle::cbm
