#include "particle/core/tangent.hpp"

#include <algorithm>

namespace concord::particle {
namespace {

/// Which pair terms a set of linearised pairs has.
bool has_dual(const PairTangent& p) { return !p.q_x.isZero(0) || !p.q_y.isZero(0); }

}  // namespace

TangentAssembly::TangentAssembly(const Body& body, const GradientRows& rows) : m_body(body) {
  m_begin.assign(1, 0);
  for (Index c = 0; c < body.n; ++c) {
    Vec3 own = Vec3::Zero();
    for (std::size_t k = rows.begin[c]; k < rows.begin[c + 1]; ++k) {
      m_member.push_back(rows.neighbour[k]);
      m_g.push_back(rows.g[k]);
      own -= rows.g[k];
    }
    m_member.push_back(c);
    m_g.push_back(own);
    m_begin.push_back(m_member.size());
  }
  // Entries by (member, owner): going through owners in order visits each member's list in
  // order of owners.
  m_mirror.resize(m_member.size());
  std::vector<std::vector<std::pair<Index, std::size_t>>> seen(body.n);
  for (Index c = 0; c < body.n; ++c) {
    for (std::size_t k = m_begin[c]; k < m_begin[c + 1]; ++k)
      seen[m_member[k]].emplace_back(c, k);
  }
  for (Index d = 0; d < body.n; ++d) {
    for (std::size_t k = m_begin[d]; k < m_begin[d + 1]; ++k) {
      const auto it = std::lower_bound(seen[d].begin(), seen[d].end(),
                                       std::pair<Index, std::size_t>{m_member[k], 0});
      m_mirror[k] = it->second;
    }
  }
}

/// Particles whose displacement enters the dual of H_c: the stencil, and with dual pair terms
/// the stencils of its members; and the columns of each row of K.
void TangentAssembly::build_pattern(bool dual) {
  const Index n = m_body.n;
  const int dim = m_body.dim;
  m_dual = dual;
  std::vector<Index> seen_by(n, -1), list;
  const auto add_stencil = [&](Index c, Index who) {
    for (std::size_t k = m_begin[c]; k < m_begin[c + 1]; ++k) {
      const Index e = m_member[k];
      if (seen_by[e] == who) continue;
      seen_by[e] = who;
      list.push_back(e);
    }
  };
  m_reach_begin.assign(1, 0);
  m_reach.clear();
  for (Index c = 0; c < n; ++c) {
    list.clear();
    if (dual) {
      for (std::size_t k = m_begin[c]; k < m_begin[c + 1]; ++k) add_stencil(m_member[k], c);
      std::sort(list.begin(), list.end());
      m_reach.insert(m_reach.end(), list.begin(), list.end());
    } else {
      m_reach.insert(m_reach.end(), m_member.begin() + static_cast<std::ptrdiff_t>(m_begin[c]),
                     m_member.begin() + static_cast<std::ptrdiff_t>(m_begin[c + 1]));
    }
    m_reach_begin.push_back(m_reach.size());
  }
  std::fill(seen_by.begin(), seen_by.end(), -1);
  std::vector<int> outer{0}, inner;
  for (Index d = 0; d < n; ++d) {
    list.clear();
    for (std::size_t k = m_begin[d]; k < m_begin[d + 1]; ++k) {
      const Index c = m_member[k];
      for (std::size_t r = m_reach_begin[c]; r < m_reach_begin[c + 1]; ++r) {
        if (seen_by[m_reach[r]] == d) continue;
        seen_by[m_reach[r]] = d;
        list.push_back(m_reach[r]);
      }
    }
    std::sort(list.begin(), list.end());
    for (int i = 0; i < dim; ++i) {
      for (const Index e : list) {
        for (int k = 0; k < dim; ++k) inner.push_back(e * dim + k);
      }
      outer.push_back(static_cast<int>(inner.size()));
    }
  }
  const std::vector<double> zero(inner.size(), 0.0);
  m_K = Eigen::Map<const Matrix>(n * dim, n * dim, static_cast<Eigen::Index>(inner.size()),
                                 outer.data(), inner.data(), zero.data());
}

/// Pairs at each particle.
void TangentAssembly::sort_pairs(const std::vector<PairTangent>& pairs) {
  m_pair_begin.assign(m_body.n + 1, 0);
  for (const PairTangent& p : pairs) ++m_pair_begin[p.a + 1], ++m_pair_begin[p.b + 1];
  for (Index c = 0; c < m_body.n; ++c) m_pair_begin[c + 1] += m_pair_begin[c];
  m_pair_of.resize(2 * pairs.size());
  std::vector<std::size_t> next(m_pair_begin.begin(), m_pair_begin.end() - 1);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    m_pair_of[next[pairs[k].a]++] = k;
    m_pair_of[next[pairs[k].b]++] = k;
  }
}

/// D_c: derivative of the dual V_c P_c + Q_c of H_c with respect to the displacements of its
/// reach; entry ((e Dim + i) Dim + k) Dim + J is d(V P + Q)_iJ / d u_e,k.
template <int Dim>
void TangentAssembly::add_dual(Index c, const Moduli& C, const std::vector<PairTangent>& pairs,
                               std::vector<Index>& place, double* D) const {
  constexpr int block = Dim * Dim * Dim;
  const auto add = [&](Index e, const auto& value) {  // value(i, k, J)
    double* B = D + static_cast<std::size_t>(place[e]) * block;
    for (int i = 0; i < Dim; ++i)
      for (int k = 0; k < Dim; ++k)
        for (int J = 0; J < Dim; ++J) B[(i * Dim + k) * Dim + J] += value(i, k, J);
  };
  for (std::size_t r = m_reach_begin[c]; r < m_reach_begin[c + 1]; ++r)
    place[m_reach[r]] = static_cast<Index>(r - m_reach_begin[c]);
  for (std::size_t n = m_begin[c]; n < m_begin[c + 1]; ++n) {
    const Vec3& g = m_g[n];
    add(m_member[n], [&](int i, int k, int J) {
      double sum = 0;
      for (int L = 0; L < Dim; ++L) sum += C(3 * i + J, 3 * k + L) * g[L];
      return m_body.V[c] * sum;
    });
  }
  if (!m_dual) return;
  // Q_c gets -1/2 (q_x dx_ab + q_y dy_ab) (x) X_ab, dy_ab = (dH_a + dH_b) X_ab / 2. The share
  // of both ends' stencils is collected over all pairs where it can be: that of c itself.
  Eigen::Matrix<double, Dim * Dim, Dim * Dim> own;
  own.setZero();
  for (std::size_t n = m_pair_begin[c]; n < m_pair_begin[c + 1]; ++n) {
    const PairTangent& p = pairs[m_pair_of[n]];
    const Vec3& X = p.X_ab;
    add(p.b, [&](int i, int k, int J) { return -0.5 * p.q_x(i, k) * X[J]; });
    add(p.a, [&](int i, int k, int J) { return 0.5 * p.q_x(i, k) * X[J]; });
    for (int i = 0; i < Dim; ++i)
      for (int J = 0; J < Dim; ++J)
        for (int k = 0; k < Dim; ++k)
          for (int L = 0; L < Dim; ++L)
            own(i * Dim + J, k * Dim + L) -= 0.25 * p.q_y(i, k) * X[J] * X[L];
    double B[block];
    for (int i = 0; i < Dim; ++i)
      for (int k = 0; k < Dim; ++k)
        for (int J = 0; J < Dim; ++J) B[(i * Dim + k) * Dim + J] = -0.25 * p.q_y(i, k) * X[J];
    const Index other = p.a == c ? p.b : p.a;
    for (std::size_t m = m_begin[other]; m < m_begin[other + 1]; ++m) {
      const double s = m_g[m].dot(X);
      double* to = D + static_cast<std::size_t>(place[m_member[m]]) * block;
      for (int l = 0; l < block; ++l) to[l] += s * B[l];
    }
  }
  for (std::size_t m = m_begin[c]; m < m_begin[c + 1]; ++m) {
    const Vec3& g = m_g[m];
    add(m_member[m], [&](int i, int k, int J) {
      double sum = 0;
      for (int L = 0; L < Dim; ++L) sum += own(i * Dim + J, k * Dim + L) * g[L];
      return sum;
    });
  }
}

/// Rows of particle d from the pairs that end there: f_a = p, f_b = -p.
template <int Dim>
void TangentAssembly::add_direct(Index d, const std::vector<PairTangent>& pairs,
                                 std::vector<double>& line) const {
  const std::size_t columns = line.size() / Dim;
  for (std::size_t n = m_pair_begin[d]; n < m_pair_begin[d + 1]; ++n) {
    const PairTangent& p = pairs[m_pair_of[n]];
    const double sign = d == p.b ? 1.0 : -1.0;
    double by_y[Dim][Dim];
    for (int i = 0; i < Dim; ++i) {
      for (int k = 0; k < Dim; ++k) {
        line[i * columns + p.b * Dim + k] += sign * p.p_x(i, k);
        line[i * columns + p.a * Dim + k] -= sign * p.p_x(i, k);
        by_y[i][k] = 0.5 * sign * p.p_y(i, k);
      }
    }
    for (const Index c : {p.a, p.b}) {
      for (std::size_t m = m_begin[c]; m < m_begin[c + 1]; ++m) {
        const double s = m_g[m].dot(p.X_ab);
        for (int i = 0; i < Dim; ++i)
          for (int k = 0; k < Dim; ++k)
            line[i * columns + m_member[m] * Dim + k] += s * by_y[i][k];
      }
    }
  }
}

template <int Dim>
void TangentAssembly::fill(const std::vector<Moduli>& moduli,
                           const std::vector<PairTangent>& pairs) {
  constexpr int block = Dim * Dim * Dim;
  const Index n = m_body.n;
  m_D.assign(m_reach.size() * block, 0.0);
  std::vector<Index> place(n, -1);
  for (Index c = 0; c < n; ++c)
    add_dual<Dim>(c, moduli[c], pairs, place, &m_D[m_reach_begin[c] * block]);
  // A row of K: sum over c of g_cd,J D_c, in a dense line from which its pattern takes what it
  // has.
  const std::size_t columns = static_cast<std::size_t>(n) * Dim;
  std::vector<double> line(Dim * columns, 0.0);
  double* value = m_K.valuePtr();
  for (Index d = 0; d < n; ++d) {
    for (std::size_t k = m_begin[d]; k < m_begin[d + 1]; ++k) {
      const Index c = m_member[k];
      const Vec3& g = m_g[m_mirror[k]];
      for (std::size_t r = m_reach_begin[c]; r < m_reach_begin[c + 1]; ++r) {
        const double* D = &m_D[r * block];
        double* to = &line[static_cast<std::size_t>(m_reach[r]) * Dim];
        for (int i = 0; i < Dim; ++i)
          for (int m = 0; m < Dim; ++m) {
            double sum = 0;
            for (int J = 0; J < Dim; ++J) sum += g[J] * D[(i * Dim + m) * Dim + J];
            to[i * columns + m] += sum;
          }
      }
    }
    add_direct<Dim>(d, pairs, line);
    for (int i = 0; i < Dim; ++i) {
      const int row = d * Dim + i;
      double* from = &line[i * columns];
      for (int k = m_K.outerIndexPtr()[row]; k < m_K.outerIndexPtr()[row + 1]; ++k) {
        double& entry = from[m_K.innerIndexPtr()[k]];
        value[k] = entry;
        entry = 0;
      }
    }
  }
}

const TangentAssembly::Matrix&
TangentAssembly::assemble(const std::vector<Moduli>& moduli,
                          const std::vector<PairTangent>& pairs) {
  const bool dual = std::any_of(pairs.begin(), pairs.end(), has_dual);
  if (m_K.rows() == 0 || (dual && !m_dual)) build_pattern(dual);
  sort_pairs(pairs);
  if (m_body.dim == 3)
    fill<3>(moduli, pairs);
  else
    fill<2>(moduli, pairs);
  return m_K;
}

}  // namespace concord::particle
