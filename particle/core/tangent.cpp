#include "particle/core/tangent.hpp"

#include <algorithm>

namespace concord::particle {
namespace {

/// A particle's stencil: neighbours, then the particle itself, with g_cd; sum_d g_cd = 0.
struct Stencils {
  std::vector<std::size_t> begin;
  std::vector<Index> member;
  std::vector<Vec3> g;
  std::vector<std::size_t> mirror;  ///< entry k = (c, d): where (d, c) is
};

Stencils make_stencils(const Body& body, const GradientRows& rows) {
  Stencils s;
  s.begin.assign(1, 0);
  for (Index c = 0; c < body.n; ++c) {
    Vec3 own = Vec3::Zero();
    for (std::size_t k = rows.begin[c]; k < rows.begin[c + 1]; ++k) {
      s.member.push_back(rows.neighbour[k]);
      s.g.push_back(rows.g[k]);
      own -= rows.g[k];
    }
    s.member.push_back(c);
    s.g.push_back(own);
    s.begin.push_back(s.member.size());
  }
  // Entries by (member, owner): going through owners in order visits each member's list in
  // order of owners.
  s.mirror.resize(s.member.size());
  std::vector<std::vector<std::pair<Index, std::size_t>>> seen(body.n);
  for (Index c = 0; c < body.n; ++c) {
    for (std::size_t k = s.begin[c]; k < s.begin[c + 1]; ++k)
      seen[s.member[k]].emplace_back(c, k);
  }
  for (Index d = 0; d < body.n; ++d) {
    for (std::size_t k = s.begin[d]; k < s.begin[d + 1]; ++k) {
      const auto it = std::lower_bound(seen[d].begin(), seen[d].end(),
                                       std::pair<Index, std::size_t>{s.member[k], 0});
      s.mirror[k] = it->second;
    }
  }
  return s;
}

/// One row of blocks under construction: K_de for a fixed d, e found through a marker.
class BlockRow {
 public:
  explicit BlockRow(Index n) : m_place(n, -1) {}
  Mat3& operator[](Index e) {
    if (m_place[e] < 0) {
      m_place[e] = static_cast<Index>(m_columns.size());
      m_columns.push_back(e);
      m_blocks.push_back(Mat3::Zero());
    }
    return m_blocks[m_place[e]];
  }
  /// Columns in order; the row is empty afterwards.
  template <class F> void drain(const F& f) {
    std::vector<Index> order = m_columns;
    std::sort(order.begin(), order.end());
    for (const Index e : order) f(e, m_blocks[m_place[e]]);
    for (const Index e : order) m_place[e] = -1;
    m_columns.clear();
    m_blocks.clear();
  }

 private:
  std::vector<Index> m_place, m_columns;
  std::vector<Mat3> m_blocks;
};

/// Everything the rows read.
struct Assembly {
  const Body& body;
  Stencils stencils;
  std::vector<Moduli> moduli;  ///< V_c C_c and, from the pairs, -1/4 q_y (x) X (x) X
  const std::vector<PairTangent>& pairs;
  std::vector<std::size_t> pair_begin, pair_of;  ///< pairs at each particle
};

Assembly prepare(const Body& body, const GradientRows& gradient,
                 const std::vector<Moduli>& moduli, const std::vector<PairTangent>& pairs) {
  Assembly s{body, make_stencils(body, gradient), moduli, pairs, {}, {}};
  for (Index c = 0; c < body.n; ++c) s.moduli[c] *= body.V[c];
  s.pair_begin.assign(body.n + 1, 0);
  for (const PairTangent& p : pairs) ++s.pair_begin[p.a + 1], ++s.pair_begin[p.b + 1];
  for (Index c = 0; c < body.n; ++c) s.pair_begin[c + 1] += s.pair_begin[c];
  s.pair_of.resize(2 * pairs.size());
  std::vector<std::size_t> next(s.pair_begin.begin(), s.pair_begin.end() - 1);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PairTangent& p = pairs[k];
    s.pair_of[next[p.a]++] = k;
    s.pair_of[next[p.b]++] = k;
    for (int i = 0; i < 3; ++i) {
      for (int m = 0; m < 3; ++m) {
        const Mat3 XX = -0.25 * p.q_y(i, m) * p.X_ab * p.X_ab.transpose();
        s.moduli[p.a].block<3, 3>(3 * i, 3 * m) += XX;
        s.moduli[p.b].block<3, 3>(3 * i, 3 * m) += XX;
      }
    }
  }
  return s;
}

/// Terms of row d in which d enters through H_c (c in its stencil), by the adjoint g_cd of the
/// gradient operator.
void add_gradient_terms(const Assembly& s, Index c, const Vec3& g_cd, BlockRow& row) {
  Eigen::Matrix<double, 3, 9> R;  // g_cd,J C_iJkL
  for (int i = 0; i < 3; ++i) R.row(i) = g_cd.transpose() * s.moduli[c].block<3, 9>(3 * i, 0);
  for (std::size_t k = s.stencils.begin[c]; k < s.stencils.begin[c + 1]; ++k) {
    Mat3& block = row[s.stencils.member[k]];
    for (int m = 0; m < 3; ++m) block.col(m) += R.block<3, 3>(0, 3 * m) * s.stencils.g[k];
  }
  for (std::size_t n = s.pair_begin[c]; n < s.pair_begin[c + 1]; ++n) {
    const PairTangent& p = s.pairs[s.pair_of[n]];
    const double alpha = g_cd.dot(p.X_ab);
    if (p.q_y.isZero(0) && p.q_x.isZero(0)) continue;
    const Index other = p.a == c ? p.b : p.a;
    const Mat3 dual = -0.25 * alpha * p.q_y;  // Q_c with respect to H of the other end
    for (std::size_t k = s.stencils.begin[other]; k < s.stencils.begin[other + 1]; ++k) {
      row[s.stencils.member[k]] += s.stencils.g[k].dot(p.X_ab) * dual;
    }
    row[p.b] -= 0.5 * alpha * p.q_x;
    row[p.a] += 0.5 * alpha * p.q_x;
  }
}

/// Terms of row d in which d is an end of a pair: f_a = p, f_b = -p.
void add_pair_terms(const Assembly& s, Index d, BlockRow& row) {
  for (std::size_t n = s.pair_begin[d]; n < s.pair_begin[d + 1]; ++n) {
    const PairTangent& p = s.pairs[s.pair_of[n]];
    const double sign = d == p.b ? 1.0 : -1.0;
    row[p.b] += sign * p.p_x;
    row[p.a] -= sign * p.p_x;
    const Mat3 by_y = 0.5 * sign * p.p_y;
    for (const Index c : {p.a, p.b}) {
      for (std::size_t k = s.stencils.begin[c]; k < s.stencils.begin[c + 1]; ++k) {
        row[s.stencils.member[k]] += s.stencils.g[k].dot(p.X_ab) * by_y;
      }
    }
  }
}

}  // namespace

Eigen::SparseMatrix<double> assemble_tangent(const Body& body, const GradientRows& gradient,
                                             const std::vector<Moduli>& moduli,
                                             const std::vector<PairTangent>& pairs) {
  const Assembly s = prepare(body, gradient, moduli, pairs);
  const int dim = body.dim;
  BlockRow row(body.n);
  std::vector<int> begin{0}, column;
  std::vector<double> value;
  for (Index d = 0; d < body.n; ++d) {
    for (std::size_t k = s.stencils.begin[d]; k < s.stencils.begin[d + 1]; ++k) {
      add_gradient_terms(s, s.stencils.member[k], s.stencils.g[s.stencils.mirror[k]], row);
    }
    add_pair_terms(s, d, row);
    std::array<std::vector<double>, 3> lines;
    const std::size_t first = column.size();
    row.drain([&](Index e, const Mat3& block) {
      for (int k = 0; k < dim; ++k) column.push_back(e * dim + k);
      for (int i = 0; i < dim; ++i) {
        for (int k = 0; k < dim; ++k) lines[i].push_back(block(i, k));
      }
    });
    const std::vector<int> pattern(column.begin() + static_cast<std::ptrdiff_t>(first),
                                   column.end());
    for (int i = 0; i < dim; ++i) {
      if (i > 0) column.insert(column.end(), pattern.begin(), pattern.end());
      value.insert(value.end(), lines[i].begin(), lines[i].end());
      begin.push_back(static_cast<int>(column.size()));
    }
  }
  using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(body.n * dim, body.n * dim,
                                    static_cast<Eigen::Index>(value.size()), begin.data(),
                                    column.data(), value.data());
}

}  // namespace concord::particle
