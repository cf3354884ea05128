#include "particle/core/triangulation.hpp"

#include "particle/core/body_surface.hpp"
#include "particle/core/delaunay_cells.hpp"
#include "particle/core/region_cells.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace concord::particle {
namespace {

/// Signed volumes of all cells.
std::vector<double> volumes_of(int dim, std::span<const Index> cells, std::span<const Vec3> X,
                               const Executor& executor) {
  const int nv = dim + 1;
  std::vector<double> volume(cells.size() / nv);
  executor.for_pieces(volume.size(), [&](std::size_t begin, std::size_t end) {
    std::array<Vec3, 4> P, g;
    for (std::size_t s = begin; s < end; ++s) {
      for (int k = 0; k < nv; ++k) P[k] = X[cells[s * nv + k]];
      volume[s] = volume_gradients(dim, P, g);
    }
  });
  return volume;
}

/// A facet, turned so that its lowest point comes first.
struct Facet {
  std::array<Index, 3> sorted{-1, -1, -1}, oriented{-1, -1, -1};

  Facet(int dim, const Index* v) {
    std::copy(v, v + dim, oriented.begin());
    if (dim == 3)
      std::rotate(oriented.begin(), std::min_element(oriented.begin(), oriented.end()),
                  oriented.end());
    sorted = oriented;
    std::sort(sorted.begin(), sorted.begin() + dim);
  }
};

/// The surface that is left of the hull when cells are dropped: facets of the hull and of
/// dropped cells, turned round, that occur once.
std::vector<Index> boundary_of(int dim, const HullCells& hull,
                               const std::vector<Index>& dropped) {
  std::vector<Facet> facets;
  for (std::size_t f = 0; f < hull.facets.size(); f += dim)
    facets.emplace_back(dim, &hull.facets[f]);
  for (const Index s : dropped) {
    for (int k = 0; k <= dim; ++k) {
      std::array<Index, 3> v =
          opposite_facet(dim, &hull.cells[static_cast<std::size_t>(s) * (dim + 1)], k);
      std::swap(v[0], v[1]);
      facets.emplace_back(dim, v.data());
    }
  }
  std::sort(facets.begin(), facets.end(),
            [](const Facet& p, const Facet& q) { return p.sorted < q.sorted; });
  std::vector<Index> boundary;
  for (std::size_t i = 0; i < facets.size();) {
    std::size_t j = i + 1;
    while (j < facets.size() && facets[j].sorted == facets[i].sorted) ++j;
    if (j == i + 1)
      boundary.insert(boundary.end(), facets[i].oriented.begin(),
                      facets[i].oriented.begin() + dim);
    i = j;
  }
  return boundary;
}

[[noreturn]] void not_reproduced(const scene::Problem& problem, const std::string& found,
                                 double h) {
  throw InputError(
      problem.geometry_where, "geometry", found,
      fmt::format(
          "a Delaunay triangulation of the particles that fills the body and has its boundary; "
          "use more particles (the spacing is {:.4g} m) or a smaller perturbation",
          h));
}

void check_against_body(const Triangulation& t, std::span<const Vec3> X,
                        const BodySurface& surface, const scene::Problem& problem, double h) {
  double volume = 0, area = 0;
  for (const double v : t.volume) volume += v;
  for (std::size_t f = 0; f < t.boundary.size(); f += t.dim)
    area += facet_area(t.dim, X, &t.boundary[f]).norm();
  if (std::abs(volume - surface.volume()) > 1e-9 * surface.volume() + surface.slack()) {
    not_reproduced(
        problem,
        fmt::format("cells with volume {:.10g} in a body of {:.10g}", volume, surface.volume()),
        h);
  }
  if (std::abs(area - surface.area()) > 1e-9 * surface.area() + surface.slack() / h) {
    not_reproduced(problem,
                   fmt::format("a boundary of measure {:.10g} on a body with {:.10g}", area,
                               surface.area()),
                   h);
  }
  for (const Index e : t.boundary_entity) {
    if (e < 0)
      not_reproduced(problem,
                     "a boundary facet that joins particles of different faces of the body", h);
  }
}

/// Moves the cells that stay to the front, in their order.
void erase_cells(int dim, const std::vector<Index>& dropped, std::vector<Index>& cells,
                 std::vector<double>& volume) {
  if (dropped.empty()) return;
  const std::size_t nv = dim + 1;
  auto next = dropped.begin();
  std::size_t kept = 0;
  for (std::size_t s = 0; s < volume.size(); ++s) {
    if (next != dropped.end() && static_cast<std::size_t>(*next) == s) {
      ++next;
      continue;
    }
    std::copy_n(cells.begin() + static_cast<std::ptrdiff_t>(s * nv), nv,
                cells.begin() + static_cast<std::ptrdiff_t>(kept * nv));
    volume[kept++] = volume[s];
  }
  cells.resize(kept * nv);
  volume.resize(kept);
}

}  // namespace

std::array<Index, 3> opposite_facet(int dim, const Index* v, int k) {
  if (dim == 2) return {v[(k + 1) % 3], v[(k + 2) % 3], -1};
  constexpr int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  return {v[face[k][0]], v[face[k][1]], v[face[k][2]]};
}

double volume_gradients(int dim, std::span<const Vec3> X, std::span<Vec3> g) {
  double volume = 0;
  if (dim == 3) {
    const Vec3 a = X[1] - X[0], b = X[2] - X[0], c = X[3] - X[0];
    g[1] = b.cross(c) / 6;
    g[2] = c.cross(a) / 6;
    g[3] = a.cross(b) / 6;
    g[0] = -(g[1] + g[2] + g[3]);
    volume = a.dot(g[1]);
  } else {
    const Vec3 a = X[1] - X[0], b = X[2] - X[0];
    g[1] = Vec3(b[1], -b[0], 0) / 2;
    g[2] = Vec3(-a[1], a[0], 0) / 2;
    g[0] = -(g[1] + g[2]);
    volume = (a[0] * b[1] - a[1] * b[0]) / 2;
  }
  return volume;
}

double shape_gradients(int dim, std::span<const Vec3> X, std::span<Vec3> g) {
  const double volume = volume_gradients(dim, X, g);
  for (int k = 0; k <= dim; ++k) g[k] /= volume;
  return volume;
}

Triangulation triangulate(const scene::Mesh& mesh, const scene::Problem& problem,
                          std::span<const Index> number, const Executor& executor) {
  Triangulation t;
  t.dim = mesh.dim;
  std::vector<Vec3> X(mesh.nodes.size());
  for (std::size_t a = 0; a < X.size(); ++a) X[number[a]] = mesh.nodes[a];
  std::optional<HullCells> lattice;
  if (mesh.dim == 3) lattice = lattice_cells(X);
  HullCells hull = lattice ? std::move(*lattice) : delaunay_cells(mesh.dim, X, executor);
  if (hull.cells.empty())
    not_reproduced(problem, "particles that all lie in one plane or line", mesh.h);
  t.volume = volumes_of(mesh.dim, hull.cells, X, executor);
  const BodySurface surface(mesh, number, X);
  const std::vector<Index> dropped =
      cells_outside(mesh.dim, hull, t.volume, surface, X, 1e-10 * std::pow(mesh.h, mesh.dim));
  t.boundary = boundary_of(mesh.dim, hull, dropped);
  erase_cells(mesh.dim, dropped, hull.cells, t.volume);
  t.simplices = std::move(hull.cells);
  for (double& v : t.volume) v = std::abs(v);
  t.on_boundary.assign(X.size(), 0);
  for (std::size_t f = 0; f < t.boundary.size(); f += t.dim) {
    t.boundary_entity.push_back(surface.entity_of(&t.boundary[f]));
    for (int k = 0; k < t.dim; ++k) t.on_boundary[t.boundary[f + k]] = 1;
  }
  check_against_body(t, X, surface, problem, mesh.h);
  return t;
}

}  // namespace concord::particle
