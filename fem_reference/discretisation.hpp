#pragma once
// From the scene's mesh to deal.II's triangulation, element, mapping and numbering.

#include "fem_reference/parameters.hpp"
#include "fem_reference/shape.hpp"

#include <deal.II/base/quadrature.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <vector>

namespace concord::fem {

/// One displacement node of the element for every node of the mesh, whose order is the
/// element's degree. Straight-sided meshes get the linear mapping, curved ones an isoparametric
/// MappingFEField. Throws InputError for a mesh that deal.II cannot take.
template <int dim> class Discretisation {
 public:
  Discretisation(const scene::Problem& problem, const scene::RunRequest& request,
                 const Options& options);

  const scene::Mesh& mesh() const { return m_mesh; }
  const LagrangeShape& cell_shape() const { return m_cell_shape; }
  const LagrangeShape& facet_shape() const { return m_facet_shape; }
  const dealii::Triangulation<dim>& triangulation() const { return m_triangulation; }
  const dealii::FESystem<dim>& element() const { return *m_element; }
  const dealii::DoFHandler<dim>& dof_handler() const { return m_dof_handler; }
  const dealii::Mapping<dim>& mapping() const { return *m_mapping; }
  bool curved() const { return m_curved; }
  int degree() const { return m_mesh.order; }

  unsigned dofs() const { return m_dof_handler.n_dofs(); }
  /// Unknown of component i at a mesh node.
  unsigned dof(Index node, int i) const { return m_node_dof[node * dim + i]; }
  /// False for nodes that belong to no cell (lone points of the geometry): they have no
  /// unknowns.
  bool used(Index node) const {
    return m_node_dof[node * dim] != dealii::numbers::invalid_dof_index;
  }
  /// Vectors of unknowns to vectors at nodes (third component 0 in plane problems), and back.
  std::vector<Vec3> at_nodes(const dealii::Vector<double>& values) const;
  void set_from_nodes(const std::vector<Vec3>& values, dealii::Vector<double>& out) const;
  Vec3 node_value(const dealii::Vector<double>& values, Index node) const;

  /// Gauss rule with n points a direction on hypercubes; on simplices the Witherden-Vincent
  /// rule that is exact to degree 2n-1.
  dealii::Quadrature<dim> gauss(int n) const;
  /// Rule of the internal force: p+1 Gauss points a direction on hypercubes, the rule exact to
  /// degree 2p-1 on simplices, or (three_points) that of the Continuum Bond Method paper's T6.
  dealii::Quadrature<dim> force_rule() const;
  /// Smallest cell height h = volume of the smallest cell to the power 1/dim [m].
  double smallest_cell() const { return m_smallest; }

 private:
  void build_triangulation();
  void build_mapping();
  void number_nodes();

  scene::Mesh m_mesh;
  LagrangeShape m_cell_shape, m_facet_shape;
  bool m_curved = false, m_three_points = false;
  double m_smallest = 0;
  dealii::Triangulation<dim> m_triangulation;
  std::unique_ptr<dealii::FESystem<dim>> m_element;
  dealii::DoFHandler<dim> m_dof_handler;
  std::vector<Index> m_node_of_vertex;
  std::vector<unsigned> m_node_dof;
  dealii::Vector<double> m_positions;  ///< node positions, for the curved mapping
  std::unique_ptr<dealii::Mapping<dim>> m_mapping;
};

extern template class Discretisation<2>;
extern template class Discretisation<3>;

}  // namespace concord::fem
