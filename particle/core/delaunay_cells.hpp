#pragma once
// The Delaunay triangulation of points: cells of their convex hull, always the same ones in the
// same order.

#include "particle/core/parallel.hpp"

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace concord::particle {

/// The convex hull of points cut into simplices.
struct HullCells {
  /// dim+1 points each, sorted by their points. Points ascend within a cell, but for the last
  /// two, which are swapped where that makes the cell positively oriented.
  std::vector<Index> cells;
  std::vector<Index> facets;  ///< facets of the hull, dim points each, outward oriented
};

/// Delaunay triangulation by CGAL with exact predicates; cospherical points are divided by
/// symbolic perturbation (Devillers and Teillaud, Comput. Geom. 44, 2011), a rule that depends
/// on their lexicographic order alone. The set of cells thus follows from the points, and the
/// result is the same for every number of threads. No cells if the points span less than dim
/// directions.
///
/// Threads divide the points by number into ranges, each triangulated with all points within
/// some spacings of it along the body's longest axis; a cell is one of the whole triangulation
/// if its circumscribed sphere reaches none of the points left out. Where that cannot be shown,
/// more points are taken. Costs least when numbers follow that axis, as particles' do.
HullCells delaunay_cells(int dim, std::span<const Vec3> X, const Executor& executor);

/// The same for points of a grid, the product of dim sets of coordinates (3D only: there the
/// exact predicates on cospherical points cost seconds per 100,000). Every box of the grid is a
/// Delaunay cell of its eight corners whatever its sides, and CGAL's rule divides all boxes
/// alike, as it does one of them. None if the points are no such grid.
std::optional<HullCells> lattice_cells(std::span<const Vec3> X);

/// Brings the points of one cell into the order of HullCells without changing its orientation.
template <std::size_t N> void order_cell(std::array<Index, N>& v) {
  bool odd = false;
  for (std::size_t i = 1; i < N; ++i) {
    for (std::size_t j = i; j > 0 && v[j] < v[j - 1]; --j) {
      std::swap(v[j], v[j - 1]);
      odd = !odd;
    }
  }
  if (odd) std::swap(v[N - 2], v[N - 1]);
}

/// Sorts cells by their points, when cells with the lowest point a are at [begin[a],
/// begin[a+1]) cells already.
void sort_cells(int dim, std::span<const Index> begin, std::span<Index> cells);

}  // namespace concord::particle
