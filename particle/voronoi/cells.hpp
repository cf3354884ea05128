#pragma once
// Voronoi cells of particles inside a body, clipped by its plane faces: volumes, faces between
// particles, and pieces of the body's surface (Sec. 2.1 of the Voronoi paper).

#include "particle/core/parallel.hpp"
#include "scene/geometry.hpp"

#include <filesystem>
#include <span>
#include <vector>

namespace concord::particle::voronoi {

/// A flat entity of the mesh (surface in 3D, straight curve in the plane) that is part of the
/// body's boundary. Coplanar entities are walls of their own with the same N and offset.
struct Wall {
  Index entity = -1;      ///< index into Mesh::entities
  Vec3 N = Vec3::Zero();  ///< outward unit normal
  double offset = 0;      ///< N . X = offset on the wall [m]
};

/// What a cell shares with one other cell, or with one wall: all pieces of it taken together.
struct Face {
  Index a = -1;           ///< particle; N points out of its cell
  Index b = -1;           ///< interior: the particle on the other side, a < b; wall piece: -1
  Index wall = -1;        ///< wall piece: index into Cells::walls; interior: -1
  double A = 0;           ///< area [m^2]; in the plane length times thickness
  Vec3 C = Vec3::Zero();  ///< centroid C_ab (VOR.2) [m]
};

/// Polygons of the faces (segments in the plane), for drawing.
struct FacePolygons {
  std::vector<Vec3> points;        ///< corners, polygon after polygon [m]
  std::vector<std::size_t> begin;  ///< first corner of each polygon; one more at the end
  std::vector<Index> face;         ///< index into Cells::faces of each polygon
};

/// The cells of all particles. Each face is computed once and seen alike from both sides.
/// With A_ab = A N, N = X_ab/L_ab, L_ab = |X_ab|, and for a wall piece g the ghost
/// X_ag = 2 d N, d = offset - N . X_a > 0, W_ag = X_a + d N:
///   sum_b A_ab = 0,   B_ab = A/L (C - X_a),   sum_b X_ab (x) B_ab = V_a I   (VOR.7, VOR.8)
/// hold for every cell to round-off.
struct Cells {
  int dim = 3;
  double thickness = 1;        ///< [m], 1 in 3D
  std::vector<double> V;       ///< V_a [m^3], thickness included
  std::vector<Vec3> centroid;  ///< of each cell [m]
  std::vector<Wall> walls;     ///< in the order of their entities
  std::vector<Face> faces;     ///< interior faces by (a, b), then wall pieces by (a, wall)
  std::size_t interior = 0;    ///< number of interior faces
  FacePolygons polygons;       ///< empty unless asked for
};

/// What is wanted besides the cells, and where the geometry was named (for messages).
struct CellOptions {
  bool polygons = false;
  SourcePosition where = {"geometry", 0, 0};
};

/// Cells of the particles X [m] in the body whose boundary facets `mesh` holds (its spacing
/// does not matter), for dim = 2 with the thickness [m] given. The same bits for every number
/// of threads; cost linear in the particles. Faces smaller than round-off in the positions lets
/// one tell from an edge are left out on both sides (README, Cells).
///
/// Throws InputError at options.where: for curved faces (plane walls only; names entity and
/// groups), particles outside the body or in one place, and where a particle does not see all
/// of its cell - a piece of wall lies behind it or in its own plane (d < V_a^(1/dim)/1000),
/// which happens next to re-entrant edges (place_particles keeps clear of that).
Cells make_cells(const scene::Mesh& mesh, int dim, double thickness, std::span<const Vec3> X,
                 const Executor& executor = Executor(1), const CellOptions& options = {});

/// Writes the polygons of the cells to a VTKHDF file (UnstructuredGrid of polygons; of lines in
/// the plane): /VTKHDF/Points, Connectivity, Offsets, Types and per polygon CellData/particle
/// (a), CellData/neighbour (b, -1 at walls) and CellData/wall (0 interior, 1 wall piece).
/// `number` renames particles (empty: as they are). Needs cells made with polygons.
void write_cells(const std::filesystem::path& file, const Cells& cells,
                 std::span<const Index> number = {});

}  // namespace concord::particle::voronoi
