// Edges and hourglass numbers against values by hand.

#include "particle/core/hourglass.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace concord::particle {
namespace {

/// The triangle (0,0), (1,0), (0,1) with its three particles.
Body triangle(double thickness = 1) {
  Body body;
  body.dim = 2, body.stride = 2, body.n = body.bulk = 3, body.h = 1, body.thickness = thickness;
  body.X = {0, 0, 1, 0, 0, 1};
  body.V.assign(3, thickness / 6);
  body.triangulation.dim = 2;
  body.triangulation.simplices = {0, 1, 2};
  return body;
}

TEST(Edges, WeighTheirShareOfTheVolumeBySquaredLength) {
  const Edges edges = make_edges(triangle(3));
  EXPECT_EQ(edges.begin, (std::vector<std::size_t>{0, 2, 3, 3}));
  EXPECT_EQ(edges.other, (std::vector<Index>{1, 2, 2}));
  // A third of 3 x 1/2 each, over 1, 1 and 2.
  EXPECT_FLOAT_EQ(edges.weight[0], 0.5F);
  EXPECT_FLOAT_EQ(edges.weight[1], 0.5F);
  EXPECT_FLOAT_EQ(edges.weight[2], 0.25F);
}

TEST(Edges, OfTwoSimplicesAddUp) {
  Body body = triangle();
  body.n = body.bulk = 4;
  body.X.insert(body.X.end(), {1, 1});
  body.triangulation.simplices = {0, 1, 2, 1, 3, 2};
  const Edges edges = make_edges(body);
  EXPECT_EQ(edges.other, (std::vector<Index>{1, 2, 2, 3, 3}));
  EXPECT_FLOAT_EQ(edges.weight[2], 1.0F / 6);  // the diagonal: 2 x 1/6 over 2
  EXPECT_FLOAT_EQ(edges.weight[3], 1.0F / 6);
}

/// The third particle moves by d along Y while gradients see nothing:
/// l = d on two edges, N = (1/6 + 1/12) d^2, C = ((1/6)^2/(1/3) + (1/12)^2/(1/4) +
/// (1/4)^2/(1/4)) d^2/2.
TEST(Hourglass, OfOneTriangleByHand) {
  const Body body = triangle();
  const double d = 1e-3;
  const std::vector<double> u{0, 0, 0, 0, 0, d};
  std::vector<Mat3> H(3, Mat3::Zero());
  const Roughness r = Hourglass(body).measure(u, H);
  EXPECT_NEAR(r.local, d * d / 4, 1e-7 * d * d);
  EXPECT_NEAR(r.alternating, 13 * d * d / 72, 1e-7 * d * d);
  EXPECT_EQ(r.strain, 0);
  const double E = 2e5, energy = 3 * 0.5 * E * r.local;
  EXPECT_NEAR(r.nonaffine_energy_share(E, energy), 0.25, 1e-9);
  // With a strain of d/2 along Y seen by all, l = d/2 there.
  for (Mat3& h : H) h(1, 1) = d / 2;
  const Roughness half = Hourglass(body).measure(u, H);
  EXPECT_NEAR(half.local, d * d / 16, 1e-7 * d * d);
  const double strain = d / 2 + d * d / 8;
  EXPECT_NEAR(half.strain, 0.5 * strain * strain, 1e-12 * d * d);
  EXPECT_NEAR(half.checkerboard(), std::sqrt(13.0 / 72 / 4 / 0.5) * d / strain, 1e-6);
}

TEST(Hourglass, IsZeroForABodyAtRestAndARigidMotion) {
  const Body body = triangle();
  std::vector<Mat3> H(3, Mat3::Zero());
  const Roughness rest = Hourglass(body).measure(std::vector<double>(6, 0.0), H);
  EXPECT_EQ(rest.nonaffine_energy_share(1, 0), 0);
  EXPECT_EQ(rest.checkerboard(), 0);
  // A shift by 1/3 with round-off in one entry.
  const double s = 1.0 / 3;
  const Roughness shift =
      Hourglass(body).measure(std::vector<double>{s, s, s, s, s, s * (1 + 1e-15)}, H);
  EXPECT_GT(shift.local, 0);
  EXPECT_LT(shift.nonaffine_energy_share(1, 1e-33), 1e-3);
  EXPECT_LT(shift.checkerboard(), 0.03);
}

}  // namespace
}  // namespace concord::particle
