// Conservation over a long run of a free, spinning, deforming body, for every registered
// particle method.

#include "tests/property/bodies.hpp"

#include <filesystem>

namespace concord::particle::test {
namespace {

scene::Result run(const Variant& variant, const scene::Problem& problem, double dt) {
  scene::RunRequest request;
  request.h = problem.reference_length / 4;
  request.perturb = 0.25;
  request.seed = 3;
  request.settings = variant.settings;
  request.settings["dt"] = std::to_string(dt);
  scene::Result result;
  scene::MethodRegistry::instance().find(variant.method).run(problem, request, result);
  return result;
}

TEST_P(EveryMethod, MomentaStayOverTenThousandSteps) {
  if (declares(GetParam(), "angular momentum")) {  // spins up until it breaks
    const scene::Problem problem = scene::read_problem("spinning_block", {{"end_time", "1 s"}});
    const scene::Result result = run(GetParam(), problem, 1e-3);
    EXPECT_LT(result.invariants.at("linear_momentum_drift"), 2e-13);
    EXPECT_GT(result.invariants.at("angular_momentum_drift"), 1e-6)
        << "declared failure did not happen";
    return;
  }
  const scene::Problem problem = scene::read_problem("spinning_block", {{"end_time", "10 s"}});
  const scene::Result result = run(GetParam(), problem, 1e-3);
  ASSERT_GE(result.steps, 10000);
  // Round-off of 10^4 steps: each adds at most a few units of 1e-16 of sum m |v|, at random.
  EXPECT_LT(result.invariants.at("linear_momentum_drift"), 2e-13);
  EXPECT_LT(result.invariants.at("angular_momentum_drift"), 2e-13);
}

TEST_P(EveryMethod, EnergyDriftIsOfSecondOrderInTheStep) {
  const scene::Problem problem = scene::read_problem("spinning_block");
  const scene::Result coarse = run(GetParam(), problem, 1e-3),
                      fine = run(GetParam(), problem, 5e-4);
  const Bench b(GetParam(), "spinning_block", 4);
  if (!b.model->has_potential()) {
    EXPECT_TRUE(declares(GetParam(), "potential"));
    return;
  }
  EXPECT_LT(coarse.invariants.at("energy_drift"), 0.02);
  EXPECT_NEAR(coarse.invariants.at("energy_drift") / fine.invariants.at("energy_drift"), 4, 1);
}

}  // namespace
}  // namespace concord::particle::test
