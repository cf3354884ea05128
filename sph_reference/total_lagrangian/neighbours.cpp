#include "sph_reference/total_lagrangian/neighbours.hpp"

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

/// A piece of the lists: whole rows, on one thread.
struct Part {
  std::vector<Index> other;
  std::vector<double> weight, stiffness;
  std::size_t directed = 0;
  Index singular = -1;    ///< first particle whose neighbours do not span the space,
  std::size_t found = 0;  ///< and their number
  Index lowest = 0, highest = -1;
};

/// Inverts V_a K_a into its padded columns; false if the neighbours do not span the space.
/// 1e-8: half of the digits are lost.
bool invert_moment(const Body& body, Mat3 K, double* p) {
  if (body.dim == 2)
    K(2, 2) =
        0.5 * K.trace();  // any value between the eigenvalues: leaves the plane's inverse alone
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(K);
  const Vec3& lambda = eigen.eigenvalues();
  if (!(lambda[0] > 1e-8 * lambda[2])) return false;
  const Mat3 inverse = eigen.eigenvectors() * lambda.cwiseInverse().asDiagonal() *
                       eigen.eigenvectors().transpose();
  for (int j = 0; j < body.dim; ++j) {
    for (int i = 0; i < body.dim; ++i)
      p[j * body.stride + i] = 0.5 * (inverse(i, j) + inverse(j, i));
  }
  return true;
}

class Search {
 public:
  Search(const Points& points, std::span<const double> V, const Kernel& kernel, double penalty)
      : m_points(points), m_V(V), m_kernel(kernel), m_penalty(penalty),
        m_grid(points, kernel.radius()) {}

  /// Rows of particles [first, last), all of the block [block_begin, block_end).
  void find(Index first, Index last, Index block_begin, Index block_end, Neighbours& rows,
            Part& part) const {
    std::vector<Grid::Found> found;
    std::vector<Entry> row;
    part.lowest = first, part.highest = last - 1;
    for (Index a = first; a < last; ++a) {
      weigh(a, block_begin, block_end, found, row, rows, part);
      std::sort(row.begin(), row.end(),
                [](const Entry& p, const Entry& q) { return p.key < q.key; });
      const auto outside = std::partition_point(
          row.begin(), row.end(), [](const Entry& e) { return e.key < elsewhere; });
      rows.cut[a] = static_cast<std::size_t>(outside - row.begin());
      rows.begin[a + 1] = row.size();
      for (const Entry& e : row) {
        part.other.push_back(static_cast<Index>(e.key % elsewhere));
        part.weight.push_back(e.c);
        if (m_penalty > 0) part.stiffness.push_back(e.k);
      }
    }
  }

 private:
  /// Sums V_a K_a (TLS.4) over all neighbours of a, and gathers those that belong to its row. A
  /// lattice has pairs at R itself, where W and W' vanish: round-off shall not decide whether
  /// they count. Nor does a particle count its image at its own place, to which X_ab = 0.
  void weigh(Index a, Index block_begin, Index block_end, std::vector<Grid::Found>& found,
             std::vector<Entry>& row, Neighbours& rows, Part& part) const {
    const Body& body = m_points.body();
    const double R2 = m_kernel.radius() * m_kernel.radius();
    const std::size_t count = m_grid.within(m_points.position(a), R2 * (1 - 1e-10), found);
    std::size_t neighbours = 0;
    Mat3 K = Mat3::Zero();
    row.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const auto& [b, r2, X_ab] = found[i];
      const Index source = m_points.source(b);
      if (b == a || (source == a && r2 <= 1e-20 * R2)) continue;
      ++neighbours;
      const double areas = m_V[a] * m_V[source] / body.thickness, r = std::sqrt(r2);
      const double c = areas * m_kernel.slope(r);
      K.noalias() += (c * X_ab) * X_ab.transpose();
      const bool within = b >= block_begin && b < block_end;
      if (within && b < a) continue;
      row.push_back({within ? b : b + elsewhere, c,
                     m_penalty > 0 ? m_penalty * areas * m_kernel.value(r) / r2 : 0});
      part.lowest = std::min(part.lowest, source);
      part.highest = std::max(part.highest, source);
    }
    part.directed += neighbours;
    double* inverse =
        &rows.inverse_moment[static_cast<std::size_t>(a) * body.dim * body.stride];
    if (!invert_moment(body, K, inverse) && part.singular < 0)
      part.singular = a, part.found = neighbours;
  }

  const Points& m_points;
  std::span<const double> m_V;
  const Kernel& m_kernel;
  double m_penalty;
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
                   "(2 spacings serve on most arrangements)");
}

/// Particles that one thread searches for at a time; pieces do not straddle blocks.
constexpr Index search_piece = 2048;
struct Piece {
  Index first, last;
  std::size_t block;
};

std::vector<Piece> pieces_of(const std::vector<Index>& blocks) {
  std::vector<Piece> pieces;
  for (std::size_t block = 0; block + 1 < blocks.size(); ++block) {
    for (Index first = blocks[block]; first < blocks[block + 1]; first += search_piece)
      pieces.push_back({first, std::min(first + search_piece, blocks[block + 1]), block});
  }
  return pieces;
}

/// Joins the parts, and turns counts into places.
void join(const std::vector<Piece>& pieces, std::vector<Part>& parts, bool penalised,
          Neighbours& rows) {
  for (std::size_t a = 0; a + 1 < rows.begin.size(); ++a) {
    rows.cut[a] += rows.begin[a];
    rows.begin[a + 1] += rows.begin[a];
  }
  const std::size_t count = rows.begin.back();
  rows.other.reserve(count);
  rows.weight.reserve(count + Neighbours::padding);
  if (penalised) rows.stiffness.reserve(count + Neighbours::padding);
  rows.lowest.assign(rows.blocks.begin(), rows.blocks.end() - 1);
  rows.highest = rows.lowest;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Part part = std::move(parts[i]);  // freed at the end of this turn
    rows.other.insert(rows.other.end(), part.other.begin(), part.other.end());
    rows.weight.insert(rows.weight.end(), part.weight.begin(), part.weight.end());
    rows.stiffness.insert(rows.stiffness.end(), part.stiffness.begin(), part.stiffness.end());
    rows.directed += part.directed;
    Index& lowest = rows.lowest[pieces[i].block];
    Index& highest = rows.highest[pieces[i].block];
    lowest = std::min(lowest, part.lowest), highest = std::max(highest, part.highest);
  }
  rows.weight.resize(count + Neighbours::padding, 0.0);
  if (penalised) rows.stiffness.resize(count + Neighbours::padding, 0.0);
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
                           const Kernel& kernel, double penalty, const Executor& executor) {
  const Body& body = points.body();
  Neighbours rows;
  rows.blocks = blocks_of(body, kernel.radius());
  rows.begin.assign(body.n + 1, 0);
  rows.cut.assign(body.n, 0);
  rows.inverse_moment.assign(static_cast<std::size_t>(body.n) * body.dim * body.stride, 0.0);
  const Search search(points, V, kernel, penalty);
  const std::vector<Piece> pieces = pieces_of(rows.blocks);
  std::vector<Part> parts(pieces.size());
  executor.for_each(pieces.size(), [&](std::size_t i) {
    const auto& [first, last, block] = pieces[i];
    search.find(first, last, rows.blocks[block], rows.blocks[block + 1], rows, parts[i]);
  });
  for (const Part& part : parts) {
    if (part.singular >= 0) throw_too_few(body, kernel, part.singular, part.found);
  }
  join(pieces, parts, penalty > 0, rows);
  return rows;
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
