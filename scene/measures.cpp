// Volume and surface of straight-sided meshes, and the quadrature that compares methods.

#include "scene/geometry.hpp"
#include "scene/mesh_parts.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>

namespace concord::scene {
namespace {

const double gauss = 1 / std::sqrt(3.0);  // two-point Gauss rule on [-1, 1], weights 1

/// Point and Jacobian of a straight-sided hypercube cell at reference coordinates xi.
double map_hypercube(const Mesh& mesh, const Index* cell, const Vec3& xi, Vec3& X) {
  Mat3 J = Mat3::Identity();
  J.leftCols(mesh.dim).setZero();
  X.setZero();
  const int corners = 1 << mesh.dim;
  for (int c = 0; c < corners; ++c) {
    const Vec3 at = hypercube_corner(c, mesh.dim);
    Vec3 factor = Vec3::Ones();
    for (int k = 0; k < mesh.dim; ++k) factor[k] = (1 + at[k] * xi[k]) / 2;
    const Vec3& node = mesh.nodes[static_cast<std::size_t>(cell[c])];
    X += factor.prod() * node;
    for (int k = 0; k < mesh.dim; ++k) {
      Vec3 derivative = factor;
      derivative[k] = at[k] / 2;
      J.col(k) += derivative.prod() * node;
    }
  }
  return J.determinant();
}

void add_hypercube(const Mesh& mesh, const Index* cell, Quadrature& rule) {
  for (int q = 0; q < (1 << mesh.dim); ++q) {
    const Vec3 xi = gauss * hypercube_corner(q, mesh.dim);
    Vec3 X;
    rule.weights.push_back(map_hypercube(mesh, cell, xi, X));
    rule.points.push_back(X);
  }
}

/// Degree 2: on tetrahedra four points (5 -+ sqrt 5)/20, on triangles three points (1/6, 2/3)
/// (Zienkiewicz and Taylor, The Finite Element Method, tables of triangular and tetrahedral
/// integration).
void add_simplex(const Mesh& mesh, const Index* cell, Quadrature& rule) {
  const int corners = mesh.dim + 1;
  const double minor = mesh.dim == 3 ? (5 - std::sqrt(5.0)) / 20 : 1.0 / 6;
  const double major = 1 - mesh.dim * minor;
  const auto X = [&](int c) -> const Vec3& {
    return mesh.nodes[static_cast<std::size_t>(cell[c])];
  };
  Mat3 edges = Mat3::Identity();
  for (int k = 0; k < mesh.dim; ++k) edges.col(k) = X(k + 1) - X(0);
  const double volume = edges.determinant() / (mesh.dim == 3 ? 6 : 2);
  for (int q = 0; q < corners; ++q) {
    Vec3 point = Vec3::Zero();
    for (int c = 0; c < corners; ++c) point += (c == q ? major : minor) * X(c);
    rule.points.push_back(point);
    rule.weights.push_back(volume / corners);
  }
}

Quadrature cell_rule(const Mesh& mesh) {
  Quadrature rule;
  const auto per_cell = static_cast<std::size_t>(mesh.nodes_per_cell);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    const Index* cell = &mesh.cells[c * per_cell];
    if (mesh.shape == CellShape::simplex)
      add_simplex(mesh, cell, rule);
    else
      add_hypercube(mesh, cell, rule);
  }
  return rule;
}

double facet_area(const Mesh& mesh, const Index* facet) {
  const auto X = [&](int c) -> const Vec3& {
    return mesh.nodes[static_cast<std::size_t>(facet[c])];
  };
  if (mesh.dim == 2) return (X(1) - X(0)).norm();
  const double half = (X(1) - X(0)).cross(X(2) - X(0)).norm() / 2;
  if (mesh.shape == CellShape::simplex) return half;
  return half + (X(2) - X(0)).cross(X(3) - X(0)).norm() / 2;
}

}  // namespace

int corner_count(CellShape shape, int dim) {
  return shape == CellShape::simplex ? dim + 1 : 1 << dim;
}

Vec3 hypercube_corner(int corner, int dim) {
  const int ring = corner % 4;
  return {ring == 1 || ring == 2 ? 1.0 : -1.0, ring >= 2 ? 1.0 : -1.0,
          dim == 2 ? 0.0 : (corner >= 4 ? 1.0 : -1.0)};
}

double mesh_volume(const Mesh& mesh) {
  long double volume = 0;  // sums of 1e6 cells to the last digits
  for (const double w : cell_rule(mesh).weights) volume += w;
  return static_cast<double>(volume);
}

double mesh_boundary_area(const Mesh& mesh) {
  double area = 0;
  for (std::size_t f = 0; f < mesh.facet_count(); ++f)
    area += facet_area(mesh, &mesh.facets[f * static_cast<std::size_t>(mesh.nodes_per_facet)]);
  return area;
}

Quadrature common_quadrature(const Problem& problem) {
  // L/24 is finer than what studies compare on the lattice ladders 4, 8, 16; with two Gauss
  // points a direction its own error is of fourth order.
  MeshRequest request;
  request.h = problem.reference_length / 24;
  request.layout = problem.layout;
  request.shape = problem.layout == Layout::lattice ? CellShape::hypercube : CellShape::simplex;
  return cell_rule(make_mesh(problem, request));
}

}  // namespace concord::scene
