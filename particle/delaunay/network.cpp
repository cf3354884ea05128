#include "particle/delaunay/network.hpp"

#include "particle/core/edges.hpp"
#include "particle/core/segments.hpp"
#include "particle/core/sorted.hpp"

#include <algorithm>
#include <cmath>

namespace concord::particle::delaunay {
namespace {

using Pair = std::pair<Index, Index>;

/// Rows of indices from (row, value) pairs, values in the order given.
void make_rows(std::size_t rows, const std::vector<Pair>& pairs, std::vector<Index>& begin,
               std::vector<Index>& values) {
  begin.assign(rows + 1, 0);
  for (const auto& [row, value] : pairs) ++begin[row + 1];
  for (std::size_t r = 0; r < rows; ++r) begin[r + 1] += begin[r];
  values.resize(pairs.size());
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  for (const auto& [row, value] : pairs) values[next[row]++] = value;
}

constexpr int edges_of_simplex(int dim) { return dim * (dim + 1) / 2; }

/// use(a, b) for the edges of a simplex, a < b.
template <class Use> void for_edges(int dim, const Index* vertices, const Use& use) {
  for (int i = 0; i < dim; ++i) {
    for (int j = i + 1; j <= dim; ++j)
      use(std::min(vertices[i], vertices[j]), std::max(vertices[i], vertices[j]));
  }
}

}  // namespace

Network::Network(const Body& body, bool contact) : m_body(body), m_dim(body.dim) {
  find_bonds();
  find_simplices();
  m_alive.assign(body.triangulation.size(), 1);
  m_rows.B.assign(bonds() * body.dim + bond_padding, 0.0);
  if (contact) m_rows.area_over_length.assign(bonds() + bond_padding, 0.0);
  m_omega.assign(body.n, 0.0);
  m_inverse_omega.assign(body.n, 0.0);
  for (Index k = 0; k < static_cast<Index>(bonds()); ++k) rebuild_bond(k);
  for (Index a = 0; a < body.n; ++a) rebuild_volume(a);
}

void Network::find_bonds() {
  const Edges edges = make_edges(m_body);
  m_rows.begin.assign(edges.begin.begin(), edges.begin.end());
  m_rows.other = edges.other;
  std::vector<Pair> incident;
  for (Index a = 0; a < m_body.n; ++a) {
    for (Index k = m_rows.begin[a]; k < m_rows.begin[a + 1]; ++k) {
      m_ends.push_back({a, m_rows.other[k]});
      incident.emplace_back(a, k);
      incident.emplace_back(m_rows.other[k], k);
    }
  }
  make_rows(m_body.n, incident, m_incident_begin, m_incident);
}

void Network::find_simplices() {
  std::vector<Pair> stars, sides;
  for (Index t = 0; t < static_cast<Index>(m_body.triangulation.size()); ++t) {
    for (int i = 0; i <= m_dim; ++i) stars.emplace_back(vertices(t)[i], t);
    for_edges(m_dim, vertices(t), [&](Index a, Index b) {
      m_edges.push_back(bond_between(a, b));
      sides.emplace_back(m_edges.back(), t);
    });
  }
  make_rows(m_body.n, stars, m_star_begin, m_star);
  make_rows(bonds(), sides, m_simplices_begin, m_simplices);
}

/// a < b.
Index Network::bond_between(Index a, Index b) const {
  const std::vector<Index>& other = m_rows.other;
  const auto row = other.begin() + m_rows.begin[a], end = other.begin() + m_rows.begin[a + 1];
  return static_cast<Index>(std::lower_bound(row, end, b) - other.begin());
}

template <int Dim>
void Network::set_skew(std::vector<SkewBond<Dim>>& skew, Index bond, const Vec3& s) {
  const auto place =
      std::lower_bound(skew.begin(), skew.end(), bond,
                       [](const SkewBond<Dim>& known, Index k) { return known.bond < k; });
  const bool known = place != skew.end() && place->bond == bond;
  if (s.isZero(0)) {
    if (known) skew.erase(place);
    return;
  }
  SkewBond<Dim> entry{{}, bond, m_ends[bond].a, m_ends[bond].b};
  for (int i = 0; i < Dim; ++i) entry.s[i] = s[i];
  if (known)
    *place = entry;
  else
    skew.insert(place, entry);
}

Vec3 Network::zeta(Index bond, Index particle) const {
  Vec3 z = Vec3::Zero(), s = Vec3::Zero();
  for (int i = 0; i < m_dim; ++i) z[i] = m_rows.B[static_cast<std::size_t>(bond) * m_dim + i];
  const auto find = [&](const auto& skew) {
    const auto place =
        std::lower_bound(skew.begin(), skew.end(), bond,
                         [](const auto& known, Index k) { return known.bond < k; });
    if (place == skew.end() || place->bond != bond) return;
    for (int i = 0; i < m_dim; ++i) s[i] = place->s[i];
  };
  m_dim == 3 ? find(m_skew_3) : find(m_skew_2);
  return particle == m_ends[bond].a ? Vec3(s + z) : Vec3(s - z);
}

/// Whether each facet of simplices at the bond is between two of them, so that s is zero but
/// for round-off.
bool Network::closed(Index bond) const {
  const Ends& ends = m_ends[bond];
  std::vector<Index> others;  // a facet at the bond is it (plane), or it and another vertex
  for (const Index t : row(m_simplices_begin, m_simplices, bond)) {
    if (!alive(t)) continue;
    if (m_dim == 2) others.push_back(-1);
    for (int i = 0; m_dim == 3 && i < 4; ++i) {
      const Index c = vertices(t)[i];
      if (c != ends.a && c != ends.b) others.push_back(c);
    }
  }
  std::sort(others.begin(), others.end());
  bool even = others.size() % 2 == 0;
  for (std::size_t k = 0; even && k < others.size(); k += 2) even = others[k] == others[k + 1];
  return even;
}

/// zeta_ip = sum over the bond's simplices of |t|/(n+1) grad w_p, (CBM.5), (CBM.7), (CBM.9):
/// X_t,i^-1 . X_ip is the gradient of p's linear shape function.
void Network::rebuild_bond(Index bond) {
  const auto [a, b] = m_ends[bond];
  const int corners = m_dim + 1;
  Bond sum{a, b, Vec3::Zero(), Vec3::Zero()};
  std::array<Vec3, 4> X, g;
  for (const Index t : row(m_simplices_begin, m_simplices, bond)) {
    if (!alive(t)) continue;
    const Index* v = vertices(t);
    for (int i = 0; i < corners; ++i) X[i] = m_body.position(v[i]);
    (void)volume_gradients(m_dim, X, g);
    for (int i = 0; i < corners; ++i) {
      if (v[i] == b) sum.B_ab += m_body.thickness / corners * g[i];
      if (v[i] == a) sum.B_ba += m_body.thickness / corners * g[i];
    }
  }
  const Vec3 z = 0.5 * (sum.B_ab - sum.B_ba);
  const Vec3 s = closed(bond) ? Vec3(Vec3::Zero()) : Vec3(0.5 * (sum.B_ab + sum.B_ba));
  for (int i = 0; i < m_dim; ++i) m_rows.B[static_cast<std::size_t>(bond) * m_dim + i] = z[i];
  m_dim == 3 ? set_skew(m_skew_3, bond, s) : set_skew(m_skew_2, bond, s);
  if (m_rows.area_over_length.empty()) return;
  const double L = (m_body.position(b) - m_body.position(a)).norm();
  m_rows.area_over_length[bond] = interface_area(m_dim, sum) / L;
}

/// Omega_i = sum |t|/(n+1) (CBM.1).
void Network::rebuild_volume(Index particle) {
  double omega = 0;
  for (const Index t : row(m_star_begin, m_star, particle)) {
    if (alive(t)) omega += m_body.thickness / (m_dim + 1) * m_body.simplex_volume(t);
  }
  m_omega[particle] = omega;
  m_inverse_omega[particle] = omega > 0 ? 1 / omega : 0;
}

bool Network::connected(Index bond) const {
  const std::span<const Index> simplices = row(m_simplices_begin, m_simplices, bond);
  return std::any_of(simplices.begin(), simplices.end(), [&](Index t) { return alive(t); });
}

std::vector<Index> Network::simplices_of(std::span<const Index> bonds) const {
  std::vector<Index> list;
  for (const Index k : bonds) {
    for (const Index t : row(m_simplices_begin, m_simplices, k)) {
      if (alive(t)) list.push_back(t);
    }
  }
  sort_unique(list);
  return list;
}

std::vector<Index> Network::vertices_of(std::span<const Index> simplices) const {
  std::vector<Index> list;
  for (const Index t : simplices) list.insert(list.end(), vertices(t), vertices(t) + m_dim + 1);
  sort_unique(list);
  return list;
}

/// Bond vectors and volumes at simplices that came or went. Returns their edges, ascending.
std::vector<Index> Network::rebuild(std::span<const Index> simplices) {
  const auto each = static_cast<std::size_t>(edges_of_simplex(m_dim));
  std::vector<Index> edges;
  for (const Index t : simplices) {
    const Index* first = &m_edges[static_cast<std::size_t>(t) * each];
    edges.insert(edges.end(), first, first + each);
  }
  sort_unique(edges);
  for (const Index k : edges) rebuild_bond(k);
  for (const Index a : vertices_of(simplices)) rebuild_volume(a);
  return edges;
}

std::vector<Index> Network::remove(std::span<const Index> simplices) {
  for (const Index t : simplices) m_alive[t] = 0;
  std::vector<Index> loose = rebuild(simplices);
  std::erase_if(loose, [&](Index k) { return connected(k); });
  return loose;
}

void Network::restore(std::span<const Index> simplices) {
  for (const Index t : simplices) m_alive[t] = 1;
  rebuild(simplices);
}

std::vector<Index> Network::simplices_at(Index particle) const {
  std::vector<Index> list;
  for (const Index t : row(m_star_begin, m_star, particle)) {
    if (alive(t)) list.push_back(t);
  }
  return list;
}

bool Network::whole(Index particle) const {
  const std::span<const Index> star = row(m_star_begin, m_star, particle);
  return std::all_of(star.begin(), star.end(), [&](Index t) { return alive(t); });
}

Stencil Network::stencil(Index particle, std::span<const Index> without) const {
  Stencil sum;
  const int corners = m_dim + 1;
  const double share = m_body.thickness / corners;
  std::array<Vec3, 4> X, g;
  for (const Index t : row(m_star_begin, m_star, particle)) {
    if (!alive(t) || std::binary_search(without.begin(), without.end(), t)) continue;
    const Index* v = vertices(t);
    for (int i = 0; i < corners; ++i) X[i] = m_body.position(v[i]);
    sum.omega += share * std::abs(volume_gradients(m_dim, X, g));
    for (int i = 0; i < corners; ++i) {
      const auto known = std::find(sum.points.begin(), sum.points.end(), v[i]);
      if (known == sum.points.end())
        sum.points.push_back(v[i]), sum.zeta.emplace_back(share * g[i]);
      else
        sum.zeta[known - sum.points.begin()] += share * g[i];
    }
  }
  return sum;
}

std::vector<Index> Network::crossing(const Vec3& from, const Vec3& to) const {
  std::vector<Index> list;
  for (Index k = 0; k < static_cast<Index>(bonds()); ++k) {
    if (segments_cross(from, to, m_body.position(m_ends[k].a), m_body.position(m_ends[k].b)))
      list.push_back(k);
  }
  return list;
}

}  // namespace concord::particle::delaunay
