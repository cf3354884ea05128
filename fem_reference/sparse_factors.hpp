#pragma once
// UMFPACK with an ordering kept from matrix to matrix: deal.II's interface finds it anew.

#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <memory>
#include <vector>

namespace concord::fem {

/// LU factors of matrices that share one symmetric sparsity pattern, whatever their values.
class SparseFactors {
 public:
  using Vector = dealii::Vector<double>;
  SparseFactors();
  ~SparseFactors();

  /// False when the matrix is singular to working precision, or memory is short.
  bool factorise(const dealii::SparseMatrix<double>& matrix);
  /// x = A^-1 b with one step of iterative refinement; false when that fails.
  bool solve(const Vector& b, Vector& x) const;
  bool ready() const;
  void forget_values();

 private:
  void read_pattern(const dealii::SparseMatrix<double>& matrix);

  struct Handles;
  std::unique_ptr<Handles> m_handles;
  std::vector<long> m_start, m_column;  ///< rows of A, that is columns of A^T
  std::vector<double> m_value;
};

}  // namespace concord::fem
