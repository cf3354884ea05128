#pragma once
// voro++ cells cut by the convex parts of the body.

#include "particle/voronoi/region.hpp"

namespace concord::particle::voronoi {

/// Faces (and polygons if asked for) of the cells of all particles X [m] in the region; volumes
/// and centroids are left empty. Each interior face comes from the cell of its lower-numbered
/// particle. Throws InputError for particles that have no cell in the region.
Cells tessellate(const Region& region, int dim, double thickness, std::span<const Vec3> X,
                 const Executor& executor, const CellOptions& options);

/// Area [m^2] below which a face is not told from an edge: positions are known to eps times the
/// body's extent, so an edge between cospherical particles may open by some of that.
double smallest_area(const Region& region, int dim, double thickness);

/// Throws the InputError for a particle without a cell: outside, or where another one is.
[[noreturn]] void no_cell(std::span<const Vec3> X, Index a, const SourcePosition& where);

/// make_cells without its last check: also where particles do not see all of their cells.
Cells all_cells(const scene::Mesh& mesh, double thickness, std::span<const Vec3> X,
                const Executor& executor, const CellOptions& options);

/// Wall pieces (indices into faces) whose plane is nearer to the particle than `least` times
/// V_a^(1/dim), or behind it.
std::vector<Index> hidden_walls(const Cells& cells, std::span<const Vec3> X, double least);

/// Below this fraction of V_a^(1/dim) make_cells holds a particle to lie in a wall's plane:
/// B_ag grows with 1/d, and with it round-off in what a ghost does.
constexpr double least_distance = 1e-3;

/// Kind, tag and groups of an entity, for messages.
std::string wall_name(const scene::Mesh& mesh, Index entity);

}  // namespace concord::particle::voronoi
