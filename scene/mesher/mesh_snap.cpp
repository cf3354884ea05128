// Exact coordinates where gmsh's are exact to round-off or to its integration only.

#include "scene/mesh_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <gmsh.h>

namespace concord::scene {
namespace {

constexpr double plane_tolerance = 1e-10;   // of the body's size
constexpr double lattice_tolerance = 1e-9;  // of the body's size: gmsh's LcIntegrationPrecision

double body_size(const Mesh& mesh) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const Vec3& X : mesh.nodes) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  return (high - low).norm();
}

std::vector<std::vector<Index>> nodes_by_entity(const Mesh& mesh) {
  std::vector<std::vector<Index>> nodes(mesh.entities.size());
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
    if (mesh.node_entity[a] >= 0)
      nodes[static_cast<std::size_t>(mesh.node_entity[a])].push_back(static_cast<Index>(a));
  return nodes;
}

/// The exact coordinate of a plane: that of a corner as the .geo states it.
double plane_coordinate(const Mesh& mesh, const Entity& entity, int axis, double nearby) {
  for (const Index e : entity.closure) {
    const Entity& corner = mesh.entities[static_cast<std::size_t>(e)];
    if (corner.dim != 0) continue;
    std::vector<double> X;
    gmsh::model::getValue(0, corner.tag, {}, X);
    return X[static_cast<std::size_t>(axis)];
  }
  return nearby;
}

using Coordinates = std::array<std::vector<double>, 3>;

/// Adds the coordinates of an evenly divided straight curve with these ends, if that is what
/// its nodes are.
void add_even_division(const Mesh& mesh, const std::vector<Index>& inner, const Vec3& begin,
                       const Vec3& end, double tolerance, Coordinates& exact) {
  const Vec3 along = end - begin;
  const double length = along.norm();
  const auto n = static_cast<int>(inner.size()) + 1;
  std::vector<double> place;
  for (const Index a : inner)
    place.push_back((mesh.nodes[static_cast<std::size_t>(a)] - begin).dot(along) / length);
  std::sort(place.begin(), place.end());
  for (int i = 1; i < n; ++i)
    if (std::abs(place[static_cast<std::size_t>(i - 1)] - length * i / n) > tolerance) return;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k < 3; ++k)
      exact[static_cast<std::size_t>(k)].push_back((begin[k] * (n - i) + end[k] * i) / n);
}

/// Sorted, and of values that differ by less than the tolerance only the first.
void merge(std::vector<double>& values, double tolerance) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(),
                           [&](double a, double b) { return b - a <= tolerance; }),
               values.end());
}

}  // namespace

void snap_to_planes(Mesh& mesh, const Problem& problem) {
  const double tolerance = plane_tolerance * body_size(mesh);
  if (mesh.dim == 2)
    for (Vec3& X : mesh.nodes) {
      if (std::abs(X[2]) > tolerance)
        throw InputError(problem.geometry_where, "geometry",
                         fmt::format("a plane body with a point at Z = {:g}", X[2]),
                         "surfaces in the plane Z = 0");
      X[2] = 0;
    }
  const auto nodes = nodes_by_entity(mesh);
  for (Entity& entity : mesh.entities) {
    if (entity.dim != mesh.dim - 1 || !entity.flat) continue;
    std::vector<Index> closure =
        nodes[static_cast<std::size_t>(&entity - mesh.entities.data())];
    for (const Index e : entity.closure)
      closure.insert(closure.end(), nodes[static_cast<std::size_t>(e)].begin(),
                     nodes[static_cast<std::size_t>(e)].end());
    if (closure.empty()) continue;
    for (int k = 0; k < mesh.dim; ++k) {
      const auto coordinate = [&](Index a) {
        return mesh.nodes[static_cast<std::size_t>(a)][k];
      };
      const auto [low, high] =
          std::minmax_element(closure.begin(), closure.end(),
                              [&](Index a, Index b) { return coordinate(a) < coordinate(b); });
      if (coordinate(*high) - coordinate(*low) > tolerance) continue;
      entity.axis = k;
      const double exact = plane_coordinate(mesh, entity, k, coordinate(*low));
      for (const Index a : closure) mesh.nodes[static_cast<std::size_t>(a)][k] = exact;
      break;
    }
  }
}

void snap_lattice(Mesh& mesh) {
  const auto nodes = nodes_by_entity(mesh);
  const double tolerance = lattice_tolerance * body_size(mesh);
  Coordinates exact;
  for (std::size_t e = 0; e < mesh.entities.size(); ++e) {
    const Entity& curve = mesh.entities[e];
    if (curve.dim != 1 || !curve.flat) continue;
    std::vector<Index> ends;
    for (const Index c : curve.closure)
      for (const Index a : nodes[static_cast<std::size_t>(c)]) ends.push_back(a);
    if (ends.size() != 2) continue;
    add_even_division(mesh, nodes[e], mesh.nodes[static_cast<std::size_t>(ends[0])],
                      mesh.nodes[static_cast<std::size_t>(ends[1])], tolerance, exact);
  }
  for (int k = 0; k < mesh.dim; ++k) {
    std::vector<double>& values = exact[static_cast<std::size_t>(k)];
    merge(values, tolerance);
    for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
      const Entity& entity = mesh.entities[static_cast<std::size_t>(mesh.node_entity[a])];
      if (entity.dim > 0 && entity.dim < mesh.dim && !entity.flat)
        continue;  // stays on its curve
      Vec3& X = mesh.nodes[a];
      const auto above = std::lower_bound(values.begin(), values.end(), X[k] - tolerance);
      if (above != values.end() && *above <= X[k] + tolerance) X[k] = *above;
    }
  }
}

}  // namespace concord::scene
