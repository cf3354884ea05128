#pragma once
// Element integrals from stored shape gradients: force, tangent, energy, masses. The path of
// Newton's method, and of all simplices.

#include "fem_reference/discretisation.hpp"
#include "fem_reference/internal_force.hpp"
#include "fem_reference/plastic_points.hpp"

namespace concord::fem {

/// Quadrature, exact for the linear stiffness of affine elements: p+1 Gauss points a direction
/// on hypercubes; on simplices the rule exact to degree 2p-1 (1 point for P1; 6 or 8 for P2),
/// or what the setting `quadrature` says. Memory: cells x points x nodes x dim doubles (17 kB a
/// Q2 hexahedron, 1 kB a P2 tetrahedron). `Law` is ElasticPoints or PlasticPoints, asked by the
/// number of the quadrature point, cells in deal.II's order.
template <int dim, class Law> class ElementTable : public TangentForce {
 public:
  /// `law` outlives the table, which gives it its number of points.
  ElementTable(const Discretisation<dim>& discretisation, Law& law, double thickness);

  long force(const Vector& u, Vector& f) const override;
  double energy(const Vector& u) const override;
  long tangent(const Vector& u, Vector& f, dealii::SparseMatrix<double>& K) const override;
  double element_force_norm() const override { return m_force_norm; }
  const dealii::SparsityPattern& sparsity() const override { return m_sparsity; }
  bool symmetric() const override { return m_law.symmetric(); }
  double volume(std::size_t point) const { return m_JxW[point]; }
  /// Consistent mass, rho N_a N_b with p+2 points a direction (exact on affine cells).
  void consistent_mass(double rho, dealii::SparseMatrix<double>& M) const;

 private:
  void gather(std::size_t cell, const Vector& u, std::vector<double>& local) const;
  dealii::Tensor<2, dim> deformation(std::size_t cell, unsigned q,
                                     const std::vector<double>& local) const;
  bool cell_force(std::size_t cell, const std::vector<double>& local,
                  std::vector<double>& out) const;
  bool cell_tangent(std::size_t cell, const std::vector<double>& local,
                    std::vector<double>& force, std::vector<double>& matrix) const;
  void add_stiffness(std::size_t cell, unsigned q, const dealii::Tensor<4, dim>& A, bool whole,
                     std::vector<double>& matrix) const;
  const dealii::Tensor<1, dim>* gradients(std::size_t cell, unsigned q) const {
    return &m_gradient[(cell * m_points + q) * m_nodes];
  }

  const Discretisation<dim>& m_discretisation;
  Law& m_law;
  double m_thickness;
  unsigned m_nodes = 0, m_points = 0;
  std::size_t m_cells = 0;
  std::vector<dealii::Tensor<1, dim>> m_gradient;  ///< [cell][q][node]
  std::vector<double> m_JxW;                       ///< [cell][q], thickness included
  std::vector<unsigned> m_dofs;                    ///< [cell][node][component]
  dealii::SparsityPattern m_sparsity;
  mutable double m_force_norm = 0;
};

extern template class ElementTable<2, ElasticPoints<2>>;
extern template class ElementTable<3, ElasticPoints<3>>;
extern template class ElementTable<2, PlasticPoints<2>>;
extern template class ElementTable<3, PlasticPoints<3>>;

}  // namespace concord::fem
