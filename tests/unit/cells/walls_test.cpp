// Cells at walls that are more than a box: re-entrant edges, holes, coplanar walls; and what
// is refused.

#include "tests/unit/cells/bodies.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>

namespace concord::particle::voronoi {
namespace {

using namespace test;
using testing::HasSubstr;

std::string message(const std::function<void()>& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing thrown";
}

double wall_area(const Cells& cells, const scene::Mesh& mesh, const std::string& group) {
  const auto& entities = mesh.groups.at(group).entities;
  double sum = 0;
  for (const Face& face : cells.faces)
    if (face.wall >= 0 && std::find(entities.begin(), entities.end(),
                                    cells.walls[face.wall].entity) != entities.end())
      sum += face.A;
  return sum;
}

TEST(VoronoiWalls, CoplanarEntitiesAreWallsOfTheirOwn) {
  // The middle third of the top is a surface of its own, cells lie across its edges.
  const std::string geo = R"(DefineConstant[ h = 0.5, structured = 1 ];
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {1, 0, 1, h}; Point(4) = {0, 0, 1, h};
Point(5) = {0.4, 0, 1, h}; Point(6) = {0.7, 0, 1, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 6}; Line(4) = {6, 5}; Line(5) = {5, 4}; Line(6) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};
out[] = Extrude {0, 1, 0} { Surface{1}; };
Physical Volume("body") = {out[1]}; Physical Surface("middle") = {out[5]};
Physical Surface("left") = {out[6]}; Physical Surface("right") = {out[4]};
)";
  const scene::Mesh mesh = surface_of(problem_on(geo, "3D"), 0.5);
  const auto X = random_points(150, 3, {.02, .02, .02}, {.98, .98, .98}, 6);
  const Cells cells = make_cells(mesh, 3, 1, X);
  EXPECT_EQ(cells.walls.size(), 8u);
  EXPECT_NEAR(wall_area(cells, mesh, "middle"), .3, 1e-13);
  EXPECT_NEAR(wall_area(cells, mesh, "left"), .4, 1e-13);
  EXPECT_NEAR(wall_area(cells, mesh, "right"), .3, 1e-13);
  expect_identities(mesh, cells, X);
}

TEST(VoronoiWalls, CoplanarPatchWithCornersPointingIn) {
  // An L-shaped patch in the top of a block, and the rest of the top around it.
  const std::string geo = R"(DefineConstant[ h = 0.5, structured = 1 ];
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {1, 1, 0, h}; Point(4) = {0, 1, 0, h};
Point(5) = {0, 0, 1, h}; Point(6) = {1, 0, 1, h}; Point(7) = {1, 1, 1, h}; Point(8) = {0, 1, 1, h};
Point(101) = {.2, .2, 1, h}; Point(102) = {.8, .2, 1, h}; Point(103) = {.8, .5, 1, h};
Point(104) = {.5, .5, 1, h}; Point(105) = {.5, .8, 1, h}; Point(106) = {.2, .8, 1, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Line(9) = {1, 5}; Line(10) = {2, 6}; Line(11) = {3, 7}; Line(12) = {4, 8};
Line(101) = {101, 102}; Line(102) = {102, 103}; Line(103) = {103, 104};
Line(104) = {104, 105}; Line(105) = {105, 106}; Line(106) = {106, 101};
Curve Loop(1) = {-4, -3, -2, -1}; Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8}; Curve Loop(101) = {101, 102, 103, 104, 105, 106};
Plane Surface(2) = {2, 101}; Plane Surface(101) = {101};
Curve Loop(3) = {1, 10, -5, -9}; Plane Surface(3) = {3};
Curve Loop(4) = {3, 12, -7, -11}; Plane Surface(4) = {4};
Curve Loop(5) = {4, 9, -8, -12}; Plane Surface(5) = {5};
Curve Loop(6) = {2, 11, -6, -10}; Plane Surface(6) = {6};
Surface Loop(1) = {1, 2, 101, 3, 4, 5, 6}; Volume(1) = {1};
Physical Volume("body") = {1}; Physical Surface("patch") = {101};
)";
  const scene::Mesh mesh = surface_of(problem_on(geo, "3D"), 0.3);
  const auto X = random_points(200, 3, {.02, .02, .02}, {.98, .98, .98}, 7);
  const Cells cells = make_cells(mesh, 3, 1, X);
  EXPECT_NEAR(wall_area(cells, mesh, "patch"), .27, 1e-12);
  expect_identities(mesh, cells, X);
}

TEST(VoronoiWalls, LatticeInAnLBlock) {
  const scene::Problem problem = problem_on(l_block(true), "3D", "lattice");
  const auto X = place_particles(problem, .25, 0, 1);
  ASSERT_EQ(X.size(), 192u);
  const scene::Mesh mesh = surface_of(problem, .5);
  const Cells cells = make_cells(mesh, 3, 1, X);
  for (const double V : cells.V) EXPECT_NEAR(V, 1.0 / 64, 1e-15);
  for (const Face& face : cells.faces) EXPECT_NEAR(face.A, 1.0 / 16, 1e-14);
  expect_identities(mesh, cells, X, 1e-13);
}

TEST(VoronoiWalls, PerturbedInAnLBlock) {
  for (const bool plane : {false, true}) {
    const scene::Problem problem =
        problem_on(l_block(!plane), plane ? "plane strain" : "3D", "lattice");
    const scene::Mesh mesh = surface_of(problem, .5);
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
      const auto X = place_particles(problem, .25, .25, seed);
      expect_identities(mesh, make_cells(mesh, plane ? 2 : 3, plane ? .5 : 1, X), X);
    }
  }
}

/// Cells against a count of the points of a fine grid that are nearest to each particle.
TEST(VoronoiWalls, CellsOfAnLBlockHoldTheNearestPoints) {
  const scene::Problem problem = problem_on(l_block(false), "plane strain", "lattice");
  const auto X = place_particles(problem, .25, .25, 11);
  const Cells cells = make_cells(surface_of(problem, .5), 2, 1, X);
  constexpr int n = 1000;  // points a unit length
  std::vector<double> V(X.size(), 0);
  for (int j = 0; j < 2 * n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const Vec3 P((i + .5) / n, (j + .5) / n, 0);
      if (P[0] > 1 && P[1] > 1) continue;
      std::size_t nearest = 0;
      double best = 1e9;
      for (std::size_t a = 0; a < X.size(); ++a)
        if (const double d = (X[a] - P).squaredNorm(); d < best) best = d, nearest = a;
      V[nearest] += 1.0 / (n * n);
    }
  // Each cell's perimeter, about 1 m, crosses 1000 squares of 1e-6 m^2, half of them in error.
  for (std::size_t a = 0; a < X.size(); ++a) EXPECT_NEAR(cells.V[a], V[a], 2e-4) << a;
}

TEST(VoronoiWalls, ThroughHoleAndNotches) {
  // A square frame around an oblique hole, and a body with two notches.
  std::string frame = outline({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  frame = frame.substr(0, frame.find("Curve Loop"));
  frame +=
      R"(Point(11) = {.5, .25, 0, h}; Point(12) = {.75, .5, 0, h}; Point(13) = {.5, .75, 0, h};
Point(14) = {.25, .5, 0, h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(1) = {1, 2, 3, 4}; Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(1) = {1, 2};
)";
  const scene::Mesh mesh = surface_of(problem_on(prism(frame, .3), "3D"), .2);
  // Particles before the hole's corners hold them: (0.5, 0.2) is nearer to (0.5, 0.25).
  std::vector<Vec3> X;
  for (const double z : {.06, .14, .25})
    for (int i = 0; i < 4; ++i) {
      const Mat3 turn = Eigen::AngleAxisd(i * M_PI / 2, Vec3::UnitZ()).toRotationMatrix();
      for (const Vec3& P : {Vec3(0, -.31, 0), Vec3(-.22, -.22, 0), Vec3(-.42, -.40, 0),
                            Vec3(-.17, -.42, 0), Vec3(.2, -.43, 0)})
        X.push_back(Vec3(.5, .5, z) + turn * P);
    }
  expect_identities(mesh, make_cells(mesh, 3, 1, X), X);
}

/// A cube of 2 m without one of its eighths, structured: seven blocks around a point.
std::string seven_blocks() {
  std::set<std::string> lines, faces;
  std::string points, volumes;
  const int step[] = {1, 3, 9};
  const auto line = [&](int axis, int p) {
    const int tag = 100 * (axis + 1) + p;
    lines.insert(fmt::format("Line({}) = {{{}, {}}};\n", tag, p, p + step[axis]));
    return tag;
  };
  const auto face = [&](int axis, int p) {
    const int tag = 1000 * (axis + 1) + p, b = (axis + 1) % 3, c = (axis + 2) % 3;
    faces.insert(fmt::format(
        "Curve Loop({0}) = {{{1}, {2}, -{3}, -{4}}}; Plane Surface({0}) = {{{0}}};\n", tag,
        line(b, p), line(c, p + step[b]), line(b, p + step[c]), line(c, p)));
    return tag;
  };
  for (int p = 1; p < 27; ++p)
    points += fmt::format("Point({}) = {{{}, {}, {}, h}};\n", p, (p - 1) % 3, (p - 1) / 3 % 3,
                          (p - 1) / 9);
  for (const int p : {1, 2, 4, 5, 10, 11, 13})
    volumes += fmt::format(
        "Surface Loop({0}) = {{{1}, {2}, {3}, {4}, {5}, {6}}}; Volume({0}) = {{{0}}};\n", p,
        face(0, p), face(0, p + 1), face(1, p), face(1, p + 3), face(2, p), face(2, p + 9));
  std::string geo = "DefineConstant[ h = 0.25, structured = 1 ];\n" + points;
  for (const std::string& text : lines) geo += text;
  for (const std::string& text : faces) geo += text;
  return geo + volumes +
         "Physical Volume(\"body\") = {1, 2, 4, 5, 10, 11, 13};\n"
         "Transfinite Curve \"*\" = Round(1/h) + 1; Transfinite Surface \"*\";\n"
         "Transfinite Volume \"*\";\n";
}

/// Three re-entrant edges that meet in a corner.
TEST(VoronoiWalls, ReEntrantCorner) {
  const scene::Problem problem = problem_on(seven_blocks(), "3D", "lattice");
  const scene::Mesh mesh = surface_of(problem, .5);
  for (const std::uint64_t seed : {0, 1, 2, 3}) {
    const auto X = place_particles(problem, .25, seed == 0 ? 0 : .25, seed);
    EXPECT_EQ(X.size(), 448u);
    const Cells cells = make_cells(mesh, 3, 1, X);
    expect_identities(mesh, cells, X);
    const Cells threads = make_cells(mesh, 3, 1, X, Executor(2));
    ASSERT_EQ(threads.faces.size(), cells.faces.size());
    EXPECT_EQ(threads.V, cells.V);
    EXPECT_EQ(threads.centroid, cells.centroid);
  }
}

/// A cell that reaches through a slot into the other leg is seen from behind there.
TEST(VoronoiWalls, CellsInTwoPiecesAreRefused) {
  const scene::Mesh mesh = surface_of(
      problem_on(
          plane(outline(
              {{0, 0}, {1, 0}, {1, 1}, {.52, 1}, {.52, .3}, {.48, .3}, {.48, 1}, {0, 1}})),
          "plane strain"),
      .1);
  std::vector<Vec3> X;
  for (const double y : {.1, .22, .5, .7, .9})
    for (const double x : {.1, .3, .7, .9}) X.emplace_back(x, y, 0);
  X.emplace_back(.44, .26, 0);
  X.emplace_back(.56, .26, 0);
  expect_identities(mesh, make_cells(mesh, 2, 1, X), X);
  for (Vec3& P : X)
    if (P == Vec3(.3, .7, 0)) P[0] = .46;
  const std::string text = message([&] { make_cells(mesh, 2, 1, X); });
  EXPECT_THAT(text, testing::AllOf(HasSubstr("(0.46, 0.7, 0)"), HasSubstr("seen from behind")));
}

TEST(VoronoiWalls, AParticleThatDoesNotSeeItsCellIsRefused) {
  const scene::Problem problem = problem_on(l_block(false), "plane strain", "lattice");
  const scene::Mesh mesh = surface_of(problem, .5);
  auto X = place_particles(problem, .25, 0, 1);
  for (Vec3& P : X)  // from (1.125, 0.875) to next to the edge at (1, 1), under the step
    if ((P - Vec3(1.125, .875, 0)).norm() < 1e-9) P = Vec3(1.06, .94, 0);
  const std::string text = message([&] { make_cells(mesh, 2, 1, X); });
  EXPECT_THAT(text, HasSubstr("seen from behind"));
  EXPECT_THAT(text, HasSubstr("(1.06, 0.94, 0)"));
  EXPECT_THAT(text, HasSubstr("curve"));
}

TEST(VoronoiWalls, CurvedWallsAreRefused) {
  const std::string disc = R"(DefineConstant[ h = 0.2, structured = 1 ];
Point(1) = {1, 0, 0, h}; Point(2) = {0, 0, 0, h}; Point(3) = {0, 1, 0, h};
Line(1) = {3, 2}; Line(2) = {2, 1}; Circle(3) = {1, 2, 3};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1}; Physical Curve("rim") = {3};
)";
  const scene::Mesh flat = surface_of(problem_on(plane(disc), "plane strain"), .2);
  const std::vector<Vec3> X = {{.3, .3, 0}, {.6, .3, 0}};
  EXPECT_THAT(message([&] { make_cells(flat, 2, 1, X); }),
              testing::AllOf(HasSubstr("curve 3 (group rim)"), HasSubstr("plane walls only")));
  const scene::Mesh solid = surface_of(problem_on(prism(disc, .5), "3D"), .2);
  const std::vector<Vec3> P = {{.3, .3, .2}, {.6, .3, .3}};
  EXPECT_THAT(message([&] { make_cells(solid, 3, 1, P); }), HasSubstr("plane walls only"));
}

TEST(VoronoiWalls, ParticlesOutsideOrInOnePlaceAreRefused) {
  const scene::Mesh mesh = surface_of(problem_on(box(1, 1, 1), "3D"), .5);
  auto X = random_points(50, 3, {.1, .1, .1}, {.9, .9, .9}, 1);
  X[7] = {.5, .5, 1.01};
  EXPECT_THAT(message([&] { make_cells(mesh, 3, 1, X); }), HasSubstr("particle 7"));
  X[7] = {.5, .5, 31};
  EXPECT_THAT(message([&] { make_cells(mesh, 3, 1, X); }),
              testing::AllOf(HasSubstr("particle 7"), HasSubstr("outside the body")));
  X[7] = X[31];
  EXPECT_THAT(message([&] { make_cells(mesh, 3, 1, X); }),
              testing::AllOf(HasSubstr("particle 7"), HasSubstr("particle 31 in one place")));
}

}  // namespace
}  // namespace concord::particle::voronoi
