#include "sph_reference/total_lagrangian/planes.hpp"

#include "scene/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace concord::sph {
namespace {

using Key = std::tuple<int, double, bool>;  ///< axis, coordinate, antisymmetric

struct Face {
  std::set<Index> nodes;  ///< where the condition holds
  SourcePosition where;
};

std::map<Key, Face> faces_of(const scene::Problem& problem, const Body& body) {
  std::map<Key, Face> faces;
  for (const scene::BoundaryCondition& bc : problem.boundaries) {
    const bool antisymmetric = bc.kind == scene::BoundaryKind::antisymmetric;
    if (!antisymmetric && bc.kind != scene::BoundaryKind::symmetric) continue;
    const int axis = body.mesh.group_axis(bc.group, bc.where);
    for (const Index node : body.mesh.group_nodes(bc.group, bc.where)) {
      Face& face = faces[{axis, body.mesh.nodes[node][axis], antisymmetric}];
      face.nodes.insert(node);
      face.where = bc.where;
    }
  }
  return faces;
}

[[noreturn]] void refuse(const Face& face, const Plane& plane, const char* why) {
  throw InputError(
      face.where, "tlsph.planes",
      fmt::format("mirror at {} = {:.6g} m, {}", "XYZ"[plane.axis], plane.coordinate, why),
      "truncated; or a plane on which the body ends, with one condition on its whole face "
      "there");
}

/// Throws where images at the plane would not continue the body.
void check(const scene::Problem& problem, const Body& body, const Face& face,
           const Plane& plane) {
  const double near = 1e-9 * body.h;
  bool below = false, above = false;
  for (std::size_t node = 0; node < body.mesh.nodes.size(); ++node) {
    const double distance = body.mesh.nodes[node][plane.axis] - plane.coordinate;
    below = below || distance < -near;
    above = above || distance > near;
    if (std::abs(distance) <= near && face.nodes.count(static_cast<Index>(node)) == 0)
      refuse(face, plane, "whose condition holds on a part of the body's face alone");
  }
  if (below && above) refuse(face, plane, "with the body on both sides");
  for (const scene::BoundaryCondition& bc : problem.boundaries) {
    if (!plane.antisymmetric || bc.kind != scene::BoundaryKind::traction) continue;
    const std::vector<Index> loaded = body.mesh.group_nodes(bc.group, bc.where);
    if (std::all_of(loaded.begin(), loaded.end(),
                    [&](Index node) { return face.nodes.count(node) > 0; }))
      refuse(face, plane,
             "an antisymmetric one under traction, on which normal strain does not vanish");
  }
}

}  // namespace

std::vector<Plane> symmetry_planes(const scene::Problem& problem, const Body& body) {
  std::vector<Plane> planes;
  for (const auto& [key, face] : faces_of(problem, body)) {
    const Plane plane{std::get<0>(key), std::get<1>(key), std::get<2>(key)};
    check(problem, body, face, plane);
    planes.push_back(plane);
  }
  return planes;
}

Points::Points(const Body& body, const std::vector<Plane>& planes, double R) : m_body(&body) {
  if (planes.empty()) return;
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (Index a = 0; a < body.n; ++a) {
    low = low.cwiseMin(body.position(a));
    high = high.cwiseMax(body.position(a));
  }
  find_maps(planes, R, low, high);
  m_X = body.X;
  for (std::size_t m = 1; m < m_maps.size(); ++m) {
    const Map& map = m_maps[m];
    for (Index b = 0; b < body.n; ++b) {
      std::array<double, 4> X{};
      bool seen = true;
      for (int i = 0; i < body.dim; ++i) {
        X[i] = map.R[i] * body.X[static_cast<std::size_t>(b) * body.stride + i] + map.t[i];
        seen = seen && X[i] > low[i] - R && X[i] < high[i] + R;
      }
      if (!seen) continue;
      m_images.push_back({b, static_cast<Index>(m)});
      m_X.insert(m_X.end(), X.begin(), X.begin() + body.stride);
    }
  }
}

/// Whether the map's image of the box [low, high] comes closer to it than R.
bool Points::reaches(const Map& map, double R, const Vec3& low, const Vec3& high) const {
  for (int i = 0; i < m_body->dim; ++i) {
    const double p = map.R[i] * low[i] + map.t[i], q = map.R[i] * high[i] + map.t[i];
    if (std::min(p, q) >= high[i] + R || std::max(p, q) <= low[i] - R) return false;
  }
  return true;
}

/// All products of reflections whose images are within reach. Along one axis the distance grows
/// with the number of factors, so that what is out of reach has no products within.
void Points::find_maps(const std::vector<Plane>& planes, double R, const Vec3& low,
                       const Vec3& high) {
  const auto same = [&](const Map& p, const Map& q) {
    for (int i = 0; i < 3; ++i) {
      if (p.R[i] != q.R[i] || std::abs(p.t[i] - q.t[i]) > 1e-9 * R) return false;
    }
    return true;
  };
  m_maps.assign(1, Map{});
  for (std::size_t m = 0; m < m_maps.size(); ++m) {
    for (const Plane& plane : planes) {
      Map next = m_maps[m];
      next.R[plane.axis] *= -1;
      next.t[plane.axis] = 2 * plane.coordinate - next.t[plane.axis];
      if (plane.antisymmetric) next.sign *= -1;
      const bool known = std::any_of(m_maps.begin(), m_maps.end(),
                                     [&](const Map& map) { return same(map, next); });
      if (!known && reaches(next, R, low, high)) m_maps.push_back(next);
    }
  }
}

const double* Points::extend(std::span<const double> values, Column& extended,
                             const Executor& executor) const {
  if (m_images.empty()) return values.data();
  const std::size_t stride = m_body->stride, own = static_cast<std::size_t>(m_body->n) * stride;
  executor.for_pieces(own, [&](std::size_t first, std::size_t last) {
    std::copy(values.begin() + first, values.begin() + last, extended.begin() + first);
  });
  executor.for_pieces(m_images.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const Map& map = m_maps[m_images[k].map];
      const double* from = values.data() + m_images[k].of * stride;
      double* to = extended.data() + own + k * stride;
      for (std::size_t i = 0; i < stride; ++i) to[i] = map.sign * map.R[i] * from[i];
    }
  });
  return extended.data();
}

Column Points::make_points() const {
  const std::size_t stride = m_body->stride;
  Column points(2 * stride * static_cast<std::size_t>(count()), 0.0);
  for (Index b = 0; b < count(); ++b)
    std::copy_n(positions() + b * stride, stride, points.begin() + 2 * stride * b);
  return points;
}

void Points::set_displacements(std::span<const double> u, Index first, Index last,
                               Column& points) const {
  const std::size_t stride = m_body->stride;
  for (std::size_t a = first; a < static_cast<std::size_t>(last); ++a) {
    for (std::size_t i = 0; i < stride; ++i)
      points[(2 * a + 1) * stride + i] = u[a * stride + i];
  }
}

void Points::set_image_displacements(std::span<const double> u, Column& points,
                                     const Executor& executor) const {
  const std::size_t stride = m_body->stride;
  executor.for_pieces(m_images.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const Map& map = m_maps[m_images[k].map];
      const double* from = u.data() + m_images[k].of * stride;
      double* to = &points[(2 * (m_body->n + k) + 1) * stride];
      for (std::size_t i = 0; i < stride; ++i) to[i] = map.sign * map.R[i] * from[i];
    }
  });
}

void Points::reflect_tensors(Column& tensors, const Executor& executor) const {
  const std::size_t stride = m_body->stride, dim = m_body->dim, size = dim * stride;
  executor.for_pieces(m_images.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const Map& map = m_maps[m_images[k].map];
      const double* from = &tensors[m_images[k].of * size];
      double* to = &tensors[(m_body->n + k) * size];
      for (std::size_t column = 0; column < dim; ++column, from += stride, to += stride) {
        const double sign = map.sign * map.R[column];
        for (std::size_t i = 0; i < stride; ++i) to[i] = sign * map.R[i] * from[i];
      }
    }
  });
}

}  // namespace concord::sph
