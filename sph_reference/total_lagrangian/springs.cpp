#include "sph_reference/total_lagrangian/springs.hpp"

#include "particle/core/edges.hpp"
#include "particle/core/segments.hpp"

#include <algorithm>

namespace concord::sph {
namespace {

/// (a, position) and (b, position) of every pair a, b.
template <class Ends> Lists incidence(Index particles, std::size_t count, const Ends& ends) {
  std::vector<std::pair<Index, Index>> entries;
  entries.reserve(2 * count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto [a, b] = ends(k);
    entries.emplace_back(a, static_cast<Index>(k));
    entries.emplace_back(b, static_cast<Index>(k));
  }
  return {particles, entries};
}

}  // namespace

Lists::Lists(Index rows, const std::vector<std::pair<Index, Index>>& entries)
    : m_begin(rows + 1, 0), m_values(entries.size()) {
  for (const auto& [row, value] : entries) ++m_begin[row + 1];
  for (Index r = 0; r < rows; ++r) m_begin[r + 1] += m_begin[r];
  std::vector<std::size_t> next(m_begin.begin(), m_begin.end() - 1);
  for (const auto& [row, value] : entries) m_values[next[row]++] = value;
}

Springs::Springs(const Body& body, const Neighbours& rows, SpringLayout layout) : m_body(body) {
  find_pairs(rows);
  if (layout == SpringLayout::edges) {
    find_edges();
  } else {
    for (const Pair& pair : m_pairs) m_first.push_back(pair.a), m_second.push_back(pair.b);
  }
  m_whole.assign(m_first.size(), 1);
  m_broken_on_way.assign(m_pairs.size(), 0);
  m_at = incidence(body.n, m_first.size(), [&](std::size_t k) {
    return std::pair{m_first[k], m_second[k]};
  });
  find_simplices();
  if (layout == SpringLayout::edges) {
    find_ways();
    return;
  }
  std::vector<std::pair<Index, Index>> own;
  for (Index p = 0; p < count(); ++p) own.emplace_back(p, p);
  m_held = Lists(count(), own);
}

void Springs::find_pairs(const Neighbours& rows) {
  const DirectedRows all = directed_rows(rows);
  for (Index a = 0; a < m_body.n; ++a) {
    for (std::size_t k = all.begin[a]; k < all.begin[a + 1]; ++k) {
      const Index b = all.other[k];
      if (b < a) continue;
      const auto row = all.other.begin() + static_cast<std::ptrdiff_t>(all.begin[b]),
                 end = all.other.begin() + static_cast<std::ptrdiff_t>(all.begin[b + 1]);
      const auto back = std::lower_bound(row, end, a) - all.other.begin();
      m_pairs.push_back({a, b, {all.entry[k], all.entry[back]}});
    }
  }
  m_pairs_at = incidence(m_body.n, m_pairs.size(), [&](std::size_t p) {
    return std::pair{m_pairs[p].a, m_pairs[p].b};
  });
}

void Springs::find_edges() {
  const particle::Edges edges = particle::make_edges(m_body);
  for (Index a = 0; a < m_body.n; ++a) {
    for (std::size_t k = edges.begin[a]; k < edges.begin[a + 1]; ++k)
      m_first.push_back(a), m_second.push_back(edges.other[k]);
  }
}

/// -1: there is none.
Index Springs::spring_of(Index a, Index b) const {
  for (const Index k : springs_at(a)) {
    if (m_first[k] == b || m_second[k] == b) return k;
  }
  return -1;
}

void Springs::find_simplices() {
  const particle::Triangulation& t = m_body.triangulation;
  const int vertices = t.dim + 1;
  std::vector<std::pair<Index, Index>> entries;
  for (std::size_t s = 0; s < t.size(); ++s) {
    const Index* v = &t.simplices[s * vertices];
    for (int i = 0; i < vertices; ++i) {
      for (int j = 0; j < i; ++j) {
        const Index k = spring_of(v[i], v[j]);
        if (k >= 0) entries.emplace_back(k, static_cast<Index>(s));
      }
    }
  }
  m_simplices = Lists(count(), entries);
}

/// The springs across whose Voronoi faces the line from a to b leads, from cell to cell
/// (TLS.19). The bisector of i and j is crossed at X_a + s X_ab with s = ((X_i + X_j)/2 -
/// X_a).X_ij / (X_ab.X_ij); of all neighbours j ahead the line enters the cell of the first.
/// False where it ends elsewhere than at b.
bool Springs::way(Index a, Index b, std::vector<Index>& springs) const {
  const Vec3 X_a = m_body.position(a), d = m_body.position(b) - X_a;
  springs.clear();
  for (Index i = a; i != b;) {
    const Vec3 X_i = m_body.position(i);
    Index next = -1, across = -1;
    double least = 1;
    for (const Index k : springs_at(i)) {
      const Index j = m_first[k] == i ? m_second[k] : m_first[k];
      const Vec3 X_j = m_body.position(j), X_ij = X_j - X_i;
      const double ahead = d.dot(X_ij), s = (0.5 * (X_i + X_j) - X_a).dot(X_ij) / ahead;
      if (!(ahead > 0) || !(s < least)) continue;
      least = s, next = j, across = k;
    }
    if (next < 0) return false;
    springs.push_back(across);
    i = next;
  }
  return true;
}

/// A pair that is an edge has its own spring on its way, whatever cells its line cuts.
void Springs::find_ways() {
  std::vector<std::pair<Index, Index>> held;
  std::vector<Index> springs;
  for (Index p = 0; p < static_cast<Index>(m_pairs.size()); ++p) {
    const auto& [a, b, entry] = m_pairs[p];
    const Index own = spring_of(a, b);
    const bool visible = way(a, b, springs);
    if (!visible) springs.clear();
    if (own >= 0 && std::find(springs.begin(), springs.end(), own) == springs.end())
      springs.push_back(own);
    if (!visible && own < 0) m_hidden.push_back(p);
    for (const Index k : springs) held.emplace_back(k, p);
  }
  m_held = Lists(count(), held);
}

std::vector<Index> Springs::break_up(std::span<const Index> springs,
                                     std::span<const Index> pairs) {
  std::vector<Index> going;
  const auto cut = [&](Index p) {
    if (m_broken_on_way[p]++ == 0) going.push_back(p);
  };
  for (const Index k : springs) {
    if (!whole(k)) continue;
    m_whole[k] = 0;
    for (const Index p : m_held.row(k)) cut(p);
  }
  for (const Index p : pairs) cut(p);
  std::sort(going.begin(), going.end());
  return going;
}

std::vector<Index> Springs::springs_across(const Vec3& from, const Vec3& to) const {
  std::vector<Index> list;
  for (Index k = 0; k < count(); ++k) {
    if (particle::segments_cross(from, to, m_body.position(m_first[k]),
                                 m_body.position(m_second[k])))
      list.push_back(k);
  }
  return list;
}

std::vector<Index> Springs::pairs_across(const Vec3& from, const Vec3& to) const {
  std::vector<Index> list;
  for (Index p = 0; p < static_cast<Index>(m_pairs.size()); ++p) {
    if (particle::segments_cross(from, to, m_body.position(m_pairs[p].a),
                                 m_body.position(m_pairs[p].b)))
      list.push_back(p);
  }
  return list;
}

}  // namespace concord::sph
