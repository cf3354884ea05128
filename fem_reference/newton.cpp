#include "fem_reference/newton.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace concord::fem {

namespace {

template <int dim> std::vector<char> mask(const Prescribed<dim>& prescribed, unsigned dofs) {
  std::vector<char> given(dofs, 0);
  for (std::size_t k = 0; k < prescribed.size(); ++k) given[prescribed.dof(k)] = 1;
  return given;
}

}  // namespace

template <int dim>
Newton<dim>::Newton(const TangentForce& table, const Prescribed<dim>& prescribed,
                    const Options& options, double tolerance, double length, bool direct,
                    double relative)
    : m_table(table), m_prescribed(prescribed), m_options(options), m_tolerance(tolerance),
      m_length(length), m_given(mask(prescribed, table.sparsity().n_rows())),
      m_linear(table.sparsity(), m_given, direct, relative) {}

template <int dim> void Newton<dim>::renew_tangent(State& state, const Inertia* inertia) {
  check(state, m_table.tangent(state.u, state.internal, m_linear.matrix()));
  if (inertia != nullptr) m_linear.matrix().add(inertia->factor, *inertia->mass);
  m_linear.ready();
  m_has_tangent = true;
}

template <int dim> void Newton<dim>::check(const State& state, long bad_element) const {
  if (bad_element < 0) return;
  throw SolveError("det F", state.step, state.t, bad_element, "det F <= 0 or not a number");
}

/// r = f_ext - f_int - M a, zero at given unknowns; returns its norm.
template <int dim>
double Newton<dim>::residual(const State& state, const Inertia* inertia, Vector& r) const {
  r = state.external;
  r -= state.internal;
  if (inertia != nullptr) {
    Vector a = state.u, Ma(a.size());
    a -= inertia->predicted;
    inertia->mass->vmult(Ma, a);
    r.add(-inertia->factor, Ma);
  }
  for (unsigned i = 0; i < r.size(); ++i) {
    if (m_given[i] != 0) r[i] = 0;
  }
  return r.l2_norm();
}

template <int dim> double Newton<dim>::scale(const State& state, const Inertia* inertia) const {
  double size = m_table.element_force_norm() + state.external.l2_norm();
  if (inertia != nullptr) {
    Vector a = state.u, Ma(a.size());
    a -= inertia->predicted;
    inertia->mass->vmult(Ma, a);
    size += inertia->factor * Ma.l2_norm();
  }
  return size;
}

/// Force that round-off alone makes [N]: F = I + Grad u holds strains to 1e-16 whatever their
/// size, and a strain of 1 in the cells at unknown i takes about K_ii times a cell's length. In
/// the tensile bar .4 of the machine's epsilon were seen; ten are allowed.
template <int dim> double Newton<dim>::roundoff() const {
  double squares = 0;
  for (unsigned i = 0; i < m_given.size(); ++i) {
    const double K = m_linear.matrix().diag_element(i);
    squares += K * K;
  }
  return 10 * std::numeric_limits<double>::epsilon() * m_length * std::sqrt(squares);
}

/// u += s du with the first s of 1, 1/2, ... that lowers the residual; returns the new norm, or
/// the old one with u unchanged when none does.
template <int dim>
double Newton<dim>::backtrack(State& state, const Vector& du, const Inertia* inertia,
                              double norm, Vector& r) const {
  const Vector start = state.u;
  for (double s = 1; s > 1e-3; s *= 0.5) {
    state.u = start;
    state.u.add(s, du);
    if (m_table.force(state.u, state.internal) >= 0) continue;
    const double trial = residual(state, inertia, r);
    if (trial <= (1 - 1e-4 * s) * norm) return trial;
  }
  state.u = start;
  check(state, m_table.force(state.u, state.internal));
  return residual(state, inertia, r);
}

template <int dim>
int Newton<dim>::solve(State& state, const std::vector<double>& given, const Inertia* inertia) {
  Vector r(state.u.size()), du(state.u.size()), jump(state.u.size());
  for (std::size_t k = 0; k < given.size(); ++k) {
    jump[m_prescribed.dof(k)] = given[k] - state.u[m_prescribed.dof(k)];
  }
  bool moved = jump.linfty_norm() > 0, cuts_well = true;
  check(state, m_table.force(state.u, state.internal));
  double norm = residual(state, inertia, r);
  for (int k = 0; k < m_options.max_iterations; ++k) {
    if (!moved && norm <= m_tolerance * scale(state, inertia)) return k;
    const bool fresh = inertia == nullptr || !m_has_tangent || !cuts_well;
    if (fresh) renew_tangent(state, inertia);
    m_linear.solve(r, jump, du, state.step, state.t);
    const double before = norm;
    if (k == 0) {
      state.u += du;
      for (std::size_t g = 0; g < given.size(); ++g) state.u[m_prescribed.dof(g)] = given[g];
      check(state, m_table.force(state.u, state.internal));
      norm = residual(state, inertia, r);
    } else {
      norm = backtrack(state, du, inertia, norm, r);
    }
    jump = 0;
    moved = false;
    cuts_well = norm <= chord_cut * before;
    // Round-off floor: no longer falling, and below 1e4 tolerances.
    if (k > 0 && fresh && norm > 0.5 * before) {
      const double size = scale(state, inertia);
      if (norm <= 1e4 * m_tolerance * size) return k + 1;
      if (inertia == nullptr && norm <= roundoff()) return k + 1;  // a tiny load step
      if (norm >= before) {
        throw SolveError(
            "residual", state.step, state.t, -1,
            fmt::format("no descent at a relative residual of {:.2e}", norm / size));
      }
    }
  }
  const double left = norm / scale(state, inertia);
  if (left <= m_tolerance) return m_options.max_iterations;
  throw SolveError("residual", state.step, state.t, -1,
                   fmt::format("{:.2e} of the element forces after {} iterations", left,
                               m_options.max_iterations));
}

template class Newton<2>;
template class Newton<3>;

}  // namespace concord::fem
