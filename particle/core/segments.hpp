#pragma once
// Segments of the plane.

#include "scene/types.hpp"

namespace concord::particle {

/// Whether the segments pq and ab of the plane X-Y cross. A point on the other's line counts as
/// lying to its left, so that a path from one side of a segment to the other crosses it once,
/// even through a corner on it. Segments of one line do not cross.
inline bool segments_cross(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  const auto left = [](const Vec3& from, const Vec3& to, const Vec3& x) {
    return (to[0] - from[0]) * (x[1] - from[1]) - (to[1] - from[1]) * (x[0] - from[0]) >= 0;
  };
  return left(p, q, a) != left(p, q, b) && left(a, b, p) != left(a, b, q);
}

}  // namespace concord::particle
