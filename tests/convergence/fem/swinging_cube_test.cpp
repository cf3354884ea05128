// The swinging cube (DEL-2): order 3 of Q2 under the explicit integrator, order 2 of Q1, and
// the implicit simplices. The exact solution is that of linear elasticity, so the amplitude is
// made small enough for the difference between the theories to vanish beside the elements'
// error.

#include "fem_scene.hpp"
#include "fit.hpp"

#include "scene/norms.hpp"

namespace concord::fem_test {
namespace {

double error(const std::string& amplitude, int n,
             const std::map<std::string, std::string>& set) {
  const auto problem = scene::read_problem("swinging_cube", {{"parameters.U", amplitude}});
  auto result = run(problem, 1.0 / n, set);
  scene::add_exact_errors(problem, result);
  const double e = result.errors.at("displacement_l2");
  fmt::print("  {} U {:8s} n {:2d}  steps {:4d}  dt {:.2e}  L2 {:.4e}  setup {:.2f} s  loop "
             "{:.2f} s\n",
             set.at("element"), amplitude, n, result.steps, result.dt, e, result.setup_s,
             result.wall_s);
  return e;
}

double order(const std::string& amplitude, const std::vector<int>& levels,
             const std::map<std::string, std::string>& set) {
  std::vector<double> h, e;
  for (const int n : levels) {
    h.push_back(1.0 / n);
    e.push_back(error(amplitude, n, set));
  }
  return fitted_order(h, e);
}

TEST(SwingingCube, QuadraticHexahedraConvergeWithThirdOrder) {
  const double slope = order("0.1 um", {2, 4, 8}, {{"element", "Q2"}, {"dt_factor", "0.4"}});
  EXPECT_GE(slope, 2.8);
  EXPECT_LE(slope, 3.5);
}

TEST(SwingingCube, LinearHexahedraConvergeWithSecondOrder) {
  const double slope = order("0.1 um", {4, 8, 16}, {{"element", "Q1"}});
  EXPECT_NEAR(slope, 2, 0.15);
}

TEST(SwingingCube, ImplicitTetrahedraConverge) {
  EXPECT_NEAR(order("0.1 um", {2, 4, 8}, {{"element", "P1"}, {"courant", "0.25"}}), 2, 0.3);
  EXPECT_NEAR(order("0.1 um", {2, 4, 8}, {{"element", "P2"}, {"courant", "0.25"}}), 3, 0.3);
}

TEST(SwingingCube, AmplitudeSetsTheFloor) {
  const std::map<std::string, std::string> set{{"element", "Q2"}, {"dt_factor", "0.4"}};
  const double large = error("0.5 mm", 8, set), small = error("0.1 um", 8, set);
  EXPECT_GT(large, 1.5 * small);
}

}  // namespace
}  // namespace concord::fem_test
