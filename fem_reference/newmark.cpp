#include "fem_reference/element_table.hpp"
#include "fem_reference/newton.hpp"
#include "fem_reference/run.hpp"

#include <cmath>

namespace concord::fem {
namespace {

using Vector = State::Vector;

/// a_0 from M a_0 = f_ext - f_int, with the prescribed accelerations (second difference forward
/// in time over two steps) given.
template <int dim>
void initial_acceleration(Run<dim>& run, const dealii::SparseMatrix<double>& M, double dt) {
  State& state = run.state;
  Vector jump(state.u.size()), r = state.external;
  std::vector<char> given(state.u.size(), 0);
  const auto& prescribed = run.prescribed;
  const auto u0 = prescribed.values(0), u1 = prescribed.values(dt),
             u2 = prescribed.values(2 * dt);
  for (std::size_t k = 0; k < prescribed.size(); ++k) {
    const unsigned d = prescribed.dof(k);
    given[d] = 1;
    if (!prescribed.depends_on_time()) continue;
    jump[d] = (u2[k] - 2 * u1[k] + u0[k]) / (dt * dt);
  }
  r -= state.internal;
  LinearSolver solver(M.get_sparsity_pattern(), given, false, 1e-12);
  solver.matrix().copy_from(M);
  solver.ready();
  solver.solve(r, jump, state.a, 0, 0);
}

/// Velocities of prescribed unknowns at the start: forward difference (zero where nothing
/// moves).
template <int dim> void initial_velocity(Run<dim>& run, double dt) {
  const auto& given = run.prescribed;
  std::vector<double> here, after;
  if (given.depends_on_time()) {
    here = given.values(0);
    after = given.values(dt);
  }
  for (std::size_t k = 0; k < given.size(); ++k) {
    run.state.v[given.dof(k)] = here.empty() ? 0.0 : (after[k] - here[k]) / dt;
  }
}

/// Residual of a time step, and of its linear systems: two or three solves a step, and an
/// energy balance that the step, not the solver, limits.
constexpr double default_tolerance = 1e-9, linear_tolerance = 1e-6;

template <int dim> double time_step(const Run<dim>& run) {
  const double end = run.problem.end_time;
  double dt = run.options.dt;
  if (!(dt > 0)) {
    dt = run.options.courant * run.request.h /
         (run.discretisation.degree() * run.problem.material.longitudinal_wave_speed());
  }
  return end / std::ceil(end / std::min(dt, end) * (1 - 1e-12));
}

}  // namespace

template <int dim> void run_newmark(Run<dim>& run) {
  State& state = run.state;
  ElasticPoints<dim> points(*run.elastic);
  const ElementTable<dim, ElasticPoints<dim>> table(run.discretisation, points,
                                                    run.problem.thickness);
  dealii::SparseMatrix<double> M;
  M.reinit(table.sparsity());
  table.consistent_mass(run.problem.material.rho0, M);
  const MassProduct mass_product = [&M](const Vector& x, Vector& y) { M.vmult(y, x); };
  run.observer.connect(table, mass_product);
  keep_what_was_reached(run, [&] {
    const double tolerance =
        run.options.tolerance > 0 ? run.options.tolerance : default_tolerance;
    Newton<dim> newton(table, run.prescribed, run.options, tolerance,
                       run.discretisation.smallest_cell(),
                       run.options.linear_solver == LinearChoice::direct, linear_tolerance);
    const double beta = run.options.beta, gamma = run.options.gamma;
    const double dt = time_step(run), end = run.problem.end_time;

    impose(run.prescribed, 0, state.u);
    initial_velocity(run, dt);
    if (const long bad = table.force(state.u, state.internal); bad >= 0) {
      throw SolveError("det F", 0, 0, bad, "in the initial state");
    }
    run.loads.evaluate(0, state.external);
    initial_acceleration(run, M, dt);
    Vector work_force, last_force, last_u, last_a;
    working_force(run, mass_product, work_force);
    run.result.dt = dt;
    run.observer.start(state);
    run.result.setup_s = now() - run.started;

    Inertia inertia{&M, 1 / (beta * dt * dt), Vector(state.u.size())};
    const double loop_started = now(), observed = run.observer.seconds();
    while (state.t < end * (1 - 1e-12)) {
      last_u = state.u;
      last_a = state.a;
      last_force = work_force;
      inertia.predicted = state.u;
      inertia.predicted.add(dt, state.v, dt * dt * (0.5 - beta), state.a);
      ++state.step;
      state.t = std::min(end, state.step * dt);
      if (run.loads.depends_on_time()) run.loads.evaluate(state.t, state.external);
      newton.solve(state, run.prescribed.values(state.t), &inertia);
      state.a = state.u;
      state.a -= inertia.predicted;
      state.a *= inertia.factor;
      state.v.add(dt * (1 - gamma), last_a, dt * gamma, state.a);
      working_force(run, mass_product, work_force);
      for (unsigned i = 0; i < last_u.size(); ++i) {
        state.external_work += 0.5 * (work_force[i] + last_force[i]) * (state.u[i] - last_u[i]);
      }
      run.result.wall_s = now() - loop_started - (run.observer.seconds() - observed);
      run.observer.after_step(state);
    }
    run.observer.finish(state, true);
  });
}

template void run_newmark<2>(Run<2>&);
template void run_newmark<3>(Run<3>&);

}  // namespace concord::fem
