#include "particle/core/leapfrog.hpp"

#include "particle/core/features.hpp"
#include "scene/interrupt.hpp"

#include <chrono>
#include <cmath>

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
  m_fracturing->advance(m_t, dt, m_u, m_v, m_f, m_executor);
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

double Leapfrog::critical_step(double dt_factor) {
  SpectralRadius spectrum(m_model, m_constraints, m_executor);
  const double omega = spectrum.omega_max(m_u);
  if (!(omega > 0)) return m_problem.end_time;
  const double zeta = m_model.viscous_damping_ratio(omega);
  return dt_factor * 2 / omega * (std::sqrt(1 + zeta * zeta) - zeta);
}

double Leapfrog::largest_gradient() {
  const Body& body = m_model.body();
  if (body.inside()) {  // simplices do not see what happens between particles and faces
    m_H.resize(body.bulk);
    m_model.gradients(m_u, m_H);
    double largest = 0;
    for (const Mat3& H : m_H) largest = std::max(largest, H.squaredNorm());
    return std::sqrt(largest);
  }
  // A bound that needs no tensors: the largest relative displacement over a bond of the
  // triangulation.
  const Triangulation& t = body.triangulation;
  const int nv = t.dim + 1;
  double largest = 0;
  for (std::size_t s = 0; s < t.size(); ++s) {
    const Index* v = &t.simplices[s * nv];
    for (int k = 1; k < nv; ++k) {
      double du = 0, dX = 0;
      for (int i = 0; i < t.dim; ++i) {
        const std::size_t p = static_cast<std::size_t>(v[k]) * body.stride + i,
                          q = static_cast<std::size_t>(v[0]) * body.stride + i;
        du += (m_u[p] - m_u[q]) * (m_u[p] - m_u[q]);
        dX += (body.X[p] - body.X[q]) * (body.X[p] - body.X[q]);
      }
      largest = std::max(largest, du / dX);
    }
  }
  return std::sqrt(largest);
}

State Leapfrog::state() {
  const Body& body = m_model.body();
  // A kick of half a step: (v_n - v) / (dt/2) = f/m - c (v + v_n)/2, v at the half step before.
  const double share = 1 / (1 + 0.25 * m_damping * m_dt_last);
  m_v_full = m_v;
  m_acceleration.assign(m_f.size(), 0.0);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < body.dim; ++i) {
      const std::size_t k = static_cast<std::size_t>(a) * body.stride + i;
      m_acceleration[k] = share * (m_f[k] * m_inverse_mass[a] - m_damping * m_v[k]);
    }
  }
  m_constraints.clear(m_acceleration);
  for (std::size_t k = 0; k < m_v.size(); ++k)
    m_v_full[k] += 0.5 * m_dt_last * m_acceleration[k];
  State s;
  s.t = m_problem.is_static ? load_time() : m_t;
  s.u = m_u;
  s.v = m_v_full;
  s.unbalanced = m_f;
  s.acceleration = m_acceleration;
  s.external_work = m_work.total(m_u, m_v_full);
  if (m_fracturing != nullptr) s.released = m_fracturing->record().released;
  s.impulse = m_work.constant_resultant() * m_t;
  if (!m_dissipation.active()) return s;
  try {
    m_dissipation.before(load_time(), m_u, m_v, m_f);
  } catch (const BadState&) {  // after a step that could not be undone
    return s;
  }
  s.dissipation = m_dissipation.work() + m_dissipation.taken(0.5 * m_dt_last, m_v_full);
  return s;
}

bool Leapfrog::settled(double fraction) {
  Column load(m_f.size(), 0.0);
  m_loads.add(load_time(), load);
  double residual = 0, scale = 0;
  Column free = m_f;
  m_constraints.clear(free);
  for (std::size_t k = 0; k < m_f.size(); ++k) {
    residual += free[k] * free[k];
    scale += (m_f[k] - load[k]) * (m_f[k] - load[k]);
  }
  return residual <= fraction * fraction * scale;
}

/// Due `count` times evenly over [0, end], and at the end.
class Leapfrog::Schedule {
 public:
  Schedule(int count, double end) : m_count(count), m_end(end) {}
  bool due(double t) {
    if (t >= m_end) return true;
    if (m_count <= 0 || t < static_cast<double>(m_next) * m_end / m_count) return false;
    m_next = static_cast<long>(t / m_end * m_count) + 1;
    return true;
  }

 private:
  int m_count;
  double m_end;
  long m_next = 1;
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
  if (row && m_row_at != m_t) recorder.row(state());
  if (frame && m_frame_at != m_t) recorder.frame(state());
  if (row) m_row_at = m_t;
  if (frame) m_frame_at = m_t;
}

/// After a step that failed: undoes its drift, so that the last good state can be written and
/// told. False where that gives no good state either.
bool Leapfrog::step_back() {
  const double dt = m_dt_last;
  for (std::size_t k = 0; k < m_u.size(); ++k) m_u[k] -= dt * m_v[k];
  m_t -= dt;
  if (m_constraints.moving()) {  // the step's prescribed values may not be numbers
    // Prescribed particles keep the velocity of a step earlier.
    m_constraints.impose(load_time(m_t - dt), m_v);
    m_constraints.impose(load_time(), m_u);
    for (const PrescribedDof& dof : m_constraints.dofs()) {
      const std::size_t k =
          static_cast<std::size_t>(dof.particle) * m_model.body().stride + dof.component;
      m_v[k] = dt > 0 && m_t >= dt ? (m_u[k] - m_v[k]) / dt : 0;
    }
  }
  m_dt_last = 0;
  try {
    m_model.forces(m_u, m_v, m_f, m_executor);
    m_loads.add(load_time(), m_f);
  } catch (const BadState&) {
    return false;
  }
  return !not_finite();
}

/// The first displacement, velocity or force that is not a finite number.
std::optional<BadState> Leapfrog::not_finite() const {
  const Body& body = m_model.body();
  const std::pair<const Column&, const char*> columns[] = {
      {m_u, "displacement"}, {m_v, "velocity"}, {m_f, "force"}};
  for (const auto& [column, quantity] : columns) {
    double sum = 0;  // 0 x is 0 or not a number
    for (const double x : column) sum += 0 * x;
    if (sum == 0) continue;
    for (Index a = 0; a < body.n; ++a) {
      for (int i = 0; i < body.dim; ++i) {
        if (!std::isfinite(column[static_cast<std::size_t>(a) * body.stride + i]))
          return BadState{quantity, body.particle_at(a)};
      }
    }
  }
  return {};
}

/// Before a state is looked at or written. Throws BadState.
void Leapfrog::check_finite() {
  const std::optional<BadState> bad = not_finite();
  if (!bad) return;
  m_in_step = true;  // this state is not taken
  throw *bad;
}

void Leapfrog::advance(const LeapfrogOptions& options, Recorder& recorder,
                       LeapfrogOutcome& outcome) {
  const double end = options.end_time;
  Schedule rows(options.history_rows, end), frames(options.frames, end);
  double dt = options.dt_fixed > 0 ? options.dt_fixed : critical_step(options.dt_factor);
  double gradient = largest_gradient();
  while (m_t < end) {
    const auto begin = Clock::now();
    const double left = end - m_t;
    const double size = left / std::ceil(left / dt * (1 - 1e-12));
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
      if (std::abs(now - gradient) > options.reestimate_at) {
        dt = critical_step(options.dt_factor);
        gradient = now;
      }
    }
    outcome.settled = look && options.stop_at_residual > 0 && m_t >= m_ramp &&
                      settled(options.stop_at_residual);
    outcome.loop_s += std::chrono::duration<double>(Clock::now() - begin).count();
    if (features::output) write(recorder, row, frame);
    if ((row || frame) && options.progress) {
      options.progress(m_t / end, "time step " + std::to_string(outcome.steps));
    }
    if (outcome.settled) break;
    scene::check_interrupt();
  }
}

void Leapfrog::run(const LeapfrogOptions& options, Recorder& recorder,
                   LeapfrogOutcome& outcome) {
  m_damping = options.damping;
  const auto failure = [&](const BadState& bad, long step) {
    return SolveError(bad.quantity, step, m_t, bad.particle,
                      bad.quantity == "det F" ? "det F <= 0 or not a number" : "not finite");
  };
  move_all();
  if (features::rest && options.rest_regions && m_model.has_parts()) {
    m_rest.emplace(m_model, m_constraints, m_loads, m_u, m_v);
    follow_rest();
  }
  try {
    advance_forces(0);
    check_finite();
    m_model.commit();
    m_work.start(load_time(), m_u, m_f);
    m_dissipation.start(m_damping);
    write(recorder, true, true);
    advance(options, recorder, outcome);
  } catch (const BadState& bad) {
    const SolveError error = failure(bad, m_dt_last > 0 ? outcome.steps + 1 : 0);
    const bool started = m_dt_last > 0, good = !m_in_step || step_back();
    if (started && good) write(recorder, true, true);
    throw error;
  } catch (const Interrupted&) {
    if (!not_finite()) write(recorder, true, true);
    throw;
  }
}

}  // namespace concord::particle
