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

/// K = -df/du over dim*n unknowns, f_a = sum of V P and Q by the adjoint of the gradient
/// operator, plus p. The relation "b is a neighbour of a" must be symmetric. Assembled row by
/// row, the stencils of neighbours of neighbours included: cost and memory O(stencil^3) and
/// O(stencil^2) a particle.
Eigen::SparseMatrix<double> assemble_tangent(const Body& body, const GradientRows& gradient,
                                             const std::vector<Moduli>& moduli,
                                             const std::vector<PairTangent>& pairs);

}  // namespace concord::particle
