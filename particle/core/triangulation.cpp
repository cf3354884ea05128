#include "particle/core/triangulation.hpp"

#include <Eigen/Geometry>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

namespace concord::particle {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// All cells of the convex hull's triangulation, dim+1 vertices each.
std::vector<Index> hull_cells(const scene::Mesh& mesh) {
  std::vector<Index> cells;
  if (mesh.dim == 3) {
    using Vb = CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>;
    using Cb = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
    using Tri =
        CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vb, Cb>>;
    std::vector<std::pair<Kernel::Point_3, Index>> points;
    points.reserve(mesh.nodes.size());
    for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
      const Vec3& X = mesh.nodes[a];
      points.emplace_back(Kernel::Point_3(X[0], X[1], X[2]), static_cast<Index>(a));
    }
    const Tri tri(points.begin(), points.end());
    if (tri.dimension() < 3) return cells;
    cells.reserve(4 * tri.number_of_finite_cells());
    for (auto c = tri.finite_cells_begin(); c != tri.finite_cells_end(); ++c) {
      for (int i = 0; i < 4; ++i) cells.push_back(c->vertex(i)->info());
    }
  } else {
    using Vb = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
    using Fb = CGAL::Triangulation_face_base_2<Kernel>;
    using Tri =
        CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vb, Fb>>;
    std::vector<std::pair<Kernel::Point_2, Index>> points;
    points.reserve(mesh.nodes.size());
    for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
      points.emplace_back(Kernel::Point_2(mesh.nodes[a][0], mesh.nodes[a][1]),
                          static_cast<Index>(a));
    }
    const Tri tri(points.begin(), points.end());
    if (tri.dimension() < 2) return cells;
    cells.reserve(3 * tri.number_of_faces());
    for (auto c = tri.finite_faces_begin(); c != tri.finite_faces_end(); ++c) {
      for (int i = 0; i < 3; ++i) cells.push_back(c->vertex(i)->info());
    }
  }
  return cells;
}

/// The mesh's boundary as simplices (quadrilateral facets split), dim vertices each, with their
/// entities.
struct Surface {
  std::vector<Index> facets;
  std::vector<Index> entity;
};

Surface body_surface(const scene::Mesh& mesh) {
  Surface s;
  const int m = mesh.nodes_per_facet;
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    const Index* v = &mesh.facets[f * m];
    s.facets.insert(s.facets.end(), v, v + mesh.dim);
    s.entity.push_back(mesh.facet_entity[f]);
    if (mesh.dim == 3 && m == 4) {
      s.facets.insert(s.facets.end(), {v[0], v[2], v[3]});
      s.entity.push_back(mesh.facet_entity[f]);
    }
  }
  return s;
}

/// Area vector of a facet (length vector in the plane), to the right of its orientation.
Vec3 facet_area(int dim, const std::vector<Vec3>& nodes, const Index* v) {
  if (dim == 2) {
    const Vec3 e = nodes[v[1]] - nodes[v[0]];
    return {e[1], -e[0], 0};
  }
  return 0.5 * (nodes[v[1]] - nodes[v[0]]).cross(nodes[v[2]] - nodes[v[0]]);
}

/// Solid angle (3D, Van Oosterom & Strackee 1983) or angle (2D) of a facet seen from X.
double seen_angle(int dim, const std::vector<Vec3>& nodes, const Index* v, const Vec3& X) {
  if (dim == 2) {
    const Vec3 a = nodes[v[0]] - X, b = nodes[v[1]] - X;
    return std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
  }
  const Vec3 a = nodes[v[0]] - X, b = nodes[v[1]] - X, c = nodes[v[2]] - X;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * std::atan2(a.dot(b.cross(c)), denominator);
}

/// Winding number of the (outward oriented) surface around X: 1 inside, 0 outside.
double winding_number(const scene::Mesh& mesh, const Surface& surface, const Vec3& X) {
  double angle = 0;
  for (std::size_t f = 0; f < surface.entity.size(); ++f) {
    angle += seen_angle(mesh.dim, mesh.nodes, &surface.facets[f * mesh.dim], X);
  }
  return angle / (mesh.dim == 3 ? 4 * std::numbers::pi : 2 * std::numbers::pi);
}

/// Per node: the faces of the body (entities) that it lies on, sorted; none inside.
using NodeFaces = std::vector<std::vector<Index>>;

NodeFaces node_faces(const scene::Mesh& mesh, const Surface& surface) {
  NodeFaces of_node(mesh.nodes.size());
  for (std::size_t f = 0; f < surface.entity.size(); ++f) {
    for (int k = 0; k < mesh.dim; ++k)
      of_node[surface.facets[f * mesh.dim + k]].push_back(surface.entity[f]);
  }
  for (auto& list : of_node) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return of_node;
}

/// Whether some face of the body holds all the vertices.
bool share_a_face(const NodeFaces& faces, const Index* v, int count) {
  return std::any_of(faces[v[0]].begin(), faces[v[0]].end(), [&](Index face) {
    return std::all_of(v + 1, v + count, [&](Index w) {
      return std::binary_search(faces[w].begin(), faces[w].end(), face);
    });
  });
}

/// Facets of the kept simplices that belong to one simplex only, outward oriented.
std::vector<Index> free_facets(const Triangulation& t) {
  const int nv = t.dim + 1;
  struct Entry {
    std::array<Index, 3> sorted, oriented;
    bool operator<(const Entry& o) const { return sorted < o.sorted; }
  };
  std::vector<Entry> entries;
  entries.reserve(t.size() * nv);
  for (std::size_t s = 0; s < t.size(); ++s) {
    const Index* v = &t.simplices[s * nv];
    for (int k = 0; k < nv; ++k) {
      Entry e{};
      if (t.dim == 3) {  // outward orientation of the face opposite to vertex k of a positive
                         // tetrahedron
        constexpr int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
        e.oriented = {v[face[k][0]], v[face[k][1]], v[face[k][2]]};
      } else {
        e.oriented = {v[(k + 1) % 3], v[(k + 2) % 3], -1};
      }
      e.sorted = e.oriented;
      std::sort(e.sorted.begin(), e.sorted.begin() + t.dim);
      entries.push_back(e);
    }
  }
  std::sort(entries.begin(), entries.end());
  std::vector<Index> facets;
  for (std::size_t i = 0; i < entries.size();) {
    std::size_t j = i + 1;
    while (j < entries.size() && entries[j].sorted == entries[i].sorted) ++j;
    if (j == i + 1)
      facets.insert(facets.end(), entries[i].oriented.begin(),
                    entries[i].oriented.begin() + t.dim);
    i = j;
  }
  return facets;
}

/// The gmsh entity each boundary facet lies on: the one whose facets contain all its vertices;
/// where several do (at corners), the one whose nearest facet has the most similar normal.
std::vector<Index> facet_entities(const Triangulation& t, const scene::Mesh& mesh,
                                  const Surface& surface, const NodeFaces& of_node) {
  // Normal of an entity near a node: sum over its facets at that node.
  std::map<std::pair<Index, Index>, Vec3> normal;
  for (std::size_t f = 0; f < surface.entity.size(); ++f) {
    const Index* v = &surface.facets[f * mesh.dim];
    const Vec3 A = facet_area(mesh.dim, mesh.nodes, v);
    for (int k = 0; k < mesh.dim; ++k) {
      auto [it, fresh] = normal.try_emplace({surface.entity[f], v[k]}, Vec3::Zero());
      it->second += A;
    }
  }
  std::vector<Index> entity;
  for (std::size_t f = 0; f * t.dim < t.boundary.size(); ++f) {
    const Index* v = &t.boundary[f * t.dim];
    const Vec3 A = facet_area(t.dim, mesh.nodes, v).normalized();
    Index best = -1;
    double best_match = -2;
    for (const Index candidate : of_node[v[0]]) {
      bool all = true;
      Vec3 N = Vec3::Zero();
      for (int k = 0; k < t.dim; ++k) {
        const auto it = normal.find({candidate, v[k]});
        if (it == normal.end())
          all = false;
        else
          N += it->second.normalized();
      }
      if (!all) continue;
      const double match = std::abs(N.normalized().dot(A));
      if (match > best_match + 1e-9) {
        best_match = match;
        best = candidate;
      }
    }
    entity.push_back(best);
  }
  return entity;
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

void check_against_body(const Triangulation& t, const scene::Mesh& mesh, const Surface& surface,
                        const scene::Problem& problem) {
  double body = 0, body_area = 0, slack = 0;
  for (std::size_t f = 0; f < surface.entity.size(); ++f) {
    const Index* v = &surface.facets[f * mesh.dim];
    const Vec3 A = facet_area(mesh.dim, mesh.nodes, v);
    body_area += A.norm();
    // A flat facet and another one through neighbouring nodes of a curved face differ by at
    // most about h A/4 locally.
    if (mesh.dim == 3 && !mesh.entities[surface.entity[f]].flat)
      slack += 0.25 * A.norm() * mesh.h;
  }
  body = scene::mesh_volume(mesh);
  double volume = 0, area = 0;
  for (const double v : t.volume) volume += v;
  for (std::size_t f = 0; f * t.dim < t.boundary.size(); ++f) {
    area += facet_area(t.dim, mesh.nodes, &t.boundary[f * t.dim]).norm();
  }
  if (std::abs(volume - body) > 1e-9 * body + slack) {
    not_reproduced(problem,
                   fmt::format("cells with volume {:.10g} in a body of {:.10g}", volume, body),
                   mesh.h);
  }
  if (std::abs(area - body_area) > 1e-9 * body_area + slack / mesh.h) {
    not_reproduced(
        problem,
        fmt::format("a boundary of measure {:.10g} on a body with {:.10g}", area, body_area),
        mesh.h);
  }
  for (const Index e : t.boundary_entity) {
    if (e < 0)
      not_reproduced(problem,
                     "a boundary facet that joins particles of different faces of the body",
                     mesh.h);
  }
}

}  // namespace

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

Triangulation triangulate(const scene::Mesh& mesh, const scene::Problem& problem) {
  const int dim = mesh.dim, nv = dim + 1;
  Triangulation t;
  t.dim = dim;
  const std::vector<Index> cells = hull_cells(mesh);
  if (cells.empty())
    not_reproduced(problem, "particles that all lie in one plane or line", mesh.h);
  const Surface surface = body_surface(mesh);
  const NodeFaces faces = node_faces(mesh, surface);
  const double body = scene::mesh_volume(mesh);
  std::array<Vec3, 4> X, g;
  double hull = 0;
  std::vector<double> volumes(cells.size() / nv);
  for (std::size_t s = 0; s < volumes.size(); ++s) {
    for (int k = 0; k < nv; ++k) X[k] = mesh.nodes[cells[s * nv + k]];
    volumes[s] = volume_gradients(dim, X, g);
    hull += std::abs(volumes[s]);
  }
  const bool convex = std::abs(hull - body) <= 1e-10 * body;
  const double flat = 1e-10 * std::pow(mesh.h, dim);
  for (std::size_t s = 0; s < volumes.size(); ++s) {
    const Index* v = &cells[s * nv];
    bool all_on_surface = true;
    Vec3 centroid = Vec3::Zero();
    for (int k = 0; k < nv; ++k) {
      all_on_surface = all_on_surface && !faces[v[k]].empty();
      centroid += mesh.nodes[v[k]] / nv;
    }
    // Flat cells along a face come from round-off in its points. Flat cells inside (four points
    // of a lattice square) stay: their neighbours lean on them.
    if (all_on_surface && std::abs(volumes[s]) < flat && share_a_face(faces, v, nv)) continue;
    if (all_on_surface && !convex && winding_number(mesh, surface, centroid) < 0.5) continue;
    t.simplices.insert(t.simplices.end(), v, v + nv);
    if (volumes[s] < 0)
      std::swap(t.simplices[t.simplices.size() - 1], t.simplices[t.simplices.size() - 2]);
    t.volume.push_back(std::abs(volumes[s]));
  }
  t.boundary = free_facets(t);
  t.boundary_entity = facet_entities(t, mesh, surface, faces);
  t.on_boundary.assign(mesh.nodes.size(), 0);
  for (const Index v : t.boundary) t.on_boundary[v] = 1;
  check_against_body(t, mesh, surface, problem);
  return t;
}

}  // namespace concord::particle
