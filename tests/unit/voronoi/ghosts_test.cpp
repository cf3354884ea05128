// Ghosts: projections, what cannot be determined, and true mirror images.

#include "particle/voronoi/ghosts.hpp"
#include "tests/unit/voronoi/bodies.hpp"

namespace concord::particle::voronoi::test {
namespace {

using enum scene::BoundaryKind;

std::vector<Vec3> sheet(int n) { return lattice({n, n, 1}, Vec3(1, 1, 1), 0, 1); }

TEST(VoronoiGhosts, FollowAffineFields) {
  const Block block = cube(4, mixed());
  const Stars stars(block.body, block.cells, block.boundary);
  const GhostSystems ghosts = solve_all_ghosts(stars, {}, Executor(1));
  Mat3 H;
  H << 0.3, 0.1, -0.2, 0.05, -0.2, 0.15, 0.1, -0.1, 0.25;
  for (const Index a : ghosts.particle) {
    const Star star = stars(a);
    const GhostSystem& system = ghosts.system[ghosts.row[a]];
    EXPECT_FALSE(system.mirrored);
    for (std::size_t g = 0; g < star.ghosts.size(); ++g) {
      Vec3 u = Vec3::Zero();
      for (std::size_t c = 0; c < star.neighbours.size(); ++c)
        u += system.T[g * star.neighbours.size() + c] * H * star.neighbours[c].X;
      for (std::size_t h = 0; h < star.ghosts.size(); ++h)
        u += system.R[g * star.ghosts.size() + h] * H * (0.5 * star.ghosts[h].X);
      EXPECT_LT((u - H * star.ghosts[g].X).norm(), 1e-13);
    }
  }
}

TEST(VoronoiGhosts, OfOneLayerBetweenFreeFacesAreRefused) {
  try {
    Block("swinging_cube", 0.25, sheet(4), {{"x0", fixed}}).model();
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("particle 0 at"), std::string::npos) << e.what();
    EXPECT_NE(e.allowed().find("two layers"), std::string::npos);
  }
  EXPECT_NO_THROW(cube(2, {}).model());
}

/// One layer between two planes of symmetry deforms as in plane strain: in-plane stretch
/// without any force on free sides but that of the law, none across.
TEST(VoronoiGhosts, BetweenPlanesOfSymmetryAreMirrorImages) {
  const std::vector<Given> planes{{"z0", symmetric}, {"z1", symmetric}};
  const Block block("swinging_cube", 0.25, sheet(4), planes);
  const auto model = block.model();
  Mat3 H = Mat3::Zero();
  H(0, 0) = 0.1, H(0, 1) = 0.05, H(1, 1) = -0.08;
  const Column u = block.affine(H);
  std::vector<Mat3> computed(block.body.n);
  model->gradients(u, computed);
  for (const Mat3& Ha : computed) EXPECT_LT((Ha - H).norm(), 1e-13);
  const Stars stars(block.body, block.cells, block.boundary);
  const GhostSystems ghosts = solve_all_ghosts(stars, {}, Executor(1));
  for (const GhostSystem& system : ghosts.system) EXPECT_TRUE(system.mirrored);
}

TEST(VoronoiBoundary, PointsOfGroupsWithoutFacesAreRefused) {
  EXPECT_THROW(membrane(4, {{"nowhere"}}), InputError);
  const Block block = cube(3, {{"body", displacement}});
  for (const BoundaryPiece& piece : block.boundary.pieces)
    EXPECT_TRUE(piece.D.isIdentity(0)) << "a displacement of the body acts on its faces";
}

TEST(VoronoiBoundary, OverlappingConditionsAreJoined) {
  const Block block = cube(3, {{"x0", symmetric}, {"x0", displacement, {false, true, false}}});
  for (const BoundaryPiece& piece : block.boundary.pieces) {
    if (block.cells.walls[block.cells.faces[piece.face].wall].N[0] > -0.5) {
      EXPECT_TRUE(piece.D.isZero(0));
      EXPECT_LT(piece.centroid_point, 0);
      continue;
    }
    EXPECT_LT((piece.D - Mat3(Vec3(1, 1, 0).asDiagonal())).norm(), 1e-15);
    EXPECT_EQ(piece.condition[0], 0);
    EXPECT_EQ(piece.condition[1], 1);
    EXPECT_EQ(piece.condition[2], -1);
    EXPECT_FALSE(piece.mirror);
    EXPECT_GE(piece.centroid_point, block.body.bulk);
  }
}

}  // namespace
}  // namespace concord::particle::voronoi::test
