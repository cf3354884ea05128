#pragma once
// Where the particles of the Voronoi method lie: inside the body, one a cell.

#include "particle/core/parallel.hpp"
#include "scene/problem.hpp"

#include <vector>

namespace concord::particle::voronoi {

/// Particles at mean spacing h [m]. Layout lattice: centroids of the cells of the structured
/// mesh of quadrangles or hexahedra (scene::make_mesh), in its order. Layout unstructured: a
/// lattice of spacing h inside the body, then Lloyd's iteration (each particle to the centroid
/// of its clipped cell) until no particle moves further than `lloyd_tolerance` h, or
/// `lloyd_sweeps` times.
///
/// In bodies that are not convex, particles around re-entrant edges are moved by small steps
/// until each sees all of its cell (README, Cells); lattices of equal spacings need none.
///
/// Then every particle is moved by a vector with components uniform in [-perturb h, perturb h]
/// (scene::uniform_random of seed, particle and component), halved until its distance to each
/// wall that it lies before is at least half of what it was. Next to re-entrant edges particles
/// stay where they were, if else some particle would not see all of its cell.
/// Depends on the arguments alone, not on threads.
///
/// Throws InputError at the problem's geometry where no particle fits, and what make_cells
/// throws.
std::vector<Vec3> place_particles(const scene::Problem& problem, double h, double perturb,
                                  std::uint64_t seed, const Executor& executor = Executor(1));

constexpr double lloyd_tolerance = 5e-3;
constexpr int lloyd_sweeps = 100;

}  // namespace concord::particle::voronoi
