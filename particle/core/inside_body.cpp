#include "particle/core/inside_body.hpp"

#include "particle/core/boundary.hpp"
#include "particle/core/delaunay_cells.hpp"
#include "particle/core/sweep_order.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace concord::particle {
namespace {

[[noreturn]] void refuse(const scene::BoundaryCondition& bc, const std::string& what) {
  throw InputError(bc.where, "boundary",
                   fmt::format("a displacement on \"{}\", {}", bc.group, what),
                   "for a method whose particles lie inside the body, none on its faces: "
                   "displacements on surfaces (3D) or curves (plane), or on the whole body");
}

/// Which line through two points crosses which piece of the body's surface.
class Crossings {
 public:
  Crossings(const scene::Mesh& mesh, std::span<const SurfacePiece> surface,
            std::span<const Vec3> X)
      : m_mesh(mesh), m_surface(surface), m_X(X), m_begin(X.size() + 1, 0) {
    for (const SurfacePiece& piece : surface) ++m_begin[piece.particle + 1];
    for (std::size_t a = 0; a < X.size(); ++a) m_begin[a + 1] += m_begin[a];
    m_pieces.resize(surface.size());
    std::vector<Index> next(m_begin.begin(), m_begin.end() - 1);
    for (std::size_t k = 0; k < surface.size(); ++k)
      m_pieces[next[surface[k].particle]++] = static_cast<Index>(k);
    m_facets.resize(mesh.entities.size());
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
      m_facets[mesh.facet_entity[f]].push_back(static_cast<Index>(f));
  }

  /// Whether some particle lies behind the plane of a face of the body: never in convex ones.
  bool possible() const {
    std::vector<char> seen(m_mesh.entities.size(), 0);
    for (const SurfacePiece& piece : m_surface) {
      if (seen[piece.entity]++ != 0) continue;
      for (const Vec3& X : m_X) {
        if (piece.N.dot(X - piece.C) > 0) return true;
      }
    }
    return false;
  }

  /// Whether an edge of the simplex crosses a face of the body that bounds a vertex' cell.
  bool cross(const Index* vertices, int count) const {
    for (int c = 0; c < count; ++c) {
      for (Index k = m_begin[vertices[c]]; k < m_begin[vertices[c] + 1]; ++k) {
        for (int i = 0; i < count; ++i) {
          for (int j = 0; j < i; ++j) {
            if (crosses(m_X[vertices[i]], m_X[vertices[j]], m_surface[m_pieces[k]]))
              return true;
          }
        }
      }
    }
    return false;
  }

 private:
  bool crosses(const Vec3& from, const Vec3& to, const SurfacePiece& piece) const {
    const double d_from = piece.N.dot(from - piece.C), d_to = piece.N.dot(to - piece.C);
    if (d_from * d_to >= 0) return false;
    const Vec3 at = from + d_from / (d_from - d_to) * (to - from);
    const std::vector<Index>& facets = m_facets[piece.entity];
    return std::any_of(facets.begin(), facets.end(),
                       [&](Index f) { return in_facet(at, piece.N, f); });
  }

  /// Whether a point of a facet's plane (line) lies in it, its border included.
  bool in_facet(const Vec3& at, const Vec3& N, Index facet) const {
    constexpr double slack = 1e-9;
    const int count = m_mesh.nodes_per_facet;
    const Index* v = &m_mesh.facets[static_cast<std::size_t>(facet) * count];
    if (m_mesh.dim == 2) {
      const Vec3 along = m_mesh.nodes[v[1]] - m_mesh.nodes[v[0]];
      const double share = along.dot(at - m_mesh.nodes[v[0]]) / along.squaredNorm();
      return share > -slack && share < 1 + slack;
    }
    for (int k = 0; k < count; ++k) {  // outward oriented: to the left of every side
      const Vec3 &p = m_mesh.nodes[v[k]], &q = m_mesh.nodes[v[(k + 1) % count]];
      if (N.dot((q - p).cross(at - p)) < -slack * (q - p).squaredNorm()) return false;
    }
    return true;
  }

  const scene::Mesh& m_mesh;
  std::span<const SurfacePiece> m_surface;
  std::span<const Vec3> m_X;
  std::vector<Index> m_begin, m_pieces;  ///< pieces of each particle
  std::vector<std::vector<Index>> m_facets;
};

/// Whether a simplex is so flat that gradients in it are those of round-off and of the method's
/// error over its height: below a quarter of the flattest one of a lattice, in 3D the half of a
/// pyramid over a face's triangle (h^3/6 and sqrt(3) h), in the plane the half square.
bool is_flat(int dim, const Index* v, std::span<const Vec3> X) {
  std::array<Vec3, 4> P, g;
  double longest = 0;  // squared
  for (int i = 0; i <= dim; ++i) {
    P[i] = X[v[i]];
    for (int j = 0; j < i; ++j) longest = std::max(longest, (P[i] - P[j]).squaredNorm());
  }
  const double lattice = dim == 3 ? 1 / (6 * std::pow(3, 1.5)) : 0.25;
  return std::abs(volume_gradients(dim, P, g)) < 0.25 * lattice * std::pow(longest, 0.5 * dim);
}

Triangulation join(const scene::Mesh& mesh, const InsideParts& parts,
                   const Executor& executor) {
  Triangulation t;
  t.dim = mesh.dim;
  std::optional<HullCells> lattice;
  if (mesh.dim == 3) lattice = lattice_cells(parts.X);
  t.simplices =
      lattice ? std::move(lattice->cells) : delaunay_cells(mesh.dim, parts.X, executor).cells;
  t.on_boundary.assign(parts.X.size(), 0);
  for (const SurfacePiece& piece : parts.surface) t.on_boundary[piece.particle] = 1;
  const Crossings crossings(mesh, parts.surface, parts.X);
  const bool may_cross = crossings.possible();
  const std::size_t nv = mesh.dim + 1;
  std::size_t kept = 0;
  for (std::size_t s = 0; s < t.size(); ++s) {
    const Index* v = &t.simplices[s * nv];
    if (is_flat(mesh.dim, v, parts.X)) continue;
    if (may_cross && crossings.cross(v, static_cast<int>(nv))) continue;
    std::copy_n(v, nv, &t.simplices[nv * kept++]);
  }
  t.simplices.resize(nv * kept);
  return t;
}

void add_points(Body& body, const InsideParts& parts) {
  const auto add = [&](const Vec3& X) {
    for (int i = 0; i < body.stride; ++i) body.X.push_back(i < body.dim ? X[i] : 0.0);
  };
  body.X.reserve((parts.X.size() + parts.points.size()) * body.stride);
  for (const Vec3& X : parts.X) add(X);
  for (std::size_t k = 0; k < parts.points.size(); ++k) {
    const SurfacePiece& piece = parts.surface[parts.owner[k]];
    body.boundary.push_back({piece.particle, piece.entity, piece.condition, piece.N});
    add(parts.points[k]);
  }
}

}  // namespace

bool is_whole_body(const scene::Mesh::Group& group, const scene::Mesh& mesh) {
  const auto parts = std::count_if(mesh.entities.begin(), mesh.entities.end(),
                                   [&](const scene::Entity& e) { return e.dim == mesh.dim; });
  return group.dim == mesh.dim && static_cast<std::ptrdiff_t>(group.entities.size()) == parts;
}

Conditions conditions_everywhere(const scene::Problem& problem, const scene::Mesh& mesh) {
  Conditions conditions{-1, -1, -1};
  for (std::size_t k = 0; k < problem.boundaries.size(); ++k) {
    const scene::BoundaryCondition& bc = problem.boundaries[k];
    if (bc.kind == scene::BoundaryKind::traction) continue;
    (void)mesh.group_nodes(bc.group, bc.where);  // reports a missing group
    const scene::Mesh::Group& group = mesh.groups.at(bc.group);
    if (group.dim == mesh.dim - 1) continue;
    if (group.dim < mesh.dim - 1)
      refuse(bc, group.dim == 0 ? "a group of points" : "a group of curves");
    if (!is_whole_body(group, mesh)) refuse(bc, "part of the body");
    const std::array<bool, 3> components = prescribed_components(bc, mesh);
    for (int i = 0; i < 3; ++i) {
      if (components[i] && conditions[i] < 0) conditions[i] = static_cast<Index>(k);
    }
  }
  return conditions;
}

std::vector<Vec3> in_sweep_order(const scene::Mesh& mesh, std::span<const Vec3> X, double h,
                                 const Executor& executor) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const Vec3& node : mesh.nodes) {
    low = low.cwiseMin(node);
    high = high.cwiseMax(node);
  }
  const Vec3 inset = (0.5 * (high - low)).cwiseMin(Vec3::Constant(0.5 * h));
  std::vector<Vec3> sorted;
  sorted.reserve(X.size());
  for (const Index a : sweep_order(mesh.dim, h, X, low + inset, high - inset, executor))
    sorted.push_back(X[a]);
  return sorted;
}

Body inside_body(const scene::Problem& problem, scene::Mesh mesh, double h, InsideParts parts,
                 const Executor& executor) {
  Body body;
  body.dim = mesh.dim;
  body.stride = stride_of(mesh.dim);
  body.bulk = static_cast<Index>(parts.X.size());
  body.n = body.bulk + static_cast<Index>(parts.points.size());
  body.h = h;
  body.h_min = parts.h_min;
  body.thickness = problem.thickness;
  body.triangulation = join(mesh, parts, executor);
  add_points(body, parts);
  body.V = std::move(parts.V);
  body.V.resize(body.n, 0.0);
  body.m.resize(body.n);
  for (Index a = 0; a < body.n; ++a) body.m[a] = problem.material.rho0 * body.V[a];
  body.surface = std::move(parts.surface);
  body.mesh = std::move(mesh);
  return body;
}

}  // namespace concord::particle
