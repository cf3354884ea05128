#include "particle/delaunay/delaunay.hpp"

#include "particle/core/features.hpp"
#include "particle/delaunay/kernels.hpp"

#include <cmath>

namespace concord::particle::delaunay {

DelaunayModel::DelaunayModel(const Body& body, const scene::Problem& problem,
                             const Parameters& parameters)
    : ForceModel(body, problem) {
  m_pairs = gradient_vectors(body);
  m_contact = parameters.xi_n > 0 || parameters.xi_t > 0;
  const double E = problem.material.E, G = problem.material.mu;
  if (m_contact) {
    m_stiffness.reserve(m_pairs.size());
    for (const Bond& bond : m_pairs) {
      const double L = (body.position(bond.b) - body.position(bond.a)).norm();
      m_stiffness.push_back(interface_area(body.dim, bond) / L);
    }
    m_normal_factor = parameters.xi_n * E;
    m_tangential_factor = parameters.xi_t * G;
  }
  m_bonds = block_bonds(body, m_pairs, m_stiffness);
  m_inverse_V.resize(body.n);
  for (Index a = 0; a < body.n; ++a) m_inverse_V[a] = 1 / body.V[a];
  m_H.assign(static_cast<std::size_t>(body.n) * body.dim * body.stride, 0.0);
  m_P.assign(m_H.size(), 0.0);
  m_bad.assign(m_bonds.blocks.size(), -1);
  if (parameters.c1 > 0 || parameters.c2 > 0) {
    const double rho0 = problem.material.rho0,
                 h = body.h_min;  // Eq. (61): h is the shortest branch vector
    m_viscosity =
        Viscosity{rho0 * parameters.c1 * problem.material.longitudinal_wave_speed() * h,
                  rho0 * parameters.c2 * h * h};
    m_rate.assign(m_H.size(), 0.0);
  }
}

/// P += J sigma_visc F^-T (62) with rho J = rho0: (linear + quadratic |tr d|) d cof F / J, d =
/// sym(dF/dt F^-1) (35), (36).
template <int Dim>
void DelaunayModel::add_viscous_stress(const BondBlock& block, const double* v) {
  volume_gradients<Dim>(block, v, m_rate.data());
  for (Index a = block.first; a < block.last; ++a) {
    const Mat3 F = Mat3::Identity() + tensor_at(m_H, Dim, a);
    const Mat3 inverse = F.inverse();
    const Mat3 l = tensor_at(m_rate, Dim, a) * m_inverse_V[a] * inverse;
    const Mat3 d = 0.5 * (l + l.transpose());
    const Mat3 P = (m_viscosity->linear + m_viscosity->quadratic * std::abs(d.trace())) * d *
                   inverse.transpose();
    for (int j = 0; j < Dim; ++j) {
      for (int i = 0; i < Dim; ++i)
        m_P[(static_cast<std::size_t>(a) * Dim + j) * Lanes<Dim>::stride + i] += P(i, j);
    }
  }
}

template <int Dim>
void DelaunayModel::forces_in(const double* u, const double* v, double* f,
                              const Executor& executor) {
  const std::size_t count = m_bonds.blocks.size();
  executor.for_each(count, [&](std::size_t k) {
    const BondBlock& block = m_bonds.blocks[k];
    m_bad[k] = with_law(m_constitution.kernel().law, [&](auto law) {
      return gradients_and_stress<Dim, decltype(law)::value>(
          block, m_constitution.kernel().constants, m_inverse_V.data(), u, m_H.data(),
          m_P.data(), f);
    });
    if (features::viscosity && m_viscosity) add_viscous_stress<Dim>(block, v);
  });
  for (const Index bad : m_bad) {
    if (bad >= 0) throw BadState{"det F", bad};
  }
  if (features::contact && m_contact) {
    const ContactColumns columns{m_body.X.data(),    u,          m_H.data(),
                                 m_inverse_V.data(), m_P.data(), f};
    const ContactFactors factors{m_normal_factor, m_tangential_factor};
    executor.for_each(count, [&](std::size_t k) {
      if (m_normal_factor == m_tangential_factor)
        contact<Dim, true>(m_bonds.blocks[k], factors, columns);
      else
        contact<Dim, false>(m_bonds.blocks[k], factors, columns);
    });
  }
  executor.for_each(
      count, [&](std::size_t k) { internal_force<Dim>(m_bonds.blocks[k], m_P.data(), f); });
}

void DelaunayModel::forces(std::span<const double> u, std::span<const double> v,
                           std::span<double> f, const Executor& executor) {
  if (m_body.dim == 3)
    forces_in<3>(u.data(), v.data(), f.data(), executor);
  else
    forces_in<2>(u.data(), v.data(), f.data(), executor);
}

double DelaunayModel::viscous_damping_ratio(double omega_max) const {
  // Damping c = (linear/rho0) k^2 against stiffness c_p^2 k^2 on the highest mode: ratio =
  // linear w / (2 rho0 c_p^2).
  if (!m_viscosity) return 0;
  const LameConstants& lame = m_constitution.kernel().constants.lame;
  return 0.5 * m_viscosity->linear * omega_max / (lame.lambda + 2 * lame.mu);
}

void DelaunayModel::compute_gradients(std::span<const double> u, const Executor& executor) {
  executor.for_each(m_bonds.blocks.size(), [&](std::size_t k) {
    const BondBlock& block = m_bonds.blocks[k];
    if (m_body.dim == 3)
      volume_gradients<3>(block, u.data(), m_H.data());
    else
      volume_gradients<2>(block, u.data(), m_H.data());
    const std::size_t size = static_cast<std::size_t>(m_body.dim) * m_body.stride;
    for (Index a = block.first; a < block.last; ++a) {
      for (std::size_t i = 0; i < size; ++i) m_H[a * size + i] *= m_inverse_V[a];
    }
  });
}

void DelaunayModel::gradients(std::span<const double> u, std::span<Mat3> H) {
  compute_gradients(u, Executor(1));
  for (Index a = 0; a < m_body.n; ++a)
    H[a] = m_constitution.complete(tensor_at(m_H, m_body.dim, a));
}

Energies DelaunayModel::energies(std::span<const double> u, const Executor& executor) {
  compute_gradients(u, executor);
  Energies e;
  add_internal_energy(e, executor, [&](Index a) { return tensor_at(m_H, m_body.dim, a); });
  if (m_contact) {
    e.stabilisation = executor.sum(m_pairs.size(), [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t k = begin; k < end; ++k) sum += contact_energy(k, u);
      return sum;
    });
  }
  return e;
}

DelaunayModel::Local DelaunayModel::local_displacement(std::size_t pair,
                                                       std::span<const double> u) const {
  const Bond& bond = m_pairs[pair];
  Local s;
  s.X_ab = m_body.position(bond.b) - m_body.position(bond.a);
  Vec3 u_ab = Vec3::Zero();
  for (int i = 0; i < m_body.dim; ++i) {
    u_ab[i] = u[static_cast<std::size_t>(bond.b) * m_body.stride + i] -
              u[static_cast<std::size_t>(bond.a) * m_body.stride + i];
  }
  s.x_ab = s.X_ab + u_ab;
  s.u_loc =
      u_ab -
      0.5 * (tensor_at(m_H, m_body.dim, bond.a) + tensor_at(m_H, m_body.dim, bond.b)) * s.X_ab;
  s.K_n = m_normal_factor * m_stiffness[pair];
  s.K_t = m_tangential_factor * m_stiffness[pair];
  return s;
}

double DelaunayModel::contact_energy(std::size_t pair, std::span<const double> u) const {
  const Local s = local_displacement(pair, u);
  const double along = s.u_loc.dot(s.x_ab), normal2 = along * along / s.x_ab.squaredNorm();
  return 0.5 * s.K_t * s.u_loc.squaredNorm() + 0.5 * (s.K_n - s.K_t) * normal2;  // (56)
}

/// Derivatives of (57), (58): with r = u_loc, c = K_n - K_t, s = r.x/|x|^2, w = r - s x,
/// q = K_t r + c s x and p = q + c s w.
PairTangent DelaunayModel::contact_tangent(std::size_t pair, std::span<const double> u) const {
  const Local l = local_displacement(pair, u);
  const Vec3 &x = l.x_ab, &r = l.u_loc;
  const double c = l.K_n - l.K_t, x2 = x.squaredNorm(), s = r.dot(x) / x2;
  const Vec3 w = r - s * x;
  const Vec3 s_y = -x / x2, s_x = (x + r - 2 * s * x) / x2;
  const Mat3 I = Mat3::Identity();
  PairTangent t;
  t.a = m_pairs[pair].a;
  t.b = m_pairs[pair].b;
  t.X_ab = l.X_ab;
  t.q_y = -l.K_t * I + c * x * s_y.transpose();
  t.q_x = (l.K_t + c * s) * I + c * x * s_x.transpose();
  t.p_y = t.q_y + c * (w * s_y.transpose() - s * I - s * x * s_y.transpose());
  t.p_x = t.q_x + c * (w * s_x.transpose() + (s - s * s) * I - s * x * s_x.transpose());
  return t;
}

const ForceModel::Stiffness& DelaunayModel::tangent(std::span<const double> u) {
  compute_gradients(u, Executor(1));
  if (!m_tangent) m_tangent.emplace(m_body, directed_rows(m_body, m_pairs));
  std::vector<Moduli> moduli(m_body.n);
  for (Index a = 0; a < m_body.n; ++a)
    moduli[a] = m_constitution.tangent(a, tensor_at(m_H, m_body.dim, a));
  std::vector<PairTangent> pairs;
  if (m_contact) {
    pairs.reserve(m_pairs.size());
    for (std::size_t k = 0; k < m_pairs.size(); ++k) pairs.push_back(contact_tangent(k, u));
  }
  return m_tangent->assemble(moduli, pairs);
}

}  // namespace concord::particle::delaunay
