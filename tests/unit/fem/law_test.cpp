// Stress laws of the reference: stress is the derivative of the energy, the tangent that of the
// stress, and both agree with the scene's laws, which were written separately.

#include "fem_reference/hyperelastic.hpp"
#include "scene/geometry.hpp"
#include "scene/material.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace concord::fem {
namespace {

using scene::MaterialModel;
enum class Split { no, yes };
using Case = std::tuple<Dimension, MaterialModel, Split>;

scene::Problem problem_of(Dimension dimension, MaterialModel model) {
  scene::Problem problem;
  problem.dimension = dimension;
  problem.material.model = model;
  problem.material.E = 17e6;
  problem.material.nu = 0.3;
  problem.material.lambda = 17e6 * 0.3 / (1.3 * 0.4);
  problem.material.mu = 17e6 / 2.6;
  return problem;
}

/// I plus components uniform in [-0.35, 0.35].
template <int dim> dealii::Tensor<2, dim> random_F(std::uint64_t seed) {
  dealii::Tensor<2, dim> F;
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < dim; ++j) {
      F[i][j] = 0.7 * (scene::uniform_random(seed, i, j) - 0.5) + (i == j ? 1 : 0);
    }
  }
  return F;
}

/// Fourth-order central difference of a function of one number.
template <class Function> auto slope(const Function& f, double step) {
  return (8.0 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step);
}

template <int dim> void check_derivatives(const Case& which) {
  const auto [dimension, model, split] = which;
  const Hyperelastic<dim> law(problem_of(dimension, model), split == Split::yes);
  // Truncation step^4/30 f^(5) of ln J at J = 0.3 is 5e-9 of the modulus.
  const double bound = 1e-7 * 17e6, step = 1e-3;
  int tried = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const dealii::Tensor<2, dim> F = random_F<dim>(seed);
    if (determinant(F) < 0.3) continue;  // the bounds below hold from here on
    dealii::Tensor<2, dim> P, P_of_tangent;
    dealii::Tensor<4, dim> A;
    if (!law.stress(F, P)) continue;  // St Venant-Kirchhoff in plane stress may have no F_33
    ++tried;
    ASSERT_TRUE(law.tangent(F, P_of_tangent, A));
    EXPECT_LE((P - P_of_tangent).norm(), 1e-13 * P.norm());
    for (int k = 0; k < dim; ++k) {
      for (int l = 0; l < dim; ++l) {
        const auto moved = [&](double s) {
          dealii::Tensor<2, dim> out = F;
          out[k][l] += s;
          return out;
        };
        const auto energy = [&](double s) { return law.energy(moved(s)); };
        EXPECT_NEAR(slope(energy, step), P[k][l], bound) << seed;
        const auto stress = [&](double s) {
          dealii::Tensor<2, dim> out;
          EXPECT_TRUE(law.stress(moved(s), out));
          return out;
        };
        const dealii::Tensor<2, dim> dP = slope(stress, step);
        for (int i = 0; i < dim; ++i) {
          for (int j = 0; j < dim; ++j) {
            EXPECT_NEAR(dP[i][j], A[i][j][k][l], bound) << seed;
            EXPECT_NEAR(A[i][j][k][l], A[k][l][i][j], 1e-12 * A.norm()) << "major symmetry";
          }
        }
      }
    }
  }
  EXPECT_GT(tried, 60);
}

class LawDerivatives : public testing::TestWithParam<Case> {};

TEST_P(LawDerivatives, StressOfEnergyAndTangentOfStress) {
  if (std::get<0>(GetParam()) == Dimension::three_d)
    check_derivatives<3>(GetParam());
  else
    check_derivatives<2>(GetParam());
}

constexpr auto neo = MaterialModel::neo_hookean;
constexpr auto svk = MaterialModel::st_venant_kirchhoff;
constexpr auto iso = MaterialModel::neo_hookean_isochoric;
INSTANTIATE_TEST_SUITE_P(All, LawDerivatives,
                         testing::Values(Case{Dimension::three_d, neo, Split::no},
                                         Case{Dimension::three_d, svk, Split::no},
                                         Case{Dimension::three_d, neo, Split::yes},
                                         Case{Dimension::plane_strain, neo, Split::no},
                                         Case{Dimension::plane_strain, svk, Split::no},
                                         Case{Dimension::plane_strain, neo, Split::yes},
                                         Case{Dimension::plane_stress, neo, Split::no},
                                         Case{Dimension::plane_stress, svk, Split::no},
                                         Case{Dimension::three_d, iso, Split::no},
                                         Case{Dimension::plane_strain, iso, Split::no},
                                         Case{Dimension::plane_stress, iso, Split::no}));

TEST(Law, PlaneStressLeavesNoStressAcross) {
  for (const MaterialModel model : {neo, iso, svk}) {
    const Hyperelastic<2> plane(problem_of(Dimension::plane_stress, model));
    const Hyperelastic<3> solid(problem_of(Dimension::three_d, model));
    int tried = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      const dealii::Tensor<2, 2> F = random_F<2>(seed);
      dealii::Tensor<2, 3> F3, P3;
      dealii::Tensor<2, 2> P;
      if (!plane.complete(F, F3)) continue;
      if (determinant(F) < 0.1) continue;
      ++tried;
      ASSERT_TRUE(solid.stress(F3, P3));
      ASSERT_TRUE(plane.stress(F, P));
      EXPECT_NEAR(P3[2][2], 0, 1e-14 * 17e6 + 1e-14 * P3.norm());
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) EXPECT_EQ(P[i][j], P3[i][j]);
      }
    }
    EXPECT_GT(tried, 80);
  }
}

TEST(Law, AgreesWithTheScenesLaws) {
  for (const MaterialModel model : {neo, iso, svk}) {
    const scene::Problem problem = problem_of(Dimension::three_d, model);
    const Hyperelastic<3> law(problem);
    const scene::ElasticLaw scenes(problem.material, problem.dimension);
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
      const dealii::Tensor<2, 3> F = random_F<3>(seed);
      dealii::Tensor<2, 3> P;
      if (determinant(F) < 0.1) continue;
      ASSERT_TRUE(law.stress(F, P));
      Mat3 H;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) H(i, j) = F[i][j] - (i == j ? 1 : 0);
      }
      const Mat3 other = scenes.stress(H);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(P[i][j], other(i, j), 1e-12 * P.norm());
      }
    }
  }
}

TEST(Law, RejectsInvertedAndUndefinedStates) {
  const Hyperelastic<3> law(problem_of(Dimension::three_d, neo));
  dealii::Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>(), P;
  F[0][0] = -1;
  EXPECT_FALSE(law.stress(F, P));
  F[0][0] = 0;
  EXPECT_FALSE(law.stress(F, P));
  F[0][0] = std::nan("");
  EXPECT_FALSE(law.stress(F, P));
  EXPECT_TRUE(std::isnan(law.energy(F)));
}

TEST(Law, SplitSettingAndIsochoricModelAreOneLaw) {
  for (const Dimension dimension : {Dimension::plane_strain, Dimension::plane_stress}) {
    const Hyperelastic<2> setting(problem_of(dimension, neo), true);
    const Hyperelastic<2> model(problem_of(dimension, iso)), other(problem_of(dimension, neo));
    const scene::Problem problem = problem_of(dimension, iso);
    const scene::ElasticLaw scenes(problem.material, dimension);
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      const dealii::Tensor<2, 2> F = random_F<2>(seed);
      if (determinant(F) < 0.1) continue;
      dealii::Tensor<2, 2> P, Q, R;
      ASSERT_TRUE(setting.stress(F, P) && model.stress(F, Q) && other.stress(F, R));
      EXPECT_EQ(P, Q);
      EXPECT_GT((P - R).norm(), 1e-4 * P.norm());
      Mat3 H = Mat3::Zero();
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) H(i, j) = F[i][j] - (i == j ? 1 : 0);
      }
      const Mat3 S = scenes.stress(H);
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) EXPECT_NEAR(P[i][j], S(i, j), 1e-12 * P.norm());
      }
    }
  }
}

}  // namespace
}  // namespace concord::fem
