#pragma once
// One run: its parts, and the three ways through time.

#include "fem_reference/observer.hpp"

namespace concord::fem {

template <int dim> struct Run {
  const scene::Problem& problem;
  const scene::RunRequest& request;
  const Options& options;
  const Discretisation<dim>& discretisation;
  const Prescribed<dim>& prescribed;
  const Loads<dim>& loads;
  Observer<dim>& observer;
  scene::Result& result;
  State& state;
  const Hyperelastic<dim>* elastic;  ///< one of the two is there
  PlasticPoints<dim>* plastic;       ///< in statics only
  double started = 0;                ///< clock at the start of the set-up [s]

  bool depends_on_time() const {
    return prescribed.depends_on_time() || loads.depends_on_time();
  }
};

/// Runs `loop`. Where it ends early, the observer writes what was reached while the forces and
/// masses that it is connected to still live.
template <int dim, class Loop> void keep_what_was_reached(Run<dim>& run, const Loop& loop) {
  try {
    loop();
  } catch (const InputError&) {
    throw;
  } catch (...) {
    run.observer.finish(run.state, false);
    throw;
  }
}

/// Seconds on a steady clock.
double now();

/// Puts the prescribed values of time t into `u`.
template <int dim>
void impose(const Prescribed<dim>& prescribed, double t, dealii::Vector<double>& u) {
  const std::vector<double> values = prescribed.values(t);
  for (std::size_t k = 0; k < values.size(); ++k) u[prescribed.dof(k)] = values[k];
}

/// Central differences (velocity Verlet) with a lumped mass.
template <int dim> void run_explicit(Run<dim>& run);
/// Newmark's method with the consistent mass.
template <int dim> void run_newmark(Run<dim>& run);
/// Load steps in t from 0 to 1, halved where Newton fails.
template <int dim> void run_statics(Run<dim>& run);

/// Force on each unknown that does work: f_ext where free, f_int + M a where given.
template <int dim>
void working_force(const Run<dim>& run, const MassProduct& mass, State::Vector& out) {
  out = run.state.external;
  if (run.prescribed.size() == 0) return;
  State::Vector Ma(out.size());
  if (mass) mass(run.state.a, Ma);
  for (std::size_t k = 0; k < run.prescribed.size(); ++k) {
    const unsigned d = run.prescribed.dof(k);
    out[d] = run.state.internal[d] + Ma[d];
  }
}

}  // namespace concord::fem
