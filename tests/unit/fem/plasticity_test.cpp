// Plastic flow in the body: homogeneous fields against a scalar integration, unloading, large
// steps, perfect plasticity, Newton's order.

#include "plastic_scene.hpp"

#include "fem_reference/element_table.hpp"
#include "fem_reference/linear_solver.hpp"

#include <algorithm>
#include <cmath>

namespace concord::fem_test {
namespace {

/// Plane-strain tension of one point, tau_yy = 0, in logarithmic stretches, which add up when
/// the axes stay: elastic strains e (sum over the steps less flow), radial return by bisection,
/// the lateral stretch by bisection around it.
struct Tension {
  double E = 1e6, nu = 0.3, tau_0 = 2e3, tau_inf = 3e3, h = 1e3, alpha = 20;
  bool cauchy = false;
  double e[3] = {0, 0, 0}, eps_p = 0, lateral = 0, tau[3] = {0, 0, 0};

  double flow(double p) const {
    return tau_0 + h * p + (tau_inf - tau_0) * (1 - std::exp(-alpha * p));
  }
  /// tau_yy at strain increments a, b; writes all when `keep`.
  double update(double a, double b, double log_J, bool keep) {
    const double mu = E / (2 * (1 + nu)), kappa = E / (3 * (1 - 2 * nu));
    double t[3] = {e[0] + a, e[1] + b, e[2]};
    const double tr = t[0] + t[1] + t[2];
    double s[3], square = 0;
    for (int A = 0; A < 3; ++A) {
      s[A] = t[A] - tr / 3;
      square += s[A] * s[A];
    }
    const double trial = 2 * mu * std::sqrt(1.5 * square);
    const double m = cauchy ? std::exp(log_J) : 1;
    double d = 0;
    if (trial > m * flow(eps_p)) {
      double low = 0, high = trial / (3 * mu);
      for (int k = 0; k < 200; ++k) {
        d = 0.5 * (low + high);
        (trial - 3 * mu * d > m * flow(eps_p + d) ? low : high) = d;
      }
    }
    const double theta = 1 - 3 * mu * d / std::max(trial, 1e-300);
    const double tau_yy = kappa * tr + 2 * mu * theta * s[1];
    if (keep) {
      for (int A = 0; A < 3; ++A) {
        tau[A] = kappa * tr + 2 * mu * theta * s[A];
        e[A] = t[A] - (1 - theta) * s[A];
      }
      eps_p += d;
    }
    return tau_yy;
  }
  /// From stretch to stretch; returns the nominal stress.
  double pull(double from, double to) {
    const double a = std::log(to / from);
    double low = -1, high = 1;
    for (int k = 0; k < 200; ++k) {
      const double b = 0.5 * (low + high);
      (update(a, b, std::log(to) + lateral + b, false) > 0 ? high : low) = b;
    }
    const double b = 0.5 * (low + high);
    update(a, b, std::log(to) + lateral + b, true);
    lateral += b;
    return tau[0] / to;
  }
  double equivalent() const {
    const double mean = (tau[0] + tau[1] + tau[2]) / 3;
    double square = 0;
    for (const double t : tau) square += (t - mean) * (t - mean);
    return std::sqrt(1.5 * square);
  }
};

class PlasticTension : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(PlasticTension, HomogeneousFlowMeetsTheScalarIntegration) {
  const auto [element, measure] = GetParam();
  const Folder folder;
  const auto problem =
      plastic_problem(folder, "plane strain", "load_steps = 10", hardening, tension("0.1*t"));
  const auto result = run(problem, 1.0 / 3, {{"element", element}, {"yield_measure", measure}},
                          0.2, folder / "out");
  Tension point;
  point.cauchy = measure == "cauchy";
  const auto columns = history(folder / "out");
  ASSERT_EQ(columns.at("pull_x_N").size(), 11u);
  for (int k = 1; k <= 10; ++k) {
    const double load = point.pull(1 + 0.01 * (k - 1), 1 + 0.01 * k);
    EXPECT_NEAR(columns.at("pull_x_N")[k], load, 1e-9 * 3e3) << k;
    EXPECT_NEAR(columns.at("eps_p")[k], point.eps_p, 1e-10) << k;
    EXPECT_NEAR(columns.at("tau_eq_Pa")[k], point.equivalent(), 1e-8 * 3e3) << k;
  }
  EXPECT_GT(point.eps_p, 0.1);
  EXPECT_NEAR(result.quantities.at("gauss_plastic_strain_max"), point.eps_p, 1e-10);
  for (const Mat3& F : result.samples.F) EXPECT_NEAR(F(1, 1), std::exp(point.lateral), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(All, PlasticTension,
                         testing::Combine(testing::Values("P1", "P2", "Q1", "Q2"),
                                          testing::Values("kirchhoff", "cauchy")),
                         [](const auto& info) {
                           return std::get<0>(info.param) + std::get<1>(info.param);
                         });

TEST(PlasticBody, AffineFieldIn3DOnEveryElement) {
  // All sides follow an affine path in two steps that flow; the field is affine, and its
  // plastic strain that of one point.
  for (const char* element : {"P1", "P2", "Q1", "Q2"}) {
    const Folder folder;
    const auto problem = plastic_problem(folder, "3D", "load_steps = 2", hardening, R"toml(
[exact]
displacement = ["t*(0.02*X + 0.01*Y - 0.005*Z)", "t*(-0.015*X + 0.01*Y + 0.01*Z)", "t*(0.005*X - 0.02*Z)"]
[[boundary]]
group = "sides"
kind = "displacement"
value = "exact"
[[quantity]]
name = "eps_p"
kind = "maximum"
field = "plastic_strain"
)toml");
    const auto result = run(problem, 0.5, {{"element", element}}, 0.2);
    const fem::Elastoplastic<3> law(problem.material, fem::YieldMeasure::kirchhoff);
    fem::PlasticPoint<3> state, next;
    Mat3 H;
    H << 0.02, 0.01, -0.005, -0.015, 0.01, 0.01, 0.005, 0, -0.02;
    for (const double t : {0.5, 1.0}) {
      dealii::Tensor<2, 3> F, P;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) F[i][j] = t * H(i, j) + (i == j ? 1 : 0);
      ASSERT_TRUE(law.stress(F, state, P, next));
      state = next;
    }
    EXPECT_GT(state.eps_p, 0.01);
    EXPECT_NEAR(result.quantities.at("gauss_plastic_strain_max"), state.eps_p, 1e-12);
    EXPECT_NEAR(result.quantities.at("eps_p"), state.eps_p, 1e-12);
    for (const Mat3& F : result.samples.F)
      EXPECT_LE((F - Mat3::Identity() - H).norm(), 1e-11) << element;
  }
}

TEST(PlasticBody, UnloadingIsElasticAndReloadingRetraces) {
  const Folder folder;
  // Up to 5 %, back by .2 % (twice the yield strain would flow back), up again, then on.
  const auto problem = plastic_problem(
      folder, "plane strain", "load_steps = 40", hardening,
      tension("t < 0.5 ? 0.1*t : (t < 0.625 ? 0.05 - 0.016*(t-0.5) : (t < 0.75 ? 0.048 + "
              "0.016*(t-0.625) : 0.05 + 0.1*(t-0.75)))"));
  const auto result = run(problem, 0.5, {{"element", "P2"}}, 0.2, folder / "out");
  const auto h = history(folder / "out");
  const auto& force = h.at("pull_x_N");
  const auto& flow = h.at("plastic_work_J");
  for (int k = 21; k <= 30; ++k) {  // t = .5 is row 20, .75 row 30
    EXPECT_NEAR(h.at("eps_p")[k], h.at("eps_p")[20], 1e-10) << k;
    EXPECT_NEAR(flow[k], flow[20], 1e-9 * flow[20]) << k;
  }
  for (int k = 1; k <= 5; ++k) EXPECT_NEAR(force[25 - k], force[25 + k], 1e-8 * force[20]);
  // Elastic slope of plane-strain tension at log strain ln 1.05, E/(1 - nu^2) over the stretch
  // squared, on the sides' thickness: within the .2 % of strain that it moves.
  const double slope = (force[20] - force[25]) / 0.002;
  const double across = 1 / 1.05;  // isochoric to .1 %
  EXPECT_NEAR(slope, 1e6 / 0.91 * across / 1.05, 0.01 * slope);
  EXPECT_GT(h.at("eps_p")[40], h.at("eps_p")[30] + 0.02);
  // Trapezoidal rule, steps of d = .0025 m: a kink of the slope from E/(1 - nu^2) to nearly
  // nothing inside a step costs at most a d^2/8; the other kinks fall between steps.
  const double total = h.at("internal_energy_J")[40] + flow[40];
  EXPECT_LE(result.invariants.at("energy_drift") * total, 1e6 / 0.91 * 0.0025 * 0.0025 / 8);
  EXPECT_GT(total, 100);
}

TEST(PlasticBody, PerfectPlasticityFlowsAtTheYieldStress) {
  const Folder folder;
  const auto problem =
      plastic_problem(folder, "plane strain", "load_steps = 20", perfect, tension("0.2*t"));
  const auto result = run(problem, 1.0 / 3, {{"element", "P2"}}, 0.2);
  EXPECT_NEAR(result.quantities.at("tau_eq"), 2e3, 1e-8 * 2e3);
  // tau_xx = 2/sqrt(3) tau_y once the elastic out-of-plane strain has relaxed; over F_xx = 1.2.
  EXPECT_NEAR(result.quantities.at("pull_x"), 2e3 * 2 / std::sqrt(3) / 1.2, 1e-3 * 2e3);
}

TEST(PlasticBody, OneHugeStep) {
  // 60 % in one step, some 200 yield strains, from a non-uniform body: the ends are clamped.
  const std::string rest = R"toml(
[[boundary]]
group = "x0"
kind = "fixed"
[[boundary]]
group = "x1"
kind = "displacement"
value = ["0.6*t", "0"]
[[quantity]]
name = "pull"
kind = "reaction"
group = "x1"
)toml";
  double force[2];
  int k = 0;
  for (const char* steps : {"load_steps = 1", "load_steps = 60"}) {
    const Folder folder;
    const auto problem = plastic_problem(folder, "plane strain", steps, hardening, rest);
    const auto result = run(problem, 0.25, {{"element", "P2"}});
    EXPECT_EQ(result.t_end, 1);
    force[k++] = result.quantities.at("pull_x");
  }
  // The return is first order in the step where the direction of flow turns.
  EXPECT_NEAR(force[0], force[1], 0.02 * force[1]);
}

TEST(PlasticBody, TinySteps) {
  // Strains of 1e-12, of which F = I + Grad u keeps four digits.
  const Folder folder;
  const auto problem =
      plastic_problem(folder, "plane strain", "load_steps = 3", hardening, tension("1e-12*t"));
  const auto result = run(problem, 0.25, {{"element", "P2"}}, 0.2);
  EXPECT_NEAR(result.quantities.at("pull_x"), 1e6 / 0.91 * 1e-12, 1e-3 * 1e-6);
  EXPECT_EQ(result.quantities.at("eps_p"), 0);
}

TEST(PlasticBody, StepThatFailsLeavesNoTrace) {
  // With 3 iterations a step is halved again and again; the answer is that of many small steps.
  const std::string rest = tension("0.05*t");
  const Folder folder;
  const auto problem =
      plastic_problem(folder, "plane strain", "load_steps = 1", hardening, rest);
  const auto halved = run(problem, 0.5, {{"element", "Q1"}, {"max_iterations", "3"}});
  const auto whole = run(problem, 0.5, {{"element", "Q1"}});
  EXPECT_GT(halved.steps, whole.steps);
  EXPECT_NEAR(halved.quantities.at("eps_p"), whole.quantities.at("eps_p"), 1e-3 * 0.05);
  EXPECT_GT(halved.quantities.at("eps_p"), 0.05);
}

/// Residuals of plain Newton iterations in one plastic step from a state that flows already.
std::vector<double> residuals(const std::string& measure) {
  const Folder folder;
  const auto problem =
      plastic_problem(folder, "plane strain", "load_steps = 1", hardening, tension("0.05*t"));
  scene::RunRequest request;
  request.h = 0.25;
  request.perturb = 0.2;
  request.settings = {{"element", "P2"}, {"yield_measure", measure}};
  const fem::Options options = fem::read_options(problem, request);
  const fem::Discretisation<2> body(problem, request, options);
  const fem::Elastoplastic<2> law(problem.material, options.yield_measure);
  fem::PlasticPoints<2> points(law);
  const fem::ElementTable<2, fem::PlasticPoints<2>> table(body, points, 1);
  std::vector<char> given(body.dofs(), 0);
  for (std::size_t n = 0; n < body.mesh().nodes.size(); ++n) {
    const Vec3& X = body.mesh().nodes[n];
    if (X.x() < 1e-9 || X.x() > 1 - 1e-9) {  // clamped ends: the field is not uniform
      for (int i = 0; i < 2; ++i) given[body.dof(static_cast<Index>(n), i)] = 1;
    }
  }
  fem::LinearSolver linear(table.sparsity(), given, true, 0);
  dealii::Vector<double> u(body.dofs()), f(body.dofs()), jump(body.dofs()), du, r;
  std::vector<double> norms;
  for (int step = 0; step < 2; ++step) {
    for (std::size_t n = 0; n < body.mesh().nodes.size(); ++n) {
      if (body.mesh().nodes[n].x() > 1 - 1e-9) jump[body.dof(static_cast<Index>(n), 0)] = 0.01;
    }
    norms.clear();
    for (int k = 0; k < 12; ++k) {
      EXPECT_EQ(table.tangent(u, f, linear.matrix()), -1);
      r = f;
      r *= -1;
      for (unsigned i = 0; i < given.size(); ++i) {
        if (given[i] != 0) r[i] = 0;
      }
      if (k > 0) norms.push_back(r.l2_norm() / table.element_force_norm());
      linear.ready();
      linear.solve(r, jump, du, 0, 0);
      u += du;
      jump = 0;
    }
    points.commit();
  }
  return norms;
}

TEST(PlasticBody, NewtonConvergesQuadratically) {
  for (const char* measure : {"kirchhoff", "cauchy"}) {
    const auto r = residuals(measure);
    int checked = 0;
    for (std::size_t k = 0; k + 1 < r.size(); ++k) {
      if (r[k] > 1e-2 || r[k] < 1e-7) continue;  // not yet, and round-off
      // Quadratic with the constant of the first such pair: of order the inverse yield strain.
      EXPECT_LE(r[k + 1], 1e3 * r[k] * r[k] + 1e-14) << measure << ' ' << k << ' ' << r[k];
      ++checked;
    }
    EXPECT_GE(checked, 1) << measure;
    EXPECT_LE(r.back(), 1e-13);
  }
}

}  // namespace
}  // namespace concord::fem_test
