#pragma once
// What acts on the pieces of cell surfaces that lie on walls, and the massless points through
// which prescribed displacements reach the particles.

#include "particle/voronoi/cells.hpp"
#include "scene/geometry.hpp"
#include "scene/problem.hpp"

#include <array>
#include <span>
#include <vector>

namespace concord::particle::voronoi {

/// One wall piece of a cell with all conditions of the scene that act on it, overlapping groups
/// merged. The piece of a free face has none.
struct BoundaryPiece {
  Index particle = -1;    ///< a
  Index face = -1;        ///< index into Cells::faces
  Mat3 D = Mat3::Zero();  ///< projection onto the prescribed displacement components (14)
  bool mirror = false;    ///< a plane of symmetry or antisymmetry and nothing else
  std::array<Index, 3> condition{-1, -1, -1};  ///< that prescribes component i: index into
                                               ///< Problem::boundaries; -1: none
  std::vector<Index> tractions;                ///< conditions of the kind traction
  /// Points of the body where the prescribed displacement is taken: the face's centroid C, and
  /// W, the particle's projection on the wall. One point where they coincide; -1 where D = 0.
  Index centroid_point = -1, wall_point = -1;
};

/// All wall pieces, in the order of Cells::faces, and the boundary points: point `bulk + k` of
/// the body, bulk the number of particles, lies at points[k] and belongs to piece owner[k].
struct Boundary {
  std::vector<BoundaryPiece> pieces;
  std::vector<Vec3> points;
  std::vector<Index> owner;
};

/// Whether centroid and projection count as one point: apart by less than 1e-12 of the
/// particle's distance to the wall, which is round-off of the cells.
inline bool coincide(const Vec3& C, const Vec3& W, double distance) {
  return (C - W).norm() <= 1e-12 * distance;
}

/// Maps every wall piece of the cells to the scene's conditions: those of groups that hold its
/// wall's entity, or (displacements) the body that it bounds. Symmetric: D = N (x) N;
/// antisymmetric: D = I - N (x) N; fixed: I; displacement: its components (14). Of two
/// conditions that prescribe one component the first counts (scene::make_mesh has compared
/// their values). Throws InputError for groups that hold no wall: curves (3D) and points, near
/// which no particle need lie.
Boundary boundary_pieces(const scene::Problem& problem, const scene::Mesh& mesh,
                         const Cells& cells, std::span<const Vec3> X);

}  // namespace concord::particle::voronoi
