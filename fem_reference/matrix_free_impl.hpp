#pragma once
// Body of matrix_free.hpp; each space dimension is compiled in a file of its own, because these
// templates are slow to compile.

#include "fem_reference/matrix_free.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/matrix_free/fe_evaluation.h>
#include <deal.II/matrix_free/matrix_free.h>

namespace concord::fem {

/// deal.II as Debian builds it has VectorizedArray<double>::size() == 1: the lane loops below
/// run once. With a native build the sum factorisation is vectorised and the law is not.
template <int dim, int degree> class MatrixFreeForce : public InternalForce {
 public:
  using Evaluation = dealii::FEEvaluation<dim, degree, degree + 1, dim, double>;
  using Range = std::pair<unsigned, unsigned>;

  MatrixFreeForce(const Discretisation<dim>& discretisation, const Hyperelastic<dim>& law,
                  double thickness)
      : m_law(law), m_thickness(thickness) {
    m_constraints.close();
    typename dealii::MatrixFree<dim, double>::AdditionalData data;
    data.tasks_parallel_scheme = dealii::MatrixFree<dim, double>::AdditionalData::none;
    data.mapping_update_flags = dealii::update_gradients | dealii::update_JxW_values;
    m_data.reinit(discretisation.mapping(), discretisation.dof_handler(), m_constraints,
                  dealii::QGauss<1>(degree + 1), data);
  }

  long force(const Vector& u, Vector& f) const override {
    m_bad_cell = -1;
    m_data.cell_loop(&MatrixFreeForce::sweep, this, f, u, true);
    return m_bad_cell;
  }

  double energy(const Vector& u) const override {
    Evaluation cells(m_data);
    double sum = 0;
    for (unsigned batch = 0; batch < m_data.n_cell_batches(); ++batch) {
      cells.reinit(batch);
      cells.gather_evaluate(u, dealii::EvaluationFlags::gradients);
      for (unsigned q = 0; q < cells.n_q_points; ++q) {
        const auto H = cells.get_gradient(q);
        for (unsigned lane = 0; lane < m_data.n_active_entries_per_cell_batch(batch); ++lane) {
          sum += m_law.energy(deformation(H, lane)) * cells.JxW(q)[lane];
        }
      }
    }
    return m_thickness * sum;
  }

 private:
  using Gradient = typename Evaluation::gradient_type;

  static dealii::Tensor<2, dim> deformation(const Gradient& H, unsigned lane) {
    dealii::Tensor<2, dim> F;
    for (int i = 0; i < dim; ++i) {
      for (int j = 0; j < dim; ++j) F[i][j] = H[i][j][lane] + (i == j ? 1.0 : 0.0);
    }
    return F;
  }

  void sweep(const dealii::MatrixFree<dim, double>& data, Vector& f, const Vector& u,
             const Range& range) const {
    Evaluation cells(data);
    for (unsigned batch = range.first; batch < range.second; ++batch) {
      cells.reinit(batch);
      cells.gather_evaluate(u, dealii::EvaluationFlags::gradients);
      const unsigned lanes = data.n_active_entries_per_cell_batch(batch);
      for (unsigned q = 0; q < cells.n_q_points; ++q) {
        Gradient H = cells.get_gradient(q), stress;
        for (unsigned lane = 0; lane < lanes; ++lane) {
          dealii::Tensor<2, dim> P;
          if (!m_law.stress(deformation(H, lane), P) && m_bad_cell < 0) {
            m_bad_cell = data.get_cell_iterator(batch, lane)->active_cell_index();
          }
          for (int i = 0; i < dim; ++i) {
            for (int j = 0; j < dim; ++j) stress[i][j][lane] = m_thickness * P[i][j];
          }
        }
        cells.submit_gradient(stress, q);
      }
      cells.integrate_scatter(dealii::EvaluationFlags::gradients, f);
    }
  }

  const Hyperelastic<dim>& m_law;
  double m_thickness;
  dealii::AffineConstraints<double> m_constraints;
  dealii::MatrixFree<dim, double> m_data;
  mutable long m_bad_cell = -1;
};

template <int dim>
std::unique_ptr<InternalForce> make_matrix_free(const Discretisation<dim>& discretisation,
                                                const Hyperelastic<dim>& law,
                                                double thickness) {
  if (discretisation.degree() == 1) {
    return std::make_unique<MatrixFreeForce<dim, 1>>(discretisation, law, thickness);
  }
  return std::make_unique<MatrixFreeForce<dim, 2>>(discretisation, law, thickness);
}

template <int dim>
void lumped_mass(const Discretisation<dim>& discretisation, double rho, double thickness,
                 dealii::Vector<double>& mass) {
  const dealii::FESystem<dim>& element = discretisation.element();
  const dealii::FiniteElement<dim>& scalar = element.base_element(0);
  dealii::FEValues<dim> values(discretisation.mapping(), scalar,
                               dealii::QGaussLobatto<dim>(discretisation.degree() + 1),
                               dealii::update_values | dealii::update_JxW_values);
  mass.reinit(discretisation.dofs());
  std::vector<dealii::types::global_dof_index> dofs(element.n_dofs_per_cell());
  for (const auto& cell : discretisation.dof_handler().active_cell_iterators()) {
    values.reinit(static_cast<typename dealii::Triangulation<dim>::cell_iterator>(cell));
    cell->get_dof_indices(dofs);
    for (unsigned a = 0; a < scalar.n_dofs_per_cell(); ++a) {
      double sum = 0;
      for (unsigned q = 0; q < values.n_quadrature_points; ++q) {
        sum += values.shape_value(a, q) * values.JxW(q);
      }
      for (unsigned i = 0; i < dim; ++i) {
        mass[dofs[element.component_to_system_index(i, a)]] += rho * thickness * sum;
      }
    }
  }
}

}  // namespace concord::fem
