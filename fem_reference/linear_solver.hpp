#pragma once
// Linear systems of Newton's method and of the consistent mass.

#include "fem_reference/parameters.hpp"

#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

namespace concord::fem {

/// Solves K x = b: UMFPACK, or conjugate gradients with SSOR to `relative` |b|. A matrix on
/// which conjugate gradients fail (not positive definite, beyond a limit point) goes to
/// UMFPACK. Throws SolveError for a singular matrix, with step and time.
void solve_linear(const dealii::SparseMatrix<double>& K, const dealii::Vector<double>& b,
                  dealii::Vector<double>& x, bool direct, double relative, long step, double t);

/// Makes K x = b give x = jump at the given unknowns: b -= K jump, then rows and columns
/// cleared, their diagonal set to the mean of all diagonals so that the conditioning stays.
void prescribe(dealii::SparseMatrix<double>& K, dealii::Vector<double>& b,
               const std::vector<char>& given, const dealii::Vector<double>& jump);

}  // namespace concord::fem
