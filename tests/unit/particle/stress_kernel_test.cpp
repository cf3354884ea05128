// The vectorised stress of the kernels against the reference laws of scene/material.

#include "particle/core/elastic.hpp"
#include "scene/material.hpp"

#include <gtest/gtest.h>

#include <random>

namespace concord::particle {
namespace {

struct Case {
  scene::MaterialModel model;
  Dimension dimension;
};

class StressKernel : public testing::TestWithParam<Case> {};

template <int Dim, StressLaw Law>
void compare(const scene::Problem& problem, double magnitude) {
  constexpr int S = Lanes<Dim>::stride;
  const KernelMaterial kernel = kernel_material(problem);
  const scene::ElasticLaw law(problem.material, problem.dimension);
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-magnitude, magnitude);
  for (int count = 1; count <= stress_width; ++count) {
    Column H(stress_width * Dim * S, 0.0), P = H;
    std::vector<double> inverse_V(stress_width, 4.0);
    std::vector<Mat3> reference(count, Mat3::Zero());
    for (int a = 0; a < count; ++a) {
      for (int j = 0; j < Dim; ++j) {
        for (int i = 0; i < Dim; ++i) {
          reference[a](i, j) = uniform(generator);
          H[(a * Dim + j) * S + i] = reference[a](i, j) / 4;
        }
      }
    }
    const unsigned bad = stress_of_group<Dim, Law>(kernel.constants, 0, count, inverse_V.data(),
                                                   H.data(), P.data());
    EXPECT_EQ(bad, 0u);
    for (int a = 0; a < count; ++a) {
      const Mat3 expected = law.stress(reference[a]);
      const Mat3 difference = tensor_at(P, Dim, a) - expected;
      // Relative to the stress itself: the laws keep their accuracy down to the smallest
      // strains.
      const double error = difference.topLeftCorner(Dim, Dim).norm();
      EXPECT_LT(error, 4e-15 * expected.norm()) << "strain " << magnitude;
      EXPECT_EQ(tensor_at(H, Dim, a), reference[a]);
    }
  }
}

TEST_P(StressKernel, AgreesWithTheReferenceLaw) {
  scene::Problem problem;
  problem.dimension = GetParam().dimension;
  problem.material.model = GetParam().model;
  problem.material.lambda = 3.1e9;
  problem.material.mu = 1.7e9;
  for (const double magnitude : {1e-12, 1e-6, 1e-3, 0.05, 0.3}) {
    with_law(kernel_material(problem).law, [&](auto law) {
      if (problem.dim() == 3)
        compare<3, decltype(law)::value>(problem, magnitude);
      else
        compare<2, decltype(law)::value>(problem, magnitude);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(
    Laws, StressKernel,
    testing::Values(Case{scene::MaterialModel::neo_hookean, Dimension::three_d},
                    Case{scene::MaterialModel::neo_hookean, Dimension::plane_strain},
                    Case{scene::MaterialModel::neo_hookean, Dimension::plane_stress},
                    Case{scene::MaterialModel::neo_hookean_isochoric, Dimension::three_d},
                    Case{scene::MaterialModel::neo_hookean_isochoric, Dimension::plane_strain},
                    Case{scene::MaterialModel::neo_hookean_isochoric, Dimension::plane_stress},
                    Case{scene::MaterialModel::st_venant_kirchhoff, Dimension::three_d},
                    Case{scene::MaterialModel::st_venant_kirchhoff, Dimension::plane_strain},
                    Case{scene::MaterialModel::st_venant_kirchhoff, Dimension::plane_stress}));

TEST(StressKernelFailure, MarksTheLanesThatAreInvertedOrNotANumber) {
  const StressConstants c{{1, 1}};
  Column H(stress_width * 12, 0.0), P = H;
  const std::vector<double> inverse_V(stress_width, 1.0);
  H[2 * 12] = -1.5;          // particle 2: F_11 = -0.5
  H[5 * 12] = std::nan("");  // particle 5
  const unsigned bad = stress_of_group<3, StressLaw::neo_hookean>(
      c, 0, stress_width, inverse_V.data(), H.data(), P.data());
  EXPECT_EQ(bad, (1u << 2) | (1u << 5));
}

TEST(ExpKernel, KeepsRelativeAccuracy) {
  for (const double x : {-0.2, -0.1, -1e-3, -1e-9, 0.0, 1e-15, 1e-7, 1e-2, 0.15, 0.2}) {
    EXPECT_NEAR(exp_near_zero(x) / std::exp(x), 1, 5e-16) << x;
  }
}

TEST(LogKernel, KeepsRelativeAccuracy) {
  for (const double j : {-0.25, -0.1, -1e-3, -1e-9, 1e-15, 1e-7, 1e-2, 0.2, 0.25}) {
    EXPECT_NEAR(log1p_near_one(j) / std::log1p(j), 1, 6e-16) << j;
  }
}

}  // namespace
}  // namespace concord::particle
