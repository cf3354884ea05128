// Cells with positive Jacobians.

#include "scene/mesh_parts.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <gmsh.h>
#include <vector>

namespace concord::scene {
namespace {

/// The corners next to a corner: where each edge of its Jacobian goes, with its sign.
struct Corner {
  int here = 0;
  std::array<int, 3> other{};
  std::array<double, 3> sign{1, 1, 1};
};

std::vector<Corner> corners_of(const Mesh& mesh) {
  if (mesh.shape == CellShape::simplex) return {{0, {1, 2, 3}, {1, 1, 1}}};
  std::vector<Corner> corners;
  for (int here = 0; here < corner_count(mesh.shape, mesh.dim); ++here) {
    Corner corner{here, {}, {}};
    for (int other = 0; other < corner_count(mesh.shape, mesh.dim); ++other) {
      const Vec3 step = hypercube_corner(other, mesh.dim) - hypercube_corner(here, mesh.dim);
      if (step.cwiseAbs().sum() != 2) continue;
      int axis = 0;
      step.cwiseAbs().maxCoeff(&axis);
      corner.other[static_cast<std::size_t>(axis)] = other;
      corner.sign[static_cast<std::size_t>(axis)] = step[axis] / 2;
    }
    corners.push_back(corner);
  }
  return corners;
}

double corner_jacobian(const Mesh& mesh, const Index* cell, const Corner& corner) {
  const auto X = [&](int c) -> const Vec3& {
    return mesh.nodes[static_cast<std::size_t>(cell[c])];
  };
  Mat3 edges = Mat3::Identity();
  for (int axis = 0; axis < mesh.dim; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    edges.col(axis) = (X(corner.other[k]) - X(corner.here)) * corner.sign[k];
  }
  return edges.determinant();
}

/// Node order of a reflected cell: node i takes the place of the one whose first two reference
/// coordinates are swapped.
std::vector<int> reflection(int gmsh_type) {
  std::string name;
  int dim = 0, order = 0, nodes = 0, primary = 0;
  std::vector<double> local;
  gmsh::model::mesh::getElementProperties(gmsh_type, name, dim, order, nodes, local, primary);
  std::vector<int> permutation;
  for (int i = 0; i < nodes; ++i)
    for (int j = 0; j < nodes; ++j) {
      const double* a = &local[static_cast<std::size_t>(dim * i)];
      const double* b = &local[static_cast<std::size_t>(dim * j)];
      const double w = dim == 3 ? std::abs(a[2] - b[2]) : 0;
      if (std::abs(a[0] - b[1]) + std::abs(a[1] - b[0]) + w < 1e-6) permutation.push_back(j);
    }
  return permutation;
}

}  // namespace

void orient_cells(Mesh& mesh, const Problem& problem) {
  const std::vector<Corner> corners = corners_of(mesh);
  const int type = gmsh_element(mesh.shape, mesh.dim, mesh.order);
  const std::vector<int> mirror = reflection(type);
  const auto per_cell = static_cast<std::size_t>(mesh.nodes_per_cell);
  std::vector<Index> old(per_cell);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    Index* cell = &mesh.cells[c * per_cell];
    const auto measure = [&] {
      std::array<double, 2> low_high{1e300, -1e300};
      for (const Corner& corner : corners) {
        const double J = corner_jacobian(mesh, cell, corner);
        low_high = {std::min(low_high[0], J), std::max(low_high[1], J)};
      }
      return low_high;
    };
    std::array<double, 2> J = measure();
    if (J[1] < 0) {
      old.assign(cell, cell + per_cell);
      for (std::size_t i = 0; i < per_cell; ++i)
        cell[i] = old[static_cast<std::size_t>(mirror[i])];
      J = measure();
    }
    if (J[0] <= 0) {
      const Vec3& X = mesh.nodes[static_cast<std::size_t>(cell[0])];
      throw InputError(
          problem.geometry_where, "geometry",
          fmt::format("a folded or flat cell at ({:g}, {:g}, {:g})", X[0], X[1], X[2]),
          "a geometry and a resolution that gmsh meshes with cells of positive "
          "volume; try a finer resolution");
    }
  }
}

}  // namespace concord::scene
