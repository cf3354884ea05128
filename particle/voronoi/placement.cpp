#include "particle/voronoi/placement.hpp"

#include "particle/core/body_surface.hpp"
#include "particle/voronoi/tessellation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace concord::particle::voronoi {
namespace {

/// Particles next to re-entrant edges keep this distance from the walls of their cells, as a
/// fraction of V_a^(1/dim); half of what the lattice perturbed by a quarter leaves.
constexpr double clear_distance = 0.1;
constexpr double edge_step = 0.03;  // of the spacing: a third of clear_distance
constexpr int edge_rounds = 60;     // enough to move by more than a spacing

std::vector<Vec3> cell_centroids(const scene::Mesh& mesh) {
  std::vector<Vec3> X(mesh.cell_count(), Vec3::Zero());
  const auto n = static_cast<std::size_t>(mesh.nodes_per_cell);
  for (std::size_t c = 0; c < X.size(); ++c)
    for (std::size_t k = 0; k < n; ++k)
      X[c] += mesh.nodes[mesh.cells[c * n + k]] / static_cast<double>(n);
  return X;
}

/// Distances to all walls that X lies before.
class Distances {
 public:
  explicit Distances(std::vector<Wall> walls) : m_walls(std::move(walls)) {}

  /// Whether Y has at least half the distance of X to each wall that X lies before.
  bool keeps_half(const Vec3& X, const Vec3& Y) const {
    return std::all_of(m_walls.begin(), m_walls.end(), [&](const Wall& w) {
      const double before = w.offset - w.N.dot(X), after = w.offset - w.N.dot(Y);
      return before <= 0 || after >= 0.5 * before;
    });
  }

 private:
  std::vector<Wall> m_walls;
};

/// A lattice of spacing h in the middle of the body's box, as far as it lies inside and a
/// quarter of h away from the walls before it.
std::vector<Vec3> inner_lattice(const scene::Mesh& mesh, const Region& region, double h) {
  std::vector<Index> number(mesh.nodes.size());
  std::iota(number.begin(), number.end(), 0);
  const BodySurface surface(mesh, number, mesh.nodes);
  const Vec3 lower = region.lower / region.scale.factor,
             upper = region.upper / region.scale.factor;
  std::array<Index, 3> count{1, 1, 1};
  for (int k = 0; k < mesh.dim; ++k)
    count[k] = std::max<Index>(1, static_cast<Index>(std::lround((upper[k] - lower[k]) / h)));
  const auto inside = [&](const Vec3& X) {
    bool behind = false;
    for (const Wall& w : region.walls) {
      const double d = w.offset - w.N.dot(X);
      if (region.convex() && d < 0.25 * h) return false;
      behind = behind || d < 0.25 * h;
    }
    return !behind || surface.winding_number(X) > 0.5;
  };
  std::vector<Vec3> found;
  for (Index k = 0; k < count[2]; ++k)
    for (Index j = 0; j < count[1]; ++j)
      for (Index i = 0; i < count[0]; ++i) {
        const std::array<Index, 3> at{i, j, k};
        Vec3 X = Vec3::Zero();
        for (int c = 0; c < mesh.dim; ++c)
          X[c] = lower[c] + (at[c] + 0.5) * (upper[c] - lower[c]) / count[c];
        if (inside(X)) found.push_back(X);
      }
  return found;
}

/// Lloyd's iteration: particles to the centroids of their cells.
void make_centroidal(std::vector<Vec3>& X, const scene::Mesh& mesh, double h,
                     const Executor& executor, const CellOptions& options) {
  for (int sweep = 0; sweep < lloyd_sweeps; ++sweep) {
    const Cells cells = all_cells(mesh, 1, X, executor, options);
    double largest = 0;
    for (std::size_t a = 0; a < X.size(); ++a)
      largest = std::max(largest, (cells.centroid[a] - X[a]).norm());
    X = cells.centroid;
    if (largest <= lloyd_tolerance * h) return;
  }
}

/// The particle on the other side of a face, -1 if it is not one of a's.
Index other(const Face& face, Index a) {
  return face.a == a ? face.b : face.b == a ? face.a : -1;
}

/// The neighbour of a nearest to P that lies before the wall and before all walls that a sees:
/// the one that ought to have the re-entrant edge at P in its cell.
Index before_both(const Cells& cells, std::span<const Vec3> X, Index a, Index wall,
                  const Vec3& P) {
  std::vector<Wall> before = {cells.walls[wall]};
  for (std::size_t f = cells.interior; f < cells.faces.size(); ++f) {
    const Wall& w = cells.walls[cells.faces[f].wall];
    if (cells.faces[f].a == a && w.N.dot(X[a]) < w.offset) before.push_back(w);
  }
  Index best = -1;
  for (std::size_t f = 0; f < cells.interior; ++f) {
    const Index b = other(cells.faces[f], a);
    if (b < 0 || (best >= 0 && (X[b] - P).norm() >= (X[best] - P).norm())) continue;
    if (std::all_of(before.begin(), before.end(),
                    [&](const Wall& w) { return w.N.dot(X[b]) < w.offset; }))
      best = b;
  }
  return best;
}

/// Neither Lloyd's iteration nor lattices of unequal spacings know of re-entrant edges. Where a
/// particle's cell reaches round one, it steps back and the particle before the edge steps
/// forward until that has the edge.
void clear_edges(std::vector<Vec3>& X, const scene::Mesh& mesh, const Distances& walls,
                 double h, const Executor& executor, const CellOptions& options) {
  for (int round = 0; round < edge_rounds; ++round) {
    const Cells cells = all_cells(mesh, 1, X, executor, options);
    const std::vector<Index> hidden = hidden_walls(cells, X, clear_distance);
    if (hidden.empty()) return;
    std::vector<Vec3> step(X.size(), Vec3::Zero());
    for (const Index f : hidden) {
      const Face& face = cells.faces[f];
      step[face.a] += X[face.a] - face.C;
      const Index b = before_both(cells, X, face.a, face.wall, face.C);
      if (b >= 0) step[b] += face.C - X[b];
    }
    for (std::size_t a = 0; a < X.size(); ++a) {
      const Vec3 Y = X[a] + edge_step * h * step[a].normalized();
      if (walls.keeps_half(X[a], Y)) X[a] = Y;
    }
  }
}

void perturb(std::vector<Vec3>& X, const Distances& walls, int dim, double size,
             std::uint64_t seed) {
  for (std::size_t a = 0; a < X.size(); ++a) {
    Vec3 step = Vec3::Zero();
    for (int k = 0; k < dim; ++k)
      step[k] = size * (2 * scene::uniform_random(seed, a, static_cast<std::uint64_t>(k)) - 1);
    while (!walls.keeps_half(X[a], X[a] + step)) step *= 0.5;
    X[a] += step;
  }
}

/// Particles to put back where some cell is not seen from its particle: that one, those of its
/// neighbours that have walls, and the one that ought to have the edge; widely: all neighbours.
std::vector<char> around_hidden(const Cells& cells, std::span<const Vec3> X, bool widely) {
  std::vector<char> at_wall(X.size(), widely), hidden(X.size(), 0);
  for (std::size_t f = cells.interior; f < cells.faces.size(); ++f)
    at_wall[cells.faces[f].a] = 1;
  std::vector<char> found(X.size(), 0);
  for (const Index f : hidden_walls(cells, X, clear_distance)) {
    const Face& face = cells.faces[f];
    hidden[face.a] = found[face.a] = 1;
    const Index b = before_both(cells, X, face.a, face.wall, face.C);
    if (b >= 0) found[b] = 1;
  }
  for (std::size_t f = 0; f < cells.interior; ++f) {
    const Face& face = cells.faces[f];
    if (hidden[face.a] && at_wall[face.b]) found[face.b] = 1;
    if (hidden[face.b] && at_wall[face.a]) found[face.a] = 1;
  }
  return found;
}

/// Takes displacements back until every particle sees its cell, or none there is left.
void withdraw(std::vector<Vec3>& X, const std::vector<Vec3>& unperturbed,
              const scene::Mesh& mesh, const Executor& executor, const CellOptions& options) {
  bool moved = true;
  while (moved) {
    const Cells cells = all_cells(mesh, 1, X, executor, options);
    moved = false;
    for (const bool widely : {false, true}) {
      const std::vector<char> back = around_hidden(cells, X, widely);
      for (std::size_t a = 0; a < X.size(); ++a) {
        if (!back[a] || X[a] == unperturbed[a]) continue;
        X[a] = unperturbed[a];
        moved = true;
      }
      if (moved) break;
    }
  }  // what is left, make_cells reports
}

}  // namespace

std::vector<Vec3> place_particles(const scene::Problem& problem, double h, double perturb_by,
                                  std::uint64_t seed, const Executor& executor) {
  if (!(perturb_by >= 0 && perturb_by < 0.5))
    throw InputError({"request", 0, 0}, "perturb", fmt::format("{}", perturb_by),
                     "a fraction of the spacing from 0 to below 0.5");
  const bool lattice = problem.layout == scene::Layout::lattice;
  const scene::Mesh mesh = scene::make_mesh(
      problem, {h, lattice ? scene::CellShape::hypercube : scene::CellShape::simplex, 1,
                problem.layout});
  const CellOptions options{false, problem.geometry_where};
  std::vector<Vec3> X = lattice ? cell_centroids(mesh) : std::vector<Vec3>{};
  const Region region =
      make_region(mesh, std::max<std::size_t>(X.size(), 1), problem.geometry_where);
  if (!lattice) {
    X = inner_lattice(mesh, region, h);
    if (X.empty())
      throw InputError(problem.geometry_where, "geometry",
                       fmt::format("no particle inside the body at a spacing of {:.4g} m", h),
                       "a spacing below the body's thickness");
    make_centroidal(X, mesh, h, executor, options);
  }
  if (!region.convex()) clear_edges(X, mesh, Distances(region.walls), h, executor, options);
  if (perturb_by == 0) return X;
  const std::vector<Vec3> unperturbed = X;
  perturb(X, Distances(region.walls), mesh.dim, perturb_by * h, seed);
  if (!region.convex()) withdraw(X, unperturbed, mesh, executor, options);
  return X;
}

}  // namespace concord::particle::voronoi
