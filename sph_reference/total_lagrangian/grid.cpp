#include "sph_reference/total_lagrangian/grid.hpp"

#include <algorithm>
#include <cmath>

namespace concord::sph {

Grid::Grid(const Points& points, double R) : m_low(Vec3::Constant(1e300)) {
  Vec3 high = Vec3::Constant(-1e300);
  for (Index a = 0; a < points.count(); ++a) {
    m_low = m_low.cwiseMin(points.position(a));
    high = high.cwiseMax(points.position(a));
  }
  // Thin or scattered bodies: no more cells than points, so that memory stays linear.
  m_edge = R / 2;
  while (cells_at(high, m_edge) > std::max<double>(64, points.count())) m_edge *= 1.26;
  for (int i = 0; i < 3; ++i) m_cells[i] = extent(high, i, m_edge);
  fill(points);
}

Index Grid::extent(const Vec3& high, int i, double edge) const {
  return static_cast<Index>((high[i] - m_low[i]) / edge) + 1;
}

double Grid::cells_at(const Vec3& high, double edge) const {
  double count = 1;
  for (int i = 0; i < 3; ++i) count *= std::floor((high[i] - m_low[i]) / edge) + 1;
  return count;
}

std::array<Index, 3> Grid::cell_of(const Vec3& X) const {
  std::array<Index, 3> c{};
  for (int i = 0; i < 3; ++i) {
    c[i] = std::min(static_cast<Index>((X[i] - m_low[i]) / m_edge), m_cells[i] - 1);
  }
  return c;
}

void Grid::fill(const Points& points) {
  m_begin.assign(static_cast<std::size_t>(m_cells[0]) * m_cells[1] * m_cells[2] + 1, 0);
  std::vector<Index> cell(points.count());
  for (Index a = 0; a < points.count(); ++a) {
    cell[a] = number(cell_of(points.position(a)));
    ++m_begin[cell[a] + 1];
  }
  for (std::size_t c = 1; c < m_begin.size(); ++c) m_begin[c] += m_begin[c - 1];
  m_sorted.resize(points.count());
  std::vector<Index> next(m_begin.begin(), m_begin.end() - 1);
  m_positions.resize(points.count());
  for (Index a = 0; a < points.count(); ++a) {
    m_positions[next[cell[a]]] = points.position(a);
    m_sorted[next[cell[a]]++] = a;
  }
}

/// Every candidate is written, the next one over it if it was too far: no branch to guess.
std::size_t Grid::within(const Vec3& X, double limit, std::vector<Found>& found) const {
  const std::array<Index, 3> c = cell_of(X);
  std::size_t count = 0;
  for (Index k = std::max(c[2] - 2, 0); k <= std::min(c[2] + 2, m_cells[2] - 1); ++k) {
    for (Index j = std::max(c[1] - 2, 0); j <= std::min(c[1] + 2, m_cells[1] - 1); ++j) {
      const Index first = m_begin[number({std::max(c[0] - 2, 0), j, k})];
      const Index last = m_begin[number({std::min(c[0] + 2, m_cells[0] - 1), j, k}) + 1];
      const std::size_t most = count + static_cast<std::size_t>(last - first) + 1;
      if (found.size() < most) found.resize(most);
      for (Index s = first; s < last; ++s) {
        const Vec3 X_ab = m_positions[s] - X;
        const double r2 = X_ab.squaredNorm();
        found[count] = {m_sorted[s], r2, X_ab};
        count += r2 < limit ? 1 : 0;
      }
    }
  }
  return count;
}

}  // namespace concord::sph
