#include "particle/voronoi/region.hpp"

#include "particle/core/body_surface.hpp"
#include "particle/voronoi/tessellation.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace concord::particle::voronoi {
namespace {

constexpr double relative_tolerance = 1e-9;  // of the body's extent: same plane, same line; far
                                             // above round-off, far below any spacing

void require_flat(const scene::Mesh& mesh, Index e, const SourcePosition& where) {
  const auto refuse = [&](Index curved) {
    throw InputError(where, "geometry", wall_name(mesh, curved) + ", which is curved",
                     "plane walls only (straight ones in plane problems): the cells of the "
                     "Voronoi method end at mirror planes of their particles");
  };
  if (!mesh.entities[e].flat) refuse(e);
  for (const Index c : mesh.entities[e].closure)
    if (mesh.entities[c].dim == 1 && !mesh.entities[c].flat) refuse(c);
}

/// A side of a facet, as an edge between two nodes (in slabs: of bottom and top copies).
struct Edge {
  std::array<Index, 2> key;  // ascending
  std::array<Vec3, 2> X;
};

/// The corners of facets of one wall: in the plane a quadrangle through the slab's thickness.
class WallFacets {
 public:
  WallFacets(const scene::Mesh& mesh, const Scale& scale) : m_mesh(mesh), m_scale(scale) {}

  void add(std::size_t f) {
    const Index* v = &m_mesh.facets[f * m_mesh.nodes_per_facet];
    std::vector<Index> key;
    std::vector<Vec3> X;
    const auto corner = [&](Index node, int top) {
      key.push_back(2 * node + top);
      X.push_back(m_scale.factor * m_mesh.nodes[node]);
      if (m_mesh.dim == 2) X.back()[2] = (top ? 1 : -1) * m_scale.half_width;
    };
    if (m_mesh.dim == 2) {
      corner(v[0], 0), corner(v[1], 0), corner(v[1], 1), corner(v[0], 1);
    } else {
      for (int k = 0; k < m_mesh.nodes_per_facet; ++k) corner(v[k], 0);
    }
    for (std::size_t k = 0; k < X.size(); ++k) {
      const std::size_t l = (k + 1) % X.size();
      const Vec3 triangle = 0.5 * (X[k] - X[0]).cross(X[l] - X[0]);
      area += triangle;
      total += triangle.norm();
      m_edges.push_back({{std::min(key[k], key[l]), std::max(key[k], key[l])}, {X[k], X[l]}});
    }
  }

  /// Edges of one facet only, in its direction: the wall to the left, seen from outside.
  std::vector<std::array<Vec3, 2>> outline() {
    std::sort(m_edges.begin(), m_edges.end(),
              [](const Edge& p, const Edge& q) { return p.key < q.key; });
    std::vector<std::array<Vec3, 2>> single;
    for (std::size_t i = 0; i < m_edges.size();) {
      std::size_t j = i + 1;
      while (j < m_edges.size() && m_edges[j].key == m_edges[i].key) ++j;
      if (j == i + 1) single.push_back(m_edges[i].X);
      i = j;
    }
    return single;
  }

  Vec3 area = Vec3::Zero();
  double total = 0;  ///< of the areas, whichever way they face

 private:
  const scene::Mesh& m_mesh;
  const Scale& m_scale;
  std::vector<Edge> m_edges;
};

/// Files a wall under its plane, which coplanar walls share to the last bit.
HalfSpace file_wall(Region& region, Index wall, HalfSpace half, double tolerance) {
  for (Plane& plane : region.planes) {
    const double along = plane.half.N.dot(half.N);
    if ((half.N - std::copysign(1.0, along) * plane.half.N).norm() > relative_tolerance)
      continue;
    const int side = along > 0 ? 0 : 1;
    if (std::abs(plane.side(side).offset - half.offset) > tolerance) continue;
    plane.walls[side].push_back(wall);
    return plane.side(side);
  }
  region.planes.push_back({half, true, {std::vector<Index>{wall}, {}}});
  return half;
}

void collect_walls(Region& region, const scene::Mesh& mesh, const SourcePosition& where) {
  std::map<Index, WallFacets> facets;
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    const Index e = mesh.facet_entity[f];
    auto found = facets.find(e);
    if (found == facets.end()) {
      require_flat(mesh, e, where);
      found = facets.emplace(e, WallFacets(mesh, region.scale)).first;
    }
    found->second.add(f);
  }
  const double tolerance = relative_tolerance * region.extent();
  for (auto& [e, wall] : facets) {
    if (wall.area.norm() < (1 - relative_tolerance) * wall.total)
      throw InputError(where, "geometry", "the body on both sides of " + wall_name(mesh, e),
                       "walls with the body on one side (Coherence joins doubled surfaces)");
    const std::vector<std::array<Vec3, 2>> outline = wall.outline();
    HalfSpace half{wall.area.normalized(), 0};
    for (const auto& s : outline)
      half.offset += half.N.dot(s[0]) / static_cast<double>(outline.size());
    for (int k = 0; k < 3; ++k) {  // walls along the axes exactly so
      if (half.N.cwiseAbs()[k] < 1 - 1e-15) continue;
      half = {std::copysign(1.0, half.N[k]) * Vec3::Unit(k), 0};
      half.offset = half.N.dot(outline.front()[0]);
    }
    const auto index = static_cast<Index>(region.walls.size());
    half = file_wall(region, index, half, tolerance);
    region.walls.push_back({e, half.N, half.offset / region.scale.factor});
    region.pieces.push_back(convex_pieces(outline, half.N, tolerance));
  }
}

/// Halves a convex part until no wall crosses it.
struct PartHalving {
  const Region& region;
  const BodySurface& surface;
  double tiny;
  std::vector<std::vector<PlaneSide>> found;

  struct Crossing {
    Index plane;
    Polygon polygon;
  };

  void run(const std::vector<PlaneSide>& part, const std::vector<Crossing>& crossing) {
    if (crossing.empty()) {
      keep_if_inside(part);
      return;
    }
    const Index plane = crossing.front().plane;
    for (const int s : {0, 1}) {
      const HalfSpace side = region.planes[plane].side(s);
      std::vector<PlaneSide> half = part;
      half.push_back({plane, s});
      std::vector<Crossing> rest;
      for (const Crossing& c : crossing) {
        if (c.plane == plane) continue;
        Crossing cut{c.plane, {}};
        clip(c.polygon, side, cut.polygon);
        if (moments(cut.polygon, region.planes[c.plane].half.N).A > tiny * region.extent())
          rest.push_back(std::move(cut));
      }
      run(half, rest);
    }
  }

  void keep_if_inside(const std::vector<PlaneSide>& part) {
    std::vector<HalfSpace> half_spaces;
    for (const PlaneSide& p : part) half_spaces.push_back(region.planes[p.plane].side(p.side));
    const Solid solid = solid_inside(half_spaces, region.lower, region.upper);
    if (solid.volume < tiny * std::pow(region.extent(), 2)) return;
    Vec3 X = solid.centroid / region.scale.factor;
    if (region.scale.half_width > 0) X[2] = 0;
    if (surface.winding_number(X) > 0.5) found.push_back(part);
  }
};

void find_parts(Region& region, const scene::Mesh& mesh, const BodySurface& surface) {
  const double tiny = relative_tolerance * region.extent();
  std::vector<PlaneSide> around;
  std::vector<PartHalving::Crossing> crossing;
  for (std::size_t p = 0; p < region.planes.size(); ++p) {
    Plane& plane = region.planes[p];
    for (const Index node : mesh.facets)
      if (plane.half.beyond(region.scale.factor * mesh.nodes[node]) > tiny) {
        plane.supporting = false;
        break;
      }
    if (plane.supporting) {
      around.push_back({static_cast<Index>(p), 0});
      continue;
    }
    for (const auto& side : plane.walls)
      for (const Index w : side)
        for (const ConvexPiece& piece : region.pieces[w])
          crossing.push_back({static_cast<Index>(p), piece.polygon});
  }
  PartHalving halving{region, surface, tiny, {}};
  halving.run(around, crossing);
  region.parts = std::move(halving.found);
}

}  // namespace

std::string wall_name(const scene::Mesh& mesh, Index e) {
  std::string groups;
  for (const auto& [name, group] : mesh.groups)
    if (std::find(group.entities.begin(), group.entities.end(), e) != group.entities.end())
      groups += (groups.empty() ? " (group " : ", ") + name;
  if (!groups.empty()) groups += ")";
  const scene::Entity& entity = mesh.entities[e];
  return fmt::format("{} {}{}", entity.dim == 2 ? "surface" : "curve", entity.tag, groups);
}

Region make_region(const scene::Mesh& mesh, std::size_t n, const SourcePosition& where) {
  std::vector<Index> number(mesh.nodes.size());
  std::iota(number.begin(), number.end(), 0);
  const BodySurface surface(mesh, number, mesh.nodes);
  Region region;
  region.volume = surface.volume();
  region.lower = Vec3::Constant(std::numeric_limits<double>::max());
  region.upper = -region.lower;
  for (const Index node : mesh.facets) {
    region.lower = region.lower.cwiseMin(mesh.nodes[node]);
    region.upper = region.upper.cwiseMax(mesh.nodes[node]);
  }
  const double h = std::pow(region.volume / static_cast<double>(std::max<std::size_t>(n, 1)),
                            1.0 / mesh.dim);
  // voro++ holds a corner to lie on a plane when nearer than 1e-11 in squared lengths; that
  // is to be about what the positions are known to, 16 eps of the body's extent.
  const double known = 16 * std::numeric_limits<double>::epsilon() * region.extent() / h;
  const double wanted = std::clamp(std::sqrt(1e-11 / known), 1.0, 16.0);
  region.scale.factor = std::exp2(std::round(std::log2(wanted / h)));
  region.scale.spacing = h * region.scale.factor;
  region.lower *= region.scale.factor;
  region.upper *= region.scale.factor;
  if (mesh.dim == 2) {
    region.scale.half_width = 0.5 * region.scale.spacing;
    region.lower[2] = -region.scale.half_width;
    region.upper[2] = region.scale.half_width;
  }
  collect_walls(region, mesh, where);
  find_parts(region, mesh, surface);
  return region;
}

}  // namespace concord::particle::voronoi
