#pragma once
// What integrators ask of the discretised body, whether it is swept matrix-free or from tables.

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

}  // namespace concord::fem
