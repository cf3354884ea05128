#pragma once
// Convex polygons in space, as the faces of cells are.

#include "scene/types.hpp"

#include <span>
#include <vector>

namespace concord::particle::voronoi {

using Polygon = std::vector<Vec3>;  ///< corners in order, either way round

/// All X with N . X <= offset.
struct HalfSpace {
  Vec3 N = Vec3::Zero();
  double offset = 0;

  double beyond(const Vec3& X) const { return N.dot(X) - offset; }
  HalfSpace opposite() const { return {-N, -offset}; }
};

/// The part of a convex polygon inside a half-space, empty if there is none. Cut by both sides
/// of one plane, a polygon falls into two parts with the same corners on it to the last bit.
void clip(const Polygon& polygon, const HalfSpace& inside, Polygon& result);

/// Area and area times centroid of a convex polygon with unit normal +N or -N.
struct Moments {
  double A = 0;
  Vec3 AC = Vec3::Zero();
};
Moments moments(std::span<const Vec3> polygon, const Vec3& N);

}  // namespace concord::particle::voronoi
