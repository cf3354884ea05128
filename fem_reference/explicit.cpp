#include "fem_reference/matrix_free.hpp"
#include "fem_reference/run.hpp"
#include "fem_reference/spectrum.hpp"

#include <cmath>

namespace concord::fem {
namespace {

using Vector = State::Vector;

/// Motion of the prescribed unknowns: u at t + dt, and v and a by central differences in time.
template <int dim> class Motion {
 public:
  explicit Motion(const Run<dim>& run)
      : m_run(run), m_moves(run.prescribed.depends_on_time()) {}
  /// v = (u(t+dt) - u(t-dt))/(2 dt), a = (u(t+dt) - 2 u(t) + u(t-dt))/dt^2 at the state's time.
  void impose_rates(State& state, double dt) const {
    const auto& given = m_run.prescribed;
    std::vector<double> before, here, after;
    if (m_moves) {
      before = given.values(state.t - dt);
      here = given.values(state.t);
      after = given.values(state.t + dt);
    }
    for (std::size_t k = 0; k < given.size(); ++k) {
      const unsigned d = given.dof(k);
      state.v[d] = m_moves ? (after[k] - before[k]) / (2 * dt) : 0.0;
      state.a[d] = m_moves ? (after[k] - 2 * here[k] + before[k]) / (dt * dt) : 0.0;
    }
  }
  void impose_positions(State& state) const {
    if (m_moves) impose(m_run.prescribed, state.t, state.u);
  }

 private:
  const Run<dim>& m_run;
  bool m_moves;
};

void accelerate(State& state, const Vector& mass) {
  for (unsigned i = 0; i < mass.size(); ++i) {
    state.a[i] = (state.external[i] - state.internal[i]) / mass[i];
  }
}

/// v += dt/2 a, u += dt v.
void kick_and_drift(State& state, double dt) {
  for (unsigned i = 0; i < state.u.size(); ++i) {
    state.v[i] += 0.5 * dt * state.a[i];
    state.u[i] += dt * state.v[i];
  }
}

void check(const State& state, long bad_element) {
  if (bad_element >= 0) {
    throw SolveError("det F", state.step, state.t, bad_element,
                     "det F <= 0 or not a number (a smaller fem.dt_factor may help)");
  }
}

/// Steps between estimates of the spectrum, and the share of the critical step at which the
/// step is renewed: 5 warm iterations every 200 steps cost 2.5 %.
constexpr int steps_between_estimates = 200;
constexpr double renew_above = 0.95;

/// The step that reaches `end` in whole steps of at most dt.
double whole_steps(double left, double dt) { return left / std::ceil(left / dt * (1 - 1e-12)); }

}  // namespace

template <int dim> void run_explicit(Run<dim>& run) {
  State& state = run.state;
  const auto force = make_matrix_free(run.discretisation, *run.elastic, run.problem.thickness);
  Vector mass;
  lumped_mass(run.discretisation, run.problem.material.rho0, run.problem.thickness, mass);
  const MassProduct mass_product = [&mass](const Vector& x, Vector& y) {
    y = x;
    y.scale(mass);
  };
  run.observer.connect(*force, mass_product);
  keep_what_was_reached(run, [&] {
    const Motion<dim> motion(run);
    Spectrum spectrum(
        *force, mass, [&](unsigned dof) { return run.prescribed.is_given(dof); },
        run.discretisation.smallest_cell());
    impose(run.prescribed, 0, state.u);
    check(state, force->force(state.u, state.internal));
    run.loads.evaluate(0, state.external);

    const double end = run.problem.end_time;
    const auto stable_step = [&](int least, int most) {
      const double omega = spectrum.omega(state.u, state.internal, least, most);
      return omega > 0 ? 2 / omega : end;
    };
    const bool chosen = run.options.dt > 0;
    double dt =
        chosen ? run.options.dt : run.options.dt_factor * stable_step(first_least, first_most);
    dt = whole_steps(end, std::min(dt, end));
    accelerate(state, mass);
    motion.impose_rates(state, dt);
    Vector work_force, last_force, last_u;
    const bool given_moves = run.prescribed.depends_on_time();
    const bool works = run.loads.any() || given_moves;
    working_force(run, mass_product, work_force);
    run.observer.start(state);
    run.result.setup_s = now() - run.started;

    const double loop_started = now(), observed = run.observer.seconds();
    while (state.t < end * (1 - 1e-12)) {
      if (works) {
        last_u = state.u;
        last_force = work_force;
      }
      kick_and_drift(state, dt);
      ++state.step;
      state.t += dt;
      motion.impose_positions(state);
      check(state, force->force(state.u, state.internal));
      if (run.loads.depends_on_time()) run.loads.evaluate(state.t, state.external);
      accelerate(state, mass);
      state.v.add(0.5 * dt, state.a);
      motion.impose_rates(state, dt);
      if (works) {
        working_force(run, mass_product, work_force);
        for (unsigned i = 0; i < last_u.size(); ++i) {
          state.external_work +=
              0.5 * (work_force[i] + last_force[i]) * (state.u[i] - last_u[i]);
        }
      }
      run.result.dt = dt;
      run.result.wall_s = now() - loop_started - (run.observer.seconds() - observed);
      run.observer.after_step(state);
      if (!chosen && state.step % steps_between_estimates == 0) {
        const double critical = stable_step(5, 5);
        if (dt > renew_above * critical) {
          dt = whole_steps(end - state.t, run.options.dt_factor * critical);
        }
      }
    }
    run.result.wall_s = now() - loop_started - (run.observer.seconds() - observed);
    run.observer.finish(state, true);
  });
}

template void run_explicit<2>(Run<2>&);
template void run_explicit<3>(Run<3>&);

}  // namespace concord::fem
