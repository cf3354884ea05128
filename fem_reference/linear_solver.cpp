#include "fem_reference/linear_solver.hpp"

#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparse_direct.h>

#include <cmath>

namespace concord::fem {
namespace {

using Vector = dealii::Vector<double>;

bool solve_cg(const dealii::SparseMatrix<double>& K, const Vector& b, Vector& x,
              double relative) {
  dealii::PreconditionSSOR<dealii::SparseMatrix<double>> ssor;
  ssor.initialize(K, 1.2);  // between Gauss-Seidel (1) and the over-relaxation of step-8 (1.2)
  dealii::SolverControl control(std::max<unsigned>(1000, b.size() / 4), relative * b.l2_norm());
  dealii::SolverCG<Vector> cg(control);
  try {
    cg.solve(K, x, b, ssor);
  } catch (const dealii::ExceptionBase&) {
    return false;
  }
  // A negative curvature shows in x.b = x.K x (x started from zero).
  return std::isfinite(x.l2_norm()) && x * b > 0;
}

}  // namespace

void solve_linear(const dealii::SparseMatrix<double>& K, const Vector& b, Vector& x,
                  bool direct, double relative, long step, double t) {
  x.reinit(b.size());
  if (b.l2_norm() == 0) return;
  if (!direct && solve_cg(K, b, x, relative)) return;
  try {
    dealii::SparseDirectUMFPACK factors;
    factors.factorize(K);
    factors.vmult(x, b);
  } catch (const dealii::ExceptionBase& error) {
    throw SolveError("singular tangent", step, t, -1, error.get_exc_name());
  }
  if (!std::isfinite(x.l2_norm())) throw SolveError("singular tangent", step, t, -1);
}

void prescribe(dealii::SparseMatrix<double>& K, Vector& b, const std::vector<char>& given,
               const Vector& jump) {
  double diagonal = 0;
  for (unsigned r = 0; r < K.m(); ++r) diagonal += std::abs(K.diag_element(r));
  diagonal /= K.m();
  for (unsigned r = 0; r < K.m(); ++r) {
    for (auto entry = K.begin(r); entry != K.end(r); ++entry) {
      const unsigned c = entry->column();
      if (given[r] != 0) {
        entry->value() = r == c ? diagonal : 0.0;
      } else if (given[c] != 0) {
        b[r] -= entry->value() * jump[c];
        entry->value() = 0.0;
      }
    }
    if (given[r] != 0) b[r] = diagonal * jump[r];
  }
}

}  // namespace concord::fem
