// The deck as CalculiX reads it: order of nodes, sets, motion in time, hardening table.

#include "fem_reference/calculix/deck.hpp"

#include "fem_reference/calculix/simplex.hpp"
#include "tests/unit/calculix/block.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <sstream>

namespace concord::calculix {
namespace {

using calculix_test::Block;
using testing::ElementsAre;
using testing::HasSubstr;

scene::Mesh mesh_of(const scene::Problem& problem, double h) {
  scene::MeshRequest request;
  request.h = h;
  request.order = 2;
  request.layout = problem.layout;
  return scene::make_mesh(problem, request);
}

/// Data lines under each keyword line of a deck, numbers apart by commas.
std::map<std::string, std::vector<std::vector<double>>> cards(const std::string& deck) {
  std::map<std::string, std::vector<std::vector<double>>> out;
  std::istringstream lines(deck);
  std::string key;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 132u) << line;
    if (line.starts_with("**")) continue;
    if (line.starts_with("*")) {
      key = line;
      out[key];
      continue;
    }
    std::vector<double> row;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) {
      EXPECT_LE(field.size(), 20u) << line;  // CalculiX reads no more
      row.push_back(std::atof(field.c_str()));
    }
    out[key].push_back(row);
  }
  return out;
}

std::string deck_of(const scene::Problem& problem, const scene::Mesh& mesh, int steps,
                    const NodeSets& sets = {}) {
  Options options;
  options.steps = steps;
  HardeningTable table;
  if (problem.material.plastic()) table = hardening_table(problem.material.hardening, 200);
  return deck_text(problem, mesh, options, prescribed_motion(problem, mesh, steps), sets,
                   table);
}

TEST(Deck, TwoTrianglesHaveTheirMiddleNodesWhereCalculixLooksForThem) {
  const Block block{.material = calculix_test::elastic(), .motion = "0.1*t"};
  const auto scene = block.scene();
  const scene::Problem problem = scene.read();
  const scene::Mesh mesh = mesh_of(problem, 1);
  const auto deck = cards(deck_of(problem, mesh, 2));
  const auto& nodes = deck.at("*NODE, NSET=NALL");
  const auto& elements = deck.at("*ELEMENT, TYPE=CPE6, ELSET=EALL");
  ASSERT_EQ(nodes.size(), 9u);
  ASSERT_EQ(elements.size(), 2u);
  const auto X = [&](double number) {
    const auto& row = nodes.at(static_cast<std::size_t>(number) - 1);
    EXPECT_EQ(row[0], number);
    return Vec3(row[1], row[2], row[3]);
  };
  for (const auto& e : elements) {
    ASSERT_EQ(e.size(), 7u);
    const Vec3 a = X(e[1]), b = X(e[2]), c = X(e[3]);
    EXPECT_GT((b - a).cross(c - a).z(), 0);
    EXPECT_LT((X(e[4]) - (a + b) / 2).norm(), 1e-12);
    EXPECT_LT((X(e[5]) - (b + c) / 2).norm(), 1e-12);
    EXPECT_LT((X(e[6]) - (c + a) / 2).norm(), 1e-12);
  }
}

TEST(Deck, TetrahedraHaveTheirMiddleNodesWhereCalculixLooksForThem) {
  const Block block{.dimension = "3D", .material = calculix_test::elastic(), .motion = "0.1*t"};
  const auto scene = block.scene();
  const scene::Problem problem = scene.read();
  const scene::Mesh mesh = mesh_of(problem, 1);
  const auto deck = cards(deck_of(problem, mesh, 1));
  const auto& nodes = deck.at("*NODE, NSET=NALL");
  const auto& elements = deck.at("*ELEMENT, TYPE=C3D10, ELSET=EALL");
  ASSERT_EQ(elements.size(), mesh.cell_count());
  // CalculiX CrunchiX manual, "Ten-node tetrahedral element": nodes 5 to 10.
  constexpr int ends[6][2] = {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}};
  const auto X = [&](double number) {
    const auto& row = nodes.at(static_cast<std::size_t>(number) - 1);
    return Vec3(row[1], row[2], row[3]);
  };
  for (const auto& e : elements) {
    ASSERT_EQ(e.size(), 11u);
    const Vec3 a = X(e[1]);
    EXPECT_GT((X(e[2]) - a).cross(X(e[3]) - a).dot(X(e[4]) - a), 0);
    for (std::size_t k = 0; k < 6; ++k) {
      const Vec3 middle = (X(e[static_cast<std::size_t>(ends[k][0])]) +
                           X(e[static_cast<std::size_t>(ends[k][1])])) /
                          2;
      EXPECT_LT((X(e[5 + k]) - middle).norm(), 1e-12) << "node " << 5 + k;
    }
  }
}

TEST(Deck, MotionFollowsTheExpressionAndProportionalNodesShareAnAmplitude) {
  Block block{.material = calculix_test::elastic(), .motion = "0.1*(1 + X)*t^2"};
  const auto scene = block.scene();
  const scene::Problem problem = scene.read();
  const scene::Mesh mesh = mesh_of(problem, 1);
  const Motion motion = prescribed_motion(problem, mesh, 4);
  ASSERT_EQ(motion.histories.size(), 1u);
  EXPECT_THAT(motion.histories[0], ElementsAre(0, 0.0625, 0.25, 0.5625, 1));
  const auto deck = cards(deck_of(problem, mesh, 4));
  const auto& amplitude = deck.at("*AMPLITUDE, NAME=A0");
  ASSERT_EQ(amplitude.size(), 5u);
  EXPECT_THAT(amplitude[3], ElementsAre(0.75, 0.5625));
  const auto& moved = deck.at("*BOUNDARY, AMPLITUDE=A0");
  ASSERT_EQ(moved.size(), 3u);  // two corners and a middle node of the top
  for (const auto& row : moved) {
    const Vec3& X = mesh.nodes.at(static_cast<std::size_t>(row[0]) - 1);
    EXPECT_EQ(X.y(), 1);
    EXPECT_EQ(row[1], 2);
    EXPECT_EQ(row[2], 2);
    EXPECT_NEAR(row[3], 0.1 * (1 + X.x()), 1e-13);
  }
  // x0 held in x and y0 in y: three nodes each.
  EXPECT_EQ(deck.at("*BOUNDARY").size(), 6u);
  EXPECT_EQ(deck.at("*TIME POINTS, NAME=LOADSTEPS").size(), 4u);
}

TEST(Deck, SetsThicknessAndWhatIsPrinted) {
  Block block{.material = calculix_test::metal(), .motion = "0.1*t"};
  block.top += "thickness = \"2 mm\"\n";
  const auto scene = block.scene();
  const scene::Problem problem = scene.read();
  const scene::Mesh mesh = mesh_of(problem, 1);
  const std::string text = deck_of(problem, mesh, 4, {{3, 5}, {0}});
  const auto deck = cards(text);
  EXPECT_THAT(deck.at("*NSET, NSET=R0"), ElementsAre(ElementsAre(4), ElementsAre(6)));
  EXPECT_THAT(deck.at("*NSET, NSET=R1"), ElementsAre(ElementsAre(1)));
  EXPECT_THAT(deck.at("*SOLID SECTION, ELSET=EALL, MATERIAL=BODY"),
              ElementsAre(ElementsAre(0.002)));
  EXPECT_EQ(deck.at("*PLASTIC").size(), 200u);
  EXPECT_THAT(text, HasSubstr("*NODE PRINT, NSET=R1, TOTALS=ONLY, TIME POINTS=LOADSTEPS\nRF"));
  EXPECT_THAT(text, HasSubstr("*EL PRINT, ELSET=EALL, TIME POINTS=LOADSTEPS\nPEEQ"));
}

TEST(HardeningTable, KeepsItsOwnErrorAndGoesOnStraight) {
  const scene::Hardening metal{450e6, 715e6, 129e6, 16.93};
  const HardeningTable table = hardening_table(metal, 200);
  ASSERT_EQ(table.strain.size(), 200u);
  EXPECT_EQ(table.strain.front(), 0);
  EXPECT_EQ(table.stress.front(), 450e6);
  // Equal shares: largest error (tau_inf - tau_0)/(2 n^2) over n intervals, next to tau_0.
  EXPECT_NEAR(table.error, (715 - 450) / (2.0 * 198 * 198) / 450, 0.02 * table.error);
  for (std::size_t i = 1; i < table.strain.size(); ++i)
    EXPECT_GT(table.strain[i], table.strain[i - 1]);
  EXPECT_EQ(table.strain[198], sampled_strain);
  EXPECT_NEAR(table.stress.back(), flow_stress(metal, last_strain), 1e-9 * table.stress.back());
}

TEST(HardeningTable, IsExactForStraightCurves) {
  const scene::Hardening perfect{450e6, 450e6, 0, 0}, linear{450e6, 450e6, 129e6, 16.93};
  for (const scene::Hardening& h : {perfect, linear}) {
    const HardeningTable table = hardening_table(h, 3);
    EXPECT_LT(table.error, 1e-15);
    EXPECT_NEAR(table.stress.back(), 450e6 + h.modulus * last_strain, 1);
  }
}

TEST(QuadraticSimplex, RulesIntegratePolynomialsExactly) {
  // int x^a (1-x)^0 over simplices: a! / (a + dim)!
  for (const int dim : {1, 2, 3}) {
    const SimplexRule rule(dim);
    const int degree = 7 - (dim - 1);
    double sum = 0;
    for (std::size_t k = 0; k < rule.points.size(); ++k)
      sum += rule.weights[k] * std::pow(rule.points[k][0], degree);
    EXPECT_NEAR(sum, std::tgamma(degree + 1.0) / std::tgamma(degree + dim + 1.0), 1e-15);
  }
}

}  // namespace
}  // namespace concord::calculix
