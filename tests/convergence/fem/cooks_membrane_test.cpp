// Cook's membrane at finite strain, Q1, plane strain: mu 422.5 kPa, nu 0.3, dead shear load of
// 1 N on the 16 mm edge, 1 mm thick; vertical displacement of the middle of that edge, (48, 52)
// mm.
//
// The published column belongs to the law of deal.II's code gallery ("Quasi-static
// finite-strain compressible elasticity", W = mu/2 (J^-2/3 tr C - 3) + kappa/4 (J^2 - 1 - 2 ln
// J)), 2 x 2 Gauss points: `law = split-neo-hookean`. With the law of the Delaunay paper, Eq.
// (51), the same elements give other digits, reproduced here from an independent script.

#include "fem_scene.hpp"

namespace concord::fem_test {
namespace {

const std::string cook_geo = R"toml(DefineConstant[ h = 0.011, structured = 1 ];
n = Round(0.044/h);
Point(1) = {0, 0, 0, h}; Point(2) = {0.048, 0.044, 0, h}; Point(3) = {0.048, 0.060, 0, h};
Point(4) = {0, 0.044, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve "*" = n + 1; Transfinite Surface {1};
Physical Curve("clamped") = {4}; Physical Curve("loaded") = {2}; Physical Surface("body") = {1};
)toml";

const std::string cook_scene = R"toml(title = "Cook's membrane"
source = "deal.II code gallery"
dimension = "plane strain"
geometry = "body.geo"
reference_length = "44 mm"
thickness = "1 mm"
static = true
load_steps = 4
[material]
model = "neo-hookean"
density = "1000 kg/m^3"
shear_modulus = "422.5 kPa"
poissons_ratio = 0.3
[[boundary]]
group = "clamped"
kind = "fixed"
[[boundary]]
group = "loaded"
kind = "traction"
value = ["0", "t/(0.016*0.001)"]
[[quantity]]
name = "tip"
kind = "point"
at = ["48 mm", "52 mm"]
)toml";

double tip_mm(const scene::Problem& problem, int n, const std::string& law,
              const std::string& element = "Q1") {
  const auto result = run(problem, 0.044 / n, {{"element", element}, {"law", law}});
  const double tip = 1e3 * result.quantities.at("tip_y");
  fmt::print("  {} {:20s} n {:3d}  tip {:.4f} mm  newton {}  {:.2f} s\n", element, law, n, tip,
             result.steps, result.wall_s);
  return tip;
}

TEST(CooksMembrane, ReproducesThePublishedColumn) {
  const Folder folder;
  const auto problem = make_problem(folder, cook_geo, cook_scene);
  EXPECT_NEAR(tip_mm(problem, 2, "split-neo-hookean"), 8.638, 5.1e-4);
  EXPECT_NEAR(tip_mm(problem, 4, "split-neo-hookean"), 12.07, 5.1e-3);
  EXPECT_NEAR(tip_mm(problem, 8, "split-neo-hookean"), 13.86, 5.1e-3);
  EXPECT_NEAR(tip_mm(problem, 16, "split-neo-hookean"), 14.49, 5.1e-3);
  EXPECT_NEAR(tip_mm(problem, 32, "split-neo-hookean"), 14.67, 5.1e-3);
  EXPECT_NEAR(tip_mm(problem, 64, "split-neo-hookean"), 14.72, 5.1e-3);
}

TEST(CooksMembrane, LawOfTheDelaunayPaper) {
  const Folder folder;
  const auto problem = make_problem(folder, cook_geo, cook_scene);
  EXPECT_NEAR(tip_mm(problem, 2, "scene"), 8.6815, 5.1e-5);
  EXPECT_NEAR(tip_mm(problem, 4, "scene"), 12.0209, 5.1e-5);
  EXPECT_NEAR(tip_mm(problem, 8, "scene"), 13.7006, 5.1e-5);
}

TEST(CooksMembrane, ElementsMeetAtTheSameTip) {
  const Folder folder;
  const auto problem = make_problem(folder, cook_geo, cook_scene);
  const double Q2 = tip_mm(problem, 16, "scene", "Q2"), P2 = tip_mm(problem, 16, "scene", "P2");
  EXPECT_NEAR(Q2, P2, 0.01);  // measured: 14.5050 and 14.5115 mm
  // Q1 comes from the stiff side, and halving h more than halves what is missing.
  const double coarse = tip_mm(problem, 16, "scene"), fine = tip_mm(problem, 32, "scene");
  EXPECT_LT(coarse, fine);
  EXPECT_LT(fine, Q2);
  EXPECT_GT((Q2 - coarse) / (Q2 - fine), 2);
}

}  // namespace
}  // namespace concord::fem_test
