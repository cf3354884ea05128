#pragma once
// Meshes and particle arrangements, both made by gmsh from the scene's one .geo file.

#include "scene/problem.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace concord::scene {

enum class CellShape { simplex, hypercube };

struct MeshRequest {
  double h = 0;  ///< mean spacing [m]
  CellShape shape = CellShape::simplex;
  int order = 1;  ///< 1 or 2; order 2 nodes lie on the true (curved) geometry
  Layout layout = Layout::lattice;
};

/// A gmsh entity (point, curve, surface, volume) that carries mesh nodes.
struct Entity {
  int dim = 0;
  int tag = 0;
  bool flat = true;  ///< a straight curve, a planar surface
  int axis = -1;  ///< planar surface (3D) or straight curve (2D) normal to coordinate axis 0,
                  ///< 1, 2; else -1
  std::vector<Index>
      closure;  ///< entities (indices) of lower dimension on its boundary or in it
};

/// Cells and boundary facets of the body. Node numbers count from 0. Connectivity in gmsh's
/// order of nodes.
struct Mesh {
  int dim = 3;
  CellShape shape = CellShape::simplex;
  int order = 1;
  double h = 0;
  std::vector<Vec3> nodes;  ///< reference positions [m]
  std::vector<Entity> entities;
  std::vector<Index> node_entity;  ///< per node: index into entities of the lowest-dimensional
                                   ///< entity that holds it
  int nodes_per_cell = 0;
  std::vector<Index> cells;  ///< nodes_per_cell a cell
  int nodes_per_facet = 0;
  std::vector<Index>
      facets;  ///< boundary facets (surfaces in 3D, curves in 2D), nodes_per_facet each; the
               ///< normal by the right-hand rule (2D: the body to the left) points outwards
  std::vector<Index> facet_entity;  ///< per facet: index into entities
  /// Physical groups: dimension and the entities (indices) each holds.
  struct Group {
    int dim = 0;
    std::vector<Index> entities;
  };
  std::map<std::string, Group> groups;

  std::size_t cell_count() const {
    return cells.size() / static_cast<std::size_t>(nodes_per_cell);
  }
  std::size_t facet_count() const {
    return facets.size() / static_cast<std::size_t>(nodes_per_facet);
  }
  /// Nodes of a group, those on its closure included, sorted. Throws InputError at `where` if
  /// the group is missing, naming the groups that exist.
  std::vector<Index> group_nodes(const std::string& group,
                                 const SourcePosition& where = {}) const;
  /// Facets (indices) of a group of dimension dim-1. Throws InputError if missing or of another
  /// dimension.
  std::vector<Index> group_facets(const std::string& group,
                                  const SourcePosition& where = {}) const;
  /// Coordinate axis (0..2) that a symmetric or antisymmetric group is normal to; throws
  /// InputError if the group is not on axis-aligned planes (3D) or lines (2D) of one direction.
  int group_axis(const std::string& group, const SourcePosition& where = {}) const;
};

/// Meshes the problem's .geo with gmsh. The .geo sees h, structured (1: lattice, 0:
/// unstructured) and the scene's parameters as variables that are already set; it must honour
/// them. Checks that every group named by the problem exists. Nodes on axis-aligned planes and
/// lines get that coordinate exactly. Throws InputError when gmsh cannot read or mesh it.
Mesh make_mesh(const Problem& problem, const MeshRequest& request);

/// Measures of a mesh with straight-sided (order 1) cells: volume (area in 2D) and boundary
/// area (length) [SI].
double mesh_volume(const Mesh& mesh);
double mesh_boundary_area(const Mesh& mesh);

/// Moves the nodes of an order-1 mesh at random: each by a vector with components uniform in
/// [-fraction h, fraction h], projected on the tangent space of its entity (edges along edges,
/// faces within faces, points not at all; nodes of curved entities are put back on them).
/// Depends on seed and node number only.
void perturb(Mesh& mesh, const Problem& problem, double fraction, std::uint64_t seed);

/// Uniform number in [0, 1) from (seed, index, component): counter-based, so order and threads
/// do not matter.
double uniform_random(std::uint64_t seed, std::uint64_t index, std::uint64_t component);

/// Quadrature points and weights on a mesh finer than what is compared, the same for every
/// method: hypercube cells of size reference_length/24 (or what the geometry makes of it), 2
/// Gauss points a direction; on unstructured problems simplices of the same size with a
/// degree-2 rule.
struct Quadrature {
  std::vector<Vec3> points;
  std::vector<double> weights;  ///< [m^dim], without thickness
};
Quadrature common_quadrature(const Problem& problem);

}  // namespace concord::scene
