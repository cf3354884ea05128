// Eigenvalues and the spectrum probe against closed forms.

#include "studies/probes/modes.hpp"
#include "tests/unit/probes/springs.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace concord::probes {
namespace {

using test::chain;
using test::MadeUp;
using test::Springs;

TEST(Modes, OfAChain) {
  const int n = 40;
  const double k = 70, m = 0.2;
  Springs body(chain(n, k), m, 0);
  const std::vector<double> rest(2 * n, 0.0);
  const Modes found = modes(body, rest);
  ASSERT_EQ(found.real.size(), n);  // y is prescribed
  for (int j = 0; j < n; ++j) {
    const double s = std::sin(j * M_PI / (2.0 * n));
    EXPECT_NEAR(found.real[j], 4 * k / m * s * s, 1e-10 * k / m) << j;
    EXPECT_EQ(found.imaginary[j], 0);
  }
  EXPECT_LT(found.asymmetry, 1e-15);
}

TEST(Modes, OfAStiffnessWithoutPotential) {
  Eigen::MatrixXd K(3, 3);
  K << 5, 2, 0, -2, 5, 0, 0, 0, 1;
  Springs body(K, 0.5, 0);
  const std::vector<double> rest(6, 0.0);
  const Modes found = modes(body, rest);
  ASSERT_EQ(found.real.size(), 3);
  EXPECT_NEAR(found.real[0], 2, 1e-12);
  EXPECT_NEAR(found.real[1], 10, 1e-12);
  EXPECT_NEAR(found.real[2], 10, 1e-12);
  EXPECT_NEAR(std::abs(found.imaginary[1]), 4, 1e-12);
  EXPECT_NEAR(found.asymmetry, std::sqrt(32.0 / 59), 1e-12);
}

std::map<std::string, double> spectrum_of(const Eigen::MatrixXd& K, double mass, double low) {
  const scene::Problem problem = scene::read_problem("spinning_block");
  const MadeUp method(
      [&](const scene::RunRequest&) { return std::make_unique<Springs>(K, mass, 1); });
  return test::run_probe("spectrum", problem, method, {},
                         {{"reference", "0"}, {"low", std::to_string(low)}})
      .quantities;
}

TEST(Spectrum, CountsZeroLowAndNegativeModes) {
  const scene::Problem problem = scene::read_problem("spinning_block");
  const double unit = problem.material.E / problem.material.rho0;  // L = 1 m
  Eigen::VectorXd eigenvalues(9);
  eigenvalues << -3, 0, 0, 0, 0, 1e-4, 7, 12, 400;
  const Eigen::MatrixXd K = (2 * unit * eigenvalues).asDiagonal();
  const auto q = spectrum_of(K, 2, 10);
  EXPECT_EQ(q.at("zero_modes"), 4);
  EXPECT_EQ(q.at("zero_modes_beyond_rigid"), 1);  // of a body in the plane
  EXPECT_EQ(q.at("low_modes"), 2);
  EXPECT_EQ(q.at("negative_modes"), 1);
  EXPECT_NEAR(q.at("lowest"), -3, 1e-9);
  EXPECT_NEAR(q.at("highest"), 400, 1e-9);
  EXPECT_EQ(q.at("complex_modes"), 0);
  EXPECT_NEAR(q.at("growth_rate"), std::sqrt(3.0), 1e-9);
}

TEST(Spectrum, TellsHowFastComplexModesGrow) {
  const scene::Problem problem = scene::read_problem("spinning_block");
  const double unit = problem.material.E / problem.material.rho0;
  Eigen::MatrixXd K(2, 2);
  K << 3, 4, -4, 3;  // lambda = 3 +- 4i = (2 +- i)^2: grows with 1
  const auto q = spectrum_of(unit * K, 1, 10);
  EXPECT_EQ(q.at("complex_modes"), 2);
  EXPECT_NEAR(q.at("growth_rate"), 1, 1e-9);
  EXPECT_EQ(q.at("negative_modes"), 0);
}

}  // namespace
}  // namespace concord::probes
