// Patch tests at finite strain on perturbed meshes: an affine field is reproduced to round-off
// by every element, from prescribed displacements and from dead loads.

#include "fem_scene.hpp"

#include <cmath>
#include <tuple>

namespace concord::fem_test {
namespace {

const std::string affine_2d = R"(["0.2*X + 0.1*Y", "-0.15*X + 0.1*Y", "0"])";
const std::string affine_3d =
    R"(["0.2*X + 0.1*Y - 0.05*Z", "-0.15*X + 0.1*Y + 0.1*Z", "0.05*X - 0.2*Z"])";

Mat3 affine_gradient(bool solid) {
  Mat3 H;
  H << 0.2, 0.1, -0.05, -0.15, 0.1, 0.1, 0.05, 0, -0.2;
  if (!solid) {
    H.row(2).setZero();
    H.col(2).setZero();
  }
  return H;
}

class Patch : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const std::string m_dimension = std::get<0>(GetParam()), m_element = std::get<1>(GetParam());
  const bool m_solid = m_dimension == "3D";
  Folder m_folder;

  scene::Result solve(const std::string& rest, const std::string& model = "neo-hookean") {
    const auto problem =
        make_problem(m_folder, geo_of(m_dimension),
                     scene_text(m_dimension, "static = true\nload_steps = 2", rest, model));
    return run(problem, 1.0 / 3, {{"element", m_element}}, 0.2);
  }
  std::string exact() const {
    return "[exact]\ndisplacement = " + (m_solid ? affine_3d : affine_2d) + "\n";
  }
  void expect_affine(const scene::Result& result, double bound) const {
    const Mat3 H = affine_gradient(m_solid);
    ASSERT_FALSE(result.samples.X.empty());
    double worst = 0, volume = 0;
    for (std::size_t k = 0; k < result.samples.X.size(); ++k) {
      worst = std::max(worst, (result.samples.u[k] - H * result.samples.X[k]).norm());
      Mat3 difference = result.samples.F[k] - Mat3::Identity() - H;
      if (!m_solid) difference(2, 2) = 0;
      worst = std::max(worst, difference.norm());
      volume += result.samples.weight[k];
    }
    EXPECT_LE(worst, bound);
    EXPECT_NEAR(volume, 1, 1e-13);
  }
};

TEST_P(Patch, FromPrescribedSides) {
  const auto result = solve(exact() + R"(
[[boundary]]
group = "sides"
kind = "displacement"
value = "exact"
[[quantity]]
name = "unbalanced"
kind = "maximum"
field = "unbalanced_force"
where = "interior"
)");
  expect_affine(result, 1e-12);
  EXPECT_LE(result.quantities.at("unbalanced"), 1e-9 * 1e6);  // of E times the face area
}

TEST_P(Patch, FromDeadLoads) {
  std::string rest = exact();
  for (const char* side : {"x1", "y1", "z0", "z1"}) {
    if (side[0] == 'z' && !m_solid) continue;
    rest += fmt::format(
        "[[boundary]]\ngroup = \"{}\"\nkind = \"traction\"\nvalue = \"exact\"\n", side);
  }
  for (const char* side : {"x0", "y0"}) {
    rest += fmt::format(
        "[[boundary]]\ngroup = \"{}\"\nkind = \"displacement\"\nvalue = \"exact\"\n", side);
  }
  expect_affine(solve(rest), 1e-10);
}

TEST_P(Patch, FromPrescribedSidesStVenantKirchhoff) {
  const auto result = solve(
      exact() + "[[boundary]]\ngroup = \"sides\"\nkind = \"displacement\"\nvalue = \"exact\"\n",
      "st-venant-kirchhoff");
  expect_affine(result, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(All, Patch,
                         testing::Combine(testing::Values("3D", "plane strain", "plane stress"),
                                          testing::Values("P1", "P2", "Q1", "Q2")),
                         [](const auto& info) {
                           std::string name = std::get<0>(info.param) + std::get<1>(info.param);
                           std::erase(name, ' ');
                           return name;
                         });

TEST(PatchWholeBody, EverythingPrescribedNeedsNoSolve) {
  const Folder folder;
  const auto problem = make_problem(
      folder, cube_geo(),
      scene_text("3D", "static = true", "[exact]\ndisplacement = " + affine_3d + R"(
[[boundary]]
group = "body"
kind = "displacement"
value = "exact"
[[quantity]]
name = "unbalanced"
kind = "maximum"
field = "unbalanced_force"
where = "interior"
)"));
  const auto result = run(problem, 1.0 / 3, {{"element", "Q2"}}, 0.2);
  EXPECT_EQ(result.unknowns, 0);
  EXPECT_LE(result.quantities.at("unbalanced"), 1e-9);  // N, beside side forces of about 3e5 N
}

TEST(PlaneStress, UniaxialTensionFindsBothTransverseStretches) {
  // Solve P22 = P33 = 0 for the transverse stretch q at stretch s by bisection; P11 is the
  // load.
  const double lambda = 1e6 * 0.3 / (1.3 * 0.4), mu = 1e6 / 2.6, s = 1.4;
  double low = 0.5, high = 1;
  for (int k = 0; k < 200; ++k) {
    const double q = 0.5 * (low + high);
    (lambda * std::log(s * q * q) - mu + mu * q * q > 0 ? high : low) = q;
  }
  const double load = (lambda * std::log(s * low * low) - mu) / s + mu * s;
  const Folder folder;
  const auto problem =
      make_problem(folder, square_geo(),
                   scene_text("plane stress", "static = true\nthickness = \"0.1 m\"",
                              fmt::format(R"(
[[boundary]]
group = "x0"
kind = "symmetric"
[[boundary]]
group = "y0"
kind = "symmetric"
[[boundary]]
group = "x1"
kind = "traction"
value = ["{:.17g}*t", "0", "0"]
[[quantity]]
name = "pull"
kind = "reaction"
group = "x0"
)",
                                          load)));
  for (const char* element : {"P1", "P2", "Q1", "Q2"}) {
    const auto result = run(problem, 0.5, {{"element", element}});
    for (const Mat3& F : result.samples.F) {
      EXPECT_NEAR(F(0, 0), s, 1e-11);
      EXPECT_NEAR(F(1, 1), low, 1e-11);
      EXPECT_NEAR(F(2, 2), low, 1e-11);
    }
    EXPECT_NEAR(result.quantities.at("pull_x"), -0.1 * load, 1e-9 * load);
  }
}

}  // namespace
}  // namespace concord::fem_test
