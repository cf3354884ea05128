#include "fem_reference/field.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace concord::fem {

MeshField::MeshField(const scene::Mesh& mesh, std::vector<Vec3> u)
    : m_dim(mesh.dim), m_shape(mesh.dim, mesh.shape, mesh.order), m_nodes(mesh.nodes),
      m_u(std::move(u)), m_cells(mesh.cells), m_nodes_per_cell(mesh.nodes_per_cell) {
  build_bins();
}

/// About one cell a bin; boxes are widened by a tenth, so that points just outside find a cell.
void MeshField::build_bins() {
  const std::size_t cells = m_cells.size() / m_nodes_per_cell;
  m_low = Vec3::Constant(1e300);
  Vec3 high = -m_low;
  for (std::size_t c = 0; c < cells; ++c) {
    std::array<Vec3, 2> box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
    for (int a = 0; a < m_nodes_per_cell; ++a) {
      const Vec3& X = m_nodes[m_cells[c * m_nodes_per_cell + a]];
      box = {box[0].cwiseMin(X), box[1].cwiseMax(X)};
    }
    const Vec3 margin = Vec3::Constant(0.1 * (box[1] - box[0]).maxCoeff());
    box = {box[0] - margin, box[1] + margin};
    m_low = m_low.cwiseMin(box[0]);
    high = high.cwiseMax(box[1]);
    m_box.push_back(box);
  }
  double volume = 1;
  for (int i = 0; i < m_dim; ++i) volume *= high[i] - m_low[i];
  const double size = std::pow(volume / static_cast<double>(cells), 1.0 / m_dim);
  m_bin = Vec3::Constant(size);
  for (int i = 0; i < m_dim; ++i) {
    m_count[i] = std::max(1, static_cast<int>(std::ceil((high[i] - m_low[i]) / size)));
  }
  const std::size_t bins = static_cast<std::size_t>(m_count[0]) * m_count[1] * m_count[2];
  const auto for_bins = [&](const std::array<Vec3, 2>& box, const auto& visit) {
    std::array<int, 3> a{0, 0, 0}, b{0, 0, 0};
    for (int i = 0; i < m_dim; ++i) {
      a[i] = std::clamp(static_cast<int>((box[0][i] - m_low[i]) / size), 0, m_count[i] - 1);
      b[i] = std::clamp(static_cast<int>((box[1][i] - m_low[i]) / size), 0, m_count[i] - 1);
    }
    for (int k = a[2]; k <= b[2]; ++k)
      for (int j = a[1]; j <= b[1]; ++j)
        for (int i = a[0]; i <= b[0]; ++i) visit((k * m_count[1] + j) * m_count[0] + i);
  };
  m_first.assign(bins + 1, 0);
  for (const auto& box : m_box) for_bins(box, [&](int bin) { ++m_first[bin + 1]; });
  for (std::size_t b = 0; b < bins; ++b) m_first[b + 1] += m_first[b];
  m_members.resize(m_first.back());
  std::vector<Index> next(m_first.begin(), m_first.end() - 1);
  for (std::size_t c = 0; c < cells; ++c) {
    for_bins(m_box[c], [&](int bin) { m_members[next[bin]++] = static_cast<Index>(c); });
  }
}

Mat3 MeshField::jacobian(Index cell, std::span<const Vec3> dN) const {
  Mat3 J = Mat3::Zero();
  const Index* nodes = &m_cells[static_cast<std::size_t>(cell) * m_nodes_per_cell];
  for (int a = 0; a < m_nodes_per_cell; ++a) J += m_nodes[nodes[a]] * dN[a].transpose();
  if (m_dim == 2) J(2, 2) = 1;
  return J;
}

/// Newton on sum N_a(xi) X_a = X from the cell's middle.
bool MeshField::invert(Index cell, const Vec3& X, Place& place) const {
  std::array<double, 27> N;
  std::array<Vec3, 27> dN;
  const std::size_t n = m_nodes_per_cell;
  const Index* nodes = &m_cells[static_cast<std::size_t>(cell) * n];
  Vec3 xi = m_shape.centre();
  for (int k = 0; k < 20; ++k) {
    m_shape.evaluate(xi, {N.data(), n}, {dN.data(), n});
    Vec3 miss = X;
    for (std::size_t a = 0; a < n; ++a) miss -= N[a] * m_nodes[nodes[a]];
    if (m_dim == 2) miss[2] = 0;
    const Vec3 step = jacobian(cell, {dN.data(), n}).inverse() * miss;
    xi += step;
    if (!(step.norm() < 1e3)) return false;
    if (step.norm() < 1e-13) break;  // quadratic: the next step would be round-off
    if (k == 19 && step.norm() > 1e-10) return false;
  }
  place = {cell, xi, m_shape.excess(xi)};
  return true;
}

void MeshField::search(const Vec3& X, int ring, const std::array<int, 3>& centre,
                       Place& best) const {
  const int deep = m_dim == 3 ? ring : 0;
  for (int k = centre[2] - deep; k <= centre[2] + deep; ++k) {
    for (int j = centre[1] - ring; j <= centre[1] + ring; ++j) {
      for (int i = centre[0] - ring; i <= centre[0] + ring; ++i) {
        if (i < 0 || j < 0 || k < 0 || i >= m_count[0] || j >= m_count[1] || k >= m_count[2]) {
          continue;
        }
        const int bin = (k * m_count[1] + j) * m_count[0] + i;
        for (Index m = m_first[bin]; m < m_first[bin + 1]; ++m) {
          const Index cell = m_members[m];
          const auto& box = m_box[cell];
          bool inside = true;
          for (int d = 0; d < m_dim; ++d) inside &= X[d] >= box[0][d] && X[d] <= box[1][d];
          Place place;
          if ((!inside && ring == 0) || !invert(cell, X, place)) continue;
          if (place.excess < best.excess) best = place;
          if (best.excess <= 1e-12) return;  // inside, up to round-off
        }
      }
    }
  }
}

MeshField::Place MeshField::locate(const Vec3& X) const {
  std::array<int, 3> centre{0, 0, 0};
  int widest = 0;
  for (int i = 0; i < m_dim; ++i) {
    const double place = std::clamp((X[i] - m_low[i]) / m_bin[i], 0.0, m_count[i] - 1.0);
    centre[i] = static_cast<int>(place);
    widest = std::max(widest, m_count[i]);
  }
  Place best;
  for (int ring = 0; ring <= widest && best.cell < 0; ++ring) search(X, ring, centre, best);
  if (best.cell < 0) throw SolveError("point outside the mesh", 0, 0, -1);
  return best;
}

std::vector<double> MeshField::weights(const Place& place) const {
  std::vector<double> N(m_nodes_per_cell);
  m_shape.evaluate(place.xi, N, {});
  return N;
}

void MeshField::evaluate(std::span<const Vec3> X, std::span<Vec3> u,
                         std::span<Mat3> gradient) const {
  std::array<double, 27> N;
  std::array<Vec3, 27> dN;
  const std::size_t n = m_nodes_per_cell;
  for (std::size_t p = 0; p < X.size(); ++p) {
    const Place place = locate(X[p]);
    m_shape.evaluate(place.xi, {N.data(), n}, {dN.data(), n});
    const Index* nodes = &m_cells[static_cast<std::size_t>(place.cell) * n];
    u[p].setZero();
    Mat3 slope = Mat3::Zero();
    for (std::size_t a = 0; a < n; ++a) {
      u[p] += N[a] * m_u[nodes[a]];
      slope += m_u[nodes[a]] * dN[a].transpose();
    }
    if (!gradient.empty()) gradient[p] = slope * jacobian(place.cell, {dN.data(), n}).inverse();
  }
}

}  // namespace concord::fem
