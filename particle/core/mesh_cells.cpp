// The triangulation that gmsh made, as it is.

#include "particle/core/triangulation.hpp"

#include <fmt/format.h>

namespace concord::particle {

Triangulation mesh_triangulation(const scene::Mesh& mesh, const scene::Problem& problem) {
  const int vertices = mesh.dim + 1;
  if (mesh.shape != scene::CellShape::simplex || mesh.nodes_per_cell != vertices) {
    throw InputError(problem.geometry_where, "geometry", "a mesh of other cells than simplices",
                     "a .geo that gmsh meshes with triangles or tetrahedra");
  }
  Triangulation t;
  t.dim = mesh.dim;
  t.simplices = mesh.cells;
  std::array<Vec3, 4> X, g;
  for (std::size_t s = 0; s < mesh.cell_count(); ++s) {
    Index* v = &t.simplices[s * vertices];
    for (int k = 0; k < vertices; ++k) X[k] = mesh.nodes[v[k]];
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
  t.boundary = mesh.facets;
  t.boundary_entity = mesh.facet_entity;
  t.on_boundary.assign(mesh.nodes.size(), 0);
  for (const Index v : t.boundary) t.on_boundary[v] = 1;
  return t;
}

}  // namespace concord::particle
