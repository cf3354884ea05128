#pragma once
// The one implementation of error norms that every study uses.

#include "scene/geometry.hpp"
#include "scene/method.hpp"

namespace concord::scene {

/// Weighted relative L2 norm of the difference, sqrt(sum w |a - b|^2) / sqrt(sum w |b|^2).
/// Absolute if b vanishes.
double relative_l2(std::span<const Vec3> a, std::span<const Vec3> b,
                   std::span<const double> weight);

/// Relative difference of a scalar field over chosen points, Eq. (29) of the Continuum Bond
/// Method paper (there in percent): sqrt(sum (reference - value)^2 / sum reference^2), every
/// point with the same weight. Spans of one size, at least one point. Throws
/// std::invalid_argument where the reference vanishes everywhere: there is no relative
/// difference.
double field_error(std::span<const double> reference, std::span<const double> value);

/// Adds to result.errors, against the problem's exact solution at time result.t_end:
/// displacement_l2 (relative, at the method's own samples), displacement_max [m], velocity_l2
/// and gradient_l2 (relative, samples), and displacement_l2_common, gradient_l2_common
/// (relative, on common_quadrature(problem)). Does nothing when the problem has no exact
/// solution.
void add_exact_errors(const Problem& problem, Result& result);

/// Relative L2 difference of two fields on the common quadrature, normalised by the second (the
/// reference).
double field_difference(const Problem& problem, const Field& field, const Field& reference);

}  // namespace concord::scene
