#include "fem_reference/shape.hpp"

#include <algorithm>
#include <array>

namespace concord::fem {
namespace {

using Supports = std::vector<std::vector<int>>;

// Node order of gmsh 4 (reference manual, "Node ordering"): corners, edges, faces, inside.
Supports higher_nodes(int dim, bool simplex) {
  if (dim == 1) return {{0, 1}};
  if (dim == 2 && simplex) return {{0, 1}, {1, 2}, {2, 0}};
  if (dim == 2) return {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1, 2, 3}};
  if (simplex) return {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}};
  return {{0, 1},
          {0, 3},
          {0, 4},
          {1, 2},
          {1, 5},
          {2, 3},
          {2, 6},
          {3, 7},
          {4, 5},
          {4, 7},
          {5, 6},
          {6, 7},
          {0, 3, 2, 1},
          {0, 1, 5, 4},
          {0, 4, 7, 3},
          {1, 2, 6, 5},
          {2, 3, 7, 6},
          {4, 5, 6, 7},
          {0, 1, 2, 3, 4, 5, 6, 7}};
}

// Node order of VTK (VTK file formats, quadratic and bi/triquadratic cells).
Supports vtk_higher_nodes(int dim, bool simplex) {
  if (dim < 3) return higher_nodes(dim, simplex);
  if (simplex) return {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  return {{0, 1},
          {1, 2},
          {2, 3},
          {3, 0},
          {4, 5},
          {5, 6},
          {6, 7},
          {7, 4},
          {0, 4},
          {1, 5},
          {2, 6},
          {3, 7},
          {0, 3, 7, 4},
          {1, 2, 6, 5},
          {0, 1, 5, 4},
          {3, 2, 6, 7},
          {0, 1, 2, 3},
          {4, 5, 6, 7},
          {0, 1, 2, 3, 4, 5, 6, 7}};
}

std::vector<Vec3> unit_corners(int dim, bool simplex) {
  std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}};
  if (dim >= 2) {
    if (!simplex) corners.push_back({1, 1, 0});
    corners.push_back({0, 1, 0});
  }
  if (dim == 3 && simplex) corners.push_back({0, 0, 1});
  if (dim == 3 && !simplex) {
    for (int k = 0; k < 4; ++k) corners.push_back(corners[k] + Vec3(0, 0, 1));
  }
  return corners;
}

/// 1D Lagrange polynomial of degree p with node x_k = k/p, and its derivative.
std::array<double, 2> lagrange_1d(int p, int k, double x) {
  if (p == 1) return k == 0 ? std::array{1 - x, -1.0} : std::array{x, 1.0};
  if (k == 0) return {(1 - x) * (1 - 2 * x), 4 * x - 3};
  if (k == 1) return {4 * x * (1 - x), 4 - 8 * x};
  return {x * (2 * x - 1), 4 * x - 1};
}

}  // namespace

LagrangeShape::LagrangeShape(int dim, scene::CellShape shape, int order)
    : m_dim(dim), m_order(order), m_shape(dim == 1 ? scene::CellShape::hypercube : shape) {
  const bool simplex = m_shape == scene::CellShape::simplex;
  const std::vector<Vec3> corners = unit_corners(dim, simplex);
  m_corners = static_cast<int>(corners.size());
  for (int c = 0; c < m_corners; ++c) m_supports.push_back({c});
  if (order == 2) {
    for (auto& support : higher_nodes(dim, simplex)) m_supports.push_back(support);
  }
  for (const auto& support : m_supports) {
    Vec3 mean = Vec3::Zero();
    for (const int c : support) mean += corners[c] / static_cast<double>(support.size());
    m_unit_nodes.push_back(mean);
  }
}

void LagrangeShape::evaluate(const Vec3& xi, std::span<double> value,
                             std::span<Vec3> gradient) const {
  if (m_shape == scene::CellShape::simplex) {
    evaluate_simplex(xi, value, gradient);
  } else {
    evaluate_hypercube(xi, value, gradient);
  }
}

void LagrangeShape::evaluate_simplex(const Vec3& xi, std::span<double> value,
                                     std::span<Vec3> gradient) const {
  std::array<double, 4> L{1, 0, 0, 0};  // barycentric coordinates
  std::array<Vec3, 4> dL;
  dL.fill(Vec3::Zero());
  for (int i = 0; i < m_dim; ++i) {
    L[0] -= xi[i];
    L[i + 1] = xi[i];
    dL[0][i] = -1;
    dL[i + 1][i] = 1;
  }
  for (int n = 0; n < node_count(); ++n) {
    const int a = m_supports[n].front(), b = m_supports[n].back();
    if (m_order == 1) {
      value[n] = L[a];
      if (!gradient.empty()) gradient[n] = dL[a];
    } else if (a == b) {
      value[n] = L[a] * (2 * L[a] - 1);
      if (!gradient.empty()) gradient[n] = (4 * L[a] - 1) * dL[a];
    } else {
      value[n] = 4 * L[a] * L[b];
      if (!gradient.empty()) gradient[n] = 4 * (L[a] * dL[b] + L[b] * dL[a]);
    }
  }
}

void LagrangeShape::evaluate_hypercube(const Vec3& xi, std::span<double> value,
                                       std::span<Vec3> gradient) const {
  std::array<std::array<std::array<double, 2>, 3>, 3>
      line{};  // [direction][k] -> value, derivative
  for (int i = 0; i < m_dim; ++i) {
    for (int k = 0; k <= m_order; ++k) line[i][k] = lagrange_1d(m_order, k, xi[i]);
  }
  for (int n = 0; n < node_count(); ++n) {
    double product = 1;
    Vec3 slope = Vec3::Zero();
    for (int i = 0; i < m_dim; ++i) {
      const auto& here = line[i][static_cast<int>(m_order * m_unit_nodes[n][i] + 0.5)];
      for (int j = 0; j < i; ++j) slope[j] *= here[0];
      slope[i] = product * here[1];
      product *= here[0];
    }
    value[n] = product;
    if (!gradient.empty()) gradient[n] = slope;
  }
}

double LagrangeShape::excess(const Vec3& xi) const {
  double out = 0, sum = 0;
  for (int i = 0; i < m_dim; ++i) {
    out = std::max(out, -xi[i]);
    sum += xi[i];
    if (m_shape == scene::CellShape::hypercube) out = std::max(out, xi[i] - 1);
  }
  return m_shape == scene::CellShape::simplex ? std::max(out, sum - 1) : out;
}

Vec3 LagrangeShape::centre() const {
  Vec3 mean = Vec3::Zero();
  for (int c = 0; c < m_corners; ++c) mean += m_unit_nodes[c] / m_corners;
  return mean;
}

unsigned char LagrangeShape::vtk_type() const {
  const bool simplex = m_shape == scene::CellShape::simplex;
  if (m_dim == 2) return m_order == 1 ? (simplex ? 5 : 9) : (simplex ? 22 : 28);
  return m_order == 1 ? (simplex ? 10 : 12) : (simplex ? 24 : 29);
}

std::vector<int> LagrangeShape::vtk_order() const {
  std::vector<int> order;
  for (int c = 0; c < m_corners; ++c) order.push_back(c);
  if (m_order == 1) return order;
  const auto sorted = [](std::vector<int> s) {
    std::sort(s.begin(), s.end());
    return s;
  };
  for (const auto& wanted : vtk_higher_nodes(m_dim, m_shape == scene::CellShape::simplex)) {
    for (int n = m_corners; n < node_count(); ++n) {
      if (sorted(m_supports[n]) == sorted(wanted)) order.push_back(n);
    }
  }
  return order;
}

}  // namespace concord::fem
