#include "scene/geometry.hpp"
#include "tests/unit/scene/scratch_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>

using namespace concord;
using namespace concord::scene;

namespace {
Mesh cube_mesh(const Problem& cube) {
  return make_mesh(cube, {1.0 / 6, CellShape::simplex, 1, Layout::lattice});
}
}  // namespace

TEST(UniformRandom, IsUniformAndDependsOnEveryArgument) {
  double sum = 0, square = 0, product = 0;
  constexpr int n = 100000;
  for (std::uint64_t i = 0; i < n; ++i) {
    const double r = uniform_random(3, i, 0), s = uniform_random(3, i, 1);
    ASSERT_GE(r, 0);
    ASSERT_LT(r, 1);
    sum += r;
    square += r * r;
    product += r * s;
  }
  // Standard errors of the three means are 9e-4, 9e-4 and 7e-4.
  EXPECT_NEAR(sum / n, 0.5, 4e-3);
  EXPECT_NEAR(square / n, 1.0 / 3, 4e-3);
  EXPECT_NEAR(product / n, 0.25, 4e-3);
  EXPECT_NE(uniform_random(1, 2, 0), uniform_random(2, 1, 0));
}

TEST(Perturb, KeepsNodesOnTheirEntities) {
  const Problem cube = read_problem("swinging_cube");
  const Mesh before = cube_mesh(cube);
  Mesh after = before;
  perturb(after, cube, 0.25, 7);
  double largest = 0;
  int inside = 0;
  for (std::size_t a = 0; a < before.nodes.size(); ++a) {
    const Vec3 d = after.nodes[a] - before.nodes[a];
    for (int k = 0; k < 3; ++k) {
      const double X = before.nodes[a][k];
      if (X == 0 || X == 1)
        EXPECT_EQ(d[k], 0) << "off its plane";
      else
        EXPECT_NE(d[k], 0) << "not moved";
      largest = std::max(largest, std::abs(d[k]));
    }
    inside += before.entities[static_cast<std::size_t>(before.node_entity[a])].dim == 3;
  }
  EXPECT_EQ(inside, 125);
  EXPECT_LE(largest, 0.25 / 6);
  EXPECT_GT(largest, 0.24 / 6);  // 1029 draws: the largest misses by 1 % on average 1e-3
  EXPECT_NEAR(mesh_volume(after), 1, 1e-12);
}

TEST(Perturb, FollowsTheSeed) {
  const Problem cube = read_problem("swinging_cube");
  Mesh a = cube_mesh(cube), b = a, c = a, none = a;
  perturb(a, cube, 0.25, 7);
  perturb(b, cube, 0.25, 7);
  perturb(c, cube, 0.25, 8);
  perturb(none, cube, 0, 7);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_NE(a.nodes, c.nodes);
  EXPECT_EQ(none.nodes, cube_mesh(cube).nodes);
  EXPECT_THROW(perturb(a, cube, 0.6, 7), InputError);
  EXPECT_THROW(perturb(a, cube, -0.1, 7), InputError);
}

TEST(Perturb, SlantedEdgesAndCurves) {
  const Problem membrane = read_problem("cooks_membrane");
  Mesh mesh = make_mesh(membrane, {4e-3, CellShape::simplex, 1, Layout::lattice});
  perturb(mesh, membrane, 0.25, 1);
  EXPECT_NEAR(mesh_volume(mesh), 48e-3 * 30e-3, 1e-15);

  const test::ScratchScene scratch(test::plane_scene(), R"(
DefineConstant[ h = 0.2, structured = 0 ];
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {0, 1, 0, h}; Point(4) = {-1, 0, 0, h};
Line(1) = {4, 2}; Circle(2) = {2, 1, 3}; Circle(3) = {3, 1, 4};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Physical Curve("arc") = {2, 3}; Physical Surface("body") = {1};
)");
  const Problem problem = scratch.read({{"layout", "unstructured"}});
  Mesh disc = make_mesh(problem, {0.1, CellShape::simplex, 1, Layout::unstructured});
  const std::vector<Vec3> before = disc.nodes;
  perturb(disc, problem, 0.2, 1);
  int moved = 0;
  for (const Index a : disc.group_nodes("arc")) {
    EXPECT_NEAR(disc.nodes[static_cast<std::size_t>(a)].norm(), 1, 1e-9);
    moved += disc.nodes[static_cast<std::size_t>(a)] != before[static_cast<std::size_t>(a)];
  }
  EXPECT_GT(moved, 20);
}
