#include "sph_reference/total_lagrangian/neighbours.hpp"

#include "particle/core/edges.hpp"
#include "scene/errors.hpp"
#include "sph_reference/total_lagrangian/grid.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace concord::sph {
namespace {

/// An entry of a row; the row is sorted by `key`, b with those of the own block first.
struct Entry {
  std::int64_t key;
  double c, k;
};
constexpr std::int64_t elsewhere = std::int64_t{1} << 32;  ///< added to b of other blocks

/// Particles that one thread searches for at a time, of one block, and what it finds out beside
/// their rows.
struct Piece {
  Index first, last;
  std::size_t block;
  std::size_t directed = 0;
  Index lowest = first, highest = last - 1;
  Index singular = -1;    ///< first particle whose neighbours do not span the space,
  std::size_t found = 0;  ///< and their number
};

/// Ratio of V_a K_a's eigenvalues below which the neighbours count as not spanning the space:
/// half of the digits are lost.
constexpr double least_ratio = 1e-8;

class Search {
 public:
  Search(const Points& points, std::span<const double> V, const Kernel& kernel, double penalty,
         std::span<const double> sizes)
      : m_points(points), m_V(V), m_kernel(kernel), m_penalty(penalty), m_sizes(sizes),
        m_largest(sizes.empty() ? 1 : *std::max_element(sizes.begin(), sizes.end())),
        m_grid(points, kernel.radius() * m_largest) {}

  /// Lengths of the piece's rows.
  void count(const Piece& piece, Neighbours& rows) const {
    std::vector<Grid::Found> found;
    for (Index a = piece.first; a < piece.last; ++a) {
      const std::size_t near = neighbours(a, found);
      for (std::size_t i = 0; i < near; ++i)
        rows.begin[a + 1] += in_row(a, found[i].b, piece.block, rows) ? 1 : 0;
    }
  }

  /// The piece's rows, sorted, whose places are known, and their corrections.
  void fill(Piece& piece, Neighbours& rows) const {
    std::vector<Grid::Found> found;
    std::vector<Entry> row;
    for (Index a = piece.first; a < piece.last; ++a) {
      weigh(a, found, row, rows, piece);
      std::sort(row.begin(), row.end(),
                [](const Entry& p, const Entry& q) { return p.key < q.key; });
      std::size_t k = rows.begin[a];
      rows.cut[a] = k;
      for (const Entry& e : row) {
        if (e.key < elsewhere) ++rows.cut[a];
        rows.other[k] = static_cast<Index>(e.key % elsewhere);
        rows.weight[k] = e.c;
        if (m_penalty > 0) rows.stiffness[k] = e.k;
        ++k;
      }
    }
  }

 private:
  static bool within(Index b, std::size_t block, const Neighbours& rows) {
    return b >= rows.blocks[block] && b < rows.blocks[block + 1];
  }
  static bool in_row(Index a, Index b, std::size_t block, const Neighbours& rows) {
    return b > a || !within(b, block, rows);
  }

  /// All neighbours of a, in the grid's order. A lattice has pairs at R itself, where W and W'
  /// vanish: round-off shall not decide whether they count. Nor does a particle count its image
  /// at its own place, to which X_ab = 0.
  std::size_t neighbours(Index a, std::vector<Grid::Found>& found) const {
    const double R2 = m_kernel.radius() * m_kernel.radius(), inside = R2 * (1 - 1e-10);
    const double reach = m_sizes.empty() ? 1 : 0.5 * (m_sizes[a] + m_largest);
    const std::size_t near = m_grid.within(m_points.position(a), inside * reach * reach, found);
    const auto end = found.begin() + static_cast<std::ptrdiff_t>(near);
    const auto none = [&](const Grid::Found& p) {
      if (p.b == a || (p.r2 <= 1e-20 * R2 && m_points.source(p.b) == a)) return true;
      const double s = size(a, m_points.source(p.b));
      return !m_sizes.empty() && p.r2 >= inside * s * s;
    };
    return static_cast<std::size_t>(std::remove_if(found.begin(), end, none) - found.begin());
  }

  /// R_ab over the kernel's radius.
  double size(Index a, Index b) const {
    return m_sizes.empty() ? 1 : 0.5 * (m_sizes[a] + m_sizes[b]);
  }
  /// W and -W'/r of the kernel stretched to `size` times its radius.
  double value(double r, double size) const {
    if (size == 1) return m_kernel.value(r);
    return m_kernel.value(r / size) / std::pow(size, m_points.body().dim);
  }
  double slope(double r, double size) const {
    if (size == 1) return m_kernel.slope(r);
    return m_kernel.slope(r / size) / std::pow(size, m_points.body().dim + 2);
  }

  /// Sums V_a K_a (TLS.4) over all neighbours of a, and weighs those that belong to its row.
  void weigh(Index a, std::vector<Grid::Found>& found, std::vector<Entry>& row,
             Neighbours& rows, Piece& piece) const {
    const Body& body = m_points.body();
    const std::size_t near = neighbours(a, found);
    Mat3 K = Mat3::Zero();
    row.clear();
    for (std::size_t i = 0; i < near; ++i) {
      const auto& [b, r2, X_ab] = found[i];
      const Index source = m_points.source(b);
      const double areas = m_V[a] * m_V[source] / body.thickness;
      const double s = size(a, source), c = areas * slope(std::sqrt(r2), s);
      K.noalias() += (c * X_ab) * X_ab.transpose();
      if (!in_row(a, b, piece.block, rows)) continue;
      row.push_back({within(b, piece.block, rows) ? b : b + elsewhere, c,
                     m_penalty > 0 ? m_penalty * areas * value(std::sqrt(r2), s) / r2 : 0});
      piece.lowest = std::min(piece.lowest, source);
      piece.highest = std::max(piece.highest, source);
    }
    piece.directed += near;
    double* inverse =
        &rows.inverse_moment[static_cast<std::size_t>(a) * body.dim * body.stride];
    if (!invert_moment(body, K, least_ratio, inverse) && piece.singular < 0)
      piece.singular = a, piece.found = near;
  }

  const Points& m_points;
  std::span<const double> m_V;
  const Kernel& m_kernel;
  double m_penalty;
  std::span<const double> m_sizes;
  double m_largest;  ///< of them
  Grid m_grid;
};

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
                   "(2 spacings serve on most arrangements); smoothing = local where "
                   "the spacing varies");
}

std::vector<Piece> pieces_of(const std::vector<Index>& blocks) {
  constexpr Index size = 2048;
  std::vector<Piece> pieces;
  for (std::size_t block = 0; block + 1 < blocks.size(); ++block) {
    for (Index first = blocks[block]; first < blocks[block + 1]; first += size)
      pieces.push_back({first, std::min(first + size, blocks[block + 1]), block});
  }
  return pieces;
}

}  // namespace

std::vector<Index> blocks_of(const Body& body, double R) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (Index a = 0; a < body.n; ++a) {
    low = low.cwiseMin(body.position(a));
    high = high.cwiseMax(body.position(a));
  }
  const double radii = (high - low).maxCoeff() / R;
  const double thick = std::max(std::min(radii / 2, 4.0), radii / 3);
  Index count = static_cast<Index>(std::min<double>({max_blocks, thick, body.n / 512.0}));
  count = std::max<Index>(1, count - count % 2);
  std::vector<Index> begin(count + 1);
  for (Index k = 0; k <= count; ++k)
    begin[k] = static_cast<Index>(static_cast<std::int64_t>(body.n) * k / count);
  return begin;
}

Neighbours find_neighbours(const Points& points, std::span<const double> V,
                           const Kernel& kernel, double penalty, const Executor& executor,
                           std::span<const double> sizes) {
  const Body& body = points.body();
  Neighbours rows;
  rows.blocks = blocks_of(body, kernel.radius());
  rows.begin.assign(body.n + 1, 0);
  rows.cut.assign(body.n, 0);
  rows.inverse_moment.assign(static_cast<std::size_t>(body.n) * body.dim * body.stride, 0.0);
  const Search search(points, V, kernel, penalty, sizes);
  std::vector<Piece> pieces = pieces_of(rows.blocks);
  executor.for_each(pieces.size(), [&](std::size_t i) { search.count(pieces[i], rows); });
  for (Index a = 0; a < body.n; ++a) rows.begin[a + 1] += rows.begin[a];
  const std::size_t count = rows.begin.back(), padded = count + Neighbours::padding;
  rows.other.resize(count);
  rows.weight.resize(padded);
  if (penalty > 0) rows.stiffness.resize(padded);
  executor.for_each(pieces.size(), [&](std::size_t i) { search.fill(pieces[i], rows); });
  rows.lowest.assign(rows.blocks.begin(), rows.blocks.end() - 1);
  rows.highest = rows.lowest;
  for (const Piece& piece : pieces) {
    if (piece.singular >= 0) throw_too_few(body, kernel, piece.singular, piece.found);
    rows.directed += piece.directed;
    Index& lowest = rows.lowest[piece.block];
    Index& highest = rows.highest[piece.block];
    lowest = std::min(lowest, piece.lowest), highest = std::max(highest, piece.highest);
  }
  return rows;
}

std::vector<double> local_sizes(const Body& body) {
  const particle::Edges edges = particle::make_edges(body);
  std::vector<double> length(body.n, 0.0), count(body.n, 0.0);
  for (Index a = 0; a < body.n; ++a) {
    for (std::size_t k = edges.begin[a]; k < edges.begin[a + 1]; ++k) {
      for (const Index end : {a, edges.other[k]}) {
        length[end] += (body.position(edges.other[k]) - body.position(a)).norm();
        ++count[end];
      }
    }
  }
  for (Index a = 0; a < body.n; ++a)
    length[a] = count[a] > 0 ? std::max(1.0, length[a] / (count[a] * body.h)) : 1;
  return length;
}

bool invert_moment(const Body& body, Mat3 K, double least, double* inverse) {
  if (body.dim == 2)
    K(2, 2) =
        0.5 * K.trace();  // any value between the eigenvalues: leaves the plane's inverse alone
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(K);
  const Vec3& lambda = eigen.eigenvalues();
  if (!(lambda[0] > least * lambda[2])) return false;
  const Mat3 K_inverse = eigen.eigenvectors() * lambda.cwiseInverse().asDiagonal() *
                         eigen.eigenvectors().transpose();
  for (int j = 0; j < body.dim; ++j) {
    for (int i = 0; i < body.dim; ++i)
      inverse[j * body.stride + i] = 0.5 * (K_inverse(i, j) + K_inverse(j, i));
  }
  return true;
}

DirectedRows directed_rows(const Neighbours& rows) {
  const auto n = static_cast<Index>(rows.cut.size());
  DirectedRows all;
  all.begin.assign(n + 1, 0);
  for (Index a = 0; a < n; ++a) {
    all.begin[a + 1] += rows.begin[a + 1] - rows.begin[a];
    for (std::size_t k = rows.begin[a]; k < rows.cut[a]; ++k) ++all.begin[rows.other[k] + 1];
  }
  for (Index a = 0; a < n; ++a) all.begin[a + 1] += all.begin[a];
  std::vector<std::pair<Index, std::size_t>> entries(all.begin.back());
  std::vector<std::size_t> next(all.begin.begin(), all.begin.end() - 1);
  for (Index a = 0; a < n; ++a) {
    for (std::size_t k = rows.begin[a]; k < rows.begin[a + 1]; ++k) {
      entries[next[a]++] = {rows.other[k], k};
      if (k < rows.cut[a]) entries[next[rows.other[k]]++] = {a, k};
    }
  }
  all.other.reserve(entries.size()), all.entry.reserve(entries.size());
  for (Index a = 0; a < n; ++a) {
    std::sort(entries.begin() + static_cast<std::ptrdiff_t>(all.begin[a]),
              entries.begin() + static_cast<std::ptrdiff_t>(all.begin[a + 1]));
    for (std::size_t k = all.begin[a]; k < all.begin[a + 1]; ++k) {
      all.other.push_back(entries[k].first);
      all.entry.push_back(entries[k].second);
    }
  }
  return all;
}

}  // namespace concord::sph
