#pragma once
// Pseudo-springs: which of the interacting pairs can break, and what goes with a broken one.
// Equations (TLS.18), (TLS.19) in README.md of this folder.

#include "sph_reference/total_lagrangian/neighbours.hpp"

#include <array>
#include <span>
#include <utility>
#include <vector>

namespace concord::sph {

/// Which pairs carry a spring.
enum class SpringLayout {
  edges,  ///< those of the triangulation; a longer pair goes with the springs that it crosses
  pairs   ///< every interacting pair its own
};

/// Lists of indices, one a row.
class Lists {
 public:
  Lists() = default;
  /// From (row, value) pairs; values in their order.
  Lists(Index rows, const std::vector<std::pair<Index, Index>>& entries);
  std::span<const Index> row(Index r) const {
    return {m_values.data() + m_begin[r], m_begin[r + 1] - m_begin[r]};
  }

 private:
  std::vector<std::size_t> m_begin;
  std::vector<Index> m_values;
};

/// Springs of a body, the pairs that they hold and the simplices that they are edges of. A pair
/// interacts as long as all springs on its way are whole (TLS.18).
class Springs {
 public:
  /// Pairs of `rows`, which knows no images. With edges, a pair whose line leaves the body is
  /// cut: hidden_pairs().
  Springs(const Body& body, const Neighbours& rows, SpringLayout layout);

  Index count() const { return static_cast<Index>(m_first.size()); }
  Index first(Index spring) const { return m_first[spring]; }  ///< a < b
  Index second(Index spring) const { return m_second[spring]; }
  const std::vector<Index>& firsts() const { return m_first; }
  const std::vector<Index>& seconds() const { return m_second; }
  bool whole(Index spring) const { return m_whole[spring] != 0; }
  /// Simplices that have this spring as an edge; none of a pair that is no edge.
  std::span<const Index> simplices(Index spring) const { return m_simplices.row(spring); }
  std::span<const Index> springs_at(Index particle) const { return m_at.row(particle); }

  /// An interacting pair a < b, and where it stands in the rows: twice the same within a block.
  struct Pair {
    Index a, b;
    std::array<std::size_t, 2> entry;
    Index other(Index particle) const { return particle == a ? b : a; }
  };
  const Pair& pair(Index p) const { return m_pairs[p]; }
  std::span<const Index> pairs_at(Index particle) const { return m_pairs_at.row(particle); }
  bool holds(Index p) const { return m_broken_on_way[p] == 0; }

  /// Breaks springs, and `pairs` whatever their springs do; returns the pairs that held until
  /// now, ascending. Of the springs only whole ones count.
  std::vector<Index> break_up(std::span<const Index> springs, std::span<const Index> pairs);

  /// Springs and pairs that cross a segment of the plane. A particle on its line counts as
  /// lying to its left.
  std::vector<Index> springs_across(const Vec3& from, const Vec3& to) const;
  std::vector<Index> pairs_across(const Vec3& from, const Vec3& to) const;
  /// Pairs without a way through the body.
  const std::vector<Index>& hidden_pairs() const { return m_hidden; }

 private:
  void find_pairs(const Neighbours& rows);
  void find_edges();
  void find_simplices();
  void find_ways();
  Index spring_of(Index a, Index b) const;
  bool way(Index a, Index b, std::vector<Index>& springs) const;

  const Body& m_body;
  std::vector<Pair> m_pairs;  ///< sorted by a, then b
  Lists m_pairs_at;
  std::vector<Index> m_first, m_second;  ///< of the springs, sorted likewise
  Lists m_at, m_simplices;
  Lists m_held;  ///< pairs on whose way a spring lies
  std::vector<Index> m_hidden;
  std::vector<char> m_whole;
  std::vector<Index> m_broken_on_way;  ///< of a pair
};

}  // namespace concord::sph
