#include "fem_reference/calculix/simplex.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace concord::calculix {
namespace {

using Edge = std::array<int, 2>;
// gmsh 4 reference manual, "Node ordering": edges of the tetrahedron10; those of the line3 and
// the triangle6 come first.
constexpr std::array<Edge, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}}};
constexpr std::array<int, 4> edge_count{0, 1, 3, 6};

std::size_t at(Index n) { return static_cast<std::size_t>(n); }

/// dX/dxi, completed to three independent columns in plane and line cells.
Mat3 tangents(const scene::Mesh& mesh, const QuadraticSimplex& shape, const Index* nodes,
              std::span<const Vec3> dN) {
  Mat3 J = Mat3::Zero();
  for (int a = 0; a < shape.node_count(); ++a)
    J += mesh.nodes[at(nodes[a])] * dN[static_cast<std::size_t>(a)].transpose();
  return J;
}

}  // namespace

QuadraticSimplex::QuadraticSimplex(int dim) : m_dim(dim) {
  m_unit_nodes.push_back(Vec3::Zero());
  for (int i = 0; i < dim; ++i) m_unit_nodes.push_back(Vec3::Unit(i));
  for (int e = 0; e < edge_count[static_cast<std::size_t>(dim)]; ++e) {
    const auto [a, b] = edges[static_cast<std::size_t>(e)];
    m_unit_nodes.push_back((m_unit_nodes[static_cast<std::size_t>(a)] +
                            m_unit_nodes[static_cast<std::size_t>(b)]) /
                           2);
  }
}

void QuadraticSimplex::evaluate(const Vec3& xi, std::span<double> N, std::span<Vec3> dN) const {
  std::array<double, 4> L{1, 0, 0, 0};  // barycentric coordinates
  std::array<Vec3, 4> dL{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int i = 0; i < m_dim; ++i) {
    const auto c = static_cast<std::size_t>(i + 1);
    L[0] -= xi[i];
    L[c] = xi[i];
    dL[0][i] = -1;
    dL[c][i] = 1;
  }
  const auto corners = static_cast<std::size_t>(corner_count());
  for (std::size_t n = 0; n < corners; ++n) {
    N[n] = L[n] * (2 * L[n] - 1);
    dN[n] = (4 * L[n] - 1) * dL[n];
  }
  for (std::size_t n = corners; n < m_unit_nodes.size(); ++n) {
    const auto a = static_cast<std::size_t>(edges[n - corners][0]);
    const auto b = static_cast<std::size_t>(edges[n - corners][1]);
    N[n] = 4 * L[a] * L[b];
    dN[n] = 4 * (L[a] * dL[b] + L[b] * dL[a]);
  }
}

double QuadraticSimplex::excess(const Vec3& xi) const {
  double least = 1;
  for (int i = 0; i < m_dim; ++i) least -= xi[i];
  for (int i = 0; i < m_dim; ++i) least = std::min(least, xi[i]);
  return std::max(0.0, -least);
}

std::vector<int> QuadraticSimplex::calculix_order() const {
  if (m_dim == 3) return {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
  std::vector<int> order;
  for (int n = 0; n < node_count(); ++n) order.push_back(n);
  return order;
}

SimplexRule::SimplexRule(int dim) {
  // Four-point Gauss-Legendre rule on [0, 1].
  const double a = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(6.0 / 5));
  const double b = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(6.0 / 5));
  const double w_a = (18 + std::sqrt(30.0)) / 72, w_b = (18 - std::sqrt(30.0)) / 72;
  const std::array<double, 4> s{(1 - b) / 2, (1 - a) / 2, (1 + a) / 2, (1 + b) / 2};
  const std::array<double, 4> w{w_b, w_a, w_a, w_b};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < (dim > 1 ? 4 : 1); ++j) {
      for (std::size_t k = 0; k < (dim > 2 ? 4 : 1); ++k) {
        Vec3 xi(s[i], 0, 0);
        double weight = w[i];
        if (dim > 1) {
          xi[1] = (1 - xi[0]) * s[j];
          weight *= w[j] * (1 - xi[0]);
        }
        if (dim > 2) {
          const double rest = 1 - xi[0] - xi[1];
          xi[2] = rest * s[k];
          weight *= w[k] * rest;
        }
        points.push_back(xi);
        weights.push_back(weight);
      }
    }
  }
}

CellPoint evaluate(const scene::Mesh& mesh, const QuadraticSimplex& shape, const Index* nodes,
                   const std::vector<Vec3>& u, const Vec3& xi) {
  std::array<double, 10> N{};
  std::array<Vec3, 10> dN;
  shape.evaluate(xi, N, dN);
  Mat3 J = tangents(mesh, shape, nodes, dN), H = Mat3::Zero();
  CellPoint point;
  for (int a = 0; a < shape.node_count(); ++a) {
    const auto n = static_cast<std::size_t>(a);
    point.X += N[n] * mesh.nodes[at(nodes[a])];
    point.u += N[n] * u[at(nodes[a])];
    H += u[at(nodes[a])] * dN[n].transpose();
  }
  if (shape.dim() == 1) {
    point.jacobian = J.col(0).norm();
  } else if (shape.dim() == 2) {
    point.jacobian = J.col(0).cross(J.col(1)).norm();
  } else {
    point.jacobian = J.determinant();
  }
  if (shape.dim() == mesh.dim) {
    if (mesh.dim == 2) J(2, 2) = 1;
    point.F += H * J.inverse();
  }
  return point;
}

Place locate(const scene::Mesh& mesh, const Vec3& X, const SourcePosition& where) {
  const QuadraticSimplex shape(mesh.dim);
  const auto count = static_cast<std::size_t>(mesh.nodes_per_cell);
  std::array<double, 10> N{};
  std::array<Vec3, 10> dN;
  Place best;
  double best_excess = 0.5;  // beyond half a cell: not a matter of a coarse boundary
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    const Index* nodes = &mesh.cells[c * count];
    Vec3 low = mesh.nodes[at(nodes[0])], high = low;
    for (std::size_t a = 0; a < count; ++a) {
      low = low.cwiseMin(mesh.nodes[at(nodes[a])]);
      high = high.cwiseMax(mesh.nodes[at(nodes[a])]);
    }
    const double margin = 0.5 * (high - low).norm();
    if (((X - low).array() < -margin).any() || ((X - high).array() > margin).any()) continue;
    Vec3 xi = Vec3::Constant(1.0 / (mesh.dim + 1));
    if (mesh.dim == 2) xi[2] = 0;
    bool found = false;
    for (int i = 0; i < 30 && !found; ++i) {  // Newton; one step for straight cells
      shape.evaluate(xi, N, dN);
      Vec3 r = X;
      for (std::size_t a = 0; a < count; ++a) r -= N[a] * mesh.nodes[at(nodes[a])];
      found = r.norm() <= 1e-13 * (high - low).norm();
      Mat3 J = tangents(mesh, shape, nodes, dN);
      if (mesh.dim == 2) J(2, 2) = 1;
      xi += J.inverse() * r;
    }
    const double excess = found ? shape.excess(xi) : 1e300;
    if (!(excess < best_excess)) continue;
    best_excess = excess;
    shape.evaluate(xi, N, dN);
    best.nodes.assign(nodes, nodes + count);
    best.weights.assign(N.begin(), N.begin() + mesh.nodes_per_cell);
    if (excess == 0) break;
  }
  if (best.nodes.empty())
    throw InputError(where, "quantity.at", fmt::format("({:g}, {:g}, {:g})", X[0], X[1], X[2]),
                     "a point of the body");
  return best;
}

std::vector<double> nodal_volume_ratio(const scene::Mesh& mesh, const std::vector<Vec3>& u,
                                       double t) {
  const QuadraticSimplex shape(mesh.dim);
  std::vector<double> sum(mesh.nodes.size(), 0);
  std::vector<int> cells(mesh.nodes.size(), 0);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    const Index* nodes = &mesh.cells[c * static_cast<std::size_t>(mesh.nodes_per_cell)];
    for (int a = 0; a < shape.node_count(); ++a) {
      const Vec3& xi = shape.unit_nodes()[static_cast<std::size_t>(a)];
      const double J = evaluate(mesh, shape, nodes, u, xi).F.determinant();
      if (!(J > 0))
        throw SolveError("det F", 0, t, static_cast<long>(c),
                         fmt::format("{:g} in CalculiX's solution", J));
      sum[at(nodes[a])] += J;
      ++cells[at(nodes[a])];
    }
  }
  for (std::size_t n = 0; n < sum.size(); ++n) sum[n] /= std::max(cells[n], 1);
  return sum;
}

}  // namespace concord::calculix
