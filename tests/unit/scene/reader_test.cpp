#include "scene/geometry.hpp"
#include "scene/material.hpp"
#include "tests/unit/scene/scratch_scene.hpp"

#include <Eigen/LU>
#include <cmath>
#include <gtest/gtest.h>
#include <regex>

using namespace concord;
using namespace concord::scene;
using concord::test::plane_scene;
using concord::test::ScratchScene;

TEST(Library, EverySceneReadsAndMeshes) {
  const auto names = library_scenes();
  EXPECT_GE(names.size(), 5u);
  for (const std::string& name : names) {
    const Problem problem = read_problem(name);
    EXPECT_EQ(problem.name, name);
    EXPECT_FALSE(problem.source.empty()) << name;
    EXPECT_TRUE(std::filesystem::exists(problem.file.parent_path() / "README.md")) << name;
    const Mesh mesh = make_mesh(
        problem, {problem.reference_length / 4, CellShape::simplex, 1, problem.layout});
    EXPECT_GT(mesh_volume(mesh), 0) << name;
  }
}

TEST(SwingingCube, StatesThePapersProblem) {
  const Problem p = read_problem("swinging_cube");
  EXPECT_EQ(p.dim(), 3);
  EXPECT_EQ(p.end_time, 2e-3);
  EXPECT_DOUBLE_EQ(p.material.mu, 17e6 / 2.6);
  const double cs = std::sqrt(17e6 / 2.6 / 1100), w = std::sqrt(3.0) * M_PI * cs / 2;
  const Vec3 X(0.3, 0.6, 0.8);
  const double k = M_PI / 2, t = 1.1e-3;
  const Vec3 u = (*p.exact_displacement)(X, t);
  EXPECT_NEAR(u[2],
              -1e-3 * std::cos(w * t) * std::cos(k * .3) * std::cos(k * .6) * std::sin(k * .8),
              1e-17);
  EXPECT_EQ((*p.initial_displacement)(X, 0), (*p.exact_displacement)(X, 0));
  // The velocity is the time derivative: central difference, error (w dt)^2/6.
  const double dt = 1e-7;
  const Vec3 v =
      ((*p.exact_displacement)(X, t + dt) - (*p.exact_displacement)(X, t - dt)) / (2 * dt);
  EXPECT_LT((v - (*p.exact_velocity)(X, t)).norm(), 1e-8 * v.norm());
  // div u = 0 and rho w^2 u = -mu lap u.
  EXPECT_LT(std::abs(p.exact_gradient(X, t).trace()), 1e-14);
  EXPECT_NEAR(1100 * w * w, p.material.mu * 3 * k * k, 1e-6);
  EXPECT_EQ(p.boundaries.size(), 6u);
}

TEST(PatchTests, ExactGradientAndTractionAreAccurateToRoundOff) {
  const Problem p = read_problem("patch_test_c");
  Mat3 G;
  G << 2, 1, 1, 1, 2, 1, 1, 1, 2;
  G *= 5e-4;
  for (const Vec3& X : {Vec3(0, 0, 0), Vec3(.01, .003, .007), Vec3(.0033, .0066, .01)}) {
    EXPECT_LT((p.exact_gradient(X, 1) - G).norm(), 2e-15 * G.norm());
    const Vec3 T = p.boundary_value(p.boundaries[0], X, 1, Vec3::UnitY());
    const Mat3 P = NeoHookean{p.material.lambda, p.material.mu}.stress(G);
    EXPECT_LT((T - P.col(1)).norm(), 1e-14 * P.norm());
  }
  const BoundaryCondition& sixth = p.boundaries[2];
  EXPECT_FALSE(sixth.value.component[0].has_value());
  EXPECT_NEAR(p.boundary_value(sixth, Vec3(.01, 0, 0), 1, Vec3::Zero())[1], 5e-6, 1e-20);
}

TEST(Reader, ParametersMayUseOneAnotherInAnyOrder) {
  const ScratchScene s(plane_scene(
      "[parameters]\na = {expr = \"2*b\"}\nb = {expr = \"c + 1\"}\nc = \"3 mm\"\nd = 4\n"));
  const Problem p = s.read({{"parameters.d", "5 mm"}});
  EXPECT_DOUBLE_EQ(p.parameters.at("a"), 2 * 1.003);
  EXPECT_DOUBLE_EQ(p.parameters.at("d"), 5e-3);
}

TEST(Reader, PairsOfElasticConstantsAgree) {
  const double mu = 1e6 / 2.6, kappa = 1e6 / 1.2;
  const std::string head =
      "dimension = \"3D\"\ngeometry = \"body.geo\"\nreference_length = \"1 m\"\n"
      "end_time = \"1 s\"\n[material]\nmodel = \"neo-hookean\"\ndensity = \"1 kg/m^3\"\n";
  const std::string mu_text = "shear_modulus = \"" + std::to_string(mu) + " Pa\"\n";
  for (const std::string& second : {std::string("poissons_ratio = 0.3\n"),
                                    "bulk_modulus = \"" + std::to_string(kappa) + " Pa\"\n"}) {
    const ScratchScene s(head + mu_text + second);
    const Material m = s.read().material;
    EXPECT_NEAR(m.E, 1e6, 1);
    EXPECT_NEAR(m.nu, 0.3, 1e-7);
    EXPECT_NEAR(m.lambda, 0.3e6 / 1.3 / 0.4, 1);
  }
}

TEST(Reader, OverridesReplaceAndAdd) {
  const ScratchScene s(plane_scene("[[boundary]]\ngroup = \"x0\"\nkind = \"fixed\"\n"));
  const Problem p = s.read({{"material.youngs_modulus", "2 MPa"},
                            {"boundary.0.kind", "symmetric"},
                            {"boundary.1.group", "x1"},
                            {"boundary.1.kind", "traction"},
                            {"boundary.1.value", "[\"0\", \"1e3*t\"]"},
                            {"output.frames", "3"},
                            {"dimension", "plane stress"}});
  EXPECT_EQ(p.material.E, 2e6);
  EXPECT_EQ(p.boundaries[0].kind, BoundaryKind::symmetric);
  EXPECT_EQ(p.boundary_value(p.boundaries[1], Vec3::Zero(), 2, Vec3::Zero())[1], 2e3);
  EXPECT_EQ(p.frames, 3);
  EXPECT_EQ(p.dimension, Dimension::plane_stress);
}

TEST(Reader, NormalisedTextFollowsContentOnly) {
  const ScratchScene a(plane_scene()), b("# a comment\n" + plane_scene() + "\n\n");
  const ScratchScene c(plane_scene(), std::string(test::square_geo) + "// changed\n");
  EXPECT_EQ(a.read().normalised_text, b.read().normalised_text);
  EXPECT_NE(a.read().normalised_text, c.read().normalised_text);
  EXPECT_NE(a.read().normalised_text, a.read({{"end_time", "2 ms"}}).normalised_text);
}

// The table of keys and the reader must agree both ways: these scenes together use every key of
// the table, and every key they use is in it (else it would be unknown) and read (else unread).
TEST(SceneKeys, TheReaderReadsExactlyTheTable) {
  const std::string everything = R"(
gravity = ["0 m/s^2", "-9.81 m/s^2"]
thickness = "2 mm"
layout = "lattice"
title = "t"
source = "s"
)";
  const std::string tables = R"(
[parameters]
U = 1
[[boundary]]
group = "x0"
kind = "displacement"
value = ["exact", "free"]
[initial]
displacement = ["0", "0"]
velocity = ["0", "0"]
[body_force]
value = ["0", "0"]
[exact]
displacement = ["U*X", "0"]
velocity = ["0", "0"]
[fracture]
energy_release_rate = "1 J/m^2"
criterion = "energy"
length = "1 mm"
arrival = "x0"
[[fracture.crack]]
from = ["0", "0"]
to = ["U", "0"]
[[quantity]]
name = "p"
kind = "point"
at = ["0 m", "0 m"]
[[quantity]]
name = "m"
kind = "maximum"
group = "x0"
field = "pressure"
where = "interior"
[output]
frames = 2
history_rows = 5
)";
  const std::string other = R"(dimension = "plane stress"
geometry = "body.geo"
reference_length = "1 m"
static = true
load_steps = 4
[material]
model = "st-venant-kirchhoff"
density = "1 kg/m^3"
shear_modulus = "1 Pa"
bulk_modulus = "1 Pa"
[[boundary]]
group = "x0"
kind = "fixed"
)";
  const std::string plastic = R"(dimension = "3D"
geometry = "body.geo"
reference_length = "1 m"
end_time = "1 s"
[material]
model = "j2-hencky"
density = "1 kg/m^3"
shear_modulus = "80 GPa"
bulk_modulus = "160 GPa"
yield_stress = "450 MPa"
saturation_stress = "715 MPa"
hardening_modulus = "129 MPa"
saturation_exponent = 16.93
)";
  const std::string first = plane_scene(tables, everything);
  EXPECT_NO_THROW(ScratchScene(first).read());
  EXPECT_NO_THROW(ScratchScene(plastic).read());
  EXPECT_NO_THROW(ScratchScene(other).read());
  for (const KeyInfo& info : scene_keys()) {
    std::string leaf =
        info.key.substr(info.key.rfind('.') == std::string::npos ? 0 : info.key.rfind('.') + 1);
    if (leaf == "*") continue;
    const std::regex line("(^|\n)" + leaf + " = ");
    EXPECT_TRUE(std::regex_search(first, line) || std::regex_search(other, line) ||
                std::regex_search(plastic, line))
        << info.key << " is in the table, but no scene of this test uses it";
    EXPECT_FALSE(info.meaning.empty()) << info.key;
  }
}
