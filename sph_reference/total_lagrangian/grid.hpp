#pragma once
// Points sorted into cells, for the search of neighbours.

#include "sph_reference/total_lagrangian/planes.hpp"

#include <array>
#include <vector>

namespace concord::sph {

/// Points by cells of edge >= R/2, so that neighbours lie in the 5^dim cells around: fewer
/// candidates than in 3^dim cells of edge R.
class Grid {
 public:
  Grid(const Points& points, double R);

  struct Found {
    Index b;
    double r2;  ///< |X_ab|^2 < limit
    Vec3 X_ab;
  };
  /// All points closer to X than the root of `limit` <= R^2, in an order that depends on the
  /// points alone. Returns their number; `found` grows as needed and is not shrunk.
  std::size_t within(const Vec3& X, double limit, std::vector<Found>& found) const;

 private:
  Index extent(const Vec3& high, int i, double edge) const;
  double cells_at(const Vec3& high, double edge) const;
  std::array<Index, 3> cell_of(const Vec3& X) const;
  Index number(const std::array<Index, 3>& c) const {
    return (c[2] * m_cells[1] + c[1]) * m_cells[0] + c[0];
  }
  void fill(const Points& points);

  Vec3 m_low;
  double m_edge = 0;
  std::array<Index, 3> m_cells{};
  std::vector<Index> m_begin, m_sorted;  ///< points of cell c: m_sorted[m_begin[c]] ...
  std::vector<Vec3> m_positions;         ///< beside m_sorted
};

}  // namespace concord::sph
