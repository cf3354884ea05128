#include "particle/core/delaunay_cells.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace concord::particle {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vb3 = CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>;
using Cb3 = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
using Tri3 =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vb3, Cb3>>;
using Vb2 = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using Tri2 = CGAL::Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<Vb2, CGAL::Triangulation_face_base_2<Kernel>>>;

constexpr double first_halo = 4;     ///< spacings beyond a share; circumscribed spheres of
                                     ///< particles up to 45 % off a lattice are below 3 wide
constexpr double least_layers = 12;  ///< of a share

template <int Dim> struct Space;
template <> struct Space<3> {
  using Tri = Tri3;
  static Kernel::Point_3 point(const Vec3& X) { return {X[0], X[1], X[2]}; }
  static auto cells(const Tri& t) { return t.finite_cell_handles(); }
};
template <> struct Space<2> {
  using Tri = Tri2;
  static Kernel::Point_2 point(const Vec3& X) { return {X[0], X[1]}; }
  static auto cells(const Tri& t) { return t.finite_face_handles(); }
};

/// Points of a cell in the order of HullCells; the cell is positively oriented.
template <int Dim, class Cell> std::array<Index, Dim + 1> ordered(const Cell& cell) {
  std::array<Index, Dim + 1> v;
  for (int i = 0; i <= Dim; ++i) v[i] = cell->vertex(i)->info();
  order_cell(v);
  return v;
}

/// Facet opposite to vertex i, outward oriented.
template <int Dim, class Cell> std::array<Index, Dim> facet_of(const Cell& cell, int i) {
  std::array<Index, Dim> facet;
  if constexpr (Dim == 3) {
    constexpr int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (int k = 0; k < 3; ++k) facet[k] = cell->vertex(face[i][k])->info();
  } else {
    facet = {cell->vertex((i + 1) % 3)->info(), cell->vertex((i + 2) % 3)->info()};
  }
  return facet;
}

/// The points with numbers [first, last), and those left out of their triangulation.
struct Share {
  Index first = 0, last = 0;
  int axis = 0;
  double low = -1e300, high = 1e300;  ///< taken are the points with low <= X[axis] <= high
  std::array<Vec3, 2> corner;         ///< of the box of all points

  bool owns(Index a) const { return first <= a && a < last; }
  bool cut_low() const { return low > corner[0][axis]; }
  bool cut_high() const { return high < corner[1][axis]; }
};

/// Whether the sphere around a cell keeps clear of the points left out. Spheres of cells so
/// flat that round-off could move them are not relied on.
bool sphere_is_inside(const Share& share, std::span<const Vec3> X,
                      const std::array<Index, 4>& v, double spacing) {
  const Vec3 a = X[v[1]] - X[v[0]], b = X[v[2]] - X[v[0]], c = X[v[3]] - X[v[0]];
  const double det = 2 * a.dot(b.cross(c));
  if (!(std::abs(det) > 1e-9 * spacing * spacing * spacing)) return false;
  const Vec3 centre = (a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) +
                       c.squaredNorm() * a.cross(b)) /
                      det;
  const double at = X[v[0]][share.axis] + centre[share.axis],
               radius = centre.norm() + 1e-3 * spacing;
  return (!share.cut_low() || at - radius > share.low) &&
         (!share.cut_high() || at + radius < share.high);
}

/// Whether all points left out lie behind a facet of the share's hull: the corners of their
/// boxes do.
bool facet_is_outermost(const Share& share, std::span<const Vec3> X,
                        const std::array<Index, 3>& f) {
  for (int corner = 0; corner < 8; ++corner) {
    for (const bool above : {false, true}) {
      if (above ? !share.cut_high() : !share.cut_low()) continue;
      std::array<Vec3, 2> box = share.corner;
      box[above ? 0 : 1][share.axis] = above ? share.high : share.low;
      const Kernel::Point_3 q(box[corner & 1][0], box[corner >> 1 & 1][1],
                              box[corner >> 2 & 1][2]);
      if (CGAL::orientation(Space<3>::point(X[f[0]]), Space<3>::point(X[f[1]]),
                            Space<3>::point(X[f[2]]), q) == CGAL::POSITIVE)
        return false;
    }
  }
  return true;
}

template <int Dim>
typename Space<Dim>::Tri triangulation_of(const Share& share, std::span<const Vec3> X) {
  using Tri = typename Space<Dim>::Tri;
  std::vector<std::pair<typename Tri::Point, Index>> points;
  points.reserve(static_cast<std::size_t>(share.last - share.first));
  for (std::size_t a = 0; a < X.size(); ++a) {
    if (X[a][share.axis] < share.low || X[a][share.axis] > share.high) continue;
    points.emplace_back(Space<Dim>::point(X[a]), static_cast<Index>(a));
  }
  return Tri(points.begin(), points.end());
}

/// Every cell at a point of the share is one of the whole triangulation.
bool certain(const Tri3& tri, const Share& share, std::span<const Vec3> X, double spacing) {
  if (!share.cut_low() && !share.cut_high()) return true;
  for (const auto cell : tri.all_cell_handles()) {
    std::array<Index, 4> v{};
    int infinite = -1;
    bool owned = false;
    for (int i = 0; i < 4; ++i) {
      if (tri.is_infinite(cell->vertex(i))) {
        infinite = i;
      } else {
        v[i] = cell->vertex(i)->info();
        owned = owned || share.owns(v[i]);
      }
    }
    if (!owned) continue;
    if (infinite < 0 && !sphere_is_inside(share, X, v, spacing)) return false;
    if (infinite < 0) continue;
    const auto inner = cell->neighbor(infinite);
    if (!facet_is_outermost(share, X, facet_of<3>(inner, inner->index(cell)))) return false;
  }
  return true;
}

/// Cells and hull facets whose lowest point belongs to the share.
template <int Dim> HullCells collect(const typename Space<Dim>::Tri& tri, const Share& share) {
  HullCells result;
  std::vector<Index> begin(static_cast<std::size_t>(share.last - share.first) + 1, 0);
  for (const auto cell : Space<Dim>::cells(tri)) {
    const Index lowest = ordered<Dim>(cell)[0];
    if (share.owns(lowest)) ++begin[lowest - share.first + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  result.cells.resize(static_cast<std::size_t>(begin.back()) * (Dim + 1));
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  for (const auto cell : Space<Dim>::cells(tri)) {
    const auto v = ordered<Dim>(cell);
    if (share.owns(v[0])) {
      const auto place = static_cast<std::size_t>(next[v[0] - share.first]++);
      std::copy(v.begin(), v.end(), result.cells.begin() + place * (Dim + 1));
    }
    for (int i = 0; i <= Dim; ++i) {
      if (!tri.is_infinite(cell->neighbor(i))) continue;
      const auto facet = facet_of<Dim>(cell, i);
      if (share.owns(*std::min_element(facet.begin(), facet.end())))
        result.facets.insert(result.facets.end(), facet.begin(), facet.end());
    }
  }
  sort_cells(Dim, begin, result.cells);
  return result;
}

/// The cells of one share; it grows until they are certain.
HullCells cells_of_share(Share share, std::span<const Vec3> X, double spacing) {
  double first = 1e300, last = -1e300;
  for (Index a = share.first; a < share.last; ++a) {
    first = std::min(first, X[a][share.axis]);
    last = std::max(last, X[a][share.axis]);
  }
  for (double halo = first_halo * spacing;; halo *= 2) {
    share.low = first - halo;
    share.high = last + halo;
    const Tri3 tri = triangulation_of<3>(share, X);
    if (tri.dimension() == 3 && certain(tri, share, X, spacing)) return collect<3>(tri, share);
    if (!share.cut_low() && !share.cut_high()) return {};
  }
}

/// The box of all points, and the spacing they would have as a lattice in it.
std::pair<std::array<Vec3, 2>, double> extent(std::span<const Vec3> X) {
  std::array<Vec3, 2> box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  for (const Vec3& x : X) {
    box[0] = box[0].cwiseMin(x);
    box[1] = box[1].cwiseMax(x);
  }
  return {box, std::cbrt((box[1] - box[0]).prod() / static_cast<double>(X.size()))};
}

}  // namespace

void sort_cells(int dim, std::span<const Index> begin, std::span<Index> cells) {
  const auto sort = [&]<int N>(std::integral_constant<int, N>) {
    auto* all = reinterpret_cast<std::array<Index, N>*>(cells.data());
    for (std::size_t a = 0; a + 1 < begin.size(); ++a)
      std::sort(all + begin[a], all + begin[a + 1]);
  };
  if (dim == 3)
    sort(std::integral_constant<int, 4>{});
  else
    sort(std::integral_constant<int, 3>{});
}

HullCells delaunay_cells(int dim, std::span<const Vec3> X, const Executor& executor) {
  Share all;
  all.last = static_cast<Index>(X.size());
  if (dim == 2) {
    const Tri2 tri = triangulation_of<2>(all, X);
    return tri.dimension() == 2 ? collect<2>(tri, all) : HullCells{};
  }
  const auto [box, spacing] = extent(X);
  all.corner = box;
  (box[1] - box[0]).maxCoeff(&all.axis);
  // Shares of many layers, or the layers that neighbours both take cost more than they save.
  const double layers = spacing > 0 ? (box[1] - box[0])[all.axis] / spacing : 0;
  const auto count = static_cast<std::size_t>(
      std::clamp(static_cast<int>(layers / least_layers), 1, executor.threads()));
  std::vector<HullCells> parts(count);
  executor.for_each(count, [&](std::size_t k) {
    Share share = all;
    share.first = static_cast<Index>(X.size() * k / count);
    share.last = static_cast<Index>(X.size() * (k + 1) / count);
    parts[k] = cells_of_share(share, X, spacing);
  });
  HullCells result = std::move(parts[0]);
  for (std::size_t k = 1; k < count; ++k) {
    result.cells.insert(result.cells.end(), parts[k].cells.begin(), parts[k].cells.end());
    result.facets.insert(result.facets.end(), parts[k].facets.begin(), parts[k].facets.end());
    parts[k] = {};
  }
  return result;
}

}  // namespace concord::particle
