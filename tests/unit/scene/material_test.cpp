// Stress and tangent against automatic differentiation of the energy, and small strains against
// extended precision.

#include "scene/geometry.hpp"
#include "scene/material.hpp"

#include <gtest/gtest.h>
#include <unsupported/Eigen/AutoDiff>

using namespace concord;
using namespace concord::scene;

namespace {

using Inner = Eigen::AutoDiffScalar<Eigen::Matrix<double, 9, 1>>;
constexpr double lambda = 1.7, mu = 0.9;

Mat3 random_gradient(std::uint64_t seed, double size) {
  Mat3 H;
  for (int i = 0; i < 9; ++i)
    H(i / 3, i % 3) = size * (2 * uniform_random(seed, static_cast<std::uint64_t>(i), 0) - 1);
  return H;
}

Tensor3<Inner> active(const Mat3& H) {
  Tensor3<Inner> A;
  for (int i = 0; i < 9; ++i) A(i / 3, i % 3) = Inner(H(i / 3, i % 3), 9, i);
  return A;
}

template <class Law> class Laws : public testing::Test {};
using Types = testing::Types<NeoHookean, NeoHookeanIsochoric, StVenantKirchhoff>;
TYPED_TEST_SUITE(Laws, Types);

Material material_of(const NeoHookean&) {
  return {MaterialModel::neo_hookean, 1, 0, 0, lambda, mu};
}
Material material_of(const NeoHookeanIsochoric&) {
  return {MaterialModel::neo_hookean_isochoric, 1, 0, 0, lambda, mu};
}
Material material_of(const StVenantKirchhoff&) {
  return {MaterialModel::st_venant_kirchhoff, 1, 0, 0, lambda, mu};
}

}  // namespace

TYPED_TEST(Laws, StressIsTheDerivativeOfTheEnergy) {
  const TypeParam law{lambda, mu};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Mat3 H = random_gradient(seed, seed < 25 ? 0.3 : 0.02);
    const Inner W = law.energy(active(H));
    const Mat3 P = law.stress(H);
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(P(i / 3, i % 3), W.derivatives()[i], 1e-13) << seed;
  }
}

TYPED_TEST(Laws, TangentIsTheDerivativeOfTheStress) {
  const TypeParam law{lambda, mu};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Mat3 H = random_gradient(seed, 0.3);
    const Tensor3<Inner> P = law.stress(active(H));
    const Tangent A = law.tangent(H);
    for (int r = 0; r < 9; ++r)
      for (int c = 0; c < 9; ++c)
        EXPECT_NEAR(A(r, c), P(r / 3, r % 3).derivatives()[c], 1e-12) << seed;
  }
}

TYPED_TEST(Laws, SmallStrainsKeepTheirRelativeAccuracy) {
  const TypeParam law{lambda, mu};
  for (const double size : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const Mat3 H = random_gradient(7, size);
    Tensor3<long double> wide = H.cast<long double>();
    Tensor3<long double> P;
    long double W = 0;
    P = law.stress(wide);
    W = law.energy(wide);
    const Mat3 difference =
        (law.stress(H).template cast<long double>() - P).template cast<double>();
    EXPECT_LT(difference.norm(), 1e-15 * 5 * law.stress(H).norm()) << size;
    EXPECT_LT(std::abs(static_cast<double>(law.energy(H) - W)), 5e-15 * law.energy(H)) << size;
    // The limit is linear elasticity, W = lambda/2 tr^2 e + mu e:e, up to terms of third order.
    const Mat3 e = (H + H.transpose()) / 2;
    const double linear = lambda / 2 * e.trace() * e.trace() + mu * e.squaredNorm();
    EXPECT_NEAR(law.energy(H) / linear, 1, 20 * size + 1e-14);
  }
}

TYPED_TEST(Laws, RigidRotationCostsNothing) {
  const TypeParam law{lambda, mu};
  const double c = std::cos(1.2), s = std::sin(1.2);
  Mat3 R;
  R << c, -s, 0, s, c, 0, 0, 0, 1;
  EXPECT_LT(law.stress(Mat3(R - Mat3::Identity())).norm(), 1e-14);
  EXPECT_LT(std::abs(law.energy(Mat3(R - Mat3::Identity()))), 1e-14);
}

TYPED_TEST(Laws, PlaneStressHasNoStressAcross) {
  const TypeParam policy{lambda, mu};
  const ElasticLaw law(material_of(policy), Dimension::plane_stress);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Mat3 H = random_gradient(seed, seed < 25 ? 0.25 : 1e-7);
    const Mat3 full = law.complete(H);
    EXPECT_LT(std::abs(law.stress(H)(2, 2)), 1e-14 * (1 + law.stress(H).norm())) << seed;
    EXPECT_EQ(full(0, 2), 0);
    EXPECT_GT(full(2, 2), -1);
  }
}

TYPED_TEST(Laws, PlaneStressTangentFollowsTheConstraint) {
  const TypeParam policy{lambda, mu};
  const ElasticLaw law(material_of(policy), Dimension::plane_stress);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Mat3 H = random_gradient(seed, 0.2);
    H.row(2).setZero();
    H.col(2).setZero();
    // The stretch itself is differentiated through its Newton iteration.
    Tensor3<Inner> A = active(H);
    A(2, 2) = policy.plane_stress_stretch(A);
    const Tensor3<Inner> P = policy.stress(A);
    const Tangent tangent = law.tangent(H);
    for (const int r : {0, 1, 3, 4})
      for (const int c : {0, 1, 3, 4})
        EXPECT_NEAR(tangent(r, c), P(r / 3, r % 3).derivatives()[c], 1e-12) << seed;
  }
}

TYPED_TEST(Laws, EachModelTakesItsOwnLaw) {
  const TypeParam policy{lambda, mu};
  const ElasticLaw law(material_of(policy), Dimension::three_d);
  const Mat3 H = random_gradient(5, 0.3);
  EXPECT_EQ(law.energy(H), policy.energy(H));
  EXPECT_EQ(law.stress(H), policy.stress(H));
  EXPECT_EQ(law.tangent(H), policy.tangent(H));
}

TYPED_TEST(Laws, PlaneStrainIgnoresTheThirdDirection) {
  const TypeParam policy{lambda, mu};
  const ElasticLaw law(material_of(policy), Dimension::plane_strain);
  Mat3 H = random_gradient(3, 0.2);
  const Mat3 P = law.stress(H);
  H(2, 2) = 5;
  H(0, 2) = 1;
  EXPECT_EQ(law.stress(H), P);
  EXPECT_EQ(law.complete(H)(2, 2), 0);
}

TEST(ElasticLaw, UniaxialAndShearByHand) {
  // Pure dilation F = s I: P = (lambda ln J - mu)/s + mu s.
  const NeoHookean law{lambda, mu};
  const double s = 1.3;
  const Mat3 P = law.stress(Mat3((s - 1) * Mat3::Identity()));
  EXPECT_NEAR(P(0, 0), (lambda * 3 * std::log(s) - mu) / s + mu * s, 1e-14);
  EXPECT_NEAR(P(0, 1), 0, 1e-16);
  // Von Mises of a uniaxial stress is that stress; of a shear sqrt(3) tau.
  EXPECT_NEAR(von_mises(Vec3(5, 0, 0).asDiagonal().toDenseMatrix()), 5, 1e-14);
  Mat3 shear = Mat3::Zero();
  shear(0, 1) = shear(1, 0) = 2;
  EXPECT_NEAR(von_mises(shear), 2 * std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(pressure(Vec3(3, 3, 3).asDiagonal().toDenseMatrix()), -3, 1e-15);
}

TEST(NeoHookeanIsochoric, ByHand) {
  // W and P as they are written, at a strain where nothing cancels.
  const NeoHookeanIsochoric law{lambda, mu};
  const double kappa = lambda + 2 * mu / 3;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Mat3 H = random_gradient(seed, 0.4), F = H + Mat3::Identity();
    const double J = F.determinant(), c = std::pow(J, -2.0 / 3), tr_C = F.squaredNorm();
    EXPECT_NEAR(law.energy(H),
                mu / 2 * (c * tr_C - 3) + kappa / 4 * (J * J - 1 - 2 * std::log(J)), 1e-14);
    const Mat3 G = F.inverse().transpose();
    const Mat3 P = mu * c * (F - tr_C / 3 * G) + kappa / 2 * (J * J - 1) * G;
    EXPECT_LT((law.stress(H) - P).norm(), 1e-14 * (1 + P.norm()));
  }
  // Pure dilation F = s I is volumetric alone: P = kappa/2 (s^6 - 1)/s.
  const double s = 1.3;
  const Mat3 dilated = law.stress(Mat3((s - 1) * Mat3::Identity()));
  EXPECT_NEAR(dilated(0, 0), kappa / 2 * (std::pow(s, 6) - 1) / s, 1e-14);
  EXPECT_NEAR(dilated(0, 1), 0, 1e-16);
}

TEST(NeoHookeanIsochoric, PlaneStressStretchFromFarAway) {
  for (const double nu : {-0.9, 0.0, 0.3, 0.49999})
    for (const double a : {0.05, 0.4, 1.0, 3.0, 20.0})
      for (const double b : {0.05, 0.9, 20.0}) {
        const double stiff = 2 * mu * nu / (1 - 2 * nu);
        const NeoHookeanIsochoric law{stiff, mu};
        Mat3 H = Mat3::Zero();
        H(0, 0) = a - 1;
        H(1, 1) = b - 1;
        H(2, 2) = law.plane_stress_stretch(H);
        ASSERT_GT(H(2, 2), -1) << nu << " " << a << " " << b;
        // P_33 is as far from zero as rounding makes it: that of 1 + H_33 and of 1 + (J - 1).
        const double F33 = 1 + H(2, 2), rounding = 1 + 1 / F33 + 1 / (a * b * F33);
        EXPECT_LT(std::abs(law.stress(H)(2, 2)), 5e-15 * rounding * law.tangent(H)(8, 8) * F33)
            << nu << " " << a << " " << b;
      }
}

TYPED_TEST(Laws, NotANumberWhereTheVolumeVanishes) {
  if (std::is_same_v<TypeParam, StVenantKirchhoff>) return;  // a polynomial in F
  const TypeParam law{lambda, mu};
  Mat3 H = Mat3::Zero();
  H(0, 0) = -1.5;
  EXPECT_TRUE(std::isnan(law.energy(H)));
  EXPECT_FALSE(law.stress(H).allFinite());
}
