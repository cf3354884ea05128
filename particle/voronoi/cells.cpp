#include "particle/voronoi/cells.hpp"

#include "particle/voronoi/tessellation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

namespace concord::particle::voronoi {
namespace {

/// V_a and centroids from the faces that both sides share: pyramids (triangles in the plane)
/// over each face with their tip at X_a, of height d_ab = N . (C - X_a).
void add_volumes(Cells& cells, std::span<const Vec3> X) {
  cells.V.assign(X.size(), 0);
  cells.centroid.assign(X.size(), Vec3::Zero());  // V_a (centroid - X_a), first
  const double n = cells.dim;
  const auto add = [&](Index a, const Vec3& C, double Ad) {
    cells.V[a] += Ad / n;
    cells.centroid[a] += Ad / (n + 1) * (C - X[a]);
  };
  for (const Face& face : cells.faces) {
    if (face.wall >= 0) {
      const Wall& wall = cells.walls[face.wall];
      add(face.a, face.C, face.A * (wall.offset - wall.N.dot(X[face.a])));
    } else {
      const double d = 0.5 * (X[face.b] - X[face.a]).norm();
      add(face.a, face.C, face.A * d);
      add(face.b, face.C, face.A * d);
    }
  }
  for (std::size_t a = 0; a < X.size(); ++a)
    cells.centroid[a] = X[a] + cells.centroid[a] / cells.V[a];
}

std::string place_of(std::span<const Vec3> X, Index a) {
  return fmt::format("particle {} at ({:.6g}, {:.6g}, {:.6g}) m", a, X[a][0], X[a][1], X[a][2]);
}

/// Throws where two particles share a place.
void require_distinct(std::span<const Vec3> X, const SourcePosition& where) {
  std::vector<Index> order(X.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](Index a) { return std::tuple(X[a][0], X[a][1], X[a][2], a); };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (X[order[i - 1]] == X[order[i]])
      throw InputError(
          where, "particles",
          fmt::format("{} and particle {} in one place", place_of(X, order[i - 1]), order[i]),
          "one particle a place");
}

/// Cells overlap where particles share a place; else the walls are at fault.
void require_filled(const Cells& cells, const Region& region, std::span<const Vec3> X,
                    const SourcePosition& where) {
  const double volume = std::accumulate(cells.V.begin(), cells.V.end(), 0.0);
  const double body = region.volume * cells.thickness;
  if (std::abs(volume - body) <= 1e-9 * body) return;
  require_distinct(X, where);
  throw InputError(
      where, "geometry",
      fmt::format("Voronoi cells of volume {:.10g} m^3 in a body of {:.10g} m^3", volume, body),
      "particles inside a body whose plane walls close it");
}

}  // namespace

void no_cell(std::span<const Vec3> X, Index a, const SourcePosition& where) {
  require_distinct(X, where);
  throw InputError(where, "particles", place_of(X, a) + " outside the body",
                   "particles inside the body");
}

std::vector<Index> hidden_walls(const Cells& cells, std::span<const Vec3> X, double least) {
  std::vector<Index> hidden;
  for (std::size_t f = cells.interior; f < cells.faces.size(); ++f) {
    const Face& face = cells.faces[f];
    const Wall& wall = cells.walls[face.wall];
    const double size = std::pow(
        std::abs(cells.V[face.a]) / (cells.dim == 2 ? cells.thickness : 1), 1.0 / cells.dim);
    if (!(wall.offset - wall.N.dot(X[face.a]) >= least * size))
      hidden.push_back(static_cast<Index>(f));
  }
  return hidden;
}

Cells all_cells(const scene::Mesh& mesh, double thickness, std::span<const Vec3> X,
                const Executor& executor, const CellOptions& options) {
  const Region region = make_region(mesh, X.size(), options.where);
  Cells cells = tessellate(region, mesh.dim, thickness, X, executor, options);
  add_volumes(cells, X);
  require_filled(cells, region, X, options.where);
  return cells;
}

Cells make_cells(const scene::Mesh& mesh, int dim, double thickness, std::span<const Vec3> X,
                 const Executor& executor, const CellOptions& options) {
  if (dim != mesh.dim) throw std::logic_error("make_cells: a mesh of another dimension");
  Cells cells = all_cells(mesh, thickness, X, executor, options);
  const std::vector<Index> hidden = hidden_walls(cells, X, least_distance);
  if (hidden.empty()) return cells;
  const Face& face = cells.faces[hidden.front()];
  const Wall& wall = cells.walls[face.wall];
  throw InputError(
      options.where, "particles",
      fmt::format(
          "{} with a piece of {} of its cell, at ({:.6g}, {:.6g}, {:.6g}) m, {} ({} such "
          "pieces)",
          place_of(X, face.a), wall_name(mesh, wall.entity), face.C[0], face.C[1], face.C[2],
          wall.offset - wall.N.dot(X[face.a]) > 0 ? "next to its plane" : "seen from behind",
          hidden.size()),
      "particles that see all of their cells: away from walls, and next to re-entrant edges as "
      "far from the edge as their neighbours around it");
}

}  // namespace concord::particle::voronoi
