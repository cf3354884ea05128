// Which entities there are, which of them are flat, and what lies on their boundaries.

#include "scene/mesh_parts.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <gmsh.h>
#include <map>
#include <set>

namespace concord::scene {
namespace {

using DimTag = std::pair<int, int>;
constexpr double flat_tolerance = 1e-10;  // of the entity's size: far above round-off, far
                                          // below any curvature that a mesh could resolve

/// Points of a curve or surface on a regular grid of its parameters.
std::vector<Vec3> sample(int dim, int tag) {
  constexpr int n = 7;
  std::vector<double> lower, upper, parameters, X;
  gmsh::model::getParametrizationBounds(dim, tag, lower, upper);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < (dim == 2 ? n : 1); ++j) {
      parameters.push_back(lower[0] + (upper[0] - lower[0]) * i / (n - 1));
      if (dim == 2) parameters.push_back(lower[1] + (upper[1] - lower[1]) * j / (n - 1));
    }
  gmsh::model::getValue(dim, tag, parameters, X);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i + 2 < X.size(); i += 3)
    points.emplace_back(X[i], X[i + 1], X[i + 2]);
  return points;
}

/// All points on a line (dim 1) or in a plane (dim 2): the singular values beyond the dim-th of
/// the centred cloud vanish.
bool is_flat(int dim, const std::vector<Vec3>& points) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& X : points) centre += X / static_cast<double>(points.size());
  double size = 0;
  Vec3 far = Vec3::Zero();
  for (const Vec3& X : points)
    if ((X - centre).norm() > size) {
      size = (X - centre).norm();
      far = X - centre;
    }
  if (size == 0) return true;
  Vec3 normal = Vec3::Zero();
  double widest = 0;
  for (const Vec3& X : points) {
    const Vec3 n = far.cross(X - centre);
    if (n.norm() > widest) {
      widest = n.norm();
      normal = n;
    }
  }
  if (dim == 1) return widest <= flat_tolerance * size * size;
  if (widest == 0) return true;
  normal.normalize();
  return std::all_of(points.begin(), points.end(), [&](const Vec3& X) {
    return std::abs(normal.dot(X - centre)) <= flat_tolerance * size;
  });
}

void classify(Entity& entity, int mesh_dim) {
  if (entity.dim == 0 || entity.dim == mesh_dim) return;
  std::string type;
  gmsh::model::getType(entity.dim, entity.tag, type);
  if (type != "Line" && type != "Plane")
    entity.flat = is_flat(entity.dim, sample(entity.dim, entity.tag));
}

void find_closure(const std::map<DimTag, Index>& index, Entity& entity) {
  std::set<Index> closure;
  std::vector<DimTag> below, embedded;
  const std::vector<DimTag> self{{entity.dim, entity.tag}};
  if (entity.dim > 0) {
    // recursive = true would give points only; the levels are followed one by one instead.
    std::vector<DimTag> level = self;
    while (!level.empty() && level.front().first > 0) {
      gmsh::model::getBoundary(level, below, false, false, false);
      for (const DimTag& d : level) {
        if (d.first < 2) continue;
        gmsh::model::mesh::getEmbedded(d.first, d.second, embedded);
        for (const DimTag& inner : embedded)
          if (const auto found = index.find(inner); found != index.end())
            closure.insert(found->second);
      }
      for (const DimTag& d : below)
        if (const auto found = index.find(d); found != index.end())
          closure.insert(found->second);
      std::sort(below.begin(), below.end());
      below.erase(std::unique(below.begin(), below.end()), below.end());
      level = below;
    }
  }
  entity.closure.assign(closure.begin(), closure.end());
}

}  // namespace

void collect_entities(Mesh& mesh, const Problem&) {
  std::map<DimTag, Index> index;
  for (int dim = 0; dim <= mesh.dim; ++dim) {
    std::vector<DimTag> found;
    gmsh::model::getEntities(found, dim);
    for (const DimTag& d : found) {
      index[d] = static_cast<Index>(mesh.entities.size());
      mesh.entities.push_back({d.first, d.second, true, -1, {}});
    }
  }
  for (Entity& entity : mesh.entities) {
    classify(entity, mesh.dim);
    find_closure(index, entity);
  }
}

}  // namespace concord::scene
