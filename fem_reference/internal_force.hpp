#pragma once
// What integrators ask of the discretised body, whether it is swept matrix-free or from tables.

#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/vector.h>

namespace concord::fem {

class InternalForce {
 public:
  using Vector = dealii::Vector<double>;
  virtual ~InternalForce() = default;
  /// f_ai = thickness * sum_q P_iJ dN_a/dX_J JxW [N], overwritten. Returns the first element
  /// with det F <= 0 or NaN, -1 when all are sound.
  virtual long force(const Vector& u, Vector& f) const = 0;
  /// Strain energy [J], by the quadrature of force(), of which it is the potential.
  virtual double energy(const Vector& u) const = 0;
};

/// What Newton's method asks for beside.
class TangentForce : public InternalForce {
 public:
  /// K = df/du (consistent, added to nothing: K is overwritten) together with f; returns as
  /// force().
  virtual long tangent(const Vector& u, Vector& f, dealii::SparseMatrix<double>& K) const = 0;
  /// Norm over all element forces of the last force() or tangent(), before they were added up:
  /// the scale of a residual, which does not vanish in equilibrium [N].
  virtual double element_force_norm() const = 0;
  virtual const dealii::SparsityPattern& sparsity() const = 0;
  virtual bool symmetric() const = 0;
};

}  // namespace concord::fem
