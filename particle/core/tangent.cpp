#include "particle/core/tangent.hpp"

namespace concord::particle {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Stacked operators: rows dim^2 a + dim i + J give H_a, behind them rows dim p + i give u_ab of pair p.
Sparse stacked_operator(const Body& body, const GradientRows& gradient, const std::vector<PairTangent>& pairs) {
  const int dim = body.dim;
  Triplets entries;
  entries.reserve((gradient.neighbour.size() + body.n) * dim * dim + 2 * dim * pairs.size());
  for (Index a = 0; a < body.n; ++a) {
    Vec3 own = Vec3::Zero();
    const auto add = [&](Index b, const Vec3& g) {
      for (int i = 0; i < dim; ++i) {
        for (int J = 0; J < dim; ++J) entries.emplace_back((a * dim + i) * dim + J, b * dim + i, g[J]);
      }
    };
    for (std::size_t k = gradient.begin[a]; k < gradient.begin[a + 1]; ++k) {
      add(gradient.neighbour[k], gradient.g[k]);
      own -= gradient.g[k];
    }
    add(a, own);
  }
  const Index first = body.n * dim * dim;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    for (int i = 0; i < dim; ++i) {
      const Index row = first + static_cast<Index>(p) * dim + i;
      entries.emplace_back(row, pairs[p].b * dim + i, 1.0);
      entries.emplace_back(row, pairs[p].a * dim + i, -1.0);
    }
  }
  Sparse G(first + static_cast<Index>(pairs.size()) * dim, body.n * dim);
  G.setFromTriplets(entries.begin(), entries.end());
  return G;
}

/// D: derivatives of V P + Q (dual to H) and of p (dual to u_ab) with respect to both.
Sparse stacked_moduli(const Body& body, const std::vector<Moduli>& moduli, const std::vector<PairTangent>& pairs) {
  const int dim = body.dim;
  const Index first = body.n * dim * dim;
  Triplets entries;
  entries.reserve(static_cast<std::size_t>(body.n) * dim * dim * dim * dim + pairs.size() * 4 * dim * dim * dim * dim);
  const auto row_of = [dim](Index a, int i, int J) { return (a * dim + i) * dim + J; };
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < dim; ++i) {
      for (int J = 0; J < dim; ++J) {
        for (int k = 0; k < dim; ++k) {
          for (int L = 0; L < dim; ++L) {
            entries.emplace_back(row_of(a, i, J), row_of(a, k, L), body.V[a] * moduli[a](3 * i + J, 3 * k + L));
          }
        }
      }
    }
  }
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const PairTangent& p = pairs[n];
    const bool dual = !(p.q_x.isZero(0) && p.q_y.isZero(0));
    for (int i = 0; i < dim; ++i) {
      const Index row = first + static_cast<Index>(n) * dim + i;
      for (int k = 0; k < dim; ++k) {
        entries.emplace_back(row, first + static_cast<Index>(n) * dim + k, p.p_x(i, k));
        for (const Index d : {p.a, p.b}) {
          for (int L = 0; L < dim; ++L) {
            entries.emplace_back(row, row_of(d, k, L), 0.5 * p.p_y(i, k) * p.X_ab[L]);
            if (!dual) continue;
            // T_d,iJ = -1/2 q_i X_J
            entries.emplace_back(row_of(d, i, L), first + static_cast<Index>(n) * dim + k, -0.5 * p.q_x(i, k) * p.X_ab[L]);
            for (const Index e : {p.a, p.b}) {
              for (int M = 0; M < dim; ++M) {
                entries.emplace_back(row_of(d, i, L), row_of(e, k, M), -0.25 * p.q_y(i, k) * p.X_ab[L] * p.X_ab[M]);
              }
            }
          }
        }
      }
    }
  }
  const Index size = first + static_cast<Index>(pairs.size()) * dim;
  Sparse D(size, size);
  D.setFromTriplets(entries.begin(), entries.end());
  return D;
}

}  // namespace

Eigen::SparseMatrix<double> assemble_tangent(const Body& body, const GradientRows& gradient,
                                             const std::vector<Moduli>& moduli, const std::vector<PairTangent>& pairs) {
  const Sparse G = stacked_operator(body, gradient, pairs);
  const Sparse D = stacked_moduli(body, moduli, pairs);
  const Sparse DG = D * G;
  Sparse K = Sparse(G.transpose()) * DG;
  K.makeCompressed();
  return K;
}

}  // namespace concord::particle
