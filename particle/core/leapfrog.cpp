#include "particle/core/leapfrog.hpp"

#include "particle/core/features.hpp"
#include "scene/interrupt.hpp"

#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace concord::particle {
namespace {

using Clock = std::chrono::steady_clock;

/// v = keep v + scale f/m, one vector a particle; keep is 1 without damping.
template <int Dim, bool Damped>
CONCORD_CLONES void kick_range(std::size_t begin, std::size_t end, double keep, double scale,
                               const double* inverse_mass, const double* f, double* v) {
  constexpr int S = Lanes<Dim>::stride;
  for (std::size_t a = begin; a < end; ++a) {
    const Vec<Dim> force =
        load<Vec<Dim>>(f + a * S) * broadcast(scale * inverse_mass[a], Vec<Dim>{});
    Vec<Dim> kept = load<Vec<Dim>>(v + a * S);
    if constexpr (Damped) kept *= broadcast(keep, Vec<Dim>{});
    store(v + a * S, kept + force);
  }
}

CONCORD_CLONES void drift_range(std::size_t begin, std::size_t end, double dt,
                                const double* __restrict v, double* __restrict u) {
#pragma omp simd
  for (std::size_t k = begin; k < end; ++k) u[k] += dt * v[k];
}

}  // namespace

Leapfrog::Leapfrog(const scene::Problem& problem, ForceModel& model,
                   const Constraints& constraints, const ExternalLoads& loads,
                   const Executor& executor, double ramp_time)
    : m_problem(problem), m_model(model), m_fracturing(model.fracturing()),
      m_constraints(constraints), m_loads(loads), m_executor(executor), m_ramp(ramp_time),
      m_work(model.body(), constraints, loads),
      m_dissipation(model, constraints, loads, executor) {
  const Body& body = model.body();
  m_u.assign(body.X.size(), 0.0);
  m_v = m_f = m_u;
  m_inverse_mass.resize(body.n);
  for (Index a = 0; a < body.n; ++a) {
    m_inverse_mass[a] = a < body.bulk ? 1 / body.m[a] : 0;  // boundary points are prescribed
    const Vec3 X = body.position(a);
    for (int i = 0; i < body.dim; ++i) {
      const std::size_t k = static_cast<std::size_t>(a) * body.stride + i;
      if (problem.initial_displacement) m_u[k] = (*problem.initial_displacement)(X, 0)[i];
      if (problem.initial_velocity) m_v[k] = (*problem.initial_velocity)(X, 0)[i];
    }
  }
  m_constraints.impose(0, m_u);
  m_constraints.clear(m_v);
}

template <class Body> void Leapfrog::for_awake(const Body& body) const {
  for (const ParticleRange& range : m_awake) {
    const auto first = static_cast<std::size_t>(range.first);
    m_executor.for_pieces(range.last - range.first, [&](std::size_t begin, std::size_t end) {
      body(first + begin, first + end);
    });
  }
}

void Leapfrog::move_all() {
  m_rest.reset();
  m_awake_count = m_model.body().bulk;
  m_awake = {{0, m_model.body().n}};
}

/// After a drift: whom the next forces are computed for.
void Leapfrog::follow_rest() {
  m_rest->look(m_u, m_v);
  if (m_rest->all_awake()) {
    move_all();
    return;
  }
  m_awake = m_rest->awake();
  m_awake_count = 0;
  const Index bulk = m_model.body().bulk;
  for (const ParticleRange& range : m_awake)
    m_awake_count += std::min(range.last, bulk) - std::min(range.first, bulk);
}

void Leapfrog::evaluate() {
  if (features::rest && m_rest)
    m_model.forces_of(m_awake, m_u, m_v, m_f, m_executor);
  else
    m_model.forces(m_u, m_v, m_f, m_executor);
  if (m_loads.none()) return;
  m_loads.add(load_time(), m_f);
}

/// Forces at the end of a step dt (0: at the start), after which bonds may break.
void Leapfrog::advance_forces(double dt) {
  if (!features::fracture || m_fracturing == nullptr) return evaluate();
  const std::size_t dead = m_fracturing->record().dead.size();
  m_fracturing->advance(m_t, dt, m_u, m_v, m_f, m_executor);
  if (dt > 0 && m_fracturing->record().dead.size() > dead) follow_breaks();
  if (!m_loads.none()) m_loads.add(load_time(), m_f);
}

void Leapfrog::kick(double dt, double damping) {
  const double keep = (1 - 0.5 * damping * dt) / (1 + 0.5 * damping * dt),
               scale = dt / (1 + 0.5 * damping * dt);
  const bool damped = features::damping && damping > 0;
  const auto range = m_model.body().dim == 3
                         ? (damped ? kick_range<3, true> : kick_range<3, false>)
                         : (damped ? kick_range<2, true> : kick_range<2, false>);
  for_awake([&](std::size_t begin, std::size_t end) {
    range(begin, end, keep, scale, m_inverse_mass.data(), m_f.data(), m_v.data());
  });
  m_constraints.clear(m_v);
}

void Leapfrog::drift(double dt) {
  const auto stride = static_cast<std::size_t>(m_model.body().stride);
  for_awake([&](std::size_t begin, std::size_t end) {
    drift_range(begin * stride, end * stride, dt, m_v.data(), m_u.data());
  });
  m_t += dt;
  if (!m_constraints.moving()) return;
  const Body& body = m_model.body();
  for (const PrescribedDof& dof : m_constraints.dofs()) {
    const std::size_t k = static_cast<std::size_t>(dof.particle) * body.stride + dof.component;
    const double u = m_constraints.value(dof, load_time());
    m_v[k] = (u - m_u[k]) / dt;
    m_u[k] = u;
  }
}

/// Due `count` times evenly over [0, end], and at the end.
class Leapfrog::Schedule {
 public:
  Schedule(int count, double end, long& next) : m_count(count), m_end(end), m_next(next) {}
  bool due(double t) {
    if (t >= m_end) return true;
    if (m_count <= 0 || t < static_cast<double>(m_next) * m_end / m_count) return false;
    m_next = static_cast<long>(t / m_end * m_count) + 1;
    return true;
  }

 private:
  int m_count;
  double m_end;
  long& m_next;
};

void Leapfrog::step(double dt) {
  m_in_step = true;
  const double kick_dt = 0.5 * (m_dt_last + dt);
  const bool dissipates = (features::viscosity || features::damping) && m_dissipation.active();
  if (dissipates) m_dissipation.before(load_time(), m_u, m_v, m_f);
  kick(kick_dt, m_damping);
  drift(dt);
  if (dissipates) m_dissipation.add(kick_dt, m_v);
  m_dt_last = dt;
  if (features::rest && m_rest) follow_rest();
  advance_forces(dt);
  if (features::plasticity) m_model.commit();
  m_in_step = false;
  if (m_work.follows_steps()) m_work.step(load_time(), m_u, m_f);
}

/// Writes the state unless it has been written.
void Leapfrog::write(Recorder& recorder, bool row, bool frame) {
  m_row_due = row && m_row_at != m_t;
  m_frame_due = frame && m_frame_at != m_t;
  if (m_row_due) recorder.row(state());
  if (row) m_row_at = m_t;
  m_row_due = false;
  if (m_frame_due) recorder.frame(state());
  if (frame) m_frame_at = m_t;
  m_frame_due = false;
}

/// Simplices that are gone.
long Leapfrog::dead() const {
  return m_fracturing == nullptr ? 0 : static_cast<long>(m_fracturing->record().dead.size());
}

void Leapfrog::advance(const LeapfrogOptions& options, Recorder& recorder,
                       LeapfrogOutcome& outcome) {
  const double end = options.end_time;
  Schedule rows(options.history_rows, end, m_next_row),
      frames(options.frames, end, m_next_frame);
  write(recorder, m_row_due, m_frame_due);
  if (!(m_dt > 0)) {
    m_dt = options.dt_fixed > 0 ? options.dt_fixed : critical_step(options.dt_factor);
    m_gradient = largest_gradient();
    m_dead = dead();
  }
  while (m_t < end && !outcome.settled) {
    const auto begin = Clock::now();
    const double left = end - m_t;
    const double size = left / std::ceil(left / m_dt * (1 - 1e-12));
    const bool last = left - size < 1e-9 * size;
    step(size);
    outcome.particle_steps += m_awake_count;
    if (last) m_t = end;
    const bool look = (outcome.steps + 1) % look_every == 0,
               row = features::output && rows.due(m_t),
               frame = features::output && frames.due(m_t);
    if (look || row || frame) check_finite();
    ++outcome.steps;
    outcome.t = m_t;
    outcome.dt = size;
    if (look && options.dt_fixed <= 0) {
      const double now = largest_gradient();
      if (std::abs(now - m_gradient) > options.reestimate_at || dead() != m_dead) {
        m_dt = critical_step(options.dt_factor);
        m_gradient = now;
        m_dead = dead();
      }
    }
    outcome.settled = look && options.stop_at_residual > 0 && m_t >= m_ramp &&
                      settled(options.stop_at_residual);
    outcome.loop_s += std::chrono::duration<double>(Clock::now() - begin).count();
    if (features::output) write(recorder, row, frame);
    if ((row || frame) && options.progress) {
      options.progress(m_t / end, "time step " + std::to_string(outcome.steps));
    }
    if (features::output && (look || row || frame) && options.checkpoints != nullptr &&
        options.checkpoints->due())
      save(options, recorder, outcome);
    if (outcome.settled) break;
    scene::check_interrupt();
  }
}

/// Forces and accounts at t = 0.
void Leapfrog::start() {
  advance_forces(0);
  check_finite();
  m_model.commit();
  m_work.start(load_time(), m_u, m_f);
  m_row_due = m_frame_due = true;
}

void Leapfrog::run(const LeapfrogOptions& options, Recorder& recorder,
                   LeapfrogOutcome& outcome) {
  m_damping = options.damping;
  m_dt_factor = options.dt_fixed > 0 ? 0 : options.dt_factor;
  m_dissipation.start(m_damping);
  const bool resumes = options.checkpoints != nullptr && options.checkpoints->resumes();
  if (resumes) {
    options.checkpoints->restore(
        [&](scene::Checkpoint& state) { keep(state, recorder, outcome); });
  }
  const auto failure = [&](const BadState& bad, long step) {
    if (bad.quantity == "time step") {
      return SolveError(bad.quantity, step, m_t, bad.particle,
                        fmt::format("{:.4g} s, above the critical one of what is left since "
                                    "bonds broke, {:.4g} s",
                                    m_dt, m_critical));
    }
    return SolveError(bad.quantity, step, m_t, bad.particle,
                      bad.quantity == "det F" ? "det F <= 0 or not a number" : "not finite");
  };
  move_all();
  if (features::rest && options.rest_regions && m_model.has_parts()) {
    m_rest.emplace(m_model, m_constraints, m_loads, m_u, m_v);
    follow_rest();
  }
  try {
    if (!resumes) start();
    advance(options, recorder, outcome);
  } catch (const BadState& bad) {
    const SolveError error = failure(bad, m_dt_last > 0 ? outcome.steps + 1 : 0);
    const bool started = m_dt_last > 0, good = !m_in_step || step_back();
    if (started && good) write(recorder, true, true);
    throw error;
  } catch (const Interrupted&) {
    if (not_finite()) throw;
    save(options, recorder, outcome);
    write(recorder, true, true);  // of this instant; a run that goes on takes them back
    throw;
  } catch (const scene::OutputError&) {
    save_unwritten(options, recorder, outcome);
    throw;
  }
}

}  // namespace concord::particle
