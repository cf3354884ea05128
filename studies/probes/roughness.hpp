#pragma once
// How rough a scalar field over scattered points is.

#include "scene/types.hpp"

#include <span>
#include <vector>

namespace concord::probes {

/// A field in two parts, at every point that lies amidst its neighbours (their centre is nearer
/// than a quarter of their mean distance); other points (those on surfaces) are left out.
struct Parts {
  std::vector<double> smooth;  ///< linear least-squares fit over the neighbours at the point
  std::vector<double> rough;   ///< value less that
};

/// Neighbours are the nearest 8 points in the plane, 18 in space, the point itself left out.
/// Rough is zero for linear fields, and the amplitude of a checkerboard on a square lattice.
Parts split_roughness(int dim, std::span<const Vec3> points, std::span<const double> values);

/// Root mean square of the lower 95 % in size: without the singular corners of a body.
double trimmed_rms(std::vector<double> values);

}  // namespace concord::probes
