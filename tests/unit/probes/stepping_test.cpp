// The bisection for the stable step, and its probe, on springs.

#include "studies/probes/stepping.hpp"
#include "tests/unit/probes/springs.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>

namespace concord::probes {
namespace {

using test::chain;
using test::MadeUp;
using test::Springs;

/// 2/omega_max of a free chain.
double critical_of_chain(int n, double k, double m) {
  return 1 / (std::sqrt(k / m) * std::sin((n - 1) * M_PI / (2.0 * n)));
}

TEST(StableStep, IsTwoOverTheHighestFrequencyOfAChain) {
  const double exact = critical_of_chain(12, 50, 0.3);
  Springs body(chain(12, 50), 0.3, 0);
  const std::vector<double> rest(24, 0.0);
  for (const double guess : {0.4, 0.97, 1.0, 1.05, 2.5})
    EXPECT_NEAR(stable_step(body, rest, guess * exact) / exact, 1, 1e-3) << guess;
}

TEST(StableStep, TellsThatTheLimitIsOutOfReach) {
  const double exact = critical_of_chain(12, 50, 0.3);
  Springs body(chain(12, 50), 0.3, 0);
  const std::vector<double> rest(24, 0.0);
  EXPECT_DOUBLE_EQ(stable_step(body, rest, 20 * exact), 20 * exact / 8);
  EXPECT_DOUBLE_EQ(stable_step(body, rest, exact / 20), exact / 20 * 8);
}

TEST(StableStep, IgnoresGrowthThatNoStepCures) {
  // Springs that push the body away: it grows by exp(0.003), exp(0.1) and exp(0.3) a step at
  // any step; without loss of accuracy.
  for (const double push : {5e-4, 0.5, 5.0}) {
    Eigen::MatrixXd K = chain(12, 50);
    K -= push * Eigen::MatrixXd::Identity(12, 12);
    Springs body(K, 0.3, 0);
    const std::vector<double> rest(24, 0.0);
    const double omega2 =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().maxCoeff() / 0.3;
    const double exact = 2 / std::sqrt(omega2);
    for (const double guess : {0.7, 1.0, 1.4})
      EXPECT_NEAR(stable_step(body, rest, guess * exact) / exact, 1, 1e-3) << push;
  }
}

TEST(StableStep, ProbePoolsOverArrangementsAndCountsRefusals) {
  const scene::Problem problem = scene::read_problem("spinning_block");
  // Seeds 3 to 7: the estimate is 1.1, 1.2, ... times the exact step; seed 5 is refused.
  const MadeUp method([](const scene::RunRequest& request) {
    if (request.seed == 5) throw InputError({}, "geometry", "inverted", "smaller moves");
    const double exact = critical_of_chain(6, 50, 0.3);
    const double factor = 1 + 0.1 * static_cast<double>(request.seed - 2);
    return std::make_unique<Springs>(chain(6, 50), 0.3, factor * exact);
  });
  scene::RunRequest run;
  run.h = 0.1;
  run.perturb = 0.4;
  run.seed = 3;
  const auto q = test::run_probe("stable_step", problem, method, run,
                                 {{"arrangements", "5"}, {"perturb_from", "0"}})
                     .quantities;
  EXPECT_NEAR(q.at("ratio_min"), 1 / 1.5, 1e-3);
  EXPECT_NEAR(q.at("ratio_max"), 1 / 1.1, 1e-3);
  EXPECT_NEAR(q.at("ratio_mean"), (1 / 1.1 + 1 / 1.2 + 1 / 1.4 + 1 / 1.5) / 4, 1e-3);
  EXPECT_EQ(q.at("accepted"), 4);
  EXPECT_EQ(q.at("refused"), 1);
  EXPECT_EQ(q.at("worst_seed"), 7);
  EXPECT_DOUBLE_EQ(q.at("worst_perturb"), 0.4);
  const double c_p = problem.material.longitudinal_wave_speed();
  EXPECT_NEAR(q.at("courant_min"), critical_of_chain(6, 50, 0.3) * c_p / 0.1, 1e-3 * c_p);
}

TEST(StableStep, ProbeFailsWhereEveryArrangementIsRefused) {
  const scene::Problem problem = scene::read_problem("spinning_block");
  const MadeUp method([](const scene::RunRequest&) -> std::unique_ptr<scene::DiscreteBody> {
    throw InputError({}, "geometry", "inverted", "smaller moves");
  });
  scene::RunRequest run;
  EXPECT_THROW(test::run_probe("stable_step", problem, method, run, {{"arrangements", "3"}}),
               SolveError);
}

TEST(Checkerboard, IsTheRatioOfTheSpringsToAShearWave) {
  // Independent springs: every displacement has the quotient k/m, prescribed ones none.
  const scene::Problem problem = scene::read_problem("cooks_membrane");
  const double k = 50, m = 0.3;
  class Grid final : public Springs {
   public:
    Grid() : Springs(50 * Eigen::MatrixXd::Identity(25, 25), 0.3, 1) {
      for (int a = 0; a < 25; ++a) m_grid.emplace_back(0.1 * (a % 5), 0.1 * (a / 5), 0);
    }
    std::span<const Vec3> positions() const override { return m_grid; }
    unsigned prescribed(Index) const override { return 0; }
    void force(std::span<const double> u, std::span<double> f) override {
      for (std::size_t i = 0; i < f.size(); ++i) f[i] = -50 * u[i];
    }

   private:
    std::vector<Vec3> m_grid;
  };
  const MadeUp method([](const scene::RunRequest&) { return std::make_unique<Grid>(); });
  scene::RunRequest run;
  run.h = 0.1;
  const auto q = test::run_probe("checkerboard", problem, method, run, {}).quantities;
  const double wave = problem.material.shear_wave_speed() * M_PI / 0.1;
  EXPECT_NEAR(q.at("restoring") * wave * wave / (k / m), 1, 1e-6);
  EXPECT_NEAR(q.at("restoring_corner") * wave * wave / (k / m), 1, 1e-6);
  EXPECT_EQ(q.at("growth_rate"), 0);
}

}  // namespace
}  // namespace concord::probes
