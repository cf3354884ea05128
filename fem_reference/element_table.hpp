#pragma once
// Element integrals from stored shape gradients: force, tangent, energy, masses. The path of
// Newton's method, and of all simplices.

#include "fem_reference/discretisation.hpp"
#include "fem_reference/hyperelastic.hpp"
#include "fem_reference/internal_force.hpp"

#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

namespace concord::fem {

/// Quadrature, exact for the linear stiffness of affine elements: p+1 Gauss points a direction
/// on hypercubes; on simplices the rule exact to degree 2p-1 (1 point for P1; 6 or 8 for P2).
/// Memory: cells x points x nodes x dim doubles (17 kB a Q2 hexahedron, 1 kB a P2 tetrahedron).
template <int dim> class ElementTable : public InternalForce {
 public:
  ElementTable(const Discretisation<dim>& discretisation, const Hyperelastic<dim>& law,
               double thickness);

  long force(const Vector& u, Vector& f) const override;
  double energy(const Vector& u) const override;
  /// K = df/du (consistent, added to nothing: K is overwritten) together with f; returns as
  /// force().
  long tangent(const Vector& u, Vector& f, dealii::SparseMatrix<double>& K) const;
  /// Norm over all element forces of the last force() or tangent(), before they were added up:
  /// the scale of a residual, which does not vanish in equilibrium [N].
  double element_force_norm() const { return m_force_norm; }

  const dealii::SparsityPattern& sparsity() const { return m_sparsity; }
  /// Consistent mass, rho N_a N_b with p+2 points a direction (exact on affine cells).
  void consistent_mass(double rho, dealii::SparseMatrix<double>& M) const;

 private:
  struct CellState;
  void gather(std::size_t cell, const Vector& u, std::vector<double>& local) const;
  dealii::Tensor<2, dim> deformation(std::size_t cell, unsigned q,
                                     const std::vector<double>& local) const;
  bool cell_force(std::size_t cell, const std::vector<double>& local,
                  std::vector<double>& out) const;
  bool cell_tangent(std::size_t cell, const std::vector<double>& local,
                    std::vector<double>& force, std::vector<double>& matrix) const;
  void add_stiffness(std::size_t cell, unsigned q, const dealii::Tensor<4, dim>& A,
                     std::vector<double>& matrix) const;
  const dealii::Tensor<1, dim>* gradients(std::size_t cell, unsigned q) const {
    return &m_gradient[(cell * m_points + q) * m_nodes];
  }

  const Discretisation<dim>& m_discretisation;
  const Hyperelastic<dim>& m_law;
  double m_thickness;
  unsigned m_nodes = 0, m_points = 0;
  std::size_t m_cells = 0;
  std::vector<dealii::Tensor<1, dim>> m_gradient;  ///< [cell][q][node]
  std::vector<double> m_JxW;                       ///< [cell][q], thickness included
  std::vector<unsigned> m_dofs;                    ///< [cell][node][component]
  dealii::SparsityPattern m_sparsity;
  mutable double m_force_norm = 0;
};

extern template class ElementTable<2>;
extern template class ElementTable<3>;

}  // namespace concord::fem
