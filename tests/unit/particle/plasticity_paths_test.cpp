// What holds along every path of deformation: the yield condition, plastic incompressibility,
// dissipation, objectivity, and convergence at every step size.

#include "plasticity_oracle.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace concord::particle::plasticity_test {
namespace {

/// Random loading with unloading and reversal: every ten steps another direction, every thirty
/// the way back. Volume changes stay small, as in metals.
std::vector<Mat3> random_path(std::uint64_t seed, int steps, double size, bool plane) {
  std::vector<Mat3> path;
  Mat3 F = Mat3::Identity();
  for (int k = 0; k < steps; ++k) {
    Mat3 L = random_matrix(7919 * seed + static_cast<std::uint64_t>(k / 10), size, plane);
    const double third = plane ? 0 : L.trace() / 3, half = plane ? L.trace() / 2 : 0;
    L -= 0.98 * Vec3(half + third, half + third, third).asDiagonal().toDenseMatrix();
    if (k / 10 % 3 == 2) L = -L;
    F = (Mat3::Identity() + L) * F;
    path.push_back(F - Mat3::Identity());
  }
  return path;
}

double kirchhoff_mises(const J2Hencky::Update& u, const Mat3& H) {
  return scene::von_mises(u.P * (Mat3::Identity() + H).transpose());
}

class Paths : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Dimensions, Paths, testing::Bool(), [](const auto& info) {
  return info.param ? "PlaneStrain" : "ThreeD";
});

TEST_P(Paths, KeepTheYieldConditionTheVolumeAndTheSecondLaw) {
  scene::Material elastic = steel();
  elastic.hardening = {1e30, 1e30, 0, 0};
  const J2Hencky law(steel()), no_flow(elastic);
  int plastic = 0, count = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    PlasticState state;
    for (const Mat3& H : random_path(seed, 150, seed < 15 ? 0.0005 : 0.02, GetParam())) {
      const J2Hencky::Update u = law.update(H, state);
      ASSERT_TRUE(u.sound);
      EXPECT_LE(u.tau_eq, law.flow_stress(u.state.eps_p) * (1 + 1e-12));
      EXPECT_NEAR(u.tau_eq, kirchhoff_mises(u, H), 1e-11 * law.flow_stress(0));
      EXPECT_NEAR((Mat3::Identity() + u.state.A).determinant(), 1, 1e-12);
      EXPECT_EQ(u.plastic, law.flow_energy(u.state.eps_p));
      // The same state seen again: no stress above the yield stress is left in it.
      const double rounding = (Mat3::Identity() + H).squaredNorm() * (1 + u.state.A.norm());
      EXPECT_NEAR(no_flow.update(H, u.state).tau_eq, u.tau_eq,
                  1e-12 * u.tau_eq + 1e-15 * law.shear_modulus() * rounding);
      if (u.yields) {
        EXPECT_GT(u.state.eps_p, state.eps_p);
        // Flow lowers the sum of stored energy and plastic work, and more or less flow than
        // the law's would not.
        const double before = no_flow.update(H, state).stored + law.flow_energy(state.eps_p);
        EXPECT_LT(u.stored + u.plastic, before * (1 + 1e-15));
        EXPECT_EQ(u.tau_eq, law.flow_stress(u.state.eps_p));
      } else {
        EXPECT_EQ(u.state.A, state.A);
        EXPECT_EQ(u.state.eps_p, state.eps_p);
      }
      EXPECT_EQ(u.state.A.col(2).head(2).norm() == 0, GetParam() || u.state.eps_p == 0);
      state = u.state;
      plastic += u.yields, ++count;
    }
  }
  EXPECT_GT(plastic, count / 3);
  EXPECT_LT(plastic, count - count / 20);
}

TEST_P(Paths, RotationsOfTheObserverChangeNothing) {
  const J2Hencky law(steel());
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    PlasticState still, turned;
    std::uint64_t k = 1000 * seed;
    for (const Mat3& H : random_path(seed, 100, 0.01, GetParam())) {
      const Mat3 Q = random_rotation(k++, GetParam());
      const Mat3 QH = Q * (H + Mat3::Identity()) - Mat3::Identity();
      const J2Hencky::Update u = law.update(H, still), v = law.update(QH, still);
      EXPECT_LT((v.P - Q * u.P).norm(), 1e-11 * 450e6);
      EXPECT_NEAR(v.state.eps_p, u.state.eps_p, 1e-14);
      // ... nor does another rotation at every step of the path.
      const J2Hencky::Update w = law.update(QH, turned);
      EXPECT_LT((w.P - Q * u.P).norm(), 1e-10 * 450e6);
      EXPECT_NEAR(w.state.eps_p, u.state.eps_p, 1e-12);
      EXPECT_LT((w.state.A - u.state.A).norm(), 1e-12);
      still = u.state, turned = w.state;
    }
  }
}

TEST_P(Paths, InvariantToTheReferenceFrameOfIsotropy) {
  // F Q and Q^T A Q: the material has no preferred direction.
  const J2Hencky law(steel());
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Mat3 Q = random_rotation(seed, GetParam());
    const std::vector<Mat3> path = random_path(seed, 20, 0.01, GetParam());
    PlasticState old;
    for (const Mat3& H : path) old = law.update(H, old).state;
    const PlasticState turned{Q.transpose() * old.A * Q, old.eps_p};
    const Mat3 H = 0.1 * path.front() + path.back();
    const Mat3 FQ = (H + Mat3::Identity()) * Q;
    const J2Hencky::Update u = law.update(H, old);
    const J2Hencky::Update v = law.update(Mat3(FQ - Mat3::Identity()), turned);
    EXPECT_LT((v.P - u.P * Q).norm(), 1e-11 * 450e6);
  }
}

/// Stretches 100-fold, to a thousandth, and mixtures.
std::vector<Vec3> huge_stretches() {
  return {{100, 1, 1}, {100, 0.1, 0.1}, {1e-3, 1, 1}, {1e-3, 30, 30}, {100, 0.01, 1}};
}

/// These in one step from rest, along the axes and across, and a shear of 50.
std::vector<Mat3> huge_steps() {
  std::vector<Mat3> steps;
  for (const Vec3& s : huge_stretches()) {
    const Mat3 H = (s - Vec3::Ones()).asDiagonal(), Q = random_rotation(5);
    steps.push_back(H);
    steps.push_back(Q * H * Q.transpose());
  }
  Mat3 H = Mat3::Zero();
  H(0, 1) = 50;
  steps.push_back(H);
  return steps;
}

TEST(HugeSteps, ReachTheYieldSurface) {
  for (const scene::Hardening h :
       {steel().hardening, scene::Hardening{450e6, 450e6, 0, 0},
        scene::Hardening{450e6, 900e6, 0, 1e4}, scene::Hardening{450e6, 100e6, 0, 600},
        scene::Hardening{1, 1, 0, 0}, scene::Hardening{1, 715e6, 1e13, 16}}) {
    const J2Hencky law(steel(h));
    for (const Mat3& H : huge_steps()) {
      SCOPED_TRACE(testing::Message() << h.saturation_stress << "\n" << H);
      const J2Hencky::Update u = law.update(H, {});
      ASSERT_TRUE(u.sound);
      // Flow removes what the trial stress has beyond the flow stress.
      const double trial = u.tau_eq + 3 * law.shear_modulus() * u.state.eps_p;
      const J2Hencky elastic(steel({1e30, 1e30, 0, 0}));
      EXPECT_NEAR(trial / elastic.update(H, {}).tau_eq, 1, 1e-12);
      EXPECT_EQ(u.tau_eq, law.flow_stress(u.state.eps_p));
      EXPECT_TRUE(law.tangent(H, {}).allFinite());
    }
  }
}

TEST(HugeSteps, DilationIsElastic) {
  const scene::Material m = steel();
  const J2Hencky::Update u = J2Hencky(m).update(Mat3(99 * Mat3::Identity()), {});
  EXPECT_FALSE(u.yields);
  const double kappa = m.lambda + 2 * m.mu / 3;
  EXPECT_NEAR(u.P(0, 0), 3 * kappa * std::log(100.0) / 100, 1e-14 * kappa);
}

TEST(HugeSteps, AreThoseOfThePrincipalLogarithms) {
  // F = R Q diag(s) Q^T: e_i = ln s_i, the return map in these three numbers.
  const scene::Material m = steel();
  const J2Hencky law(m);
  for (const Vec3& s : huge_stretches())
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(testing::Message() << s.transpose() << " seed " << seed);
      const Vec3 e = s.array().log();
      const Vec3 dev = 2 * m.mu * (e.array() - e.mean());
      const double q = std::sqrt(1.5) * dev.norm(), d = oracle_increment(m, q, 0.0);
      const Vec3 tau =
          dev * (1 - 3 * m.mu * d / q) + Vec3::Constant((m.lambda + 2 * m.mu / 3) * e.sum());
      const Mat3 Q = seed == 0 ? Mat3(Mat3::Identity()) : random_rotation(seed);
      const Mat3 R = seed < 10 ? Mat3(Mat3::Identity()) : random_rotation(3 * seed);
      const Mat3 P = R * Q * Vec3(tau.cwiseQuotient(s)).asDiagonal() * Q.transpose();
      const Mat3 F = R * Q * s.asDiagonal() * Q.transpose();
      const J2Hencky::Update u = law.update(Mat3(F - Mat3::Identity()), {});
      // The rounding of F changes its stretches by as much as its condition; the expansion of
      // det F rounds by |F|^3, which the pressure feels.
      const double rounding = 1e-15 * s.maxCoeff() / s.minCoeff();
      const double volume = 2.2e-16 * std::pow(s.maxCoeff(), 3) / s.prod();
      const double pressure = 2 * m.mu * volume / tau.norm();
      EXPECT_NEAR(u.state.eps_p, d, 10 * rounding);
      EXPECT_LT((u.P - P).norm(), (10 * rounding + pressure) * P.norm());
    }
}

TEST(Softening, FollowsTheFlowStressDown) {
  // To a quarter of the yield stress, nearly as fast as uniqueness allows: 3 mu.
  const scene::Hardening h{400e6, 100e6, 0, 700};
  const scene::Material m = steel(h);
  ASSERT_GT(-3 * m.mu, -1.2 * h.exponent * (h.yield_stress - h.saturation_stress));
  const J2Hencky law(m);
  PlasticState state;
  double stress = 400e6;
  for (int k = 1; k <= 400; ++k) {
    Mat3 H = Mat3::Zero();
    H(0, 1) = 5e-5 * k;
    const J2Hencky::Update u = law.update(H, state);
    EXPECT_LE(u.tau_eq, law.flow_stress(u.state.eps_p) * (1 + 1e-12));
    if (u.yields) {
      EXPECT_LT(u.tau_eq, stress);
      stress = u.tau_eq;
    }
    state = u.state;
  }
  EXPECT_LT(stress, 110e6);
}

TEST(PerfectPlasticity, KeepsTheYieldStress) {
  const J2Hencky law(steel({450e6, 450e6, 0, 0}));
  const double mu = law.shear_modulus();
  Mat3 H = Mat3::Zero();
  H(0, 1) = 0.1;
  const J2Hencky::Update u = law.update(H, {});
  EXPECT_EQ(u.tau_eq, 450e6);
  const double trial = 2 * std::sqrt(3.0) * mu * std::asinh(0.05);
  EXPECT_NEAR(u.state.eps_p, (trial - 450e6) / (3 * mu), 1e-15);
  EXPECT_NEAR(u.plastic, 450e6 * u.state.eps_p, 1e-6);
}

}  // namespace
}  // namespace concord::particle::plasticity_test
