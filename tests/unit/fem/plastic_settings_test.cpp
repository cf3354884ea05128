// What plastic scenes ask of the settings of method `fem`, and what is refused.

#include "plastic_scene.hpp"

namespace concord::fem_test {
namespace {

TEST(PlasticBody, ThreePointRuleIsTheDefaultOfP2InThePlane) {
  const Folder folder;
  const auto problem =
      plastic_problem(folder, "plane strain", "load_steps = 1", hardening, tension("0.05*t"));
  const auto elastic =
      make_problem(folder, square_geo(), scene_text("plane strain", "static = true", R"toml(
[[boundary]]
group = "sides"
kind = "fixed"
)toml"));
  EXPECT_EQ(run(problem, 0.5, {{"element", "P2"}}).notes.at("quadrature"), "3 points");
  EXPECT_EQ(run(problem, 0.5, {{"element", "Q2"}}).notes.count("quadrature"), 0u);
  EXPECT_EQ(run(elastic, 0.5, {{"element", "P2"}}).notes.count("quadrature"), 0u);
  EXPECT_EQ(run(elastic, 0.5, {{"element", "P2"}, {"quadrature", "3"}}).notes.at("quadrature"),
            "3 points");
  EXPECT_THROW(run(elastic, 0.5, {{"element", "Q2"}, {"quadrature", "3"}}), InputError);
}

TEST(PlasticBody, DynamicsAreRefused) {
  const Folder folder;
  const std::string rest = hardening + R"toml(
[[boundary]]
group = "x0"
kind = "fixed"
)toml";
  const auto dynamic =
      make_problem(folder, square_geo(),
                   scene_text("plane strain", "end_time = \"0.1 s\"", rest, "j2-hencky"));
  for (const char* solver : {"auto", "explicit", "newmark", "static"}) {
    try {
      run(dynamic, 0.5, {{"element", "Q2"}, {"solver", solver}});
      ADD_FAILURE() << solver;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("quasi-statically"), std::string::npos)
          << error.what();
    }
  }
  const auto still = make_problem(
      folder, square_geo(), scene_text("plane strain", "static = true", rest, "j2-hencky"));
  EXPECT_THROW(run(still, 0.5, {{"solver", "newmark"}}), InputError);
  EXPECT_THROW(run(still, 0.5, {{"law", "split-neo-hookean"}}), InputError);
}

TEST(PlasticBody, KirchhoffMisesOfElasticScenesIsJTimesCauchy) {
  const Folder folder;
  const auto problem =
      make_problem(folder, square_geo(), scene_text("plane strain", "static = true", R"toml(
[exact]
displacement = ["0.2*X", "0.1*Y", "0"]
[[boundary]]
group = "sides"
kind = "displacement"
value = "exact"
[[quantity]]
name = "tau_eq"
kind = "maximum"
field = "kirchhoff_mises"
[[quantity]]
name = "sigma_eq"
kind = "maximum"
field = "von_mises"
)toml"));
  const auto result = run(problem, 0.5, {{"element", "P2"}});
  EXPECT_NEAR(result.quantities.at("tau_eq"), 1.2 * 1.1 * result.quantities.at("sigma_eq"),
              1e-10 * 1e6);
  EXPECT_GT(result.quantities.at("sigma_eq"), 1e4);
  EXPECT_EQ(result.quantities.count("gauss_plastic_strain_max"), 0u);
}

}  // namespace
}  // namespace concord::fem_test
