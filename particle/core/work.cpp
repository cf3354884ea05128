#include "particle/core/work.hpp"

#include <algorithm>
#include <map>

namespace concord::particle {

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

}  // namespace concord::particle
