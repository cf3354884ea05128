#pragma once
// Quadratic simplices: shape functions in gmsh's order of nodes, a quadrature rule, and the
// order of nodes that CalculiX wants. Serves averages, points, gradients; not the solution.

#include "scene/geometry.hpp"

#include <span>
#include <vector>

namespace concord::calculix {

/// The quadratic line, triangle or tetrahedron on the unit simplex.
class QuadraticSimplex {
 public:
  explicit QuadraticSimplex(int dim);  ///< 1, 2 or 3
  int dim() const { return m_dim; }
  int corner_count() const { return m_dim + 1; }
  int node_count() const { return static_cast<int>(m_unit_nodes.size()); }
  const std::vector<Vec3>& unit_nodes() const { return m_unit_nodes; }
  /// N_a = L_a (2 L_a - 1) at corners, 4 L_a L_b on edges, and dN_a/dxi; both spans hold
  /// node_count() entries.
  void evaluate(const Vec3& xi, std::span<double> N, std::span<Vec3> dN) const;
  /// How far xi lies outside, in reference units; 0 inside.
  double excess(const Vec3& xi) const;
  /// gmsh's place of each of CalculiX's (and VTK's) nodes: CPE6 has gmsh's order, C3D10 has
  /// edges (2,4) before (3,4) where gmsh has them the other way round.
  std::vector<int> calculix_order() const;

 private:
  int m_dim;
  std::vector<Vec3> m_unit_nodes;
};

/// Points and weights on the unit simplex, exact to degree 7 - dim: Gauss points with four a
/// direction, collapsed.
struct SimplexRule {
  explicit SimplexRule(int dim);
  std::vector<Vec3> points;
  std::vector<double> weights;
};

/// One cell of a mesh seen at a place of its reference cell.
struct CellPoint {
  Vec3 X = Vec3::Zero();
  Mat3 F = Mat3::Identity();  ///< I + du/dX
  Vec3 u = Vec3::Zero();
  double jacobian = 0;  ///< dV/dxi; length or area ratio for facets
};
/// X, u and F of the nodes' interpolation; `u` holds every node of the mesh. F stays the
/// identity for facets.
CellPoint evaluate(const scene::Mesh& mesh, const QuadraticSimplex& shape, const Index* nodes,
                   const std::vector<Vec3>& u, const Vec3& xi);

/// Nodes and weights N_a(xi) of the cell at X. Throws InputError at `where` if X is more than
/// half a cell outside of every cell.
struct Place {
  std::vector<Index> nodes;
  std::vector<double> weights;
};
Place locate(const scene::Mesh& mesh, const Vec3& X, const SourcePosition& where);

/// det F at every node: mean over the cells around it. Throws SolveError for a cell where it is
/// not positive, which CalculiX lets pass; `t` is the time to tell.
std::vector<double> nodal_volume_ratio(const scene::Mesh& mesh, const std::vector<Vec3>& u,
                                       double t);

}  // namespace concord::calculix
