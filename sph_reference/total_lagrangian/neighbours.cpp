#include "sph_reference/total_lagrangian/neighbours.hpp"

#include "scene/errors.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace concord::sph {
namespace {

/// Points by cells of edge >= R, so that neighbours lie in the 3^dim cells around.
class Grid {
 public:
  Grid(const Points& points, double R) : m_points(points), m_low(Vec3::Constant(1e300)) {
    Vec3 high = Vec3::Constant(-1e300);
    for (Index a = 0; a < points.count(); ++a) {
      m_low = m_low.cwiseMin(points.position(a));
      high = high.cwiseMax(points.position(a));
    }
    // Thin or scattered bodies: no more cells than points, so that memory stays linear.
    m_edge = R;
    while (cells_at(high, m_edge) > std::max<double>(64, points.count())) m_edge *= 1.26;
    for (int i = 0; i < 3; ++i) m_cells[i] = extent(high, i, m_edge);
    fill();
  }

  /// visit(b, X_b) for every point in the cells around X.
  template <class Visit> void around(const Vec3& X, const Visit& visit) const {
    const std::array<Index, 3> c = cell_of(X);
    for (Index k = std::max(c[2] - 1, 0); k <= std::min(c[2] + 1, m_cells[2] - 1); ++k) {
      for (Index j = std::max(c[1] - 1, 0); j <= std::min(c[1] + 1, m_cells[1] - 1); ++j) {
        const Index first = number({std::max(c[0] - 1, 0), j, k});
        const Index last = number({std::min(c[0] + 1, m_cells[0] - 1), j, k});
        for (Index s = m_begin[first]; s < m_begin[last + 1]; ++s)
          visit(m_sorted[s], m_positions[s]);
      }
    }
  }

 private:
  Index extent(const Vec3& high, int i, double edge) const {
    return static_cast<Index>((high[i] - m_low[i]) / edge) + 1;
  }
  double cells_at(const Vec3& high, double edge) const {
    double count = 1;
    for (int i = 0; i < 3; ++i) count *= std::floor((high[i] - m_low[i]) / edge) + 1;
    return count;
  }
  std::array<Index, 3> cell_of(const Vec3& X) const {
    std::array<Index, 3> c{};
    for (int i = 0; i < 3; ++i) {
      c[i] = std::min(static_cast<Index>((X[i] - m_low[i]) / m_edge), m_cells[i] - 1);
    }
    return c;
  }
  Index number(const std::array<Index, 3>& c) const {
    return (c[2] * m_cells[1] + c[1]) * m_cells[0] + c[0];
  }
  void fill() {
    m_begin.assign(static_cast<std::size_t>(m_cells[0]) * m_cells[1] * m_cells[2] + 1, 0);
    std::vector<Index> cell(m_points.count());
    for (Index a = 0; a < m_points.count(); ++a) {
      cell[a] = number(cell_of(m_points.position(a)));
      ++m_begin[cell[a] + 1];
    }
    for (std::size_t c = 1; c < m_begin.size(); ++c) m_begin[c] += m_begin[c - 1];
    m_sorted.resize(m_points.count());
    std::vector<Index> next(m_begin.begin(), m_begin.end() - 1);
    m_positions.resize(m_points.count());
    for (Index a = 0; a < m_points.count(); ++a) {
      m_positions[next[cell[a]]] = m_points.position(a);
      m_sorted[next[cell[a]]++] = a;
    }
  }

  const Points& m_points;
  Vec3 m_low;
  double m_edge = 0;
  std::array<Index, 3> m_cells{};
  std::vector<Index> m_begin, m_sorted;  ///< points of cell c: m_sorted[m_begin[c]] ...
  std::vector<Vec3> m_positions;         ///< beside m_sorted
};

/// Appends the neighbours of particles [first, last) to `found`, sorted by number, and counts
/// them in begin[a + 1]. A lattice has pairs at R itself, where W and W' vanish: round-off
/// shall not decide whether they count. Nor does a particle count its image at its own place,
/// to which X_ab = 0.
void append_rows(const Points& points, const Grid& grid, double R, std::size_t first,
                 std::size_t last, std::vector<std::size_t>& begin, std::vector<Index>& found) {
  const double limit = R * R * (1 - 1e-10), same_place = 1e-20 * R * R;
  for (auto a = static_cast<Index>(first); a < static_cast<Index>(last); ++a) {
    const Vec3 X_a = points.position(a);
    const std::size_t start = found.size();
    grid.around(X_a, [&](Index b, const Vec3& X_b) {
      const double r2 = (X_b - X_a).squaredNorm();
      if (r2 < limit && b != a && (r2 > same_place || points.source(b) != a))
        found.push_back(b);
    });
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(start), found.end());
    begin[a + 1] = found.size() - start;
  }
}

void find_rows(const Points& points, const Kernel& kernel, const Executor& executor,
               Neighbours& rows) {
  const Body& body = points.body();
  const Grid grid(points, kernel.radius());
  rows.begin.assign(body.n + 1, 0);
  std::vector<std::vector<Index>> found(Executor::pieces(body.n));
  executor.for_pieces(body.n, [&](std::size_t first, std::size_t last) {
    append_rows(points, grid, kernel.radius(), first, last, rows.begin,
                found[first / Executor::piece]);
  });
  for (Index a = 0; a < body.n; ++a) rows.begin[a + 1] += rows.begin[a];
  rows.other.reserve(rows.count());
  for (std::vector<Index>& part : found) {
    rows.other.insert(rows.other.end(), part.begin(), part.end());
    std::vector<Index>().swap(part);
  }
}

/// K_a (TLS.4) of a row whose weights are there.
Mat3 moment(const Points& points, const Neighbours& rows, Index a) {
  Mat3 K = Mat3::Zero();
  for (std::size_t k = rows.begin[a]; k < rows.begin[a + 1]; ++k) {
    const Vec3 X_ab = points.position(rows.other[k]) - points.position(a);
    K += rows.weight[k] * X_ab * X_ab.transpose();
  }
  return K;
}

/// Inverts K_a into its padded columns; false if the neighbours do not span the space. 1e-8:
/// half of the digits are lost.
bool invert_moment(const Points& points, Neighbours& rows, Index a) {
  const Body& body = points.body();
  Mat3 K = moment(points, rows, a);
  if (body.dim == 2)
    K(2, 2) =
        0.5 * K.trace();  // any value between the eigenvalues: leaves the plane's inverse alone
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(K);
  const Vec3& lambda = eigen.eigenvalues();
  if (!(lambda[0] > 1e-8 * lambda[2])) return false;
  const Mat3 inverse = eigen.eigenvectors() * lambda.cwiseInverse().asDiagonal() *
                       eigen.eigenvectors().transpose();
  double* p = &rows.inverse_moment[static_cast<std::size_t>(a) * body.dim * body.stride];
  for (int j = 0; j < body.dim; ++j) {
    for (int i = 0; i < body.dim; ++i)
      p[j * body.stride + i] = 0.5 * (inverse(i, j) + inverse(j, i));
  }
  return true;
}

[[noreturn]] void throw_too_few(const Body& body, const Kernel& kernel, Index a,
                                std::size_t count) {
  const Vec3 X = body.position(a);
  throw InputError({}, "tlsph.support",
                   fmt::format("{:.4g} spacings: the particle at ({:.6g}, {:.6g}, {:.6g}) m "
                               "has {} neighbours that do not "
                               "span {} dimensions",
                               kernel.radius() / body.h, X[0], X[1], X[2], count, body.dim),
                   "a larger support radius, or a finer resolution, so that every particle's "
                   "neighbours span the space "
                   "(2 spacings serve on most arrangements)");
}

}  // namespace

Neighbours find_neighbours(const Points& points, std::span<const double> V,
                           const Kernel& kernel, double penalty, const Executor& executor) {
  const Body& body = points.body();
  Neighbours rows;
  find_rows(points, kernel, executor, rows);
  rows.weight.assign(rows.count() + Neighbours::padding, 0.0);
  rows.stiffness.assign(penalty > 0 ? rows.count() + Neighbours::padding : 0, 0.0);
  rows.inverse_moment.assign(static_cast<std::size_t>(body.n) * body.dim * body.stride, 0.0);
  std::vector<Index> singular(Executor::pieces(body.n), -1);
  executor.for_pieces(body.n, [&](std::size_t first, std::size_t last) {
    for (auto a = static_cast<Index>(first); a < static_cast<Index>(last); ++a) {
      for (std::size_t k = rows.begin[a]; k < rows.begin[a + 1]; ++k) {
        const Index b = rows.other[k];
        const double r = (points.position(b) - points.position(a)).norm();
        const double A_b = V[points.source(b)] / body.thickness;
        rows.weight[k] = A_b * kernel.slope(r);
        if (penalty > 0) rows.stiffness[k] = penalty * A_b * kernel.value(r) / (r * r);
      }
      Index& bad = singular[first / Executor::piece];
      if (!invert_moment(points, rows, a) && bad < 0) bad = a;
    }
  });
  for (const Index a : singular) {
    if (a >= 0) throw_too_few(body, kernel, a, rows.begin[a + 1] - rows.begin[a]);
  }
  return rows;
}

}  // namespace concord::sph
