// How the integrator looks at its state: for output, for the stable step, after a failure.

#include "particle/core/leapfrog.hpp"

#include <cmath>

namespace concord::particle {

double Leapfrog::critical_step(double dt_factor) {
  SpectralRadius spectrum(m_model, m_constraints, m_executor);
  const double omega = spectrum.omega_max(m_u);
  if (m_fracturing != nullptr && m_model.viscous())
    m_fracturing->set_damping(spectrum.damping_max(m_u));
  return omega > 0 ? step_for(omega, dt_factor) : m_problem.end_time;
}

/// A share of the critical step at a frequency. With viscous forces of the velocity half a step
/// before, dt^2 K + 2 dt C < 4 M: omega and 2 zeta omega, the largest of either matrix by
/// itself, give a step that is never too long.
double Leapfrog::step_for(double omega, double dt_factor) const {
  const double zeta = m_model.viscous_damping_ratio(omega);
  return dt_factor * 2 / omega * (std::sqrt(1 + zeta * zeta) - zeta);
}

/// Bonds broke in this step. A bound of the frequencies that may have risen is enough for a
/// step that can be cut; a fixed one gets the true frequency before it is given up. Throws
/// BadState.
void Leapfrog::follow_breaks() {
  const FrequencyBound bound = m_fracturing->stiffened(m_u);
  if (!(bound.omega > 0)) return;
  const double step = step_for(bound.omega, m_dt_factor > 0 ? m_dt_factor : 1);
  if (m_dt <= step) return;
  if (m_dt_factor > 0) {
    m_dt = step;
    return;
  }
  m_critical = critical_step(1);
  if (m_dt > m_critical) throw BadState{"time step", bound.particle};
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

/// After a step that failed: undoes its drift, so that the last good state can be written and
/// told. False where that gives no good state either.
bool Leapfrog::step_back() {
  const double dt = m_dt_last;
  if (m_fracturing != nullptr) m_fracturing->take_back();
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

}  // namespace concord::particle
