#pragma once
// How rough a scalar field over scattered points is.

#include "scene/types.hpp"

#include <span>
#include <vector>

namespace concord::probes {

/// Value less that of a linear least-squares fit over the nearest neighbours (8 in the plane,
/// 18 in space), the point itself left out, at every point that lies amidst its neighbours
/// (theirs centre is nearer than a quarter of their mean distance); other points (surfaces) are
/// left out. Zero for linear fields; the amplitude of a checkerboard on a square lattice.
std::vector<double> roughness(int dim, std::span<const Vec3> points,
                              std::span<const double> values);

/// Root mean square of the lower 95 % in size: without the singular corners of a body.
double trimmed_rms(std::vector<double> values);

}  // namespace concord::probes
