// Irregular arrangements: nodes moved at random within what their entity allows.

#include "scene/geometry.hpp"
#include "scene/mesher.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <fmt/format.h>

namespace concord::scene {
namespace {

/// One step of splitmix64 (Steele, Lea and Flood, OOPSLA 2014).
std::uint64_t mix(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Projector on the directions in which nodes of an entity may move; the identity for curved
/// entities, whose nodes are put back afterwards.
Mat3 tangent_projector(const Mesh& mesh, const Entity& entity,
                       const std::vector<Vec3>& points) {
  Mat3 whole = Mat3::Identity();
  if (mesh.dim == 2) whole(2, 2) = 0;
  if (entity.dim == 0) return Mat3::Zero();
  if (entity.dim == mesh.dim || !entity.flat) return whole;
  if (entity.axis >= 0) {
    whole(entity.axis, entity.axis) = 0;
    return whole;
  }
  Vec3 along = Vec3::Zero(), normal = Vec3::Zero();
  for (const Vec3& X : points)
    if ((X - points.front()).norm() > along.norm()) along = X - points.front();
  if (entity.dim == 1) {
    along.normalize();
    // A line parallel to an axis keeps its other coordinates exactly.
    for (int k = 0; k < 3; ++k)
      if (std::abs(along[k]) < 1e-12) along[k] = 0;
    return along * along.transpose();
  }
  for (const Vec3& X : points)
    if (const Vec3 n = along.cross(X - points.front()); n.norm() > normal.norm()) normal = n;
  normal.normalize();
  return Mat3::Identity() - normal * normal.transpose();
}

/// Nodes on each entity of the surface and its closure, as points.
std::vector<std::vector<Vec3>> closure_points(const Mesh& mesh) {
  std::vector<std::vector<Vec3>> own(mesh.entities.size());
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    const auto e = static_cast<std::size_t>(mesh.node_entity[a]);
    if (mesh.entities[e].dim < mesh.dim) own[e].push_back(mesh.nodes[a]);
  }
  std::vector<std::vector<Vec3>> all = own;
  for (std::size_t e = 0; e < all.size(); ++e) {
    if (mesh.entities[e].dim == mesh.dim) continue;
    for (const Index c : mesh.entities[e].closure)
      all[e].insert(all[e].end(), own[static_cast<std::size_t>(c)].begin(),
                    own[static_cast<std::size_t>(c)].end());
  }
  return all;
}

void put_back_on_curved(Mesh& mesh, const Problem& problem) {
  std::vector<Index> curved;
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    const Entity& e = mesh.entities[static_cast<std::size_t>(mesh.node_entity[a])];
    if (e.dim > 0 && e.dim < mesh.dim && !e.flat) curved.push_back(static_cast<Index>(a));
  }
  if (!curved.empty()) mesher().put_on_entities(mesh, problem, curved);
}

}  // namespace

double uniform_random(std::uint64_t seed, std::uint64_t index, std::uint64_t component) {
  const std::uint64_t bits = mix(mix(mix(seed) ^ index) ^ component);
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

void perturb(Mesh& mesh, const Problem& problem, double fraction, std::uint64_t seed) {
  if (fraction == 0) return;
  if (!(fraction > 0 && fraction < 0.5))
    throw InputError({"request", 0, 0}, "perturb", fmt::format("{}", fraction),
                     "a fraction of the spacing from 0 to below 0.5");
  if (mesh.order != 1) throw std::logic_error("perturb: meshes of order 1 only");
  const auto points = closure_points(mesh);
  std::vector<Mat3> projector;
  for (std::size_t e = 0; e < mesh.entities.size(); ++e)
    projector.push_back(tangent_projector(mesh, mesh.entities[e], points[e]));
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    Vec3 d;
    for (int k = 0; k < 3; ++k)
      d[k] =
          fraction * mesh.h * (2 * uniform_random(seed, a, static_cast<std::uint64_t>(k)) - 1);
    mesh.nodes[a] += projector[static_cast<std::size_t>(mesh.node_entity[a])] * d;
  }
  put_back_on_curved(mesh, problem);
}

}  // namespace concord::scene
