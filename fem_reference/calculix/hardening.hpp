#pragma once
// The hardening curve as the table that CalculiX interpolates linearly.

#include "scene/problem.hpp"

#include <vector>

namespace concord::calculix {

/// CalculiX holds at most this many pairs of stress and plastic strain (plconloc in its
/// incplas.f).
inline constexpr int max_hardening_points = 200;
/// The curve is sampled up to this plastic strain; one point more continues it on a straight
/// line to last_strain, since CalculiX takes the stress as constant beyond the last point.
inline constexpr double sampled_strain = 2, last_strain = 100;

struct HardeningTable {
  std::vector<double> strain, stress;  ///< eps_p ascending from 0, tau_y [Pa]
  double error = 0;  ///< largest |table - curve|/curve for eps_p up to sampled_strain
};

/// tau_y(eps_p), Eq. (24) of the Continuum Bond Method paper [Pa].
double flow_stress(const scene::Hardening& hardening, double eps_p);

/// `points` pairs of Eq. (24) placed so that the error of linear interpolation is the same
/// between all: spacing proportional to |tau_y''|^(-1/2).
HardeningTable hardening_table(const scene::Hardening& hardening, int points);

}  // namespace concord::calculix
