#pragma once
// Artificial viscosity on the gradient of every particle, (61), (62) of the Delaunay paper and
// (51) of the Voronoi paper.

#include "particle/core/stress_kernel.hpp"
#include "scene/problem.hpp"

#include <Eigen/LU>

#include <cmath>
#include <optional>

namespace concord::particle {

/// Coefficients of the viscous stress, times rho0.
struct Viscosity {
  double linear;     ///< rho0 c1 c_p h [Pa s]
  double quadratic;  ///< rho0 c2 h^2 [Pa s^2]

  /// J sigma_visc F^-T with rho J = rho0: (linear + quadratic |tr d|) d F^-T, d = sym(dF/dt
  /// F^-1); H = F - I, rate = dF/dt.
  CONCORD_INLINE Mat3 stress(const Mat3& H, const Mat3& rate) const {
    const Mat3 inverse = (Mat3::Identity() + H).inverse(), l = rate * inverse;
    const Mat3 d = 0.5 * (l + l.transpose());
    return (linear + quadratic * std::abs(d.trace())) * d * inverse.transpose();
  }

  /// Of the highest mode: damping c = (linear/rho0) k^2 against stiffness c_p^2 k^2, ratio =
  /// linear w / (2 rho0 c_p^2).
  double damping_ratio(const LameConstants& lame, double omega_max) const {
    return 0.5 * linear * omega_max / (lame.lambda + 2 * lame.mu);
  }
};

/// Nothing with c1 = c2 = 0. h: the shortest branch vector [m].
inline std::optional<Viscosity>
artificial_viscosity(double c1, double c2, const scene::Material& material, double h) {
  if (!(c1 > 0 || c2 > 0)) return std::nullopt;
  return Viscosity{material.rho0 * c1 * material.longitudinal_wave_speed() * h,
                   material.rho0 * c2 * h * h};
}

}  // namespace concord::particle
