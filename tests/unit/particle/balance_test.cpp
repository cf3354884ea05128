// The energy balance of viscous and damped runs: one oscillator a component with a dashpot.

#include "particle/core/leapfrog.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace concord::particle {
namespace {

/// f = -m (omega^2 u + eta v) on every component.
class Dashpots final : public ForceModel {
 public:
  Dashpots(const Body& body, const scene::Problem& problem, double omega, double eta)
      : ForceModel(body, problem), m_k(omega * omega), m_eta(eta) {}
  void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor&) override {
    ++evaluations;
    for (std::size_t i = 0; i < f.size(); ++i)
      f[i] = -m_body.m[i / m_body.stride] * (m_k * u[i] + m_eta * v[i]);
  }
  Energies energies(std::span<const double> u, const Executor&) override {
    Energies e;
    for (std::size_t i = 0; i < u.size(); ++i)
      e.internal += 0.5 * m_body.m[i / m_body.stride] * m_k * u[i] * u[i];
    return e;
  }
  void gradients(std::span<const double>, std::span<Mat3> H) override {
    for (Mat3& h : H) h.setZero();
  }
  const Stiffness& tangent(std::span<const double>) override { return m_none; }
  bool viscous() const override { return m_eta > 0; }
  std::size_t interactions() const override { return 0; }
  long evaluations = 0;

 private:
  double m_k, m_eta;
  Stiffness m_none;
};

struct Outcome {
  double drift, dissipated, start;
  long evaluations, steps;
};

/// From rest at u = 1 mm for 4 s at omega = 3/s.
Outcome run(double eta, double damping, double dt) {
  scene::Problem problem = scene::read_problem(
      "spinning_block", {{"initial.velocity", "[\"0\", \"0\", \"0\"]"},
                         {"initial.displacement", "[\"1e-3\", \"0\", \"0\"]"}});
  problem.end_time = 4;
  const Body body = make_body(problem, 1.0, 0, 1);
  Dashpots model(body, problem, 3, eta);
  const Executor executor(1);
  const Constraints constraints(problem, body);
  const ExternalLoads loads(problem, model);
  Recorder recorder(problem, model, constraints, executor, {}, false, true);
  Leapfrog leapfrog(problem, model, constraints, loads, executor);
  LeapfrogOptions options;
  options.end_time = problem.end_time;
  options.dt_fixed = dt;
  options.damping = damping;
  options.history_rows = 50;
  LeapfrogOutcome outcome;
  leapfrog.run(options, recorder, outcome);
  scene::Result result;
  recorder.add_invariants(result);
  double mass = 0;
  for (const double m : body.m) mass += m;
  return {result.invariants.at("energy_drift"), leapfrog.state().dissipation,
          0.5 * mass * 9 * 1e-6, model.evaluations, outcome.steps};
}

class Losses : public testing::TestWithParam<std::pair<double, double>> {};

/// (k/2) u^2 + (m/2) v^2 oscillates by O(dt^2) in the leapfrog; nothing else may be left.
TEST_P(Losses, CloseTheBalanceToSecondOrder) {
  const auto [eta, damping] = GetParam();
  const Outcome coarse = run(eta, damping, 0.02), fine = run(eta, damping, 0.01);
  EXPECT_NEAR(std::log2(coarse.drift / fine.drift), 2, 0.1);
  // m v_n^2/2 exceeds the conserved m v_{n-1/2} v_{n+1/2}/2 by m (dt a_n/2)^2/2, at most
  // (omega dt)^2/4 of the energy; damping moves that by eta dt or so.
  EXPECT_LT(fine.drift, 0.25 * 9 * 0.01 * 0.01 * (1 + 0.01));
  // exp(-0.8 x 4) of the energy is left, up to its ripple, (eta / 2 omega) of it.
  EXPECT_NEAR(fine.dissipated / fine.start, 1 - std::exp(-3.2), 0.15 * std::exp(-3.2) + 0.01);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Losses,
                         testing::Values(std::pair(0.8, 0.0), std::pair(0.0, 0.8),
                                         std::pair(0.3, 0.5)));

TEST(Losses, CostNothingWhereThereAreNone) {
  const Outcome none = run(0, 0, 0.02), damped = run(0, 0.8, 0.02), viscous = run(0.8, 0, 0.02);
  EXPECT_EQ(none.dissipated, 0);
  EXPECT_EQ(none.evaluations, none.steps + 1);
  EXPECT_EQ(damped.evaluations, damped.steps + 1);
  EXPECT_GE(viscous.evaluations, 2 * viscous.steps);  // the check above can fail
}

}  // namespace
}  // namespace concord::particle
