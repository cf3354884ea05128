#include "sph_reference/total_lagrangian/model.hpp"

#include <algorithm>

namespace concord::sph {
namespace {

/// Particles in a range dealt to a thread: whole groups of stress_width, several ranges a
/// thread from a few thousand particles on.
constexpr std::size_t range = 64 * particle::stress_width;

template <class Loop>
void for_ranges(std::size_t n, const Executor& executor, const Loop& loop) {
  executor.for_each((n + range - 1) / range,
                    [&](std::size_t k) { loop(k, k * range, std::min(n, (k + 1) * range)); });
}

Viscosity viscosity(const TlsphOptions& options, const scene::Material& material, double h) {
  return {options.alpha * material.rho0 * material.longitudinal_wave_speed() * h,
          options.beta * material.rho0 * h * h, 0.01 * h * h};
}

}  // namespace

TotalLagrangianSph::TotalLagrangianSph(const Body& body, const scene::Problem& problem,
                                       const TlsphOptions& options, const Executor& executor)
    : ForceModel(body, problem), m_options(options),
      m_kernel(options.kernel, body.dim, options.support * body.h),
      m_rho0(problem.material.rho0),
      m_viscosity(viscosity(options, problem.material, m_kernel.smoothing_length())),
      m_points(body, options.planes, m_kernel.radius()),
      m_rows(find_neighbours(m_points, body.V, m_kernel, options.psi * problem.material.E,
                             executor)),
      m_loops(choose_loops(body.dim, m_constitution.kernel().law, penalty(), viscous())),
      m_records(static_cast<std::size_t>(m_points.count()) * 2 * body.dim * body.stride, 0.0),
      m_u(m_points.make_column()), m_v(viscous() ? m_points.make_column() : Column()),
      m_bad((static_cast<std::size_t>(body.n) + range - 1) / range, -1) {}

State TotalLagrangianSph::state(std::span<const double> u, std::span<const double> v,
                                std::span<double> f, const Executor& executor) {
  const double* all_v = viscous() && !v.empty() ? m_points.extend(v, m_v, executor) : v.data();
  return {m_points.positions(),
          m_points.extend(u, m_u, executor),
          all_v,
          m_body.V.data(),
          m_records.data(),
          f.data()};
}

void TotalLagrangianSph::forces(std::span<const double> u, std::span<const double> v,
                                std::span<double> f, const Executor& executor) {
  const State s = state(u, v, f, executor);
  if (penalty() == PenaltyForm::potential) update_gradients(s, executor);
  for_ranges(m_body.n, executor, [&](std::size_t k, std::size_t first, std::size_t last) {
    m_bad[k] = m_loops.stresses(m_rows, first, last, m_constitution.kernel().constants, s);
  });
  for (const Index a : m_bad) {
    if (a >= 0) throw particle::BadState{"det F", a};
  }
  m_points.reflect_records(m_records.data(), executor);
  for_ranges(m_body.n, executor, [&](std::size_t, std::size_t first, std::size_t last) {
    m_loops.forces(m_rows, first, last, m_viscosity, s);
  });
}

void TotalLagrangianSph::update_gradients(const State& s, const Executor& executor) {
  for_ranges(m_body.n, executor, [&](std::size_t, std::size_t first, std::size_t last) {
    m_loops.gradients(m_rows, first, last, s);
  });
  m_points.reflect_records(m_records.data(), executor);
}

/// H_a as the records hold it, without out-of-plane part.
Mat3 TotalLagrangianSph::plane_gradient(Index a) const {
  const int dim = m_body.dim, S = m_body.stride;
  const double* record = &m_records[static_cast<std::size_t>(a) * 2 * dim * S];
  Mat3 H = Mat3::Zero();
  for (int j = 0; j < dim; ++j) {
    for (int i = 0; i < dim; ++i) H(i, j) = record[(2 * j + 1) * S + i];
  }
  return H;
}

void TotalLagrangianSph::gradients(std::span<const double> u, std::span<Mat3> H) {
  const Executor one_thread(1);
  update_gradients(state(u, {}, {}, one_thread), one_thread);
  for (Index a = 0; a < m_body.n; ++a) H[a] = m_constitution.complete(plane_gradient(a));
}

/// l_ab (TLS.8) from the gradients in the records.
Vec3 TotalLagrangianSph::local_displacement(const double* u, Index a, Index b) const {
  Vec3 u_ab = Vec3::Zero();
  for (int i = 0; i < m_body.dim; ++i) {
    u_ab[i] = u[static_cast<std::size_t>(b) * m_body.stride + i] -
              u[static_cast<std::size_t>(a) * m_body.stride + i];
  }
  return u_ab - 0.5 * (plane_gradient(a) + plane_gradient(b)) *
                    (m_points.position(b) - m_points.position(a));
}

particle::Energies TotalLagrangianSph::energies(std::span<const double> u,
                                                const Executor& executor) {
  const State s = state(u, {}, {}, executor);
  update_gradients(s, executor);
  particle::Energies e;
  add_internal_energy(e, executor, [&](Index a) { return plane_gradient(a); });
  if (penalty() == PenaltyForm::potential) e.stabilisation = penalty_energy(s.u, executor);
  return e;
}

/// sum over pairs of 1/2 k_ab |l_ab|^2, k_ab = V_a kappa_ab (TLS.11); each pair stands in two
/// rows, as do a pair with an image and its reflection. A particle and its own image stand in
/// one: theirs is half a pair (TLS.16).
double TotalLagrangianSph::penalty_energy(const double* u, const Executor& executor) const {
  return executor.sum(m_body.n, [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (auto a = static_cast<Index>(first); a < static_cast<Index>(last); ++a) {
      for (std::size_t k = m_rows.begin[a]; k < m_rows.begin[a + 1]; ++k) {
        sum += 0.25 * m_body.V[a] * m_rows.stiffness[k] *
               local_displacement(u, a, m_rows.other[k]).squaredNorm();
      }
    }
    return sum;
  });
}

double TotalLagrangianSph::viscous_damping_ratio(double omega_max) const {
  if (!viscous()) return 0;
  double largest = 0;
  for (Index a = 0; a < m_body.n; ++a) {
    double sum = 0;
    for (std::size_t k = m_rows.begin[a]; k < m_rows.begin[a + 1]; ++k) sum += m_rows.weight[k];
    largest = std::max(largest, sum);
  }
  return m_viscosity.linear / m_rho0 * largest / omega_max;  // (TLS.13)
}

}  // namespace concord::sph
