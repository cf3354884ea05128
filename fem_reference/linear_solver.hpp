#pragma once
// Linear systems of Newton's method and of the consistent mass, with given unknowns.

#include "fem_reference/sparse_factors.hpp"

#include <vector>

namespace concord::fem {

/// Solves K x = b at the free unknowns with x = jump at the given ones: rows and columns of the
/// given unknowns are cleared (b -= K jump first) and their diagonal set to the mean of all, so
/// that the conditioning stays. One matrix may serve several right-hand sides.
class LinearSolver {
 public:
  using Matrix = dealii::SparseMatrix<double>;
  using Vector = dealii::Vector<double>;

  /// `direct`: UMFPACK, factorised once a matrix, ordered once; else conjugate gradients with
  /// SSOR to `relative` |b|. A matrix on which conjugate gradients fail (not positive definite,
  /// as beyond a limit point) goes to UMFPACK.
  LinearSolver(const dealii::SparsityPattern& pattern, std::vector<char> given, bool direct,
               double relative);

  /// The matrix to fill, given unknowns included; then call ready().
  Matrix& matrix() { return m_K; }
  const Matrix& matrix() const { return m_K; }
  void ready();
  /// Throws SolveError for a singular matrix, with step and time.
  void solve(Vector b, const Vector& jump, Vector& x, long step, double t);

 private:
  bool solve_iteratively(const Vector& b, Vector& x) const;

  Matrix m_K, m_cleared;
  std::vector<char> m_given;
  bool m_direct;
  double m_relative, m_diagonal = 1;
  SparseFactors m_factors;
};

}  // namespace concord::fem
