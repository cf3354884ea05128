// Orders and discretisation errors of sequences whose answers are known in closed form.

#include "studies/driver/fits.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

using namespace concord::studies;

TEST(Fit, RecoversThePowerLaw) {
  const std::vector<double> h{0.5, 0.25, 0.1};
  std::vector<double> error;
  for (const double x : h) error.push_back(3 * std::pow(x, 1.7));
  const LineFit fit = fit_loglog(h, error);
  EXPECT_NEAR(fit.slope, 1.7, 1e-13);
  EXPECT_NEAR(fit.intercept, std::log(3.0), 1e-13);
  EXPECT_NEAR(fit.r2, 1, 1e-13);
}

// y = 1, 4, 4 at log2(x) = 0, 1, 2: slope 1 and r2 = 3/4 by hand.
TEST(Fit, LeastSquaresByHand) {
  const LineFit fit = fit_loglog(std::array{1.0, 2.0, 4.0}, std::array{1.0, 4.0, 4.0});
  EXPECT_NEAR(fit.slope, 1, 1e-14);
  EXPECT_NEAR(fit.r2, 0.75, 1e-14);
}

TEST(Fit, RejectsWhatHasNoLogarithmOrNoSpread) {
  EXPECT_THROW(fit_loglog(std::array{1.0, 2.0}, std::array{0.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(fit_loglog(std::array{1.0, 1.0}, std::array{2.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(fit_loglog(std::array{1.0}, std::array{2.0}), std::invalid_argument);
}

TEST(LocalOrder, BetweenTwoLevels) {
  EXPECT_NEAR(local_order(0.2, 0.08, 0.1, 0.02), 2, 1e-14);
  EXPECT_TRUE(std::isnan(local_order(0.2, 0.08, 0.1, 0)));
}

// f = 1 + h^2: order 2 and the limit 1 exactly.
TEST(GridConvergence, ExactSecondOrderHasTheSmallSafetyFactor) {
  const std::array h{0.4, 0.2, 0.1}, f{1.16, 1.04, 1.01};
  const GridConvergence g = grid_convergence(h, f, 2);
  ASSERT_TRUE(g.asymptotic);
  EXPECT_NEAR(g.order, 2, 1e-12);
  EXPECT_NEAR(g.extrapolated, 1, 1e-12);
  EXPECT_EQ(g.safety_factor, 1.25);
  EXPECT_NEAR(g.gci, 1.25 * (0.03 / 1.01) / 3, 1e-12);
}

// NPARC alliance tutorial on grid convergence: f = 0.97050, 0.96854, 0.96178, r = 2, p
// = 1.786170.
TEST(GridConvergence, ObservedOrderOfThePublishedExample) {
  const std::array h{4.0, 2.0, 1.0}, f{0.96178, 0.96854, 0.97050};
  const GridConvergence g = grid_convergence(h, f, 2);
  EXPECT_NEAR(g.order, 1.786170, 1e-6);
  EXPECT_NEAR(g.extrapolated, 0.97130, 5e-6);
  EXPECT_EQ(g.safety_factor, 3.0) << "10.7 % away from the formal order";
}

TEST(GridConvergence, UnequalRatios) {
  std::array<double, 3> h{0.5, 0.3, 0.1}, f{};
  for (std::size_t i = 0; i < 3; ++i) f[i] = 2 - 5 * std::pow(h[i], 1.5);
  const GridConvergence g = grid_convergence(h, f, 1.5);
  ASSERT_TRUE(g.asymptotic);
  EXPECT_NEAR(g.order, 1.5, 1e-9);
  EXPECT_NEAR(g.extrapolated, 2, 1e-9);
}

TEST(GridConvergence, FarFromTheFormalOrderTakesTheLargeFactorAndTheSmallerOrder) {
  const std::array h{4.0, 2.0, 1.0}, f{1 + 16.0, 1 + 4.0, 1 + 1.0};
  const GridConvergence g = grid_convergence(h, f, 1);
  EXPECT_EQ(g.safety_factor, 3.0);
  EXPECT_NEAR(g.gci, 3 * (3.0 / 2) / (2 - 1), 1e-12) << "with p = 1, not 2";
}

TEST(GridConvergence, SaysWhenItIsNotAsymptotic) {
  const std::array h{4.0, 2.0, 1.0};
  EXPECT_FALSE(grid_convergence(h, std::array{1.0, 1.2, 1.1}, 2).asymptotic) << "oscillates";
  EXPECT_FALSE(grid_convergence(h, std::array{1.0, 1.1, 1.3}, 2).asymptotic) << "diverges";
  EXPECT_FALSE(grid_convergence(h, std::array{1.0, 1.0, 1.0}, 2).asymptotic) << "does not move";
  EXPECT_NE(grid_convergence(h, std::array{1.0, 1.2, 1.1}, 2).statement.find("not asymptotic"),
            std::string::npos);
  EXPECT_THROW(grid_convergence(std::array{1.0, 2.0, 4.0}, std::array{1.0, 1.1, 1.2}, 2),
               std::invalid_argument);
}
