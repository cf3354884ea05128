#include "particle/core/work.hpp"

#include <algorithm>
#include <map>

namespace concord::particle {
namespace {

/// sum f.v over [begin, end), sixteen products at a time in four sums.
CONCORD_CLONES double power_of(const double* f, const double* v, std::size_t begin,
                               std::size_t end) {
  v4d sum[4] = {};
  std::size_t k = begin;
  for (; k + 16 <= end; k += 16) {
    for (int i = 0; i < 4; ++i) sum[i] += load<v4d>(f + k + 4 * i) * load<v4d>(v + k + 4 * i);
  }
  double rest = 0;
  for (; k < end; ++k) rest += f[k] * v[k];
  return lane_sum((sum[0] + sum[1]) + (sum[2] + sum[3])) + rest;
}

}  // namespace

ExternalWork::ExternalWork(const Body& body, const Constraints& constraints,
                           const ExternalLoads& loads)
    : m_body(body), m_constraints(constraints), m_loads(loads) {
  std::map<std::size_t, char> dofs;
  for (const Index a : loads.varying_particles()) {
    for (int i = 0; i < body.dim; ++i) dofs[static_cast<std::size_t>(a) * body.stride + i] = 0;
  }
  if (constraints.moving()) {
    for (const PrescribedDof& dof : constraints.dofs()) {
      dofs[static_cast<std::size_t>(dof.particle) * body.stride + dof.component] = 1;
    }
  }
  for (const auto& [k, prescribed] : dofs) {
    m_dofs.push_back(k);
    m_prescribed.push_back(prescribed);
  }
  if (loads.any_constant()) {
    m_constant.assign(body.X.size(), 0.0);
    loads.add_constant(m_constant);
  }
  if (loads.depend_on_time()) m_varying.assign(body.X.size(), 0.0);
}

/// Varying load on a followed component; on a prescribed one minus the internal force, less the
/// constant load, whose work total() counts: then load and reaction together do the work of
/// -f_internal.
void ExternalWork::forces(double t, std::span<const double> f, std::vector<double>& out) {
  out.resize(m_dofs.size());
  if (!m_varying.empty()) {
    std::fill(m_varying.begin(), m_varying.end(), 0.0);
    m_loads.add_varying(t, m_varying);
  }
  for (std::size_t n = 0; n < m_dofs.size(); ++n) {
    const std::size_t k = m_dofs[n];
    const double load = m_varying.empty() ? 0.0 : m_varying[k];
    // f = internal + constant + varying, so -internal - constant = varying - f.
    out[n] = m_prescribed[n] ? load - f[k] : load;
  }
}

void ExternalWork::start(double t, std::span<const double> u, std::span<const double> f) {
  m_work = 0;
  if (!m_constant.empty()) m_start_u.assign(u.begin(), u.end());
  if (!follows_steps()) return;
  forces(t, f, m_force);
  m_u.clear();
  for (const std::size_t k : m_dofs) m_u.push_back(u[k]);
}

void ExternalWork::step(double t, std::span<const double> u, std::span<const double> f) {
  forces(t, f, m_next_force);
  for (std::size_t n = 0; n < m_dofs.size(); ++n) {
    const double now = u[m_dofs[n]];
    m_work += 0.5 * (m_force[n] + m_next_force[n]) * (now - m_u[n]);
    m_u[n] = now;
  }
  std::swap(m_force, m_next_force);
}

double ExternalWork::total(std::span<const double> u, std::span<const double> v) const {
  double work = m_work;
  for (std::size_t k = 0; k < m_constant.size(); ++k)
    work += m_constant[k] * (u[k] - m_start_u[k]);
  if (v.empty() || !m_constraints.moving()) return work;
  for (const PrescribedDof& dof : m_constraints.dofs()) {
    const double v_k =
        v[static_cast<std::size_t>(dof.particle) * m_body.stride + dof.component];
    work += 0.5 * m_body.m[dof.particle] * v_k * v_k;
  }
  return work;
}

Vec3 ExternalWork::constant_resultant() const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < m_constant.size(); ++k) {
    if (static_cast<int>(k % m_body.stride) < m_body.dim)
      sum[k % m_body.stride] += m_constant[k];
  }
  return sum;
}

void Dissipation::start(double rate) {
  m_work = 0;
  m_rate = rate;
  m_viscous = m_model.viscous();
  if (m_viscous) m_rest.assign(m_model.body().X.size(), 0.0);
  if (m_viscous) m_force = m_rest;
}

void Dissipation::before(double t, std::span<const double> u, std::span<const double> v,
                         std::span<const double> f) {
  const Fracturing* fracturing = m_viscous ? m_model.fracturing() : nullptr;
  if (fracturing != nullptr) {  // keeps the viscous part by itself, until it advances
    m_kept = fracturing->viscous_forces();
    m_kept_power = kept_power(v);
    if (!(m_rate > 0)) return;
  }
  m_v.assign(v.begin(), v.end());
  if (!m_viscous || fracturing != nullptr) return;
  m_model.forces(u, m_rest, m_force, m_executor);
  m_loads.add(t, m_force);
  for (std::size_t k = 0; k < f.size(); ++k) m_force[k] = f[k] - m_force[k];
}

double Dissipation::kept_power(std::span<const double> v) const {
  return m_executor.sum(v.size(), [&](std::size_t begin, std::size_t end) {
    return power_of(m_kept.data(), v.data(), begin, end);
  });
}

double Dissipation::taken(double dt, std::span<const double> v) const {
  const Body& body = m_model.body();
  const auto mean = [&](std::size_t k) { return 0.5 * (m_v[k] + v[k]); };
  double power = 0;
  if (!m_kept.empty()) {
    power = -0.5 * (m_kept_power + kept_power(v));
  } else if (m_viscous) {
    power = m_executor.sum(v.size(), [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t k = begin; k < end; ++k) sum -= m_force[k] * mean(k);
      return sum;
    });
  }
  if (!(m_rate > 0)) return dt * power;
  const auto S = static_cast<std::size_t>(body.stride);
  double damped = m_executor.sum(body.n, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t a = begin; a < end; ++a) {
      for (std::size_t k = a * S; k < (a + 1) * S; ++k) sum += body.m[a] * mean(k) * mean(k);
    }
    return sum;
  });
  // Prescribed components move as they are told, undamped.
  for (const PrescribedDof& dof : m_constraints.dofs()) {
    const std::size_t k = dof.particle * S + dof.component;
    damped -= body.m[dof.particle] * mean(k) * mean(k);
  }
  return dt * (power + m_rate * damped);
}

}  // namespace concord::particle
