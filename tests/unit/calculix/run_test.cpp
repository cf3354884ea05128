// Method `calculix` from scene to quantities: against closed forms where CalculiX is installed,
// and what a missing or failing program leads to.

#include "scene/method.hpp"
#include "scene/norms.hpp"
#include "tests/unit/calculix/block.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace concord::calculix_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

scene::Result run(const scene::Problem& problem, double h, const fs::path& out = {},
                  std::map<std::string, std::string> settings = {}) {
  scene::RunRequest request;
  request.h = h;
  request.out = out;
  request.settings = std::move(settings);
  scene::Result result;
  scene::MethodRegistry::instance().find("calculix").run(problem, request, result);
  return result;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class WithCalculix : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v ccx > /dev/null") != 0)
      GTEST_SKIP() << "ccx is not installed (package calculix-ccx)";
  }
};

/// PATH for the life of this.
class Path {
 public:
  explicit Path(const std::string& path) : m_old(std::getenv("PATH")) {
    setenv("PATH", path.c_str(), 1);
  }
  ~Path() { setenv("PATH", m_old.c_str(), 1); }
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;

 private:
  std::string m_old;
};

// CalculiX prints seven digits.
constexpr double printed = 2e-6;
constexpr double K = 164.21e9, mu = 80.19e9;  // of metal()

/// Cauchy stress of CalculiX's elastic law beside plasticity with the principal stretches
/// given: W = K/2 ((J^2 - 1)/2 - ln J) + mu/2 (J^(-2/3) tr b - 3).
Vec3 cauchy(const Vec3& stretch) {
  const double J = stretch.prod();
  const Vec3 b = stretch.cwiseProduct(stretch) * std::pow(J, -2.0 / 3);
  return Vec3::Constant(K / 2 * (J - 1 / J)) + mu / J * (b - Vec3::Constant(b.mean()));
}

TEST_F(WithCalculix, ElasticBlockIsStVenantKirchhoffAndReactionsBalance) {
  Block block{.material = elastic(), .motion = "0.2*t"};
  block.top += "thickness = \"0.5 m\"\n";
  const auto scene = block.scene();
  const scene::Result result = run(scene.read(), 0.5);
  // x1 is free: S_xx = 0, S_yy = E/(1 - nu^2) E_yy, P_yy = F_yy S_yy.
  const double E_yy = (1.2 * 1.2 - 1) / 2, force = 1.2 * 1e6 / (1 - 0.09) * E_yy * 0.5;
  const double F_xx = std::sqrt(1 - 2 * 0.3 / 0.7 * E_yy);
  EXPECT_NEAR(result.quantities.at("top_y"), force, printed * force);
  EXPECT_NEAR(result.quantities.at("bottom_y"), -force, printed * force);
  EXPECT_NEAR(result.quantities.at("top_x"), 0, printed * force);
  EXPECT_NEAR(result.quantities.at("side_x"), F_xx - 1, printed);
  EXPECT_EQ(result.t_end, 1);
  EXPECT_EQ(result.particles, 25);
  EXPECT_EQ(result.unknowns, 50 - 15);
}

TEST_F(WithCalculix, AffineMotionOfAnUnstructuredCubeIsReproduced) {
  Block block{.dimension = "3D", .material = elastic(), .motion = "0.2*t"};
  block.top += "layout = \"unstructured\"\n";
  block.more = R"([[quantity]]
name = "inside"
kind = "point"
at = ["0.3 m", "0.6 m", "0.2 m"]
[exact]
displacement = ["sqrt(1 - 0.6*0.5*((1 + 0.2*t)^2 - 1))*X - X", "0.2*t*Y",
                "sqrt(1 - 0.6*0.5*((1 + 0.2*t)^2 - 1))*Z - Z"]
)";
  const auto scene = block.scene();
  const scene::Problem problem = scene.read();
  scene::Result result = run(problem, 0.5);
  const double E_yy = 0.22;
  // Uniaxial: S_yy = E E_yy.
  EXPECT_NEAR(result.quantities.at("top_y"), 1.2e6 * E_yy, printed * 1.2e6 * E_yy);
  EXPECT_NEAR(result.quantities.at("inside_y"), 0.12, 1e-7);
  scene::add_exact_errors(problem, result);
  EXPECT_LT(result.errors.at("displacement_l2"), 1e-6);
  EXPECT_LT(result.errors.at("gradient_l2"), 1e-5);
}

TEST_F(WithCalculix, BelowYieldItsMetalIsSplitNeoHookean) {
  Block block{.material = metal("1e6 MPa", "1e6 MPa"), .motion = "0.1*t", .held = true};
  const auto scene = block.scene();
  const scene::Result result = run(scene.read(), 1);
  // Cross-section of 1 m^2, held: the force is the Cauchy stress.
  const double force = cauchy({1, 1.1, 1}).y();
  EXPECT_NEAR(result.quantities.at("top_y"), force, 1e-5 * force);
  EXPECT_NEAR(result.quantities.at("bottom_y"), -force, 1e-5 * force);
  EXPECT_EQ(result.quantities.at("gauss_plastic_strain_max"), 0);
  // Kirchhoff stress linear in ln(1.1), the law of the paper, is another one: by 4 % here.
  const double hencky = (K + 4.0 / 3 * mu) * std::log(1.1) / 1.1 * 1.1;
  EXPECT_GT(std::abs(hencky / force - 1), 0.01);
}

TEST_F(WithCalculix, SmallStrainsGiveHookesLaw) {
  Block block{.material = metal("1e6 MPa", "1e6 MPa"), .motion = "1e-5*t", .held = true};
  const auto scene = block.scene();
  const scene::Result result = run(scene.read(), 1);
  const double force = (K + 4.0 / 3 * mu) * 1e-5;
  EXPECT_NEAR(result.quantities.at("top_y"), force, 3e-5 * force);
}

double flow_stress(double eps_p) {  // of metal()
  return 450e6 + 129e6 * eps_p + 265e6 * (1 - std::exp(-16.93 * eps_p));
}

TEST_F(WithCalculix, UniaxialBarYieldsOnTheCauchyStress) {
  Block block{.dimension = "3D", .material = metal(), .motion = "0.2*t"};
  block.top = "static = true\nload_steps = 50\n";
  const auto scene = block.scene();
  const scene::Result result = run(scene.read(), 1);
  // Cauchy stress s = tau_y(eps_p) on a cross-section of J/1.2; K/2 (J - 1/J) = s/3. A yield
  // limit on the Kirchhoff stress would give 1/J of it, 1.3e-3 less.
  const double eps_p = result.quantities.at("gauss_plastic_strain_max");
  const double s = flow_stress(eps_p), p = s / 3 / K, J = p + std::sqrt(p * p + 1);
  const double force = s * J / 1.2;
  EXPECT_NEAR(result.quantities.at("top_y"), force, 1e-5 * force);  // table: 7.5e-6
  EXPECT_NEAR(result.quantities.at("bottom_y"), -force, 1e-5 * force);
  // With exponential flow eps_p = ln(1.2/elastic axial stretch); CalculiX's rule departs from
  // that by about s/(3 mu) = 2.7e-3 and by 1.7e-3 for 50 steps (README.md).
  const double elastic = s / (9 * K) + s / (3 * mu);
  const double logarithmic = std::log(1.2) - elastic;
  EXPECT_NEAR(eps_p, logarithmic, 6e-3 * logarithmic);
  EXPECT_GT(eps_p, logarithmic);
}

TEST_F(WithCalculix, PlaneStrainFlowOfAPerfectlyPlasticBlock) {
  Block block{.material = metal("450 MPa", "450 MPa", "0 MPa"), .motion = "0.1*t"};
  block.top = "static = true\nload_steps = 20\n";
  block.more = R"([[quantity]]
name = "strain"
kind = "maximum"
field = "plastic_strain"
[[quantity]]
name = "stress"
kind = "maximum"
field = "von_mises"
)";
  const auto scene = block.scene();
  const fs::path out = scene.folder / "out";
  const scene::Result result = run(scene.read(), 0.5, out);
  // Developed flow: s_yy = 2 s_0/sqrt(3), s_zz = s_yy/2, s_xx = 0; elastic volume change from
  // the mean stress, K/2 (J - 1/J) = s_0/sqrt(3); plastic rate 2/sqrt(3) of the axial one.
  const double s_yy = 2 * 450e6 / std::sqrt(3.0);
  const double p = s_yy / 2 / K, J = p + std::sqrt(p * p + 1);
  const double force = s_yy * J / 1.1;
  // CalculiX's flow rule lets s_zz differ from s_yy/2 by about (s_0/mu)^2 = 3e-5.
  EXPECT_NEAR(result.quantities.at("top_y"), force, 3e-5 * force);
  EXPECT_NEAR(result.quantities.at("stress"), 450e6, 5e-5 * 450e6);  // extrapolated by CalculiX
  EXPECT_NEAR(result.quantities.at("strain"), result.quantities.at("gauss_plastic_strain_max"),
              5e-5);
  // From row 10 on (strain .05) the flow has developed.
  std::istringstream rows(text_of(out / "history.csv"));
  std::vector<std::vector<double>> table;
  std::string line;
  ASSERT_TRUE(std::getline(rows, line));
  EXPECT_EQ(line,
            "t_s,bottom_x_N,bottom_y_N,top_x_N,top_y_N,side_x_m,side_y_m,strain,stress_Pa,"
            "gauss_plastic_strain_max");
  while (std::getline(rows, line)) {
    table.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');)
      table.back().push_back(std::atof(field.c_str()));
  }
  ASSERT_EQ(table.size(), 21u);
  EXPECT_EQ(table[0][9], 0);
  const double grown = table[20][9] - table[10][9];
  EXPECT_NEAR(grown, 2 / std::sqrt(3.0) * std::log(1.1 / 1.05), 1e-6);
  EXPECT_TRUE(fs::exists(out / "calculix" / "job.inp"));
  EXPECT_TRUE(fs::exists(out / "fields_0000.hdf"));
  EXPECT_FALSE(fs::exists(out / "calculix" / "job.frd"));
}

TEST_F(WithCalculix, DivergenceEndsWithItsMessageAndReadableResults) {
  // After t = 0.5 one end of the top goes down into the bottom, the other up.
  Block block{.material = metal(), .motion = "0.1*t + 10*(X - 0.5)*max(t - 0.5, 0)"};
  block.top = "static = true\nload_steps = 2\n";
  const auto scene = block.scene();
  const fs::path out = scene.folder / "out";
  try {
    run(scene.read(), 0.5, out);
    ADD_FAILURE() << "no error";
  } catch (const SolveError& error) {
    EXPECT_THAT(error.what(), HasSubstr("1 of 2 load steps done"));
    EXPECT_THAT(error.what(), HasSubstr("*ERROR: increment size smaller than minimum"));
    EXPECT_EQ(error.step(), 1);
    EXPECT_GE(error.time(), 0.5);
    EXPECT_LT(error.time(), 1);
  }
  EXPECT_THAT(text_of(out / "history.csv"), HasSubstr("\n0.5,"));
  EXPECT_TRUE(fs::exists(out / "calculix" / "job.log"));
}

TEST_F(WithCalculix, ATurnedOverBodyThatCalculixLetsPassIsAnError) {
  const Block block{.material = metal(), .motion = "-1.5*t"};
  const auto scene = block.scene();
  const fs::path out = scene.folder / "out";
  try {
    run(scene.read(), 1, out);
    ADD_FAILURE() << "no error";
  } catch (const SolveError& error) {
    EXPECT_EQ(error.quantity(), "det F");
    EXPECT_NEAR(error.time(), 0.75, 1e-12);
  }
  EXPECT_THAT(text_of(out / "history.csv"), HasSubstr("\n0.5,"));
}

TEST(Calculix, SaysWhichPackageIsMissing) {
  const Block block{.material = elastic(), .motion = "0.1*t"};
  const auto scene = block.scene();
  const scene::Problem problem = scene.read();
  const Path nothing((scene.folder / "nothing").string());
  try {
    run(problem, 1);
    ADD_FAILURE() << "no error";
  } catch (const SolveError& error) {
    EXPECT_THAT(error.what(), HasSubstr("calculix-ccx"));
  }
}

TEST(Calculix, ProgramThatFailsIsQuoted) {
  const Block block{.material = elastic(), .motion = "0.1*t"};
  const auto scene = block.scene();
  const scene::Problem problem = scene.read();
  const fs::path program = scene.folder / "ccx";
  test::write_text(program, "#!/bin/sh\necho '*ERROR: made up for a test'\nexit 201\n");
  fs::permissions(program, fs::perms::owner_all);
  const Path here(scene.folder.string());
  try {
    run(problem, 1);
    ADD_FAILURE() << "no error";
  } catch (const SolveError& error) {
    EXPECT_THAT(error.what(), HasSubstr("exit status 201"));
    EXPECT_THAT(error.what(), HasSubstr("*ERROR: made up for a test"));
    EXPECT_THAT(error.what(), HasSubstr("0 of 4 load steps"));
  }
}

void expect_refused(const std::string& scene_text, const std::string& key,
                    const std::string& allowed) {
  const test::ScratchScene scene(scene_text);
  const scene::Problem problem = scene.read();
  try {
    run(problem, 1);
    ADD_FAILURE() << "no error for " << key;
  } catch (const InputError& error) {
    EXPECT_THAT(error.key(), HasSubstr(key));
    EXPECT_THAT(error.allowed(), HasSubstr(allowed));
  }
}

TEST(Calculix, RefusesWhatItCannotDo) {
  Block block{.material = elastic(), .motion = "0.1*t"};
  const std::string good = block.text();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  expect_refused(with("st-venant-kirchhoff", "neo-hookean"), "material.model", "j2-hencky");
  expect_refused(with("plane strain", "plane stress"), "dimension", "plane strain");
  expect_refused(with("static = true\nload_steps = 4\n", "end_time = \"1 s\"\n"), "static",
                 "static = true");
  block.more = "[[boundary]]\ngroup = \"x1\"\nkind = \"traction\"\nvalue = [\"1\", \"0\"]\n";
  expect_refused(block.text(), "boundary.kind", "displacement");
  block.more = "[[quantity]]\nname = \"v\"\nkind = \"maximum\"\nfield = \"unbalanced_force\"\n";
  expect_refused(block.text(), "quantity.field", "von_mises");
}

TEST(Calculix, RefusesPerturbationAndWrongSettings) {
  const Block block{.material = elastic(), .motion = "0.1*t"};
  const auto scene = block.scene();
  const scene::Problem problem = scene.read();
  scene::RunRequest request;
  request.h = 1;
  request.perturb = 0.1;
  scene::Result result;
  const scene::Method& method = scene::MethodRegistry::instance().find("calculix");
  EXPECT_THROW(method.run(problem, request, result), InputError);
  EXPECT_THROW(run(problem, 1, {}, {{"hardening_points", "201"}}), InputError);
  EXPECT_THROW(run(problem, 1, {}, {{"element", "Q2"}}), InputError);
}

}  // namespace
}  // namespace concord::calculix_test
