#include "particle/voronoi/polygon.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace concord::particle::voronoi {

void clip(const Polygon& polygon, const HalfSpace& inside, Polygon& result) {
  result.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double dp = inside.beyond(p), dq = inside.beyond(q);
    if (dp <= 0) result.push_back(p);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0))
      result.push_back(p + dp / (dp - dq) * (q - p));
  }
  if (result.size() < 3) result.clear();
}

Moments moments(std::span<const Vec3> polygon, const Vec3& N) {
  Moments sum;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Vec3 p = polygon[i - 1] - polygon[0], q = polygon[i] - polygon[0];
    const double A = 0.5 * p.cross(q).dot(N);
    sum.A += A;
    sum.AC += A / 3 * (p + q);
  }
  if (sum.A < 0) {
    sum.A = -sum.A;
    sum.AC = -sum.AC;
  }
  if (!polygon.empty()) sum.AC += sum.A * polygon[0];
  return sum;
}

}  // namespace concord::particle::voronoi
