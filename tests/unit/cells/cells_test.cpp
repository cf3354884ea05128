// Voronoi cells of convex bodies: volumes, closure, the identities of the paper's Sec. 2, the
// same bits for any number of threads.

#include "tests/unit/cells/bodies.hpp"

#include <cstring>

namespace concord::particle::voronoi {
namespace {

using namespace test;

TEST(VoronoiCells, LatticeHasCubesWithSixFaces) {
  const scene::Mesh mesh = surface_of(problem_on(box(1, 1, 1), "3D"), 0.5);
  std::vector<Vec3> X;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) X.emplace_back((i + .5) / 4, (j + .5) / 4, (k + .5) / 4);
  const Cells cells = make_cells(mesh, 3, 1, X);
  EXPECT_EQ(cells.interior, 3u * 3 * 16);  // edges and corners of cubes are no faces
  EXPECT_EQ(cells.faces.size(), 3u * 3 * 16 + 96);
  for (const double V : cells.V) EXPECT_NEAR(V, 1.0 / 64, 1e-16);
  for (const Face& face : cells.faces) EXPECT_NEAR(face.A, 1.0 / 16, 1e-15);
  for (std::size_t a = 0; a < X.size(); ++a)
    EXPECT_LT((cells.centroid[a] - X[a]).norm(), 1e-15);
  expect_identities(mesh, cells, X, 1e-14);
}

TEST(VoronoiCells, RandomPointsInABox) {
  const scene::Mesh mesh = surface_of(problem_on(box(1.2, 1, 0.7), "3D"), 0.5);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto X = random_points(400, 3, {.01, .01, .01}, {1.19, .99, .69}, seed);
    expect_identities(mesh, make_cells(mesh, 3, 1, X), X);
  }
}

TEST(VoronoiCells, FacesAreSortedAndSeenOnce) {
  const scene::Mesh mesh = surface_of(problem_on(box(1, 1, 1), "3D"), 0.5);
  const auto X = random_points(100, 3, {.01, .01, .01}, {.99, .99, .99}, 5);
  const Cells cells = make_cells(mesh, 3, 1, X);
  ASSERT_EQ(cells.walls.size(), 6u);
  for (std::size_t f = 0; f < cells.faces.size(); ++f) {
    const Face& face = cells.faces[f];
    EXPECT_EQ(f < cells.interior, face.wall < 0);
    EXPECT_EQ(f < cells.interior, face.a < face.b);
    if (f == 0 || f == cells.interior) continue;
    const Face& last = cells.faces[f - 1];
    EXPECT_LT(std::tuple(last.a, last.b, last.wall), std::tuple(face.a, face.b, face.wall));
  }
}

TEST(VoronoiCells, ObliquePlaneFace) {
  // A block cut by a plane that is oblique to two axes, and a truncated pyramid.
  const scene::Mesh wedge = surface_of(
      problem_on(prism(outline({{0, 0}, {1.5, 0}, {.9, 1}, {0, 1}}), .8), "3D"), 0.5);
  const auto X = random_points(200, 3, {.01, .01, .01}, {.89, .99, .79}, 3);
  expect_identities(wedge, make_cells(wedge, 3, 1, X), X);

  const scene::Problem pyramid = problem_on(R"(DefineConstant[ h = 0.5, structured = 1 ];
Point(1) = {-1, -1, 0, h}; Point(2) = {1, -1, 0, h}; Point(3) = {1, 1, 0, h}; Point(4) = {-1, 1, 0, h};
Point(5) = {0.1, 0.2, 1.3, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {1, 5}; Line(6) = {2, 5}; Line(7) = {3, 5}; Line(8) = {4, 5};
Curve Loop(1) = {-4, -3, -2, -1}; Plane Surface(1) = {1};
Curve Loop(2) = {1, 6, -5}; Plane Surface(2) = {2}; Curve Loop(3) = {2, 7, -6}; Plane Surface(3) = {3};
Curve Loop(4) = {3, 8, -7}; Plane Surface(4) = {4}; Curve Loop(5) = {4, 5, -8}; Plane Surface(5) = {5};
Surface Loop(1) = {1, 2, 3, 4, 5}; Volume(1) = {1}; Physical Volume("body") = {1};
)",
                                            "3D");
  const scene::Mesh mesh = surface_of(pyramid, 0.5);
  const auto P = random_points(60, 3, {-.4, -.4, .02}, {.4, .4, .4}, 4);
  expect_identities(mesh, make_cells(mesh, 3, 1, P), P);
}

TEST(VoronoiCells, PlaneBodiesWithThickness) {
  const scene::Mesh mesh =
      surface_of(problem_on(plane(outline({{0, 0}, {.048, .044}, {.048, .06}, {0, .044}})),
                            "plane strain"),
                 .01);
  std::vector<Vec3> X;  // in the trapezoid's own coordinates
  for (int a = 0; a < 300; ++a) {
    const double s = .01 + .98 * scene::uniform_random(1, a, 0);
    const double t = .01 + .98 * scene::uniform_random(1, a, 1);
    X.emplace_back(.048 * s, .044 * s + t * (.044 + (.06 - .044 - .044) * s), 0);
  }
  const Cells cells = make_cells(mesh, 2, .003, X);
  EXPECT_EQ(cells.walls.size(), 4u);
  for (const Face& face : cells.faces) EXPECT_EQ(face.C[2], 0);
  expect_identities(mesh, cells, X);
}

TEST(VoronoiCells, SizeOfTheBodyDoesNotMatter) {
  // voro++'s tolerance is a length: cells of a body 1e-6 and 1e6 times as large are the same.
  const auto X = random_points(150, 3, {.01, .01, .01}, {.99, .99, .99}, 9);
  const scene::Mesh mesh = surface_of(problem_on(box(1, 1, 1), "3D"), 0.5);
  const Cells cells = make_cells(mesh, 3, 1, X);
  for (const double factor : {0x1p-20, 0x1p20}) {
    scene::Mesh scaled = mesh;
    for (Vec3& node : scaled.nodes) node *= factor;
    std::vector<Vec3> Y = X;
    for (Vec3& y : Y) y *= factor;
    const Cells same = make_cells(scaled, 3, 1, Y);
    ASSERT_EQ(same.faces.size(), cells.faces.size());
    for (std::size_t f = 0; f < cells.faces.size(); ++f)
      EXPECT_NEAR(same.faces[f].A / (factor * factor), cells.faces[f].A, 1e-14);
  }
}

/// (App. B) dV_a/dX_b = -B_ba and dV_a/dX_a = sum of B_ab over interior neighbours, by
/// differences; walls move no volume to others.
TEST(VoronoiCells, GradientVectorsAreDerivativesOfVolumes) {
  const scene::Mesh mesh = surface_of(problem_on(box(1, 1, 1), "3D"), 0.5);
  const auto X = random_points(60, 3, {.02, .02, .02}, {.98, .98, .98}, 8);
  const Cells cells = make_cells(mesh, 3, 1, X);
  const Index b = 17;
  std::vector<Vec3> expected(X.size(), Vec3::Zero());  // dV_a/dX_b
  for (std::size_t f = 0; f < cells.interior; ++f) {
    const Face& face = cells.faces[f];
    if (face.a != b && face.b != b) continue;
    const Index a = face.a == b ? face.b : face.a;
    const Vec3 B_ba = face.A / (X[a] - X[b]).norm() * (face.C - X[b]);
    expected[a] -= B_ba;
    expected[b] += B_ba;
  }
  constexpr double step = 1e-6;
  for (int k = 0; k < 3; ++k) {
    std::vector<Vec3> up = X, down = X;
    up[b][k] += step;
    down[b][k] -= step;
    const Cells more = make_cells(mesh, 3, 1, up), less = make_cells(mesh, 3, 1, down);
    for (std::size_t a = 0; a < X.size(); ++a)
      EXPECT_NEAR((more.V[a] - less.V[a]) / (2 * step), expected[a][k], 2e-8) << a;
  }
}

TEST(VoronoiCells, SameBitsForAnyNumberOfThreads) {
  const scene::Mesh mesh = surface_of(problem_on(box(1, 1, 1), "3D"), 0.5);
  const auto X = random_points(3000, 3, {.001, .001, .001}, {.999, .999, .999}, 2);
  const Cells one = make_cells(mesh, 3, 1, X, Executor(1), {true});
  for (const int threads : {2, 5}) {
    const Cells more = make_cells(mesh, 3, 1, X, Executor(threads), {true});
    ASSERT_EQ(more.faces.size(), one.faces.size());
    EXPECT_EQ(more.V, one.V);
    EXPECT_EQ(more.centroid, one.centroid);
    EXPECT_EQ(more.polygons.points, one.polygons.points);
    for (std::size_t f = 0; f < one.faces.size(); ++f) {
      EXPECT_EQ(more.faces[f].b, one.faces[f].b);
      EXPECT_EQ(more.faces[f].A, one.faces[f].A);
      EXPECT_EQ(more.faces[f].C, one.faces[f].C);
    }
  }
}

/// Faces smaller than round-off are left out on both sides: a lattice that is not exact in
/// binary, turned, and far from the origin.
TEST(VoronoiCells, CosphericalParticlesHaveNoSlivers) {
  const Mat3 turn = (Eigen::AngleAxisd(.7, Vec3(1, 2, 3).normalized())).toRotationMatrix();
  const scene::Mesh straight = surface_of(problem_on(box(1, 1, 1), "3D"), 0.5);
  for (const double away : {0.0, 100.0}) {
    scene::Mesh mesh = straight;
    for (Vec3& node : mesh.nodes) node = turn * node + Vec3::Constant(away);
    std::vector<Vec3> X;
    for (int k = 0; k < 7; ++k)
      for (int j = 0; j < 7; ++j)
        for (int i = 0; i < 7; ++i)
          X.push_back(turn * Vec3((i + .5) / 7, (j + .5) / 7, (k + .5) / 7) +
                      Vec3::Constant(away));
    const Cells cells = make_cells(mesh, 3, 1, X);
    EXPECT_EQ(cells.interior, 3u * 6 * 49);
    EXPECT_EQ(cells.faces.size() - cells.interior, 6u * 49);
    expect_identities(mesh, cells, X, away == 0 ? 1e-13 : 1e-11);
  }
}

}  // namespace
}  // namespace concord::particle::voronoi
