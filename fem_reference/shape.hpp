#pragma once
// Lagrange shape functions with nodes in gmsh's order, on deal.II's reference cells ([0,1]^dim
// and the unit simplex). Used for boundary facets, point evaluation and output.

#include "scene/geometry.hpp"

#include <span>
#include <vector>

namespace concord::fem {

class LagrangeShape {
 public:
  /// dim 1, 2 or 3; order 1 or 2. A facet of a 2D mesh is a line: either shape does.
  LagrangeShape(int dim, scene::CellShape shape, int order);

  int dim() const { return m_dim; }
  int node_count() const { return static_cast<int>(m_supports.size()); }
  int corner_count() const { return m_corners; }
  /// Corners whose mean is node `n`: one for a corner, two for a mid-edge node, four or eight
  /// for the middle of a face or cell.
  const std::vector<int>& corners_of(int n) const { return m_supports[n]; }
  const std::vector<Vec3>& unit_nodes() const { return m_unit_nodes; }

  /// N_a(xi) and dN_a/dxi for all nodes; both spans hold node_count() entries; gradient may be
  /// empty.
  void evaluate(const Vec3& xi, std::span<double> value, std::span<Vec3> gradient) const;
  /// How far xi lies outside the reference cell, in reference units; 0 inside.
  double excess(const Vec3& xi) const;
  Vec3 centre() const;

  unsigned char vtk_type() const;
  /// gmsh node that stands at each place of VTK's order.
  std::vector<int> vtk_order() const;

 private:
  void evaluate_simplex(const Vec3& xi, std::span<double> value,
                        std::span<Vec3> gradient) const;
  void evaluate_hypercube(const Vec3& xi, std::span<double> value,
                          std::span<Vec3> gradient) const;

  int m_dim, m_order, m_corners;
  scene::CellShape m_shape;
  std::vector<std::vector<int>> m_supports;
  std::vector<Vec3> m_unit_nodes;
};

}  // namespace concord::fem
