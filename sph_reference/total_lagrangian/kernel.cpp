#include "sph_reference/total_lagrangian/kernel.hpp"

#include <cmath>
#include <numbers>

namespace concord::sph {
namespace {

/// W(0) h^dim from the unit integral.
double normalisation(KernelShape shape, int dim) {
  using std::numbers::pi;
  if (shape == KernelShape::cubic_spline) return dim == 3 ? 1 / pi : 10 / (7 * pi);
  return dim == 3 ? 21 / (16 * pi) : 7 / (4 * pi);
}

}  // namespace

Kernel::Kernel(KernelShape shape, int dim, double R)
    : m_shape(shape), m_h(R / 2), m_factor(normalisation(shape, dim) / std::pow(R / 2, dim)) {}

double Kernel::value(double r) const {
  const double q = r / m_h;
  if (q >= 2) return 0;
  if (m_shape == KernelShape::wendland_c2) {
    const double s = 1 - q / 2;
    return m_factor * s * s * s * s * (1 + 2 * q);  // (TLS.2)
  }
  if (q > 1) return m_factor * 0.25 * (2 - q) * (2 - q) * (2 - q);  // (TLS.1)
  return m_factor * (1 - 1.5 * q * q + 0.75 * q * q * q);
}

double Kernel::slope(double r) const {
  const double q = r / m_h, scale = m_factor / (m_h * m_h);
  if (q >= 2) return 0;
  if (m_shape == KernelShape::wendland_c2) {
    const double s = 1 - q / 2;
    return scale * 5 * s * s * s;
  }
  if (q > 1) return scale * 0.75 * (2 - q) * (2 - q) / q;
  return scale * (3 - 2.25 * q);
}

double Kernel::second_derivative(double r) const {
  const double q = r / m_h, scale = m_factor / (m_h * m_h);
  if (q >= 2) return 0;
  if (m_shape == KernelShape::wendland_c2) {
    const double s = 1 - q / 2;
    return scale * 5 * s * s * (2 * q - 1);
  }
  if (q > 1) return scale * 1.5 * (2 - q);
  return scale * (4.5 * q - 3);
}

}  // namespace concord::sph
