#pragma once
// Delaunay simplices of the particles that fill the body, their volumes, and the surface they
// reproduce.

#include "particle/core/parallel.hpp"
#include "scene/geometry.hpp"

#include <array>
#include <span>
#include <vector>

namespace concord::particle {

/// The body cut into simplices with particles as vertices (Sec. 2.1 of the Delaunay paper).
/// Simplices are positively oriented and sorted by their vertices (order_cell in
/// delaunay_cells.hpp).
struct Triangulation {
  int dim = 3;
  std::vector<Index> simplices;  ///< dim+1 vertices each
  std::vector<double> volume;    ///< |t| of each simplex [m^dim]; bodies do not keep it
  std::vector<Index> boundary;   ///< dim vertices of each boundary facet, outward oriented
  std::vector<Index> boundary_entity;  ///< gmsh entity (index into Mesh::entities) that each
                                       ///< boundary facet lies on
  std::vector<char> on_boundary;       ///< per point

  std::size_t size() const { return simplices.size() / static_cast<std::size_t>(dim + 1); }
};

/// Delaunay triangulation of the mesh's nodes, restricted to the body. `number` gives each node
/// its number in the result. Cells outside a non-convex body are dropped, as are flat cells
/// along its faces (region_cells.hpp). The same for every number of threads. Throws InputError
/// at the problem's geometry when the cells' volumes do not add up to the body's or its
/// boundary is not reproduced: the spacing is then too coarse for the shape. The tolerance is
/// 1e-9 relative for bodies with plane faces; bodies with curved faces may differ by what a
/// flat facet cuts off, h^2/4 of the local turning a facet.
Triangulation triangulate(const scene::Mesh& mesh, const scene::Problem& problem,
                          std::span<const Index> number, const Executor& executor);

/// The mesh's own cells in place of Delaunay's, for methods that are defined on gmsh's
/// triangulation. Throws InputError for cells other than simplices, and for inverted ones.
Triangulation mesh_triangulation(const scene::Mesh& mesh, const scene::Problem& problem,
                                 std::span<const Index> number);

/// Facet of a simplex opposite to its vertex k, outward oriented for positive simplices; the
/// third entry is -1 in the plane.
std::array<Index, 3> opposite_facet(int dim, const Index* vertices, int k);

/// |t| grad w_k of the linear shape functions of one simplex, and its signed volume |t|
/// [m^dim]. X: dim+1 vertices; result: dim+1 vectors [m^(dim-1)], area vectors of the opposite
/// faces over dim. Without division: flat simplices (lattices have them) are as good as any.
double volume_gradients(int dim, std::span<const Vec3> X, std::span<Vec3> volume_times_g);

/// Gradients grad w_k themselves [1/m]; not finite for a flat simplex. Returns the signed
/// volume.
double shape_gradients(int dim, std::span<const Vec3> X, std::span<Vec3> g);

}  // namespace concord::particle
