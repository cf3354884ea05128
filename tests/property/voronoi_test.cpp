// What must hold of the Voronoi method alone: the numbering of the particles does not matter,
// nor does the body depend on threads; what it refuses.

#include "particle/core/inside_body.hpp"
#include "particle/core/state.hpp"
#include "particle/voronoi/voronoi.hpp"
#include "tests/property/bodies.hpp"

#include <algorithm>
#include <numeric>

namespace concord::particle::test {
namespace {

const Variant plain{"voronoi", "voronoi", {}};

/// Columns of points by the places of the points, so that bodies that number them otherwise can
/// be compared.
std::map<std::array<double, 3>, Vec3> by_place(const Body& body, const Column& f) {
  std::map<std::array<double, 3>, Vec3> found;
  for (Index p = 0; p < body.n; ++p) {
    const Vec3 X = body.position(p);
    found[{X[0], X[1], X[2]}] = column_vector(f, body, p);
  }
  return found;
}

TEST(Voronoi, NumberingOfTheParticlesDoesNotMatter) {
  const Bench b(plain, "swinging_cube", 4);
  const auto field = [](const Vec3& X) {
    return Vec3(0.02 * std::sin(3 * X[0] + X[1]), 0.03 * X[2] * X[1], -0.02 * X[0] * X[0]);
  };
  std::vector<Vec3> X;
  for (Index a = 0; a < b.body.bulk; ++a) X.push_back(b.body.position(a));
  std::mt19937_64 generator(5);
  const auto forces = [&] {
    InsideParts parts;
    parts.X = X;
    const voronoi::Cells cells = voronoi::make_cells(b.body.mesh, 3, 1, X);
    const voronoi::Boundary boundary =
        voronoi::boundary_pieces(b.problem, b.body.mesh, cells, X);
    for (const voronoi::BoundaryPiece& piece : boundary.pieces) {
      const voronoi::Face& face = cells.faces[piece.face];
      const voronoi::Wall& wall = cells.walls[face.wall];
      parts.surface.push_back({piece.particle, wall.entity, piece.centroid_point,
                               piece.condition, face.A, face.C, wall.N});
    }
    parts.V = cells.V, parts.points = boundary.points, parts.owner = boundary.owner;
    parts.h_min = b.body.h_min;
    const Body body = inside_body(b.problem, b.body.mesh, b.body.h, parts, b.executor);
    voronoi::VoronoiModel model(body, b.problem, cells, boundary, {});
    Column u(body.X.size(), 0.0), f = u;
    for (Index p = 0; p < body.n; ++p) {
      for (int i = 0; i < 3; ++i) u[4 * p + i] = field(body.position(p))[i];
    }
    model.forces(u, u, f, b.executor);
    return by_place(body, f);
  };
  const auto first = forces();
  std::shuffle(X.begin(), X.end(), generator);
  const auto second = forces();
  ASSERT_EQ(first.size(), second.size());
  double difference = 0, scale = 0;
  for (const auto& [place, f] : first) {
    // Centroids of faces may differ in the last digits: the nearest one.
    Vec3 other = Vec3::Zero();
    double nearest = 1e300;
    for (const auto& [at, g] : second) {
      const double d = std::hypot(at[0] - place[0], at[1] - place[1], at[2] - place[2]);
      if (d < nearest) nearest = d, other = g;
    }
    EXPECT_LT(nearest, 1e-12);
    difference += (f - other).squaredNorm();
    scale += f.squaredNorm();
  }
  EXPECT_LT(std::sqrt(difference / scale), 1e-12);
}

TEST(Voronoi, BodyIsTheSameOnAllThreads) {
  const scene::Problem problem = scene::read_problem("spinning_block");
  scene::RunRequest request;
  request.h = 1.0 / 12;
  request.perturb = 0.25;
  const auto make = [&](int threads) {
    return Bench::method_of(plain).make_particles(problem, request, Bench::settings_of(plain),
                                                  Executor(threads));
  };
  const Body one = make(1), three = make(3);
  EXPECT_EQ(one.X, three.X);
  EXPECT_EQ(one.V, three.V);
  EXPECT_EQ(one.triangulation.simplices, three.triangulation.simplices);
}

TEST(Voronoi, RefusesConditionsOnPoints) {
  try {
    const Bench b(plain, "patch_test_c", 3);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_GT(e.where().line, 0);
    EXPECT_NE(std::string(e.what()).find("corner_000"), std::string::npos);
    EXPECT_NE(e.allowed().find("surfaces"), std::string::npos);
  }
}

TEST(Voronoi, HasTheVolumeOfTheBody) {
  for (const auto& [scene, volume] : {std::pair{"spinning_block", 1.0}, {"cantilever", 6.0}}) {
    const Bench b(plain, scene, 4);
    EXPECT_NEAR(std::accumulate(b.body.V.begin(), b.body.V.end(), 0.0), volume, 1e-12 * volume);
    double area = 0;
    for (const SurfacePiece& piece : b.body.surface) area += piece.area;
    EXPECT_NEAR(area, volume == 1 ? 6 : 26, 1e-11);
  }
}

}  // namespace
}  // namespace concord::particle::test
