// Roughness of fields with known roughness.

#include "studies/probes/roughness.hpp"

#include <gtest/gtest.h>

namespace concord::probes {
namespace {

std::vector<Vec3> lattice(int n) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) points.emplace_back(0.1 * i, 0.1 * j, 0);
  return points;
}

TEST(Roughness, VanishesForLinearFields) {
  const std::vector<Vec3> points = lattice(7);
  std::vector<double> values;
  for (const Vec3& X : points) values.push_back(3 + 2 * X[0] - 5 * X[1]);
  const Parts parts = split_roughness(2, points, values);
  EXPECT_EQ(parts.rough.size(), 25);  // those inside
  for (const double r : parts.rough) EXPECT_NEAR(r, 0, 1e-13);
}

TEST(Roughness, IsTheAmplitudeOfACheckerboard) {
  const std::vector<Vec3> points = lattice(7);
  std::vector<double> values;
  for (std::size_t a = 0; a < points.size(); ++a)
    values.push_back(10 +
                     (a % 2 == 0 ? 0.3 : -0.3));  // 7 is odd: alternates in both directions
  const Parts parts = split_roughness(2, points, values);
  EXPECT_NEAR(trimmed_rms(parts.rough), 0.3, 1e-12);
  EXPECT_NEAR(trimmed_rms(parts.smooth), 10, 0.01);
}

TEST(Roughness, LeavesOutTheLargestTwentieth) {
  std::vector<double> values(100, -2.0);
  for (int k = 0; k < 5; ++k) values[20 * k] = 1e6;
  EXPECT_DOUBLE_EQ(trimmed_rms(values), 2);
  values[1] = 1e6;
  EXPECT_GT(trimmed_rms(values), 1e4);
}

}  // namespace
}  // namespace concord::probes
