#pragma once
// The body as a union of convex parts between planes, and its walls as unions of convex
// polygons.

#include "particle/voronoi/cells.hpp"
#include "particle/voronoi/polygon.hpp"

#include <algorithm>
#include <array>

namespace concord::particle::voronoi {

/// Lengths are scaled by a power of two, so that voro++'s absolute tolerance suits the spacing;
/// plane bodies become slabs |Z| <= half_width.
struct Scale {
  double factor = 1;      ///< X' = factor X
  double spacing = 1;     ///< mean spacing, scaled
  double half_width = 0;  ///< scaled
};

/// A plane that holds walls; side 0 is N . X <= offset, side 1 the other.
struct Plane {
  HalfSpace half;
  bool supporting = true;                   ///< the whole body lies on side 0
  std::array<std::vector<Index>, 2> walls;  ///< walls whose body is on that side
  /// The only wall on a supporting plane: whatever of a cell lies on the plane is on the wall.
  Index whole() const { return supporting && walls[0].size() == 1 ? walls[0][0] : -1; }
  HalfSpace side(int s) const { return s == 0 ? half : half.opposite(); }
};

struct PlaneSide {
  Index plane = -1;
  int side = 0;
};

/// A convex polygon as its corners and the half-spaces that cut it out of its plane.
struct ConvexPiece {
  Polygon polygon;
  std::vector<HalfSpace> edges;
};

struct Region {
  Scale scale;
  std::vector<Wall> walls;                       ///< in metres
  std::vector<Plane> planes;                     ///< scaled, as all below
  std::vector<std::vector<ConvexPiece>> pieces;  ///< per wall
  std::vector<std::vector<PlaneSide>> parts;     ///< convex parts of the body; one: convex
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
  double volume = 0;

  bool convex() const { return parts.size() == 1; }
  double extent() const {
    return std::max(lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff());
  }
};

/// The region that the mesh's facets enclose, for about n particles. Parts: the box around the
/// body is halved by planes of walls that still cross a part, until none does; those inside
/// stay. A convex body is one part at once. Throws InputError for curved faces.
Region make_region(const scene::Mesh& mesh, std::size_t n, const SourcePosition& where);

/// Convex pieces of the polygon that the directed segments enclose in the plane with unit
/// normal N (interior to their left, holes and several loops allowed), by halving along the
/// segments. Segments shorter than `tiny` are left out.
std::vector<ConvexPiece> convex_pieces(const std::vector<std::array<Vec3, 2>>& segments,
                                       const Vec3& N, double tiny);

/// Volume and centroid of the convex body inside all half-spaces within the box; volume 0 if
/// there is none.
struct Solid {
  double volume = 0;
  Vec3 centroid = Vec3::Zero();
};
Solid solid_inside(std::span<const HalfSpace> half_spaces, const Vec3& lower,
                   const Vec3& upper);

}  // namespace concord::particle::voronoi
