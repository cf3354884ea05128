// Where particles are put: lattices, irregular arrangements, Lloyd's iteration.

#include "tests/unit/cells/bodies.hpp"

namespace concord::particle::voronoi {
namespace {

using namespace test;

scene::Problem cube() {
  std::string geo = outline({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  geo += "out[] = Extrude {0, 0, 1} { Surface{1}; };\n"
         "Transfinite Curve \"*\" = Round(1/h) + 1; Transfinite Surface \"*\";\n"
         "Transfinite Volume \"*\"; Physical Volume(\"body\") = {out[1]};\n";
  return problem_on(geo, "3D", "lattice");
}

TEST(VoronoiPlacement, LatticesOfCellCentres) {
  const auto X = place_particles(cube(), .25, 0, 1);
  ASSERT_EQ(X.size(), 64u);
  for (const Vec3& P : X)
    for (int k = 0; k < 3; ++k) {
      const double cell = 4 * P[k] - .5;
      EXPECT_NEAR(cell, std::round(cell), 1e-12);
      EXPECT_TRUE(P[k] > 0 && P[k] < 1);
    }
}

TEST(VoronoiPlacement, IrregularArrangements) {
  const scene::Problem problem = cube();
  const auto X = place_particles(problem, .25, 0, 1), Y = place_particles(problem, .25, .25, 1),
             same = place_particles(problem, .25, .25, 1, Executor(3)),
             other = place_particles(problem, .25, .25, 2);
  EXPECT_EQ(Y, same);
  EXPECT_NE(Y, other);
  double mean_square = 0;
  for (std::size_t a = 0; a < X.size(); ++a) {
    EXPECT_LE((Y[a] - X[a]).cwiseAbs().maxCoeff(), .25 * .25);
    mean_square += (Y[a] - X[a]).squaredNorm() / 3 / static_cast<double>(X.size());
  }
  // Uniform in [-s, s]: variance s^2/3; 192 numbers, standard error 6.5 %.
  EXPECT_NEAR(mean_square / (.0625 * .0625 / 3), 1, .2);
  EXPECT_THROW(place_particles(problem, .25, .5, 1), InputError);
}

TEST(VoronoiPlacement, ParticlesStayInNarrowCells) {
  // Cook's membrane: cells three times as wide as high at the right end.
  std::string geo = outline({{0, 0}, {.048, .044}, {.048, .06}, {0, .044}});
  geo += "Transfinite Curve \"*\" = Round(.048/h) + 1; Transfinite Surface {1};\n";
  const scene::Problem problem = problem_on(plane(geo), "plane strain", "lattice");
  const scene::Mesh mesh = surface_of(problem, .006);
  const auto lattice = place_particles(problem, .006, 0, 1);
  ASSERT_EQ(lattice.size(), 64u);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto X = place_particles(problem, .006, .25, seed);
    const Cells cells = make_cells(mesh, 2, 1, X);
    expect_identities(mesh, cells, X);
    for (const Wall& wall : cells.walls)
      for (std::size_t a = 0; a < X.size(); ++a)
        EXPECT_GE(wall.offset - wall.N.dot(X[a]),
                  .5 * (wall.offset - wall.N.dot(lattice[a])) - 1e-15);
  }
}

TEST(VoronoiPlacement, NextToReEntrantEdgesParticlesStay) {
  const scene::Problem problem = problem_on(l_block(true), "3D", "lattice");
  const scene::Mesh mesh = surface_of(problem, .5);
  const auto lattice = place_particles(problem, .25, 0, 1);
  std::size_t stayed = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const auto X = place_particles(problem, .25, .25, seed);
    const Cells cells = make_cells(mesh, 3, 1, X);
    for (std::size_t f = cells.interior; f < cells.faces.size(); ++f) {
      const Wall& wall = cells.walls[cells.faces[f].wall];
      EXPECT_GT(wall.offset - wall.N.dot(X[cells.faces[f].a]), .02);
    }
    for (std::size_t a = 0; a < X.size(); ++a) {
      if (X[a] != lattice[a]) continue;
      ++stayed;
      EXPECT_LT((Vec3(1, 1, X[a][2]) - X[a]).norm(), .6) << a;  // the two columns around it
    }
  }
  EXPECT_GT(stayed, 0u);
}

TEST(VoronoiPlacement, UnstructuredLayoutsAreCentroidal) {
  const scene::Problem problem =
      problem_on(prism(outline({{0, 0}, {1.5, 0}, {.9, 1}, {0, 1}}), .8), "3D");
  const scene::Mesh mesh = surface_of(problem, .5);
  const auto X = place_particles(problem, .2, 0, 1);
  EXPECT_NEAR(static_cast<double>(X.size()), 1.2 * .8 / .008, 25);
  const Cells cells = make_cells(mesh, 3, 1, X);
  for (std::size_t a = 0; a < X.size(); ++a)
    EXPECT_LT((cells.centroid[a] - X[a]).norm(), 1.5 * lloyd_tolerance * .2);
  const auto Y = place_particles(problem, .2, .25, 3);
  expect_identities(mesh, make_cells(mesh, 3, 1, Y), Y);
}

TEST(VoronoiPlacement, LatticesOfUnequalSpacingsAroundAReEntrantEdge) {
  // Above the edge the rows are narrower: their particles are nearer to it than those before
  // it.
  std::string geo = l_block(true);
  geo.replace(geo.find("Point(7) = {0, 2, 0, h}; Point(8) = {1, 2, 0, h};"), 49,
              "Point(7) = {0, 1.9, 0, h}; Point(8) = {1, 1.9, 0, h};");
  const scene::Problem problem = problem_on(geo, "3D", "lattice");
  const scene::Mesh mesh = surface_of(problem, .5);
  for (const std::uint64_t seed : {0, 1, 2, 3, 4}) {
    const auto X = place_particles(problem, .25, seed == 0 ? 0 : .25, seed);
    EXPECT_EQ(X.size(), 192u);
    expect_identities(mesh, make_cells(mesh, 3, 1, X), X);
  }
}

TEST(VoronoiPlacement, UnstructuredBodiesWithReEntrantEdges) {
  // A plane L with an oblique leg, and a solid one.
  const std::string l = outline({{0, 0}, {2, 0}, {2, .9}, {1.1, 1}, {.8, 2}, {0, 2}});
  const scene::Problem flat = problem_on(plane(l), "plane strain");
  const scene::Mesh curve = surface_of(flat, .2);
  for (const double h : {.2, .11}) {
    const auto X = place_particles(flat, h, 0, 1), Y = place_particles(flat, h, .25, 1);
    expect_identities(curve, make_cells(curve, 2, 1, X), X);
    expect_identities(curve, make_cells(curve, 2, 1, Y), Y);
  }
  const scene::Problem solid = problem_on(prism(l, .8), "3D");
  const scene::Mesh mesh = surface_of(solid, .5);
  const auto X = place_particles(solid, .25, .25, 2);
  expect_identities(mesh, make_cells(mesh, 3, 1, X), X);
}

}  // namespace
}  // namespace concord::particle::voronoi
