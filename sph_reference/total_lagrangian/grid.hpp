#pragma once
// Points sorted into cells, for the search of neighbours.

#include "sph_reference/total_lagrangian/planes.hpp"

#include <array>
#include <vector>

namespace concord::sph {

/// Points by cells of edge >= R, so that neighbours lie in the 3^dim cells around.
class Grid {
 public:
  Grid(const Points& points, double R);

  /// visit(b, X_b) for every point in the cells around X.
  template <class Visit> void around(const Vec3& X, const Visit& visit) const {
    const std::array<Index, 3> c = cell_of(X);
    for (Index k = std::max(c[2] - 1, 0); k <= std::min(c[2] + 1, m_cells[2] - 1); ++k) {
      for (Index j = std::max(c[1] - 1, 0); j <= std::min(c[1] + 1, m_cells[1] - 1); ++j) {
        const Index first = number({std::max(c[0] - 1, 0), j, k});
        const Index last = number({std::min(c[0] + 1, m_cells[0] - 1), j, k});
        for (Index s = m_begin[first]; s < m_begin[last + 1]; ++s)
          visit(m_sorted[s], m_positions[s]);
      }
    }
  }

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
