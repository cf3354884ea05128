// Delaunay cells of a grid, without asking a predicate.

#include "particle/core/delaunay_cells.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_set>

namespace concord::particle {
namespace {

/// The values of one coordinate, ascending; empty if there are more than `most`.
std::vector<double> distinct(std::span<const Vec3> X, int axis, std::size_t most) {
  std::unordered_set<double> seen;
  for (const Vec3& x : X) {
    seen.insert(x[axis]);
    if (seen.size() > most) return {};
  }
  std::vector<double> values(seen.begin(), seen.end());
  std::sort(values.begin(), values.end());
  return values;
}

/// Points of a grid by their place.
struct Grid {
  std::array<int, 3> points{};
  std::vector<Index> point;  ///< the last axis fastest

  Index at(int i, int j, int k) const {
    return point[(static_cast<std::size_t>(i) * points[1] + j) * points[2] + k];
  }
};

std::optional<Grid> grid_of(std::span<const Vec3> X) {
  Grid grid;
  std::array<std::vector<double>, 3> values;
  std::size_t product = 1;
  for (int axis = 0; axis < 3; ++axis) {
    // Two points a direction at least, so that no direction has more than a quarter of them.
    values[axis] = distinct(X, axis, X.size() / 4);
    if (values[axis].size() < 2) return {};
    grid.points[axis] = static_cast<int>(values[axis].size());
    product *= values[axis].size();
  }
  if (product != X.size()) return {};
  grid.point.assign(product, -1);
  for (std::size_t a = 0; a < X.size(); ++a) {
    std::size_t place = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& v = values[axis];
      place =
          place * v.size() + static_cast<std::size_t>(
                                 std::lower_bound(v.begin(), v.end(), X[a][axis]) - v.begin());
    }
    if (grid.point[place] >= 0) return {};
    grid.point[place] = static_cast<Index>(a);
  }
  return grid;
}

/// Corner c of a box: bit 2 - i is its place along axis i, so that numbers are in lexicographic
/// order of coordinates.
constexpr int bit(int corner, int axis) { return corner >> (2 - axis) & 1; }

HullCells cells_of_one_box() {
  std::array<Vec3, 8> corners;
  for (int c = 0; c < 8; ++c) corners[c] = Vec3(bit(c, 0), bit(c, 1), bit(c, 2));
  return delaunay_cells(3, corners, Executor(1));
}

/// visit(points of the box by corner, its place) for all boxes.
template <class Visit> void for_boxes(const Grid& grid, const Visit& visit) {
  std::array<int, 3> at{};
  std::array<Index, 8> box{};
  for (at[0] = 0; at[0] + 1 < grid.points[0]; ++at[0]) {
    for (at[1] = 0; at[1] + 1 < grid.points[1]; ++at[1]) {
      for (at[2] = 0; at[2] + 1 < grid.points[2]; ++at[2]) {
        for (int c = 0; c < 8; ++c)
          box[c] = grid.at(at[0] + bit(c, 0), at[1] + bit(c, 1), at[2] + bit(c, 2));
        visit(box, at);
      }
    }
  }
}

/// Whether a facet of a box at this place lies on the grid's surface.
bool is_outer(const Grid& grid, const std::array<int, 3>& at, const Index* corners) {
  for (int axis = 0; axis < 3; ++axis) {
    const int side = bit(corners[0], axis);
    if (bit(corners[1], axis) != side || bit(corners[2], axis) != side) continue;
    return side == 0 ? at[axis] == 0 : at[axis] + 2 == grid.points[axis];
  }
  return false;
}

}  // namespace

std::optional<HullCells> lattice_cells(std::span<const Vec3> X) {
  const std::optional<Grid> grid = grid_of(X);
  if (!grid) return {};
  const HullCells box_cells = cells_of_one_box();
  const auto cell_of = [&](const std::array<Index, 8>& box, std::size_t k) {
    std::array<Index, 4> v;
    for (int i = 0; i < 4; ++i) v[i] = box[box_cells.cells[4 * k + i]];
    order_cell(v);
    return v;
  };
  const std::size_t per_box = box_cells.cells.size() / 4;
  HullCells result;
  std::vector<Index> begin(X.size() + 1, 0);
  for_boxes(*grid, [&](const std::array<Index, 8>& box, const std::array<int, 3>& at) {
    for (std::size_t k = 0; k < per_box; ++k) ++begin[cell_of(box, k)[0] + 1];
    for (std::size_t f = 0; f < box_cells.facets.size(); f += 3) {
      if (!is_outer(*grid, at, &box_cells.facets[f])) continue;
      for (int i = 0; i < 3; ++i) result.facets.push_back(box[box_cells.facets[f + i]]);
    }
  });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  result.cells.resize(4 * static_cast<std::size_t>(begin.back()));
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  for_boxes(*grid, [&](const std::array<Index, 8>& box, const std::array<int, 3>&) {
    for (std::size_t k = 0; k < per_box; ++k) {
      const std::array<Index, 4> v = cell_of(box, k);
      std::copy(v.begin(), v.end(),
                result.cells.begin() + 4 * static_cast<std::ptrdiff_t>(next[v[0]]++));
    }
  });
  sort_cells(3, begin, result.cells);
  return result;
}

}  // namespace concord::particle
