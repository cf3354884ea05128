#include "fem_reference/element_table.hpp"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <cmath>

namespace concord::fem {

template <int dim, class Law>
ElementTable<dim, Law>::ElementTable(const Discretisation<dim>& discretisation, Law& law,
                                     double thickness)
    : m_discretisation(discretisation), m_law(law), m_thickness(thickness) {
  const dealii::FESystem<dim>& element = discretisation.element();
  const dealii::FiniteElement<dim>& scalar = element.base_element(0);
  dealii::FEValues<dim> values(discretisation.mapping(), scalar, discretisation.force_rule(),
                               dealii::update_gradients | dealii::update_JxW_values);
  m_nodes = scalar.n_dofs_per_cell();
  m_points = values.n_quadrature_points;
  m_cells = discretisation.triangulation().n_active_cells();
  law.resize(m_cells * m_points);
  m_gradient.reserve(m_cells * m_points * m_nodes);
  std::vector<dealii::types::global_dof_index> dofs(element.n_dofs_per_cell());
  for (const auto& cell : discretisation.dof_handler().active_cell_iterators()) {
    values.reinit(static_cast<typename dealii::Triangulation<dim>::cell_iterator>(cell));
    for (unsigned q = 0; q < m_points; ++q) {
      m_JxW.push_back(values.JxW(q) * thickness);
      for (unsigned a = 0; a < m_nodes; ++a) m_gradient.push_back(values.shape_grad(a, q));
    }
    cell->get_dof_indices(dofs);
    for (unsigned a = 0; a < m_nodes; ++a) {
      for (unsigned i = 0; i < dim; ++i) {
        m_dofs.push_back(dofs[element.component_to_system_index(i, a)]);
      }
    }
  }
  dealii::DynamicSparsityPattern pattern(discretisation.dofs());
  dealii::DoFTools::make_sparsity_pattern(discretisation.dof_handler(), pattern);
  m_sparsity.copy_from(pattern);
}

template <int dim, class Law>
void ElementTable<dim, Law>::gather(std::size_t cell, const Vector& u,
                                    std::vector<double>& local) const {
  const unsigned n = m_nodes * dim;
  local.resize(n);
  for (unsigned k = 0; k < n; ++k) local[k] = u[m_dofs[cell * n + k]];
}

template <int dim, class Law>
dealii::Tensor<2, dim>
ElementTable<dim, Law>::deformation(std::size_t cell, unsigned q,
                                    const std::vector<double>& local) const {
  const dealii::Tensor<1, dim>* g = gradients(cell, q);
  dealii::Tensor<2, dim> F;
  for (unsigned a = 0; a < m_nodes; ++a) {
    for (int i = 0; i < dim; ++i) {
      for (int j = 0; j < dim; ++j) F[i][j] += local[a * dim + i] * g[a][j];
    }
  }
  for (int i = 0; i < dim; ++i) F[i][i] += 1;
  return F;
}

template <int dim, class Law>
bool ElementTable<dim, Law>::cell_force(std::size_t cell, const std::vector<double>& local,
                                        std::vector<double>& out) const {
  out.assign(m_nodes * dim, 0.0);
  for (unsigned q = 0; q < m_points; ++q) {
    dealii::Tensor<2, dim> P;
    if (!m_law.stress(cell * m_points + q, deformation(cell, q, local), P)) return false;
    const dealii::Tensor<1, dim>* g = gradients(cell, q);
    const double w = m_JxW[cell * m_points + q];
    for (unsigned a = 0; a < m_nodes; ++a) {
      for (int i = 0; i < dim; ++i) out[a * dim + i] += w * (P[i] * g[a]);
    }
  }
  return true;
}

template <int dim, class Law>
long ElementTable<dim, Law>::force(const Vector& u, Vector& f) const {
  std::vector<double> local, out;
  double squares = 0;
  f = 0;
  for (std::size_t c = 0; c < m_cells; ++c) {
    gather(c, u, local);
    if (!cell_force(c, local, out)) return static_cast<long>(c);
    for (unsigned k = 0; k < out.size(); ++k) {
      f[m_dofs[c * out.size() + k]] += out[k];
      squares += out[k] * out[k];
    }
  }
  m_force_norm = std::sqrt(squares);
  return -1;
}

template <int dim, class Law> double ElementTable<dim, Law>::energy(const Vector& u) const {
  std::vector<double> local;
  double sum = 0;
  for (std::size_t c = 0; c < m_cells; ++c) {
    gather(c, u, local);
    for (unsigned q = 0; q < m_points; ++q) {
      sum += m_JxW[c * m_points + q] * m_law.energy(c * m_points + q, deformation(c, q, local));
    }
  }
  return sum;
}

/// K_ai,bk += w dN_a/dX_J A_iJkL dN_b/dX_L for b <= a; the rest follows from symmetry, or
/// comes too (`whole`).
template <int dim, class Law>
void ElementTable<dim, Law>::add_stiffness(std::size_t cell, unsigned q,
                                           const dealii::Tensor<4, dim>& A, bool whole,
                                           std::vector<double>& matrix) const {
  const unsigned n = m_nodes * dim;
  const dealii::Tensor<1, dim>* g = gradients(cell, q);
  const double w = m_JxW[cell * m_points + q];
  for (unsigned b = 0; b < m_nodes; ++b) {
    double Ag[dim][dim][dim];  // [i][k][J]
    for (int i = 0; i < dim; ++i)
      for (int J = 0; J < dim; ++J)
        for (int k = 0; k < dim; ++k) Ag[i][k][J] = w * (A[i][J][k] * g[b]);
    for (unsigned a = whole ? 0 : b; a < m_nodes; ++a) {
      for (int i = 0; i < dim; ++i) {
        for (int k = 0; k < dim; ++k) {
          double sum = 0;
          for (int J = 0; J < dim; ++J) sum += g[a][J] * Ag[i][k][J];
          matrix[(a * dim + i) * n + b * dim + k] += sum;
        }
      }
    }
  }
}

template <int dim, class Law>
bool ElementTable<dim, Law>::cell_tangent(std::size_t cell, const std::vector<double>& local,
                                          std::vector<double>& force,
                                          std::vector<double>& matrix) const {
  const unsigned n = m_nodes * dim;
  const bool whole = !m_law.symmetric();
  force.assign(n, 0.0);
  matrix.assign(static_cast<std::size_t>(n) * n, 0.0);
  for (unsigned q = 0; q < m_points; ++q) {
    dealii::Tensor<2, dim> P;
    dealii::Tensor<4, dim> A;
    if (!m_law.tangent(cell * m_points + q, deformation(cell, q, local), P, A)) return false;
    const dealii::Tensor<1, dim>* g = gradients(cell, q);
    const double w = m_JxW[cell * m_points + q];
    for (unsigned a = 0; a < m_nodes; ++a) {
      for (int i = 0; i < dim; ++i) force[a * dim + i] += w * (P[i] * g[a]);
    }
    add_stiffness(cell, q, A, whole, matrix);
  }
  for (unsigned r = 0; r < n && !whole; ++r) {
    for (unsigned c = (r / dim + 1) * dim; c < n; ++c) matrix[r * n + c] = matrix[c * n + r];
  }
  return true;
}

template <int dim, class Law>
long ElementTable<dim, Law>::tangent(const Vector& u, Vector& f,
                                     dealii::SparseMatrix<double>& K) const {
  const unsigned n = m_nodes * dim;
  std::vector<double> local, out, matrix;
  double squares = 0;
  f = 0;
  K = 0;
  for (std::size_t c = 0; c < m_cells; ++c) {
    gather(c, u, local);
    if (!cell_tangent(c, local, out, matrix)) return static_cast<long>(c);
    const unsigned* dofs = &m_dofs[c * n];
    for (unsigned r = 0; r < n; ++r) {
      f[dofs[r]] += out[r];
      squares += out[r] * out[r];
      K.add(dofs[r], n, dofs, &matrix[static_cast<std::size_t>(r) * n]);
    }
  }
  m_force_norm = std::sqrt(squares);
  return -1;
}

template <int dim, class Law>
void ElementTable<dim, Law>::consistent_mass(double rho,
                                             dealii::SparseMatrix<double>& M) const {
  const dealii::FiniteElement<dim>& scalar = m_discretisation.element().base_element(0);
  dealii::FEValues<dim> values(m_discretisation.mapping(), scalar,
                               m_discretisation.gauss(m_discretisation.degree() + 2),
                               dealii::update_values | dealii::update_JxW_values);
  M = 0;
  for (const auto& cell : m_discretisation.triangulation().active_cell_iterators()) {
    values.reinit(cell);
    const unsigned* dofs = &m_dofs[cell->active_cell_index() * m_nodes * dim];
    for (unsigned a = 0; a < m_nodes; ++a) {
      for (unsigned b = 0; b < m_nodes; ++b) {
        double sum = 0;
        for (unsigned q = 0; q < values.n_quadrature_points; ++q) {
          sum += values.shape_value(a, q) * values.shape_value(b, q) * values.JxW(q);
        }
        for (int i = 0; i < dim; ++i) {
          M.add(dofs[a * dim + i], dofs[b * dim + i], rho * m_thickness * sum);
        }
      }
    }
  }
}

template class ElementTable<2, ElasticPoints<2>>;
template class ElementTable<3, ElasticPoints<3>>;
template class ElementTable<2, PlasticPoints<2>>;
template class ElementTable<3, PlasticPoints<3>>;

}  // namespace concord::fem
