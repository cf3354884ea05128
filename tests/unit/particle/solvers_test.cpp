// The integrator, the stable step and the static solver against closed forms.

#include "particle/core/leapfrog.hpp"
#include "particle/core/statics.hpp"
#include "particle/delaunay/delaunay.hpp"
#include "scene/errors.hpp"
#include "scene/reader.hpp"

#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace concord::particle {
namespace {

/// Springs of stiffness k_a to the reference position: n independent oscillators.
class Oscillators final : public ForceModel {
 public:
  Oscillators(const Body& body, const scene::Problem& problem, std::vector<double> k)
      : ForceModel(body, problem), m_k(std::move(k)) {}
  void forces(std::span<const double> u, std::span<const double>, std::span<double> f,
              const Executor&) override {
    for (std::size_t i = 0; i < f.size(); ++i) f[i] = -m_k[i / m_body.stride] * u[i];
  }
  Energies energies(std::span<const double> u, const Executor&) override {
    Energies e;
    for (std::size_t i = 0; i < u.size(); ++i)
      e.internal += 0.5 * m_k[i / m_body.stride] * u[i] * u[i];
    return e;
  }
  void gradients(std::span<const double>, std::span<Mat3> H) override {
    for (Mat3& h : H) h.setZero();
  }
  const Stiffness& tangent(std::span<const double>) override { return m_none; }
  std::size_t interactions() const override { return 0; }

 private:
  std::vector<double> m_k;
  Stiffness m_none;
};

scene::Problem free_block(const std::vector<scene::Override>& set = {}) {
  return scene::read_problem("spinning_block", set);
}

/// Runs one oscillator frequency for `T` seconds from rest at u = 1e-3 and returns its
/// displacement at the end.
double oscillate(double omega, double damping, double dt, double T) {
  scene::Problem problem = free_block({{"initial.velocity", "[\"0\", \"0\", \"0\"]"},
                                       {"initial.displacement", "[\"1e-3\", \"0\", \"0\"]"}});
  problem.end_time = T;
  const Body body = make_body(problem, 1.0, 0, 1);
  std::vector<double> k;
  for (const double m : body.m) k.push_back(omega * omega * m);
  Oscillators model(body, problem, k);
  const Executor executor(1);
  const Constraints constraints(problem, body);
  const ExternalLoads loads(problem, model);
  Recorder recorder(problem, model, constraints, executor, {}, false);
  Leapfrog leapfrog(problem, model, constraints, loads, executor);
  LeapfrogOptions options;
  options.end_time = T;
  options.dt_fixed = dt;
  options.damping = damping;
  LeapfrogOutcome outcome;
  leapfrog.run(options, recorder, outcome);
  EXPECT_DOUBLE_EQ(outcome.t, T);
  return leapfrog.state().u[0];
}

TEST(Leapfrog, IsOfSecondOrderOnAnOscillator) {
  const double omega = 3, T = 5, exact = 1e-3 * std::cos(omega * T);
  const double coarse = std::abs(oscillate(omega, 0, 0.02, T) - exact),
               fine = std::abs(oscillate(omega, 0, 0.01, T) - exact);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.05);
  EXPECT_LT(fine, 1e-6);
}

TEST(Leapfrog, DampsAtTheRateAskedFor) {
  const double omega = 3, c = 0.8, T = 4, damped = std::sqrt(omega * omega - 0.25 * c * c);
  const double exact = 1e-3 * std::exp(-0.5 * c * T) *
                       (std::cos(damped * T) + 0.5 * c / damped * std::sin(damped * T));
  const double coarse = std::abs(oscillate(omega, c, 0.02, T) - exact),
               fine = std::abs(oscillate(omega, c, 0.01, T) - exact);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TEST(StableStep, FindsTheHighestFrequency) {
  const scene::Problem problem = free_block();
  const Body body = make_body(problem, 0.25, 0.2, 1);
  std::vector<double> k;
  for (Index a = 0; a < body.n; ++a) k.push_back(body.m[a] * (1 + 99.0 * a / (body.n - 1)));
  Oscillators model(body, problem, k);
  const Executor executor(1);
  const Constraints constraints(problem, body);
  const double omega =
      SpectralRadius(model, constraints, executor).omega_max(Column(body.X.size(), 0.0));
  EXPECT_LE(omega, 10 * (1 + 1e-9));
  EXPECT_GT(omega, 10 * (1 - 5e-3));
}

TEST(StableStep, AgreesWithTheDenseEigenvaluesOfTheTangent) {
  const scene::Problem problem = scene::read_problem("swinging_cube");
  const Body body = make_body(problem, 0.25, 0.25, 6);
  delaunay::DelaunayModel model(body, problem, {});
  const Constraints constraints(problem, body);
  const Executor executor(1);
  Eigen::MatrixXd K = model.tangent(Column(body.X.size(), 0.0));
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < 3; ++i) {
      K.row(3 * a + i) /= std::sqrt(body.m[a]);
      K.col(3 * a + i) /= std::sqrt(body.m[a]);
    }
  }
  for (const PrescribedDof& dof : constraints.dofs()) {
    K.row(3 * dof.particle + dof.component).setZero();
    K.col(3 * dof.particle + dof.component).setZero();
  }
  const double exact =
      std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().maxCoeff());
  const double omega =
      SpectralRadius(model, constraints, executor).omega_max(Column(body.X.size(), 0.0));
  EXPECT_LE(omega, exact * (1 + 1e-6));
  EXPECT_GT(omega, exact * (1 - 1e-2));
}

TEST(Leapfrog, StopsAtNotANumberWithStepAndTime) {
  scene::Problem problem = free_block();
  const Body body = make_body(problem, 0.25, 0.2, 1);
  delaunay::DelaunayModel model(body, problem, {});
  const Executor executor(1);
  const Constraints constraints(problem, body);
  const ExternalLoads loads(problem, model);
  Recorder recorder(problem, model, constraints, executor, {}, false);
  Leapfrog leapfrog(problem, model, constraints, loads, executor);
  LeapfrogOptions options;
  options.end_time = 10;
  options.dt_fixed = 0.05;  // far beyond the stable step
  LeapfrogOutcome outcome;
  try {
    leapfrog.run(options, recorder, outcome);
    FAIL() << "survived";
  } catch (const SolveError& e) {
    EXPECT_EQ(e.quantity(), "det F");
    EXPECT_GT(e.step(), 0);
    EXPECT_NEAR(e.time(), 0.05 * e.step(), 1e-9);
    EXPECT_GE(e.particle(), 0);
    // The last good state is what is left.
    EXPECT_EQ(outcome.steps, e.step() - 1);
    EXPECT_NEAR(leapfrog.state().t, 0.05 * outcome.steps, 1e-9);
    std::vector<Mat3> H(body.n);
    model.gradients(leapfrog.state().u, H);
    for (const Mat3& h : H) EXPECT_GT((Mat3::Identity() + h).determinant(), 0);
  }
}

/// A prescribed motion that is no number beyond 60 % of the time ends the run there; what is
/// written, and what is left, are numbers.
TEST(Leapfrog, StopsWherePrescribedMotionIsNotANumber) {
  scene::Problem problem = scene::read_problem("swinging_cube");
  const double T = problem.end_time, lost = 0.6 * T;
  std::erase_if(problem.boundaries, [](const auto& bc) { return bc.group[1] == '1'; });
  problem.initial_displacement = {};
  problem.exact_displacement = {};
  std::erase_if(problem.quantities, [](const auto& q) { return q.name == "largest_error"; });
  scene::BoundaryCondition& pulled = problem.boundaries.front();
  pulled.kind = scene::BoundaryKind::displacement;
  pulled.value.component[0] =
      scene::Expression("1e-4*(1 - sqrt(1 - t/lost))", {{"lost", lost}});
  const Body body = make_body(problem, 0.25, 0.2, 1);
  delaunay::DelaunayModel model(body, problem, {});
  const Executor executor(1);
  const Constraints constraints(problem, body);
  ASSERT_TRUE(constraints.moving());
  const ExternalLoads loads(problem, model);
  const std::filesystem::path out = std::filesystem::path(testing::TempDir()) /
                                    ("concord-lost-" + std::to_string(::getpid()));
  std::filesystem::create_directories(out);
  Leapfrog leapfrog(problem, model, constraints, loads, executor);
  LeapfrogOptions options;
  options.end_time = T;
  options.dt_fixed = T / 200;
  options.history_rows = 1000;
  LeapfrogOutcome outcome;
  {
    Recorder recorder(problem, model, constraints, executor, out, false);
    EXPECT_THROW(leapfrog.run(options, recorder, outcome), SolveError);
  }
  EXPECT_LE(outcome.t, lost);
  EXPECT_GT(outcome.t, lost - 2 * outcome.dt);
  const State state = leapfrog.state();
  EXPECT_NEAR(state.t, outcome.t, 1e-9 * T);
  for (const double u : state.u) EXPECT_TRUE(std::isfinite(u));
  for (const double v : state.v) EXPECT_TRUE(std::isfinite(v));
  std::ifstream file(out / "history.csv");
  std::stringstream history;
  history << file.rdbuf();
  EXPECT_GT(history.str().size(), 1000u);
  EXPECT_EQ(history.str().find("nan"), std::string::npos);
  EXPECT_EQ(history.str().find("inf"), std::string::npos);
  std::filesystem::remove_all(out);
}

/// Statics of a scene, to the end.
struct StaticRun {
  scene::Problem problem;
  Body body;
  delaunay::DelaunayModel model;
  Executor executor{1};
  Constraints constraints;
  ExternalLoads loads;
  Recorder recorder;
  StaticsOutcome outcome;

  StaticRun(scene::Problem p, double resolution, double perturb)
      : problem(std::move(p)),
        body(make_body(problem, problem.reference_length / resolution, perturb, 2)),
        model(body, problem, {}), constraints(problem, body), loads(problem, model),
        recorder(problem, model, constraints, executor, {}, false) {}

  State solve() {
    Statics statics(problem, model, constraints, loads, executor);
    StaticsOptions options;
    options.load_steps = problem.load_steps;
    statics.run(options, recorder, outcome);
    u.assign(statics.state().u.begin(), statics.state().u.end());
    State s = statics.state();
    s.u = u;
    s.unbalanced = {};
    return s;
  }
  Column u;
};

TEST(Statics, RefusesABodyThatCanMoveRigidly) {
  scene::Problem problem = scene::read_problem("patch_test_c");
  std::erase_if(problem.boundaries,
                [](const auto& bc) { return bc.kind != scene::BoundaryKind::traction; });
  StaticRun run(problem, 3, 0.2);
  try {
    run.solve();
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.key(), "boundary");
    EXPECT_NE(e.found().find("6 rigid motions"), std::string::npos);
  }
}

/// Finite homogeneous strain by prescribed motion of the whole surface: the state inside must
/// follow, for large steps too.
TEST(Statics, ReachesFiniteHomogeneousStrainInOneStep) {
  scene::Problem problem =
      scene::read_problem("patch_test_b", {{"parameters.u0", "0.1"}, {"load_steps", "1"}});
  StaticRun run(problem, 4, 0.2);
  const State s = run.solve();
  for (Index a = 0; a < run.body.n; ++a) {
    const Vec3 exact = (*problem.exact_displacement)(run.body.position(a), 1);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(s.u[a * 4 + i], exact[i], 1e-14 * 0.01) << a;
  }
}

TEST(Statics, WorkOfPrescribedMotionIsTheStoredEnergy) {
  // 40 steps of the trapezoidal rule on a smooth path: error about 1/40^2 of the small
  // nonlinear part.
  scene::Problem problem =
      scene::read_problem("patch_test_b", {{"parameters.u0", "0.02"}, {"load_steps", "40"}});
  StaticRun run(problem, 3, 0.2);
  const State s = run.solve();
  const Energies e = run.model.energies(s.u, run.executor);
  EXPECT_GT(e.internal, 0);
  EXPECT_NEAR(s.external_work / (e.internal + e.stabilisation), 1, 1e-4);
}

}  // namespace
}  // namespace concord::particle
