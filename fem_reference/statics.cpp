#include "fem_reference/element_table.hpp"
#include "fem_reference/newton.hpp"
#include "fem_reference/run.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace concord::fem {
namespace {

using Vector = State::Vector;

/// Above this many unknowns a factorisation in three dimensions is taken to cost more than
/// conjugate gradients: a guess, not measured yet.
constexpr unsigned direct_up_to_3d = 20000;

/// Near round-off: a static solution costs one more iteration for it.
constexpr double default_tolerance = 1e-12;

template <int dim> bool use_direct(const Run<dim>& run) {
  if (run.options.linear_solver != LinearChoice::automatic) {
    return run.options.linear_solver == LinearChoice::direct;
  }
  return dim == 2 || run.discretisation.dofs() <= direct_up_to_3d;
}

/// Where a load step comes from and goes to: prescribed values, external forces, time.
struct LoadStep {
  std::vector<double> given_0, given_1;
  Vector external_0, external_1;
  double t_0, t_1;
};

/// The part `s` of a step: everything interpolated between its ends, so that halving also helps
/// where a scene puts on its whole load at once. On failure leaves the state as it was and
/// throws.
template <int dim>
void solve_part(Run<dim>& run, Newton<dim>& newton, const LoadStep& step, double s) {
  State& state = run.state;
  const State before = state;
  Vector work_force, last_force;
  working_force(run, MassProduct(), last_force);
  std::vector<double> given = step.given_1;
  if (s < 1) {
    for (std::size_t k = 0; k < given.size(); ++k) {
      given[k] = (1 - s) * step.given_0[k] + s * step.given_1[k];
    }
  }
  state.t = s < 1 ? (1 - s) * step.t_0 + s * step.t_1 : step.t_1;
  state.external = step.external_1;
  if (s < 1) state.external.sadd(s, 1 - s, step.external_0);
  try {
    state.step += newton.solve(state, given, nullptr);
  } catch (const SolveError&) {
    state = before;
    throw;
  }
  if (run.plastic != nullptr) run.plastic->commit();
  working_force(run, MassProduct(), work_force);
  for (unsigned i = 0; i < state.u.size(); ++i) {
    state.external_work += 0.5 * (work_force[i] + last_force[i]) * (state.u[i] - before.u[i]);
  }
}

/// One load step of the scene, in as many parts as Newton needs.
template <int dim> void solve_step(Run<dim>& run, Newton<dim>& newton, const LoadStep& step) {
  double done = 0, stride = 1;
  int halvings = 0;
  while (done < 1) {
    const double next = done + stride * (1 + 1e-9) >= 1 ? 1 : done + stride;
    try {
      solve_part(run, newton, step, next);
      done = next;
      if (halvings > 0) {  // a part that worked may be followed by one twice as long
        stride *= 2;
        --halvings;
      }
    } catch (const SolveError& error) {
      if (++halvings > run.options.max_halvings) {
        const double t = (1 - next) * step.t_0 + next * step.t_1;
        throw SolveError(error.quantity(), run.state.step, t, error.particle(),
                         fmt::format("the load step was halved {} times; {}",
                                     run.options.max_halvings, error.what()));
      }
      stride *= 0.5;
    }
  }
}

template <int dim, class Law> void run_with(Run<dim>& run, Law& law) {
  run.prescribed.require_support();
  State& state = run.state;
  const ElementTable<dim, Law> table(run.discretisation, law, run.problem.thickness);
  run.observer.connect(table, MassProduct());
  keep_what_was_reached(run, [&] {
    const bool direct = use_direct(run) || !table.symmetric();
    const double tolerance =
        run.options.tolerance > 0 ? run.options.tolerance : default_tolerance;
    Newton<dim> newton(table, run.prescribed, run.options, tolerance,
                       run.discretisation.smallest_cell(), direct, 1e-10);
    if (const long bad = table.force(state.u, state.internal); bad >= 0) {
      throw SolveError("det F", 0, 0, bad, "in the initial state");
    }
    if (run.plastic != nullptr) run.plastic->commit();
    state.external = state.internal;  // the loads under which the initial state is at rest
    run.observer.start(state);
    run.result.setup_s = now() - run.started;

    const double loop_started = now(), observed = run.observer.seconds();
    for (int k = 1; k <= run.problem.load_steps; ++k) {
      LoadStep step;
      step.t_0 = state.t;
      step.t_1 = static_cast<double>(k) / run.problem.load_steps;
      step.given_1 = run.prescribed.values(step.t_1);
      for (std::size_t i = 0; i < run.prescribed.size(); ++i) {
        step.given_0.push_back(state.u[run.prescribed.dof(i)]);
      }
      step.external_0 = state.external;
      run.loads.evaluate(step.t_1, step.external_1);
      solve_step(run, newton, step);
      run.result.wall_s = now() - loop_started - (run.observer.seconds() - observed);
      run.observer.after_step(state);
    }
    run.result.wall_s = now() - loop_started - (run.observer.seconds() - observed);
    run.observer.finish(state, true);
  });
}

}  // namespace

template <int dim> void run_statics(Run<dim>& run) {
  if (run.plastic != nullptr) return run_with(run, *run.plastic);
  ElasticPoints<dim> points(*run.elastic);
  run_with(run, points);
}

template void run_statics<2>(Run<2>&);
template void run_statics<3>(Run<3>&);

}  // namespace concord::fem
