// The triangulation that gmsh made, as it is.

#include "particle/core/delaunay_cells.hpp"
#include "particle/core/triangulation.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace concord::particle {
namespace {

/// The mesh's simplices in the order of HullCells.
template <std::size_t N>
std::vector<Index> sorted_simplices(const scene::Mesh& mesh, std::span<const Index> number) {
  std::vector<std::array<Index, N>> cells(mesh.cell_count());
  for (std::size_t s = 0; s < cells.size(); ++s) {
    for (std::size_t k = 0; k < N; ++k) cells[s][k] = number[mesh.cells[N * s + k]];
    order_cell(cells[s]);
  }
  std::sort(cells.begin(), cells.end());
  std::vector<Index> sorted;
  sorted.reserve(N * cells.size());
  for (const auto& cell : cells) sorted.insert(sorted.end(), cell.begin(), cell.end());
  return sorted;
}

std::vector<Index> sorted_cells(const scene::Mesh& mesh, std::span<const Index> number) {
  return mesh.dim == 3 ? sorted_simplices<4>(mesh, number) : sorted_simplices<3>(mesh, number);
}

}  // namespace

Triangulation mesh_triangulation(const scene::Mesh& mesh, const scene::Problem& problem,
                                 std::span<const Index> number) {
  const int vertices = mesh.dim + 1;
  if (mesh.shape != scene::CellShape::simplex || mesh.nodes_per_cell != vertices) {
    throw InputError(problem.geometry_where, "geometry", "a mesh of other cells than simplices",
                     "a .geo that gmsh meshes with triangles or tetrahedra");
  }
  Triangulation t;
  t.dim = mesh.dim;
  const std::vector<Index> cells = sorted_cells(mesh, number);
  std::vector<Index> node(number.size());
  for (std::size_t a = 0; a < node.size(); ++a) node[number[a]] = static_cast<Index>(a);
  std::array<Vec3, 4> X, g;
  for (std::size_t s = 0; s < mesh.cell_count(); ++s) {
    for (int k = 0; k < vertices; ++k) X[k] = mesh.nodes[node[cells[s * vertices + k]]];
    const double volume = volume_gradients(t.dim, X, g);
    if (!(volume > 0)) {
      throw InputError(problem.geometry_where, "geometry",
                       fmt::format("a cell of the mesh with the signed volume {:.3g} m^{} at "
                                   "({:.4g}, {:.4g}, {:.4g})",
                                   volume, t.dim, X[0][0], X[0][1], X[0][2]),
                       "smaller random displacements of the particles, or the Delaunay cells");
    }
    t.volume.push_back(volume);
  }
  t.simplices = cells;
  t.boundary = mesh.facets;
  for (Index& v : t.boundary) v = number[v];
  t.boundary_entity = mesh.facet_entity;
  t.on_boundary.assign(mesh.nodes.size(), 0);
  for (const Index v : t.boundary) t.on_boundary[v] = 1;
  return t;
}

}  // namespace concord::particle
