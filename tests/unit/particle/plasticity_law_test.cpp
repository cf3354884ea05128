// The plastic law against closed forms, and against the ordinary differential equation that its
// return map discretises.

#include "plasticity_oracle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace concord::particle::plasticity_test {
namespace {

constexpr double never = 1e30;  // [Pa] yield stress of elastic tests

Mat3 diagonal(double a, double b, double c) { return Vec3(a, b, c).asDiagonal(); }

Mat3 shear(double gamma) {
  Mat3 H = Mat3::Zero();
  H(0, 1) = gamma;
  return H;
}

TEST(J2Law, FlowStressOfTable1) {
  // Eq. (24) by hand; flow_energy is its integral, here by Simpson's rule.
  const J2Hencky law(steel());
  EXPECT_EQ(law.flow_stress(0), 450e6);
  EXPECT_NEAR(law.flow_stress(0.1), 450e6 + 12.9e6 + 265e6 * (1 - std::exp(-1.693)), 1e-6);
  EXPECT_NEAR(law.flow_slope(0.1), 129e6 + 265e6 * 16.93 * std::exp(-1.693), 1e-5);
  for (const double eps : {1e-9, 1e-4, 0.03, 0.4, 2.0}) {
    double sum = 0;
    const int n = 2000;
    for (int k = 0; k <= n; ++k)
      sum += law.flow_stress(eps * k / n) * (k == 0 || k == n ? 1 : k % 2 == 1 ? 4 : 2);
    EXPECT_NEAR(law.flow_energy(eps) / (sum * eps / (3 * n)), 1, 1e-9);
  }
  const J2Hencky linear(steel({450e6, 715e6, 129e6, 0}));
  EXPECT_EQ(linear.flow_stress(0.5), 450e6 + 64.5e6);
  EXPECT_EQ(linear.flow_energy(0.5), 225e6 + 0.5 * 129e6 * 0.25);
}

TEST(J2Law, ElasticUniaxialStrainAndShearByHand) {
  const scene::Material m = steel({never, never, 0, 0});
  const J2Hencky law(m);
  const double kappa = m.lambda + 2 * m.mu / 3;
  for (const double s : {0.4, 0.999, 1.0001, 1.7, 30.0}) {
    const J2Hencky::Update u = law.update(diagonal(s - 1, 0, 0), {});
    const double e = std::log(s), scale = std::abs(e) * m.mu;
    EXPECT_NEAR(u.P(0, 0), (kappa + 4 * m.mu / 3) * e / s, 1e-14 * scale / s);
    EXPECT_NEAR(u.P(1, 1), (kappa - 2 * m.mu / 3) * e, 1e-14 * scale);
    EXPECT_NEAR(u.tau_eq, 2 * m.mu * std::abs(e), 1e-14 * scale);
    EXPECT_NEAR(u.stored, (kappa / 2 + 2 * m.mu / 3) * e * e, 1e-14 * scale * std::abs(e));
    EXPECT_FALSE(u.yields);
  }
  // Simple shear: principal stretches exp(+-asinh(gamma/2)), tau = 2 mu asinh(gamma/2)/
  // sqrt(1 + gamma^2/4) [[gamma/2, 1], [1, -gamma/2]].
  for (const double g : {1e-9, 0.01, 0.8, 5.0, 50.0}) {
    const J2Hencky::Update u = law.update(shear(g), {});
    const double t12 = 2 * m.mu * std::asinh(g / 2) / std::sqrt(1 + g * g / 4);
    const double t11 = t12 * g / 2;
    const double tolerance = 1e-14 * t12 * (1 + g * g);
    EXPECT_NEAR(u.P(0, 1), t12, 1e-14 * t12);
    EXPECT_NEAR(u.P(0, 0), t11 - g * t12, tolerance);
    EXPECT_NEAR(u.P(1, 0), t12 + g * t11, tolerance);
    EXPECT_NEAR(u.P(1, 1), -t11, tolerance);
    EXPECT_NEAR(u.P(2, 2), 0, tolerance);
  }
}

TEST(J2Law, UniaxialStressWithHardening) {
  // Coaxial loading: ln F = e + eps_p N, so that the axial strain eps_p + tau/E and the lateral
  // one -eps_p/2 - nu tau/E leave the sides free and the axial Kirchhoff stress tau_y(eps_p),
  // whatever the number of steps.
  const scene::Material m = steel();
  const J2Hencky law(m);
  for (const int steps : {1, 10, 1000}) {
    PlasticState state;
    for (int k = 1; k <= steps; ++k) {
      const double eps = 1.2 * k / steps, tau = law.flow_stress(eps);
      const double axial = std::expm1(eps + tau / m.E);
      const double side = std::expm1(-eps / 2 - m.nu * tau / m.E);
      const J2Hencky::Update u = law.update(diagonal(axial, side, side), state);
      ASSERT_TRUE(u.yields);
      EXPECT_NEAR(u.state.eps_p, eps, 1e-12);
      EXPECT_NEAR(u.P(0, 0), tau / (1 + axial), 1e-11 * tau);
      EXPECT_NEAR(u.P(1, 1), 0, 1e-10 * tau);
      EXPECT_NEAR(u.P(2, 2), 0, 1e-10 * tau);
      EXPECT_NEAR(1 + u.state.A(0, 0), std::exp(-2 * eps), 1e-12);
      EXPECT_NEAR(1 + u.state.A(1, 1), std::exp(eps), 1e-12);
      state = u.state;
    }
  }
}

/// Rates of b_e and eps_p under the velocity gradient l while plastic: L_v b_e = -2 g N b_e,
/// with g such that tau_eq stays tau_y(eps_p): g = 2 mu N:l/(3 mu + tau_y').
struct Flow {
  Mat3 b = Mat3::Identity();
  double eps_p = 0;
};
Flow rate(const J2Hencky& law, const Mat3& l, const Flow& at) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(at.b);
  Vec3 e = 0.5 * solver.eigenvalues().array().log();
  e.array() -= e.mean();
  const Mat3 N = std::sqrt(1.5) / e.norm() * solver.eigenvectors() * e.asDiagonal() *
                 solver.eigenvectors().transpose();
  const double mu = law.shear_modulus();
  const double g = 2 * mu * N.cwiseProduct(l).sum() / (3 * mu + law.flow_slope(at.eps_p));
  return {l * at.b + at.b * l.transpose() - 2 * g * N * at.b, g};
}

TEST(J2Law, LargePlasticShearConvergesToTheDifferentialEquation) {
  // Simple shear to gamma = 2; the equation by Runge and Kutta's fourth-order scheme from the
  // yield point on, the law in n steps of first order.
  const J2Hencky law(steel());
  const double mu = law.shear_modulus();
  const double yield = 2 * std::sinh(450e6 / std::sqrt(3.0) / (2 * mu)), end = 2;
  const Mat3 l = shear(1);
  const Mat3 F = Mat3::Identity() + shear(yield);
  Flow y{F * F.transpose(), 0};
  const int n = 4000;
  const double h = (end - yield) / n;
  const auto shifted = [](const Flow& a, double t, const Flow& r) {
    return Flow{a.b + t * r.b, a.eps_p + t * r.eps_p};
  };
  for (int k = 0; k < n; ++k) {
    const Flow k1 = rate(law, l, y), k2 = rate(law, l, shifted(y, h / 2, k1));
    const Flow k3 = rate(law, l, shifted(y, h / 2, k2)), k4 = rate(law, l, shifted(y, h, k3));
    y = shifted(shifted(y, h / 6, k1), h / 3, k2);
    y = shifted(shifted(y, h / 3, k3), h / 6, k4);
  }
  const auto run = [&](int steps) {
    J2Hencky::Update u;
    for (int k = 1; k <= steps; ++k) u = law.update(shear(end * k / steps), u.state);
    return u;
  };
  const Mat3 G = Mat3::Identity() + shear(end);
  double before = 0;
  for (const int steps : {1000, 2000, 4000}) {
    const J2Hencky::Update u = run(steps);
    const Mat3 b = G * (u.state.A + Mat3::Identity()) * G.transpose();
    const double error = (b - y.b).norm() + std::abs(u.state.eps_p - y.eps_p);
    EXPECT_LT(error, 4.0 / steps * 450e6 / mu);
    if (before > 0) EXPECT_NEAR(before / error, 2, 0.1);
    before = error;
  }
}

TEST(J2Law, TinyStrainsAreThoseOfTheSmallStrainLaw) {
  // Radial return of infinitesimal plasticity with linear hardening, yield at strains of 1e-12.
  const scene::Material m = steel({80e-3, 80e-3, 5e9, 0});
  const J2Hencky law(m);
  const double kappa = m.lambda + 2 * m.mu / 3;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const bool plane = seed % 2 == 0;
    const Mat3 H = random_matrix(seed, 3e-12, plane);
    const J2Hencky::Update u = law.update(H, {});
    const Mat3 e = (H + H.transpose()) / 2, I = Mat3::Identity();
    Mat3 s = 2 * m.mu * (e - e.trace() / 3 * I);
    const double q = std::sqrt(1.5) * s.norm();
    const double d = (q - 80e-3) / (3 * m.mu + 5e9);
    ASSERT_GT(d, 0);
    const Mat3 N = 1.5 * s / q;
    s -= 2 * m.mu * d * N;
    // The small-strain law leaves terms of second order away.
    const double second = 3 * H.squaredNorm(), stress = 3 * kappa * H.squaredNorm();
    EXPECT_NEAR(u.state.eps_p, d, 1e-14 * d + second);
    EXPECT_LT((u.state.A + 2 * d * N).norm(), 1e-14 * d + second) << seed;
    EXPECT_LT((u.P - s - kappa * e.trace() * I).norm(), 1e-14 * u.P.norm() + stress) << seed;
    EXPECT_NEAR(u.stored, kappa / 2 * std::pow(e.trace(), 2) + s.squaredNorm() / (4 * m.mu),
                1e-13 * u.stored + stress * H.norm());
    EXPECT_LT(second, 1e-10 * d);
  }
}

TEST(J2Law, UnsoundWhereTheVolumeVanishes) {
  const J2Hencky law(steel());
  EXPECT_FALSE(law.update(diagonal(-1.5, 0, 0), {}).sound);
  EXPECT_FALSE(law.update(diagonal(-1, 0, 0), {}).sound);
  EXPECT_FALSE(law.update(diagonal(std::nan(""), 0, 0), {}).sound);
  Mat3 H = random_matrix(1, 0.1);
  EXPECT_TRUE(law.update(H, {}).sound);
  H(2, 0) = std::nan("");
  EXPECT_FALSE(law.update(H, {}).sound);
  H(2, 0) = HUGE_VAL;
  EXPECT_FALSE(law.update(H, {}).sound);
}

}  // namespace
}  // namespace concord::particle::plasticity_test
