#pragma once
// Newton's method for one load or time step.

#include "fem_reference/boundary.hpp"
#include "fem_reference/internal_force.hpp"
#include "fem_reference/linear_solver.hpp"
#include "fem_reference/state.hpp"

namespace concord::fem {

/// Inertia M a with a = factor (u - predicted), factor = 1/(beta dt^2): Newmark's rule.
struct Inertia {
  const dealii::SparseMatrix<double>* mass;
  double factor;
  State::Vector predicted;
};

/// Solves f_ext - f_int(u) - M a(u) = 0 at the free unknowns with the given ones prescribed.
/// The first iteration carries the prescribed increments through the tangent (a predictor with
/// lift); later ones backtrack until the residual falls (Armijo's constant 1e-4, halving). With
/// inertia the tangent of earlier steps serves as long as it cuts the residual by `chord_cut`
/// an iteration.
template <int dim> class Newton {
 public:
  /// `length`: size of a cell [m]; `direct`: which linear solver; `relative`: tolerance of the
  /// iterative one.
  Newton(const TangentForce& table, const Prescribed<dim>& prescribed, const Options& options,
         double tolerance, double length, bool direct, double relative);

  /// state.u in: last solution, out: new one; state.internal is renewed; state.external must be
  /// that of the new step. Returns the number of linear solves. Throws SolveError (step and
  /// time of `state`): det F <= 0 with the element, no convergence, singular tangent; state.u
  /// is then of no use.
  int solve(State& state, const std::vector<double>& given, const Inertia* inertia);

 private:
  using Vector = State::Vector;
  double residual(const State& state, const Inertia* inertia, Vector& r) const;
  double scale(const State& state, const Inertia* inertia) const;
  double roundoff() const;
  double backtrack(State& state, const Vector& du, const Inertia* inertia, double norm,
                   Vector& r) const;
  void check(const State& state, long bad_element) const;
  void renew_tangent(State& state, const Inertia* inertia);

  const TangentForce& m_table;
  const Prescribed<dim>& m_prescribed;
  const Options& m_options;
  double m_tolerance, m_length;
  std::vector<char> m_given;
  LinearSolver m_linear;
  bool m_has_tangent = false;
  static constexpr double chord_cut = 0.2;
};

extern template class Newton<2>;
extern template class Newton<3>;

}  // namespace concord::fem
