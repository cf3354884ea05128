#include "scene/geometry.hpp"
#include "tests/unit/scene/scratch_scene.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

using namespace concord;
using namespace concord::scene;
using concord::test::plane_scene;
using concord::test::ScratchScene;

namespace {

constexpr Layout layouts[] = {Layout::lattice, Layout::unstructured};
constexpr CellShape shapes[] = {CellShape::simplex, CellShape::hypercube};

const char* const annulus_geo = R"(
DefineConstant[ h = 0.2, structured = 1 ];
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {2, 0, 0, h};
Point(4) = {0, 2, 0, h}; Point(5) = {0, 1, 0, h};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {-1};
If (structured)
  Transfinite Curve {1, 3} = Round(1/h) + 1; Transfinite Curve {2, 4} = Round(2.4/h) + 1;
  Transfinite Surface {1};
EndIf
Physical Curve("y0") = {1}; Physical Curve("outer") = {2}; Physical Curve("x0") = {3};
Physical Surface("body") = {1};
)";

/// Outward flux of X over the facets is dim times the volume (divergence theorem): true only if
/// the facets close the body and point outwards.
double flux(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    const Index* facet = &mesh.facets[f * static_cast<std::size_t>(mesh.nodes_per_facet)];
    const auto X = [&](int c) { return mesh.nodes[static_cast<std::size_t>(facet[c])]; };
    if (mesh.dim == 2) {
      const Vec3 d = X(1) - X(0);
      sum += Vec3(d[1], -d[0], 0).dot(X(0) + X(1)) / 2;
    } else {
      sum += (X(1) - X(0)).cross(X(2) - X(0)).dot(X(0)) / 2;
      if (mesh.shape == CellShape::hypercube)
        sum += (X(2) - X(0)).cross(X(3) - X(0)).dot(X(0)) / 2;
    }
  }
  return sum / mesh.dim;
}

}  // namespace

TEST(MakeMesh, CubeOfEveryShapeOrderAndLayout) {
  const Problem cube = read_problem("swinging_cube");
  for (const Layout layout : layouts)
    for (const CellShape shape : shapes)
      for (const int order : {1, 2}) {
        const Mesh mesh = make_mesh(cube, {0.25, shape, order, layout});
        EXPECT_NEAR(mesh_volume(mesh), 1, 1e-14);
        EXPECT_NEAR(mesh_boundary_area(mesh), 6, 1e-13);
        EXPECT_NEAR(flux(mesh), 1, 1e-13);
        for (const Index a : mesh.group_nodes("x1"))
          EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(a)][0], 1.0);
        EXPECT_EQ(mesh.group_axis("y0"), 1);
        EXPECT_EQ(mesh.group_nodes("body").size(), mesh.nodes.size());
      }
}

TEST(MakeMesh, LatticeHasTheNodesOfTheLattice) {
  const Problem cube = read_problem("swinging_cube");
  const Mesh mesh = make_mesh(cube, {1.0 / 5, CellShape::hypercube, 1, Layout::lattice});
  EXPECT_EQ(mesh.nodes.size(), 216u);
  EXPECT_EQ(mesh.cell_count(), 125u);
  EXPECT_EQ(mesh.group_nodes("x0").size(), 36u);
  EXPECT_EQ(mesh.group_facets("x0").size(), 25u);
  for (const int n : {5, 7, 41}) {
    const Mesh lattice = make_mesh(cube, {1.0 / n, CellShape::simplex, 1, Layout::lattice});
    for (const Vec3& X : lattice.nodes)
      for (int k = 0; k < 3; ++k) ASSERT_EQ(X[k], std::round(n * X[k]) / n);  // to the last bit
  }
}

// gmsh cuts transfinite surfaces along other diagonals than the volume behind them: with order
// 2 the facets' own nodes tell.
TEST(MakeMesh, FacetsAreFacesOfCells) {
  const Problem cube = read_problem("swinging_cube");
  const Mesh mesh = make_mesh(cube, {0.25, CellShape::simplex, 2, Layout::lattice});
  for (const char* group : {"x0", "x1", "y0", "y1", "z0", "z1"}) {
    EXPECT_EQ(mesh.group_nodes(group).size(), 81u) << group;
    std::set<Index> on_facets;
    for (const Index f : mesh.group_facets(group))
      for (int i = 0; i < mesh.nodes_per_facet; ++i)
        on_facets.insert(mesh.facets[static_cast<std::size_t>(f * mesh.nodes_per_facet + i)]);
    EXPECT_EQ(on_facets.size(), 81u) << group;
  }
}

TEST(MakeMesh, CurvedBodyKeepsOrderTwoNodesOnTheCurve) {
  // The surface is oriented downwards on purpose: cells must come out positive.
  const ScratchScene scratch(plane_scene(), annulus_geo);
  const Problem problem = scratch.read();
  for (const Layout layout : layouts)
    for (const CellShape shape : shapes) {
      const Mesh mesh = make_mesh(problem, {0.1, shape, 2, layout});
      EXPECT_GT(mesh_volume(mesh), 0);
      for (const Index a : mesh.group_nodes("outer"))
        EXPECT_NEAR(mesh.nodes[static_cast<std::size_t>(a)].norm(), 2, 1e-12);
      const Mesh linear = make_mesh(problem, {0.1, shape, 1, layout});
      EXPECT_NEAR(mesh_volume(linear), 0.75 * M_PI, 0.01);  // chords: (h/R)^2/6 relative
      EXPECT_NEAR(flux(linear), mesh_volume(linear), 1e-12);
      EXPECT_EQ(mesh.group_axis("y0"), 1);
      EXPECT_THROW(mesh.group_axis("outer"), InputError);
    }
}

TEST(MakeMesh, ParametersReachTheGeometry) {
  const ScratchScene scratch(plane_scene("[parameters]\nA = \"3 m\"\n"));
  const Mesh mesh =
      make_mesh(scratch.read(), {0.5, CellShape::simplex, 1, Layout::unstructured});
  EXPECT_NEAR(mesh_volume(mesh), 3, 1e-13);
}

TEST(MakeMesh, SameRequestSameMesh) {
  const Problem cube = read_problem("swinging_cube");
  const MeshRequest request{0.3, CellShape::simplex, 1, Layout::unstructured};
  const Mesh first = make_mesh(cube, request);
  (void)make_mesh(cube, {0.2, CellShape::hypercube, 2, Layout::unstructured});
  const Mesh second = make_mesh(cube, request);
  EXPECT_EQ(first.nodes, second.nodes);
  EXPECT_EQ(first.cells, second.cells);
}

TEST(CommonQuadrature, WeightsSumToTheVolumeAndIntegrateQuadratics) {
  for (const char* layout : {"lattice", "unstructured"}) {
    const Problem cube = read_problem("swinging_cube", {{"layout", layout}});
    const Quadrature rule = common_quadrature(cube);
    long double volume = 0, moment = 0;  // 110592 terms
    for (std::size_t q = 0; q < rule.points.size(); ++q) {
      volume += rule.weights[q];
      moment += rule.weights[q] * rule.points[q][0] * rule.points[q][1];
    }
    EXPECT_NEAR(static_cast<double>(volume), 1, 1e-14) << layout;
    EXPECT_NEAR(static_cast<double>(moment), 0.25, 1e-14) << layout;
    EXPECT_GT(*std::min_element(rule.weights.begin(), rule.weights.end()), 0);
  }
  const Problem membrane = read_problem("cooks_membrane");
  double area = 0;
  for (const double w : common_quadrature(membrane).weights) area += w;
  EXPECT_NEAR(area, 48e-3 * 30e-3, 1e-15);
}
