// The plastic law against the oracle: stress, state and consistent tangent; and the stress as
// the derivative of the energy.

#include "plasticity_oracle.hpp"

#include <gtest/gtest.h>

namespace concord::particle::plasticity_test {
namespace {

struct Point {
  PlasticState old;
  Mat3 H;
};

/// A state that `steps` random increments of size `size` lead to, and the gradient after one
/// more; the whole turned by a large rotation.
Point random_point(const J2Hencky& law, std::uint64_t seed, int steps, double size,
                   bool plane) {
  Point point;
  Mat3 F = Mat3::Identity();
  for (int k = 0; k <= steps; ++k) {
    if (k > 0) point.old = law.update(Mat3(F - Mat3::Identity()), point.old).state;
    Mat3 L = random_matrix(1000 * seed + static_cast<std::uint64_t>(k), size, plane);
    L -= 0.9 * L.trace() / 3 * Mat3::Identity();
    if (plane) L(2, 2) = 0;
    F = (Mat3::Identity() + L) * F;
  }
  if (seed % 2 == 1) F = random_rotation(seed, plane) * F;
  point.H = F - Mat3::Identity();
  return point;
}

/// Stress, state and tangent at one point; returns whether it yields.
bool compare(const scene::Material& m, const Point& point) {
  const J2Hencky law(m);
  const Mat3 F = point.H + Mat3::Identity();
  const J2Hencky::Update u = law.update(point.H, point.old);
  const OracleUpdate<Dual> o = oracle_update(m, active(F), point.old);
  EXPECT_TRUE(u.sound);
  EXPECT_EQ(u.yields, o.yields);
  Mat3 P;
  scene::Tangent T;
  for (int r = 0; r < 9; ++r) {
    P(r / 3, r % 3) = o.P(r / 3, r % 3).value();
    T.row(r) = o.P(r / 3, r % 3).derivatives().transpose();
  }
  EXPECT_LT((u.P - P).norm(), 1e-11 * P.norm());
  // Where nearly all of the strain is dilation, the deviator has the round-off of the strain.
  EXPECT_NEAR(u.tau_eq, o.tau_eq.value(), 1e-11 * u.tau_eq + 5e-15 * m.mu);
  EXPECT_NEAR(u.stored, o.energy.value(), 1e-11 * u.stored);
  EXPECT_LT((u.state.A - o.state.A).norm(), 1e-12 * F.inverse().squaredNorm());
  EXPECT_NEAR(u.state.eps_p, o.state.eps_p, 1e-13);
  const scene::Tangent tangent = law.tangent(point.H, point.old);
  EXPECT_LT((tangent - T).norm(), 1e-9 * T.norm());
  EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-13 * T.norm());
  return u.yields;
}

class Oracle : public testing::TestWithParam<bool> {};

TEST_P(Oracle, RandomStates) {
  const scene::Material m = steel();
  int plastic = 0, count = 0;
  for (const double size : {1e-3, 0.02, 0.2})
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
      SCOPED_TRACE(testing::Message() << "size " << size << " seed " << seed);
      const int steps = static_cast<int>(seed % 4);
      plastic += compare(m, random_point(J2Hencky(m), seed, steps, size, GetParam()));
      ++count;
    }
  EXPECT_GT(plastic, count / 2);
  EXPECT_LT(plastic, count);
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Oracle, testing::Bool(), [](const auto& info) {
  return info.param ? "PlaneStrain" : "ThreeD";
});

TEST(PlasticOracle, OtherHardenings) {
  // Perfect, linear, softening to 2/3, and a saturation that a step of this size runs through.
  for (const scene::Hardening h :
       {scene::Hardening{450e6, 450e6, 0, 0}, scene::Hardening{450e6, 450e6, 5e9, 0},
        scene::Hardening{450e6, 300e6, 0, 20}, scene::Hardening{450e6, 900e6, 0, 200}}) {
    const scene::Material m = steel(h);
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      SCOPED_TRACE(testing::Message() << h.saturation_stress << " seed " << seed);
      EXPECT_TRUE(compare(m, random_point(J2Hencky(m), seed, 2, 0.1, seed > 4)));
    }
  }
}

TEST(PlasticOracle, EqualAndNearlyEqualStretches) {
  const scene::Material m = steel();
  const Mat3 Q = random_rotation(3);
  for (const double gap : {0.0, 1e-15, 1e-11, 1e-8, 1e-5, 1e-3})
    for (const double s : {1.0005, 1.2, 0.7}) {
      SCOPED_TRACE(testing::Message() << "gap " << gap << " stretch " << s);
      const Mat3 R = random_rotation(8);
      Point two, three;
      two.H = R * Q * Vec3(s, 1, 1 + gap).asDiagonal() * Q.transpose() - Mat3::Identity();
      compare(m, two);
      // All three: under pure dilation the elastic law is smooth.
      three.H = R * Q * Vec3(s, s + gap, s).asDiagonal() * Q.transpose() - Mat3::Identity();
      if (gap < 1e-4) {
        const OracleUpdate<Dual> o =
            oracle_update(m, active(Mat3(three.H + Mat3::Identity())), three.old);
        EXPECT_FALSE(o.yields);
      }
      if (gap > 1e-9) compare(m, three);
    }
}

TEST(PlasticOracle, PureDilationHasTheElasticTangent) {
  // F = s I: dP = (lambda tr l I + mu (l + l^T) - kappa ln s^3 l^T)/s, l = dF/s.
  const scene::Material m = steel();
  const double s = 1.3, kappa = m.lambda + 2 * m.mu / 3, p = 3 * kappa * std::log(s);
  const scene::Tangent T = J2Hencky(m).tangent(Mat3((s - 1) * Mat3::Identity()), {});
  for (int r = 0; r < 9; ++r)
    for (int c = 0; c < 9; ++c) {
      const int i = r / 3, j = r % 3, k = c / 3, l = c % 3;
      const double expected = m.lambda * (i == j) * (k == l) + m.mu * (i == k) * (j == l) +
                              (m.mu - p) * (i == l) * (j == k);
      EXPECT_NEAR(T(r, c), expected / (s * s), 1e-13 * m.mu);
    }
}

TEST(PlasticOracle, OntoTheYieldSurfaceTheTangentLoads) {
  // After a plastic step the same F lies on the surface: the tangent is that of a step onwards.
  const scene::Material m = steel();
  const J2Hencky law(m);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Point point = random_point(law, seed, 2, 0.05, false);
    const J2Hencky::Update u = law.update(point.H, point.old);
    ASSERT_TRUE(u.yields);
    const scene::Tangent T = law.tangent(point.H, u.state);
    // Along the current velocity of loading the return map stays active: one-sided difference
    // of second order, 4 P(h) - P(2h) - 3 P(0).
    const Mat3 tau = u.P * (point.H + Mat3::Identity()).transpose();
    const Mat3 L = tau - tau.trace() / 3 * Mat3::Identity();
    const Mat3 dF = L / L.norm() * (point.H + Mat3::Identity());
    const double h = 1e-5;
    const Mat3 one = law.update(Mat3(point.H + h * dF), u.state).P;
    const Mat3 two = law.update(Mat3(point.H + 2 * h * dF), u.state).P;
    const Mat3 slope = (4 * one - two - 3 * u.P) / (2 * h);
    Mat3 expected = Mat3::Zero();
    for (int r = 0; r < 9; ++r)
      for (int c = 0; c < 9; ++c) expected(r / 3, r % 3) += T(r, c) * dF(c / 3, c % 3);
    EXPECT_LT((slope - expected).norm(), 1e-4 * m.hardening.yield_stress) << seed;
    // ... which the elastic tangent misses by 3 mu.
    EXPECT_LT(expected.norm(), 0.05 * m.mu);
  }
}

TEST_P(Oracle, StressIsTheDerivativeOfStoredAndPlasticEnergy) {
  const scene::Material m = steel();
  const J2Hencky law(m);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Point point = random_point(law, seed, 3, 0.05, GetParam());
    const J2Hencky::Update u = law.update(point.H, point.old);
    const auto energy = [&](int i, int k, double h) {
      Mat3 H = point.H;
      H(i, k) += h;
      const J2Hencky::Update v = law.update(H, point.old);
      return v.stored + v.plastic;
    };
    const double h = 1e-4;  // fourth order: error h^4 of a strain of 1
    for (int i = 0; i < 9; ++i) {
      const auto difference = [&](double d) {
        return (energy(i / 3, i % 3, d) - energy(i / 3, i % 3, -d)) / (2 * d);
      };
      const double slope = (4 * difference(h) - difference(2 * h)) / 3;
      EXPECT_NEAR(slope, u.P(i / 3, i % 3), 1e-7 * u.P.norm()) << seed << " " << i;
    }
  }
}

}  // namespace
}  // namespace concord::particle::plasticity_test
