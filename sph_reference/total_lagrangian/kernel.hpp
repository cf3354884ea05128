#pragma once
// Smoothing kernels of SPH, by their support radius.

namespace concord::sph {

enum class KernelShape { cubic_spline, wendland_c2 };

/// A radial weight W(r) [1/m^dim] with unit integral over its support r < R. Both kernels reach
/// to two smoothing lengths, R = 2 h, q = r/h. Cubic spline (TLS.1): Eq. (27) of the Continuum
/// Bond Method paper, whose r is R; Wendland C2 (TLS.2).
class Kernel {
 public:
  /// dim: 2 or 3; R: support radius [m].
  Kernel(KernelShape shape, int dim, double R);
  double radius() const { return 2 * m_h; }
  double smoothing_length() const { return m_h; }

  /// W(r) [1/m^dim]; zero for r >= R.
  double value(double r) const;
  /// W'(r) [1/m^(dim+1)]; zero for r >= R.
  double derivative(double r) const { return -r * slope(r); }
  /// W''(r) [1/m^(dim+2)]; at r = 0 in 3D -3/(pi h^5) and -105/(16 pi h^5).
  double second_derivative(double r) const;
  /// -W'(r)/r [1/m^(dim+2)]: positive, finite at r = 0, so that dW/dX_a = slope X_ab with X_ab
  /// = X_b - X_a.
  double slope(double r) const;

 private:
  KernelShape m_shape;
  double m_h;       ///< smoothing length R/2
  double m_factor;  ///< W(0)
};

}  // namespace concord::sph
