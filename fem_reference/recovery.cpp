#include "fem_reference/recovery.hpp"

#include <Eigen/QR>

namespace concord::fem {
namespace {

/// 1, x, y (z) on simplices; all products of 1, x and 1, y ... on hypercubes.
template <int dim>
Eigen::MatrixXd monomials(const std::vector<dealii::Point<dim>>& at, bool simplex,
                          bool constant) {
  const int columns = constant ? 1 : simplex ? dim + 1 : 1 << dim;
  Eigen::MatrixXd B(at.size(), columns);
  for (std::size_t p = 0; p < at.size(); ++p) {
    for (int c = 0; c < columns; ++c) {
      double value = 1;
      for (int i = 0; i < dim; ++i) {
        if (simplex ? c == i + 1 : (c >> i & 1) != 0) value *= at[p][i];
      }
      B(static_cast<Eigen::Index>(p), c) = value;
    }
  }
  return B;
}

}  // namespace

template <int dim>
Recovery<dim>::Recovery(const Discretisation<dim>& discretisation)
    : m_mesh_nodes(discretisation.mesh().nodes.size()) {
  const bool simplex = discretisation.mesh().shape == scene::CellShape::simplex;
  const dealii::Quadrature<dim> rule = discretisation.force_rule();
  const auto& element = discretisation.element();
  const auto& support = element.base_element(0).get_unit_support_points();
  m_points = rule.size();
  m_nodes = static_cast<unsigned>(support.size());
  const bool constant = m_points < (simplex ? dim + 1u : 1u << dim);
  const Eigen::MatrixXd fit = monomials<dim>(rule.get_points(), simplex, constant)
                                  .completeOrthogonalDecomposition()
                                  .pseudoInverse();
  const Eigen::MatrixXd E = monomials<dim>(support, simplex, constant) * fit;
  for (unsigned a = 0; a < m_nodes; ++a) {
    for (unsigned q = 0; q < m_points; ++q) m_weight.push_back(E(a, q));
  }
  std::vector<Index> node_of_dof(discretisation.dofs(), -1);
  for (std::size_t n = 0; n < m_mesh_nodes; ++n) {
    const Index node = static_cast<Index>(n);
    if (discretisation.used(node)) node_of_dof[discretisation.dof(node, 0)] = node;
  }
  std::vector<dealii::types::global_dof_index> dofs(element.n_dofs_per_cell());
  for (const auto& cell : discretisation.dof_handler().active_cell_iterators()) {
    cell->get_dof_indices(dofs);
    for (unsigned a = 0; a < m_nodes; ++a) {
      m_node.push_back(node_of_dof[dofs[element.component_to_system_index(0, a)]]);
    }
  }
}

template <int dim>
std::vector<double> Recovery<dim>::at_nodes(std::span<const double> values) const {
  std::vector<double> out(m_mesh_nodes, 0);
  std::vector<int> count(m_mesh_nodes, 0);
  for (std::size_t k = 0; k < m_node.size(); ++k) {
    const double* weight = &m_weight[k % m_nodes * m_points];
    const double* value = &values[k / m_nodes * m_points];
    double sum = 0;
    for (unsigned q = 0; q < m_points; ++q) sum += weight[q] * value[q];
    out[m_node[k]] += sum;
    ++count[m_node[k]];
  }
  for (std::size_t n = 0; n < out.size(); ++n) {
    if (count[n] > 0) out[n] /= count[n];
  }
  return out;
}

template class Recovery<2>;
template class Recovery<3>;

}  // namespace concord::fem
