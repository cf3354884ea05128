// J2 plasticity of the reference: derivatives, invariance, the return map at its limits, and
// the particles' law, which was written separately.

#include "fem_reference/elastoplastic.hpp"
#include "particle/core/plasticity.hpp"
#include "scene/geometry.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace concord::fem {
namespace {

/// Table 1 of the Continuum Bond Method paper.
scene::Material steel() {
  scene::Material m;
  m.model = scene::MaterialModel::j2_hencky;
  m.mu = 80.19e9;
  const double kappa = 164.21e9;
  m.E = 9 * kappa * m.mu / (3 * kappa + m.mu);
  m.nu = (3 * kappa - 2 * m.mu) / (2 * (3 * kappa + m.mu));
  m.lambda = kappa - 2 * m.mu / 3;
  m.hardening = {450e6, 715e6, 129e6, 16.93};
  return m;
}

template <int dim> dealii::Tensor<2, dim> identity() {
  return dealii::unit_symmetric_tensor<dim>();
}

/// Components uniform in [-size/2, size/2].
template <int dim> dealii::Tensor<2, dim> noise(std::uint64_t seed, int step, double size) {
  dealii::Tensor<2, dim> H;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      H[i][j] = size * (scene::uniform_random(seed, 16 * step + i, j) - 0.5);
  return H;
}

/// Rotation about the third axis, in 3D then about the first.
template <int dim> dealii::Tensor<2, dim> rotation(double angle) {
  dealii::Tensor<2, dim> R = identity<dim>();
  R[0][0] = R[1][1] = std::cos(angle);
  R[0][1] = -std::sin(angle);
  R[1][0] = std::sin(angle);
  if constexpr (dim == 3) {
    dealii::Tensor<2, 3> S = identity<3>();
    S[1][1] = S[2][2] = std::cos(2 * angle);
    S[1][2] = -std::sin(2 * angle);
    S[2][1] = std::sin(2 * angle);
    return R * S;
  }
  return R;
}

/// Deformations of a path: loading to some 30 % in steps of some 3 %, an elastic step back,
/// reverse flow, a large rotation alone, and more loading on top of it.
template <int dim> std::vector<dealii::Tensor<2, dim>> path(std::uint64_t seed) {
  const dealii::Tensor<2, dim> rate = noise<dim>(seed, 0, 1);
  dealii::Tensor<2, dim> F = identity<dim>();
  std::vector<dealii::Tensor<2, dim>> out;
  const auto stretch = [&](double s, int step) {
    F = (identity<dim>() + s * rate + noise<dim>(seed, step, 0.1 * s)) * F;
    out.push_back(F);
  };
  stretch(1e-4, 1);  // elastic
  for (int k = 2; k < 8; ++k) stretch(0.06, k);
  stretch(-1e-3, 8);  // unloading
  stretch(-0.05, 9);  // reverse flow
  stretch(-0.05, 10);
  F = rotation<dim>(1.3) * F;
  out.push_back(F);
  for (int k = 11; k < 14; ++k) stretch(0.06, k);
  return out;
}

/// Fourth-order central difference. With steps of 1e-5 its truncation, 1e-20 times the fifth
/// derivative, whose scale is the modulus over the fourth power of the yield strain (3e-3), is
/// 1e-10 of the modulus; round-off of the stress, 1e-15 of the modulus, gives as much.
template <class Function> auto slope(const Function& f) {
  const double h = 1e-5;
  return (8.0 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

/// Compares the tangent with differences; false where a difference straddles the yield point.
template <int dim>
bool tangent_is_derivative(const Elastoplastic<dim>& law, const dealii::Tensor<2, dim>& F,
                           const PlasticPoint<dim>& old) {
  dealii::Tensor<2, dim> P, P0;
  dealii::Tensor<4, dim> A;
  PlasticPoint<dim> now;
  EXPECT_TRUE(law.tangent(F, old, P, A, now));
  EXPECT_TRUE(law.stress(F, old, P0, now));
  EXPECT_EQ(P, P0);
  const bool yields = now.eps_p > old.eps_p;
  bool one_side = true;
  double worst = 0;
  for (int k = 0; k < dim; ++k) {
    for (int l = 0; l < dim; ++l) {
      const dealii::Tensor<2, dim> dP = slope([&](double s) {
        dealii::Tensor<2, dim> moved = F, out;
        PlasticPoint<dim> state;
        moved[k][l] += s;
        EXPECT_TRUE(law.stress(moved, old, out, state));
        one_side &= (state.eps_p > old.eps_p) == yields;
        return out;
      });
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          worst = std::max(worst, std::abs(dP[i][j] - A[i][j][k][l]) / A.norm());
    }
  }
  if (one_side) {
    EXPECT_LE(worst, 1e-8);
  }
  if (law.symmetric()) {
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l)
            EXPECT_NEAR(A[i][j][k][l], A[k][l][i][j], 1e-12 * A.norm());
  }
  return one_side;
}

template <int dim> void check_tangents(YieldMeasure measure) {
  const Elastoplastic<dim> law(steel(), measure);
  int tried = 0, plastic = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    PlasticPoint<dim> state;
    for (const auto& F : path<dim>(seed)) {
      tried += tangent_is_derivative<dim>(law, F, state);
      dealii::Tensor<2, dim> P;
      PlasticPoint<dim> next;
      ASSERT_TRUE(law.stress(F, state, P, next));
      plastic += next.eps_p > state.eps_p;
      state = next;
    }
  }
  EXPECT_GT(tried, 480);  // of 560, of which 40 only rotate: they stand on the yield surface
  EXPECT_GT(plastic, 300);
  EXPECT_LT(plastic, 500);  // the rest elastic
}

TEST(Elastoplastic, TangentIsTheDerivativeIn3D) { check_tangents<3>(YieldMeasure::kirchhoff); }
TEST(Elastoplastic, TangentIsTheDerivativeInPlaneStrain) {
  check_tangents<2>(YieldMeasure::kirchhoff);
}
TEST(Elastoplastic, TangentOfTheCauchyMeasureIn3D) { check_tangents<3>(YieldMeasure::cauchy); }
TEST(Elastoplastic, TangentOfTheCauchyMeasureInPlaneStrain) {
  check_tangents<2>(YieldMeasure::cauchy);
}

TEST(Elastoplastic, TangentWithEqualPrincipalStretches) {
  const Elastoplastic<3> law(steel(), YieldMeasure::kirchhoff);
  for (const double s : {0.0, 1e-9, 1e-5, 1e-3}) {
    for (const double pull : {1.0, 1.001, 1.1}) {  // none, elastic, plastic
      dealii::Tensor<2, 3> F = identity<3>();
      F[0][0] = pull;
      F[1][1] += s;
      F[2][2] -= s;
      EXPECT_TRUE(tangent_is_derivative<3>(law, rotation<3>(0.4) * F, PlasticPoint<3>()));
    }
  }
}

Mat3 gradient(const dealii::Tensor<2, 3>& F) {
  Mat3 H;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) H(i, j) = F[i][j] - (i == j ? 1 : 0);
  return H;
}
Mat3 gradient(const dealii::Tensor<2, 2>& F) {
  Mat3 H = Mat3::Zero();
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) H(i, j) = F[i][j] - (i == j ? 1 : 0);
  return H;
}

template <int dim> void compare_with_particles() {
  const Elastoplastic<dim> law(steel(), YieldMeasure::kirchhoff);
  const particle::J2Hencky other(steel());
  const double modulus = steel().E;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    PlasticPoint<dim> state;
    particle::PlasticState other_state;
    for (const auto& F : path<dim>(seed)) {
      dealii::Tensor<2, dim> P;
      dealii::Tensor<4, dim> A;
      PlasticPoint<dim> next;
      ASSERT_TRUE(law.tangent(F, state, P, A, next));
      const auto update = other.update(gradient(F), other_state);
      const auto slope = other.tangent(gradient(F), other_state);
      ASSERT_TRUE(update.sound);
      const auto m = law.measures(next);
      EXPECT_NEAR(next.eps_p, update.state.eps_p, 1e-10 * (1e-3 + next.eps_p));
      EXPECT_NEAR(m.tau_eq, update.tau_eq, 1e-10 * 715e6);
      EXPECT_NEAR(m.stored, update.stored, 1e-10 * 715e6);
      EXPECT_NEAR(next.work, update.plastic, 1e-10 * 715e6);
      for (int i = 0; i < dim; ++i) {
        for (int j = 0; j < dim; ++j) {
          EXPECT_NEAR(P[i][j], update.P(i, j), 1e-10 * 715e6);
          for (int k = 0; k < dim; ++k)
            for (int l = 0; l < dim; ++l)
              EXPECT_NEAR(A[i][j][k][l], slope(3 * i + j, 3 * k + l), 1e-10 * modulus);
        }
      }
      state = next;
      other_state = update.state;
    }
    EXPECT_GT(state.eps_p, 0.02);
  }
}

TEST(Elastoplastic, AgreesWithTheLawOfTheParticlesIn3D) { compare_with_particles<3>(); }
TEST(Elastoplastic, AgreesWithTheLawOfTheParticlesInPlaneStrain) {
  compare_with_particles<2>();
}

TEST(Elastoplastic, PlaneStrainIsTheSolidWithoutThirdStretch) {
  for (const YieldMeasure measure : {YieldMeasure::kirchhoff, YieldMeasure::cauchy}) {
    const Elastoplastic<2> plane(steel(), measure);
    const Elastoplastic<3> solid(steel(), measure);
    PlasticPoint<2> flat;
    PlasticPoint<3> full;
    for (const auto& F : path<2>(3)) {
      dealii::Tensor<2, 3> F3 = identity<3>(), P3;
      dealii::Tensor<2, 2> P;
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) F3[i][j] = F[i][j];
      PlasticPoint<2> flat_next;
      PlasticPoint<3> full_next;
      ASSERT_TRUE(plane.stress(F, flat, P, flat_next) && solid.stress(F3, full, P3, full_next));
      flat = flat_next;
      full = full_next;
      EXPECT_NEAR(flat.eps_p, full.eps_p, 1e-13);
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) EXPECT_NEAR(P[i][j], P3[i][j], 1e-12 * 715e6);
    }
  }
}

TEST(Elastoplastic, RotationOfTheWholePathRotatesTheStress) {
  const Elastoplastic<3> law(steel(), YieldMeasure::kirchhoff);
  PlasticPoint<3> here, turned;
  int step = 0;
  for (const auto& F : path<3>(5)) {
    const dealii::Tensor<2, 3> Q = rotation<3>(0.7 * ++step);
    dealii::Tensor<2, 3> P, P_turned;
    PlasticPoint<3> next;
    ASSERT_TRUE(law.stress(F, here, P, next));
    here = next;
    ASSERT_TRUE(law.stress(Q * F, turned, P_turned, next));
    turned = next;
    EXPECT_LE((P_turned - Q * P).norm(), 1e-11 * 715e6);
    EXPECT_NEAR(here.eps_p, turned.eps_p, 1e-12);
  }
  EXPECT_GT(here.eps_p, 0.02);
}

/// Uniaxial isochoric stretch s along the first axis.
dealii::Tensor<2, 3> isochoric(double s) {
  dealii::Tensor<2, 3> F;
  F[0][0] = s;
  F[1][1] = F[2][2] = 1 / std::sqrt(s);
  return F;
}

TEST(Elastoplastic, ReturnsToTheYieldSurfaceFromAnywhere) {
  scene::Material perfect = steel(), steep = steel(), soft = steel();
  perfect.hardening = {450e6, 450e6, 0, 0};
  steep.hardening = {450e6, 2e12, 0, 1e4};  // saturates at once: Newton overshoots
  soft.hardening = {450e6, 1e6, 0, 100};    // slope -4.5e10 > -3 mu
  for (const scene::Material& material : {steel(), perfect, steep, soft}) {
    const Elastoplastic<3> law(material, YieldMeasure::kirchhoff);
    for (const double s : {1.003, 1.01, 2.0, 1e3, 1e6, 1e-6}) {
      PlasticPoint<3> now;
      dealii::Tensor<2, 3> P;
      ASSERT_TRUE(law.stress(isochoric(s), PlasticPoint<3>(), P, now)) << s;
      const double tau_y = law.flow_stress(now.eps_p);
      // tau_eq comes from ln b_e, whose round-off counts with 3 mu.
      EXPECT_NEAR(law.measures(now).tau_eq, tau_y, 1e-13 * tau_y + 1e-14 * 3 * material.E) << s;
      // |3/2 ln s| of the axes: e_eq = |ln s| = eps_p + tau_y/(3 mu).
      EXPECT_NEAR(now.eps_p + tau_y / (3 * material.mu), std::abs(std::log(s)),
                  1e-12 * std::abs(std::log(s)))
          << s;
    }
  }
}

TEST(Elastoplastic, CauchyMeasureHoldsTheFlowStressAgainstTauOverJ) {
  const Elastoplastic<3> law(steel(), YieldMeasure::cauchy);
  PlasticPoint<3> now;
  dealii::Tensor<2, 3> P;
  ASSERT_TRUE(law.stress(1.01 * isochoric(1.1), PlasticPoint<3>(), P, now));
  const auto m = law.measures(now);
  EXPECT_NEAR(m.J, std::pow(1.01, 3), 1e-13);
  EXPECT_NEAR(m.tau_eq / m.J, law.flow_stress(now.eps_p), 1e-4);
}

TEST(Elastoplastic, WorkOfTheStressIsStoredOrPlastic) {
  for (const YieldMeasure measure : {YieldMeasure::kirchhoff, YieldMeasure::cauchy}) {
    const Elastoplastic<3> law(steel(), measure);
    PlasticPoint<3> state, next;
    dealii::Tensor<2, 3> P, last;
    double work = 0;
    const int steps = 4000;
    const auto F_at = [](double t) {  // out and half the way back, turning and swelling
      const double s = t < 0.5 ? 0.2 * t : 0.2 * (0.75 - 0.5 * t);
      return (1 + 0.02 * t) * rotation<3>(t) * isochoric(1 + s);
    };
    for (int k = 1; k <= steps; ++k) {
      const dealii::Tensor<2, 3> F = F_at(double(k) / steps), F0 = F_at((k - 1.0) / steps);
      ASSERT_TRUE(law.stress(F, state, P, next));
      work += 0.5 * scalar_product(P + last, F - F0);
      last = P;
      state = next;
    }
    EXPECT_GT(state.work, 3e7);
    // Trapezoidal rule over kinks, 4000 steps.
    EXPECT_NEAR(work, law.measures(state).stored + state.work, 1e-5 * work);
  }
}

TEST(Elastoplastic, PointOnTheYieldSurfaceTakesThePlasticTangent) {
  const Elastoplastic<3> law(steel(), YieldMeasure::kirchhoff);
  PlasticPoint<3> state, next;
  dealii::Tensor<2, 3> P, P1;
  dealii::Tensor<4, 3> A;
  ASSERT_TRUE(law.stress(isochoric(1.05), PlasticPoint<3>(), P, state));
  ASSERT_TRUE(law.tangent(isochoric(1.05), state, P, A, next));
  const dealii::Tensor<2, 3> dF = isochoric(1.05 + 1e-7) - isochoric(1.05);
  ASSERT_TRUE(law.stress(isochoric(1.05) + dF, state, P1, next));
  EXPECT_GT(next.eps_p, state.eps_p);
  const dealii::Tensor<2, 3> predicted = double_contract<2, 0, 3, 1>(A, dF);
  // Curvature over the step: 1e-7 of strain in a yield strain of 2e-3, at most.
  EXPECT_LE((P1 - P - predicted).norm(), 1e-4 * (P1 - P).norm());
}

TEST(Elastoplastic, RejectsInvertedAndUndefinedStates) {
  const Elastoplastic<2> law(steel(), YieldMeasure::kirchhoff);
  dealii::Tensor<2, 2> F = identity<2>(), P;
  PlasticPoint<2> now;
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    F[0][0] = bad;
    EXPECT_FALSE(law.stress(F, PlasticPoint<2>(), P, now)) << bad;
  }
}

}  // namespace
}  // namespace concord::fem
