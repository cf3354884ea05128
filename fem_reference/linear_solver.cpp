#include "fem_reference/linear_solver.hpp"

#include "scene/errors.hpp"

#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>

#include <algorithm>
#include <cmath>

namespace concord::fem {

LinearSolver::LinearSolver(const dealii::SparsityPattern& pattern, std::vector<char> given,
                           bool direct, double relative)
    : m_given(std::move(given)), m_direct(direct), m_relative(relative) {
  m_K.reinit(pattern);
  m_cleared.reinit(pattern);
}

void LinearSolver::ready() {
  m_factors.forget_values();
  m_cleared.copy_from(m_K);
  m_diagonal = 0;
  for (unsigned r = 0; r < m_K.m(); ++r) m_diagonal += std::abs(m_K.diag_element(r)) / m_K.m();
  for (unsigned r = 0; r < m_cleared.m(); ++r) {
    for (auto entry = m_cleared.begin(r); entry != m_cleared.end(r); ++entry) {
      const unsigned c = entry->column();
      if (m_given[r] != 0)
        entry->value() = r == c ? m_diagonal : 0.0;
      else if (m_given[c] != 0)
        entry->value() = 0.0;
    }
  }
}

bool LinearSolver::solve_iteratively(const Vector& b, Vector& x) const {
  dealii::PreconditionSSOR<Matrix> ssor;
  ssor.initialize(m_cleared, 1.2);  // the over-relaxation of deal.II's step-8
  dealii::SolverControl control(std::max<unsigned>(1000, b.size() / 4),
                                m_relative * b.l2_norm());
  dealii::SolverCG<Vector> cg(control);
  try {
    cg.solve(m_cleared, x, b, ssor);
  } catch (const dealii::ExceptionBase&) {
    return false;
  }
  // A negative curvature shows in x.b = x.K x (x started from zero).
  return std::isfinite(x.l2_norm()) && x * b > 0;
}

void LinearSolver::solve(Vector b, const Vector& jump, Vector& x, long step, double t) {
  if (jump.linfty_norm() > 0) {
    Vector lift(b.size());
    m_K.vmult(lift, jump);
    b -= lift;
  }
  for (unsigned r = 0; r < b.size(); ++r) {
    if (m_given[r] != 0) b[r] = m_diagonal * jump[r];
  }
  x.reinit(b.size());
  if (b.linfty_norm() == 0) return;
  if (!m_direct && solve_iteratively(b, x)) return;
  const bool solved =
      (m_factors.ready() || m_factors.factorise(m_cleared)) && m_factors.solve(b, x);
  if (!solved || !std::isfinite(x.l2_norm())) {
    throw SolveError("singular tangent", step, t, -1);
  }
}

}  // namespace concord::fem
