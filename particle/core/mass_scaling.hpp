#pragma once
// Mass scaling: a longer stable step for more inertia in the few particles that bound it.

#include "particle/core/stable_step.hpp"

#include <vector>

namespace concord::particle {

/// What mass scaling did to a body.
struct MassScaling {
  double step_ratio = 1;      ///< critical step over that of the unscaled body
  double added_share = 0;     ///< added mass over the body's
  double particle_share = 0;  ///< particles with added mass over all
  double largest_ratio = 1;   ///< largest m_a' / m_a
};

/// Raises masses of `body`, which is the one `model` works on, until the critical step about u
/// is `factor` times the present one (to 1 %, measured by SpectralRadius):
///   m_a' = m_a max(1, r_a / r),   r_a = root mean square over the components i of a of
///   [sum_bj K_ai,bj^2 / (m_a m_b)]^(1/2) (MS.1)
/// r_a [1/s^2], the norm of the particle's rows of M^-1/2 K M^-1/2, is found with 16 random
/// vectors (to some 10 %). The bound r follows by iteration: omega_max^2 is nearly
/// proportional to it. Gravity is to be taken before: added mass has inertia, no weight.
/// Throws InputError (key mass_scaling) where the factor cannot be reached.
MassScaling scale_masses(Body& body, ForceModel& model, const Constraints& constraints,
                         const Executor& executor, std::span<const double> u, double factor);

}  // namespace concord::particle
