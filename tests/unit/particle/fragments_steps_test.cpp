// Fragments, step by step: crushed ones in the energy account, steps that fail.

#include "scene/errors.hpp"
#include "tests/unit/particle/fragments.hpp"
#include "tests/unit/potential.hpp"

#include <gtest/gtest.h>

namespace concord::particle::delaunay::fragments {
namespace {

double stored(FractureModel& model, const Column& u) {
  const Energies e = model.energies(u, Executor(1));
  return e.internal + e.stabilisation;
}

double work(const Column& f, const Column& dx) {
  double sum = 0;
  for (std::size_t k = 0; k < f.size(); ++k) sum += f[k] * dx[k];
  return sum;
}

/// A run of the torn beam with a model that can be asked afterwards.
struct OwnRun {
  scene::Problem problem = torn();
  Body body;
  FractureModel model;
  Executor executor{1};
  Constraints constraints{problem, body};
  ExternalLoads loads{problem, model};
  Recorder recorder{problem, model, constraints, executor, {}, false};
  Leapfrog leapfrog{problem, model, constraints, loads, executor};
  LeapfrogOutcome outcome;

  OwnRun(std::uint64_t seed, double perturb)
      : body(torn_body(problem, seed, perturb)), model(body, problem, {0, 0.1, 0.1}) {}
  void go(double dt) {
    LeapfrogOptions options;
    options.end_time = problem.end_time;
    options.dt_fixed = dt;
    options.history_rows = 10;
    leapfrog.run(options, recorder, outcome);
  }
  double critical() { return 2 / omega_of(model, problem, body, Column(body.X.size(), 0.0)); }
};

}  // namespace

// The last tetrahedron of a particle is passed through by it: only what sums over it has any
// energy, so that the step's balance is exact.
TEST(FragmentSteps, ACrushedOneGoesWithAllItHeld) {
  const scene::Problem problem = torn();
  for (const FractureParameters& parameters :
       {FractureParameters{0, 0, 0}, FractureParameters{0, 0.2, 0.3}}) {
    const Body body = torn_body(problem, 2);
    FractureModel model(body, problem, parameters);
    const Tip tip = leave_a_tip(model, body);
    ASSERT_GE(tip.particle, 0);
    const Stencil sum = model.network().stencil(tip.particle);
    const auto own = std::find(sum.points.begin(), sum.points.end(), tip.particle);
    const Vec3 g = sum.zeta[own - sum.points.begin()] / sum.omega;  // of its shape function
    const Vec3 height = g / g.squaredNorm();
    Column u(body.X.size(), 0.0), v = u, f_before = u, f = u, dx = u;
    const double dt = 1e-5;
    for (int i = 0; i < 3; ++i) {
      const std::size_t k = at(body, tip.particle) + i;
      u[k] = -0.2 * height[i];
      dx[k] = -0.9 * height[i];
      v[k] = dx[k] / dt;
    }
    const double before = stored(model, u);
    model.forces(u, {}, f_before, Executor(1));
    Column after = u;
    for (std::size_t k = 0; k < u.size(); ++k) after[k] += dx[k];
    const FractureRecord record = model.record();
    model.advance(100, dt, after, v, f, Executor(1));
    EXPECT_EQ(model.network().omega()[tip.particle], 0);
    EXPECT_GT(model.record().dead.size(), record.dead.size());
    const double lost =
        before - stored(model, after) - 0.5 * (work(f_before, dx) + work(f, dx));
    EXPECT_GT(before, 0);
    EXPECT_NEAR(model.record().released - record.released, lost, 1e-10 * before);
  }
}

TEST(FragmentSteps, AStepThatFailsTakesNothingWithIt) {
  const scene::Problem problem = torn();
  const Body body = torn_body(problem, 1);
  FractureModel model(body, problem, {0.5, 0.1, 0.1}), other(body, problem, {0.5, 0.1, 0.1});
  const Column still(body.X.size(), 0.0), some = test::random_column(body, 0.01 * body.h, 3);
  for (FractureModel* both : {&model, &other}) break_some(*both, body, 0);
  Column u = some, f = still, expected = still;
  Index whole = 0;
  while (!model.network().whole(whole) || body.triangulation.on_boundary[whole] != 0) ++whole;
  // All around it goes through it: det F < 0, and many bonds are too long.
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 X = body.position(a) - body.position(whole);
    if (X.norm() > 2 * body.h) continue;
    for (int i = 0; i < 3; ++i) u[at(body, a) + i] = i == 0 ? -2.5 * X[0] : 0.3 * X[i];
  }
  const FractureRecord before = model.record();
  ASSERT_THROW(model.advance(5, 1e-5, u, still, f, Executor(1)), BadState);
  EXPECT_EQ(model.record().dead.size(), before.dead.size());
  break_some(model, body, 1);  // a step that the integrator undoes later
  ASSERT_GT(model.record().dead.size(), before.dead.size());
  model.take_back();
  EXPECT_EQ(model.record().dead.size(), before.dead.size());
  EXPECT_EQ(model.record().broken.size(), before.broken.size());
  EXPECT_EQ(model.record().released, before.released);
  EXPECT_EQ(model.network().omega(), other.network().omega());
  EXPECT_EQ(model.network().skew<3>().size(), other.network().skew<3>().size());
  for (int step = 0; step < 2; ++step) {  // the same bits, and the same limits
    u = some;
    u[at(body, 300)] += step * 0.3 * body.h;
    model.advance(6 + step, 1e-5, u, some, f, Executor(1));
    other.advance(6 + step, 1e-5, u, some, expected, Executor(1));
    EXPECT_EQ(f, expected);
  }
  EXPECT_GT(model.record().broken.size(), before.broken.size());
  EXPECT_EQ(model.record().broken.size(), other.record().broken.size());
  EXPECT_EQ(model.record().released, other.record().released);
}

TEST(FragmentSteps, NothingThatIsLeftOfATornBeamIsFlat) {
  for (const std::uint64_t seed : {1, 2}) {
    OwnRun run(seed, 0.2);
    run.go(0.1 * run.body.h / std::sqrt(run.problem.material.E / run.problem.material.rho0));
    EXPECT_GT(run.model.record().flat, 0);
    Index cut = 0;
    for (Index a = 0; a < run.body.n; ++a) {
      if (run.model.network().whole(a) || run.model.network().omega()[a] == 0) continue;
      ++cut;
      EXPECT_GE(thickness(run.body, run.model.network(), a), 0.2) << a;
    }
    EXPECT_GT(cut, 50);
  }
}

// A fixed step a little too long, which the few steps to the first break do not show: it is
// told there, and what the failed step had removed is back.
TEST(FragmentSteps, AFixedStepThatIsTooLongIsToldAtTheFirstBreak) {
  OwnRun run(1, 0.2);
  try {
    run.go(1.1 * run.critical());
    FAIL() << "a step above the critical one ran to the end";
  } catch (const SolveError& error) {
    EXPECT_EQ(error.quantity(), "time step");
    EXPECT_GT(error.time(), 0.01);
    EXPECT_GE(error.particle(), 0);
    EXPECT_TRUE(run.model.record().dead.empty());
    EXPECT_TRUE(run.model.record().broken.empty());
    EXPECT_EQ(run.model.record().released, 0);
    for (Index a = 0; a < run.body.n; ++a) ASSERT_TRUE(run.model.network().whole(a));
  }
}

}  // namespace concord::particle::delaunay::fragments
