#include "fem_reference/newton.hpp"
#include "fem_reference/run.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace concord::fem {
namespace {

using Vector = State::Vector;

/// Above this many unknowns a factorisation in three dimensions costs more than conjugate
/// gradients (measured: README, cost table).
constexpr unsigned direct_up_to_3d = 20000;

template <int dim> bool use_direct(const Run<dim>& run) {
  if (run.options.linear_solver != LinearSolver::automatic) {
    return run.options.linear_solver == LinearSolver::direct;
  }
  return dim == 2 || run.discretisation.dofs() <= direct_up_to_3d;
}

/// One step to time t; on failure leaves the state as it was and throws.
template <int dim> void load_step(Run<dim>& run, Newton<dim>& newton, double t) {
  State& state = run.state;
  const State before = state;
  Vector work_force, last_force;
  working_force(run, MassProduct(), last_force);
  state.t = t;
  run.loads.evaluate(t, state.external);
  try {
    state.step += newton.solve(state, run.prescribed.values(t), nullptr);
  } catch (const SolveError&) {
    state = before;
    throw;
  }
  working_force(run, MassProduct(), work_force);
  for (unsigned i = 0; i < state.u.size(); ++i) {
    state.external_work += 0.5 * (work_force[i] + last_force[i]) * (state.u[i] - before.u[i]);
  }
}

}  // namespace

template <int dim> void run_statics(Run<dim>& run) {
  run.prescribed.require_support();
  State& state = run.state;
  const ElementTable<dim> table(run.discretisation, run.law, run.problem.thickness);
  run.observer.connect(table, MassProduct());
  Newton<dim> newton(table, run.prescribed, run.options, use_direct(run));
  if (const long bad = table.force(state.u, state.internal); bad >= 0) {
    throw SolveError("det F", 0, 0, bad, "in the initial state");
  }
  run.loads.evaluate(0, state.external);
  run.observer.start(state);
  run.result.setup_s = now() - run.started;

  const double loop_started = now(), observed = run.observer.seconds();
  for (int k = 1; k <= run.problem.load_steps; ++k) {
    const double target = static_cast<double>(k) / run.problem.load_steps;
    double stride = target - state.t;
    int halvings = 0;
    while (state.t < target) {
      const double next = target - state.t <= stride * (1 + 1e-9) ? target : state.t + stride;
      try {
        load_step(run, newton, next);
        // A step that worked may be followed by one twice as long, up to the scene's own.
        if (halvings > 0) {
          stride *= 2;
          --halvings;
        }
      } catch (const SolveError& error) {
        if (++halvings > run.options.max_halvings) {
          throw SolveError(error.quantity(), state.step, next, error.particle(),
                           fmt::format("the load step was halved {} times; {}",
                                       run.options.max_halvings, error.what()));
        }
        stride *= 0.5;
      }
      run.result.wall_s = now() - loop_started - (run.observer.seconds() - observed);
    }
    run.observer.after_step(state);
  }
  run.result.wall_s = now() - loop_started - (run.observer.seconds() - observed);
  run.observer.finish(state, true);
}

template void run_statics<2>(Run<2>&);
template void run_statics<3>(Run<3>&);

}  // namespace concord::fem
