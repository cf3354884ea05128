#pragma once
// Assembly of the tangent stiffness of any method whose particles have one displacement
// gradient each and whose bonds have a pair law in (x_ab, y_ab), y_ab = (F_a + F_b) X_ab / 2.

#include "particle/core/body.hpp"

#include <Eigen/SparseCore>

#include <vector>

namespace concord::particle {

/// The discrete gradient operator, H_a = sum_b (u_b - u_a) (x) g_ab, in compressed rows. g_ab =
/// B_ab / V_a [1/m].
struct GradientRows {
  std::vector<std::size_t> begin;  ///< n + 1
  std::vector<Index> neighbour;
  std::vector<Vec3> g;
};

/// dP/dF as a matrix: entry (3 i + J, 3 k + L) is dP_iJ / dF_kL [Pa].
using Moduli = Eigen::Matrix<double, 9, 9>;

/// Linearised pair law of one undirected bond: force p on a (and -p on b), dual q, so that Q_a,
/// Q_b each get -1/2 q (x) X_ab; derivatives with respect to x_ab and y_ab [N/m]. A law whose
/// force acts only between the two particles has q = 0.
struct PairTangent {
  Index a, b;
  Vec3 X_ab;
  Mat3 p_x, p_y, q_x, q_y;
};

/// Tangent stiffness of one body: the stencils and the pattern are found once, values for every
/// state. K = -df/du over dim*n unknowns, f_a = sum of V P and Q by the adjoint of the gradient
/// operator, plus p. The relation "b is a neighbour of a" must be symmetric.
///
/// Per particle the derivative of V P + Q with respect to its reach is formed (the stencil s,
/// or with dual pair terms the second neighbours s2), then rows of K are sums over a particle's
/// stencil: O(s^2), or O(s s2), operations and memory O(s2) a particle.
class TangentAssembly {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  TangentAssembly(const Body& body, const GradientRows& gradient);

  /// Valid until the next call. The pattern is structurally symmetric and changes only when
  /// pairs with dual terms come in for the first time.
  const Matrix& assemble(const std::vector<Moduli>& moduli,
                         const std::vector<PairTangent>& pairs);

 private:
  void build_pattern(bool dual);
  void sort_pairs(const std::vector<PairTangent>& pairs);
  template <int Dim>
  void add_dual(Index c, const Moduli& C, const std::vector<PairTangent>& pairs,
                std::vector<Index>& place, double* D) const;
  template <int Dim>
  void add_direct(Index d, const std::vector<PairTangent>& pairs,
                  std::vector<double>& line) const;
  template <int Dim>
  void fill(const std::vector<Moduli>& moduli, const std::vector<PairTangent>& pairs);

  const Body& m_body;
  std::vector<std::size_t> m_begin;  ///< a particle's stencil: neighbours, then itself
  std::vector<Index> m_member;
  std::vector<Vec3> m_g;              ///< g_cd; sum_d g_cd = 0
  std::vector<std::size_t> m_mirror;  ///< entry k = (c, d): where (d, c) is
  std::vector<std::size_t> m_reach_begin, m_pair_begin, m_pair_of;
  std::vector<Index> m_reach;
  std::vector<double> m_D;
  bool m_dual = false;
  Matrix m_K;
};

}  // namespace concord::particle
