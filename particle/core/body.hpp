#pragma once
// The discrete body of a particle method: particles in sweep order with volumes, masses and the
// triangulation.

#include "particle/core/simd.hpp"
#include "particle/core/triangulation.hpp"
#include "scene/problem.hpp"

#include <vector>

namespace concord::particle {

/// Particles sorted by slabs of thickness about h along the body's longest axis, rows within a
/// slab, places within a row: neighbours are near in memory and a plane at a time can be swept.
/// The order follows from the positions alone.
struct Body {
  int dim = 3;
  int stride = 4;
  Index n = 0;
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

  double saved_s = 0;  ///< time that a cache spared: what making the body took, less reading it

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
