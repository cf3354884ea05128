#pragma once
// Steps of make_mesh, in its order; each works on the mesh made so far. Those that ask gmsh
// need a GmshSession held by the caller.

#include "scene/geometry.hpp"

namespace concord::scene {

/// Entities of dimension 0 to mesh.dim with flatness, axis and closure, from gmsh's open model.
void collect_entities(Mesh& mesh, const Problem& problem);

/// gmsh's number of the element of a shape, dimension and order (reference manual, "MSH file
/// format").
int gmsh_element(CellShape shape, int dim, int order);

/// Fills facets and facet_entity from the oriented cells; gmsh's own surface elements (nodes
/// and entities) say which entity a face lies on. Throws InputError if a face lies on none.
void collect_facets(Mesh& mesh, const Problem& problem, const std::vector<Index>& gmsh_facets,
                    const std::vector<Index>& gmsh_facet_entity);

/// Nodes on the closure of axis-aligned planes (3D) or lines (2D) get that coordinate exactly:
/// the one of the entity's first corner. Plane meshes get Z = 0; throws InputError if they lie
/// elsewhere.
void snap_to_planes(Mesh& mesh, const Problem& problem);

/// Coordinates of a lattice that gmsh has to 1e-9 or so become those of its evenly divided
/// straight curves, (a (n - i) + b i)/n, where they are that near.
void snap_lattice(Mesh& mesh);

/// Gives every cell a positive Jacobian at its corners by reflecting those that are negative.
/// Throws InputError for cells that are folded.
void orient_cells(Mesh& mesh, const Problem& problem);

/// Every group that the problem names exists and suits what is asked of it; no two conditions
/// prescribe different values of one component at one node.
void check_groups(const Mesh& mesh, const Problem& problem);

/// Corner nodes of a cell or facet: 2, 3, 4 or 8.
int corner_count(CellShape shape, int dim);

/// Reference coordinates of the corners of a hypercube in gmsh's order, components -1 or 1.
Vec3 hypercube_corner(int corner, int dim);

}  // namespace concord::scene
