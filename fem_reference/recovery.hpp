#pragma once
// From values at quadrature points to values at nodes.

#include "fem_reference/discretisation.hpp"

#include <span>
#include <vector>

namespace concord::fem {

/// In every cell a polynomial through the values at the points of force_rule(), by least
/// squares where there are more points than coefficients: linear on simplices (exactly through
/// the 3 points of the paper's triangles), multilinear on hypercubes, constant in cells with
/// fewer points than that. Its values at the cell's nodes are averaged over the cells at a
/// node. A point of maximum between quadrature points is cut by the linear part, and values
/// that cannot be negative may become so, a little, beside zeros.
template <int dim> class Recovery {
 public:
  explicit Recovery(const Discretisation<dim>& discretisation);

  /// `values` as [cell][point], cells in deal.II's order; returns one value a node of the mesh
  /// (0 at nodes of no cell).
  std::vector<double> at_nodes(std::span<const double> values) const;
  unsigned points() const { return m_points; }

 private:
  unsigned m_points = 0, m_nodes = 0;
  std::size_t m_mesh_nodes;
  std::vector<double> m_weight;  ///< [node of the cell][point]
  std::vector<Index> m_node;     ///< [cell][node of the cell] -> node of the mesh
};

extern template class Recovery<2>;
extern template class Recovery<3>;

}  // namespace concord::fem
