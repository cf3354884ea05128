#pragma once
// The discrete body of a particle method: particles in sweep order with volumes, masses and the
// triangulation.

#include "particle/core/simd.hpp"
#include "particle/core/triangulation.hpp"
#include "scene/problem.hpp"

#include <array>
#include <memory>
#include <vector>

namespace concord::particle {

/// Displacement conditions of the components at one place: indices into Problem::boundaries,
/// -1 for free ones.
using Conditions = std::array<Index, 3>;

/// A point without mass on the surface, through which a displacement condition acts where the
/// particles lie inside the body.
struct BoundaryPoint {
  Index particle = -1;               ///< in whose cell's face it lies
  Index entity = -1;                 ///< index into Mesh::entities
  Conditions condition{-1, -1, -1};  ///< at least one of them is there
  Vec3 N = Vec3::Zero();             ///< outward unit normal
};

/// A plane piece of the surface that bounds one particle's cell, where particles lie inside.
struct SurfacePiece {
  Index particle = -1;
  Index entity = -1;                 ///< index into Mesh::entities
  Index point = -1;                  ///< boundary point at its centroid; -1 where all is free
  Conditions condition{-1, -1, -1};  ///< of displacement
  double area = 0;                   ///< [m^2], thickness included
  Vec3 C = Vec3::Zero();             ///< centroid [m]
  Vec3 N = Vec3::Zero();             ///< outward unit normal
};

/// What a formulation found out while it made a body, for its model; only it knows what.
struct FormulationData {
  virtual ~FormulationData() = default;
};

/// Particles sorted by slabs of thickness about h along the body's longest axis, rows within a
/// slab, places within a row: neighbours are near in memory and a plane at a time can be swept.
/// The order follows from the positions alone.
///
/// Formulations either have their particles on the faces of the body too, or all of them inside
/// (inside_body.hpp). Columns are over all points: the particles with mass, [0, bulk), and
/// after them boundary points, [bulk, n), with V = m = 0; the first kind has none.
struct Body {
  int dim = 3;
  int stride = 4;
  Index n = 0;           ///< points
  Index bulk = 0;        ///< particles: points with mass
  double h = 0;          ///< mean spacing asked for [m]
  double h_min = 0;      ///< shortest edge of the triangulation [m]
  double thickness = 1;  ///< [m], 1 in 3D
  Column X;              ///< reference positions, `stride` doubles a particle [m]
  std::vector<double>
      V;  ///< V_a = sum |t|/(n+1) over the simplices at a, times thickness [m^3]
  std::vector<double> m;        ///< rho0 V_a [kg]
  std::vector<Index> node;      ///< mesh node of each particle
  std::vector<Index> particle;  ///< particle of each mesh node
  Triangulation triangulation;  ///< vertices are particles; without volumes
  scene::Mesh mesh;             ///< gmsh's mesh, with groups (node numbers); cells may be gone
  std::vector<BoundaryPoint> boundary;  ///< of the points [bulk, n)
  std::vector<SurfacePiece> surface;    ///< all of it, where the particles lie inside
  std::shared_ptr<const FormulationData> data;

  double saved_s = 0;  ///< time that a cache spared: what making the body took, less reading it

  /// Whether the particles lie inside the body, none on its faces; then they are no mesh nodes.
  bool inside() const { return !surface.empty(); }
  /// The particle that a point is, or to whose cell it belongs.
  Index particle_at(Index point) const {
    return point < bulk ? point : boundary[point - bulk].particle;
  }
  Vec3 position(Index a) const {
    Vec3 r = Vec3::Zero();
    for (int i = 0; i < dim; ++i) r[i] = X[static_cast<std::size_t>(a) * stride + i];
    return r;
  }
  /// |t| of a simplex [m^dim].
  double simplex_volume(std::size_t s) const;
};

/// Where the simplices between the particles come from.
enum class CellSource {
  delaunay,  ///< Delaunay triangulation of the particles
  mesh       ///< the cells of gmsh's mesh
};

/// The nodes that gmsh arranges at spacing h, with the surface. Only these matter to Delaunay
/// cells; hexahedra give a lattice's with a sixth of the elements, and simplices stand in where
/// gmsh cannot fill the body with them. Throws InputError (geometry cannot be filled).
scene::Mesh arrangement(const scene::Problem& problem, double h, CellSource cells);

/// Meshes the geometry at spacing h, perturbs, triangulates and sorts; the same body for every
/// number of threads. Its mesh has no cells where the triangulation is Delaunay's. Bodies that
/// take long come from $CONCORD_CACHE if that is set (body_cache.hpp). Throws InputError
/// (geometry cannot be filled).
Body make_body(const scene::Problem& problem, double h, double perturb, std::uint64_t seed,
               CellSource cells = CellSource::delaunay, const Executor& executor = Executor(1));

/// The same from a mesh that is there already (tests, benchmarks).
Body make_body(const scene::Problem& problem, scene::Mesh mesh,
               CellSource cells = CellSource::delaunay, const Executor& executor = Executor(1));

}  // namespace concord::particle
