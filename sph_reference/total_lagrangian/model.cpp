#include "sph_reference/total_lagrangian/model.hpp"

#include "particle/core/features.hpp"

#include <algorithm>
#include <array>

namespace concord::sph {
namespace {

namespace features = particle::features;

Viscosity viscosity(const TlsphOptions& options, const scene::Material& material, double h) {
  return {options.alpha * material.rho0 * material.longitudinal_wave_speed() * h,
          options.beta * material.rho0 * h * h, 0.01 * h * h};
}

/// 1 for no sizes.
double largest(const std::vector<double>& sizes) {
  return sizes.empty() ? 1 : *std::max_element(sizes.begin(), sizes.end());
}

}  // namespace

TotalLagrangianSph::TotalLagrangianSph(const Body& body, const scene::Problem& problem,
                                       const TlsphOptions& options, const Executor& executor)
    : ForceModel(body, problem), m_options(options),
      m_kernel(options.kernel, body.dim, options.support * body.h),
      m_rho0(problem.material.rho0),
      m_sizes(options.local ? local_sizes(body) : std::vector<double>()),
      m_viscosity(viscosity(options, problem.material, m_kernel.smoothing_length())),
      m_points(body, options.planes, m_kernel.radius() * largest(m_sizes)),
      m_rows(find_neighbours(m_points, body.V, m_kernel, options.psi * problem.material.E,
                             executor, m_sizes)),
      m_loops(choose_loops(body.dim, m_constitution.kernel().law, penalty(), viscous())),
      m_state(m_points.make_points()), m_H(make_tensors()), m_T(make_tensors()),
      m_v(viscous() ? m_points.make_column() : Column()), m_bad(m_rows.blocks.size() - 1, -1) {
  for (std::size_t k = 0; k < m_bad.size(); ++k)
    m_near.push_back(blocks_over({m_rows.lowest[k], m_rows.highest[k] + 1}));
}

Column TotalLagrangianSph::make_tensors() const {
  return Column(static_cast<std::size_t>(m_points.count()) * m_body.dim * m_body.stride, 0.0);
}

TotalLagrangianSph::BlockSet TotalLagrangianSph::all_blocks() const {
  return blocks_over({0, m_body.n});
}

TotalLagrangianSph::BlockSet
TotalLagrangianSph::blocks_over(particle::ParticleRange range) const {
  BlockSet set;
  for (std::size_t k = 0; k + 1 < m_rows.blocks.size(); ++k)
    set[k] = m_rows.blocks[k] < range.last && m_rows.blocks[k + 1] > range.first;
  return set;
}

TotalLagrangianSph::BlockSet TotalLagrangianSph::neighbours_of(const BlockSet& blocks) const {
  BlockSet near;
  for (std::size_t k = 0; k < m_near.size(); ++k) {
    if (blocks[k]) near |= m_near[k];
  }
  return near;
}

/// Forces read T and H of neighbours; a potential penalty's Q in T reads H of neighbours again;
/// H reads u of neighbours.
TotalLagrangianSph::Needs TotalLagrangianSph::needs_of(const BlockSet& blocks) const {
  Needs needs;
  needs.T = neighbours_of(blocks);
  needs.H = penalty() == PenaltyForm::potential ? neighbours_of(needs.T) : needs.T;
  needs.u = neighbours_of(needs.H);
  return needs;
}

particle::ParticleRange TotalLagrangianSph::reach(particle::ParticleRange part) const {
  const BlockSet u = needs_of(blocks_over(part)).u;
  std::size_t first = 0, last = m_near.size();
  while (first + 1 < last && !u[first]) ++first;
  while (first + 1 < last && !u[last - 1]) --last;
  return {m_rows.blocks[first], m_rows.blocks[last]};
}

/// loop(block, first, last) over `blocks`.
template <class Loop>
void TotalLagrangianSph::for_blocks(const BlockSet& blocks, const Executor& executor,
                                    const Loop& loop) const {
  std::array<std::size_t, max_blocks> list{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < m_near.size(); ++k) {
    if (blocks[k]) list[count++] = k;
  }
  executor.for_each(count, [&](std::size_t i) {
    loop(list[i], static_cast<std::size_t>(m_rows.blocks[list[i]]),
         static_cast<std::size_t>(m_rows.blocks[list[i] + 1]));
  });
}

State TotalLagrangianSph::state(const BlockSet& blocks, std::span<const double> u,
                                std::span<const double> v, std::span<double> f,
                                const Executor& executor) {
  for_blocks(blocks, executor, [&](std::size_t, std::size_t first, std::size_t last) {
    m_points.set_displacements(u, static_cast<Index>(first), static_cast<Index>(last), m_state);
  });
  m_points.set_image_displacements(u, m_state, executor);
  const double* all_v = features::viscosity && viscous() && !v.empty()
                            ? m_points.extend(v, m_v, executor)
                            : v.data();
  return {m_state.data(), all_v, m_body.V.data(), m_H.data(), m_T.data(), f.data()};
}

void TotalLagrangianSph::evaluate(const BlockSet& blocks, const Needs& needs, const State& s,
                                  const Executor& executor) {
  if (features::penalty && penalty() == PenaltyForm::potential)
    update_gradients(needs.H, s, executor);
  for_blocks(needs.T, executor, [&](std::size_t k, std::size_t first, std::size_t last) {
    m_bad[k] = m_loops.stresses(m_rows, first, last, m_constitution.kernel().constants, s);
  });
  for (std::size_t k = 0; k < m_bad.size(); ++k) {
    if (needs.T[k] && m_bad[k] >= 0) throw particle::BadState{"det F", m_bad[k]};
  }
  m_points.reflect_tensors(m_T, executor);
  if (features::penalty && penalty() == PenaltyForm::ganzenmueller)
    m_points.reflect_tensors(m_H, executor);
  for_blocks(blocks, executor, [&](std::size_t, std::size_t first, std::size_t last) {
    m_loops.forces(m_rows, first, last, m_viscosity, s);
  });
}

void TotalLagrangianSph::forces(std::span<const double> u, std::span<const double> v,
                                std::span<double> f, const Executor& executor) {
  const BlockSet all = all_blocks();
  evaluate(all, {all, all, all}, state(all, u, v, f, executor), executor);
}

void TotalLagrangianSph::forces_of(std::span<const particle::ParticleRange> parts,
                                   std::span<const double> u, std::span<const double> v,
                                   std::span<double> f, const Executor& executor) {
  if (m_partial.empty()) m_partial.assign(f.size(), 0.0);
  BlockSet blocks;
  for (const particle::ParticleRange& part : parts) blocks |= blocks_over(part);
  const Needs needs = needs_of(blocks);
  evaluate(blocks, needs, state(needs.u, u, v, m_partial, executor), executor);
  for (const particle::ParticleRange& part : parts) {
    const auto first = static_cast<std::ptrdiff_t>(part.first) * m_body.stride;
    const auto last = static_cast<std::ptrdiff_t>(part.last) * m_body.stride;
    std::copy(m_partial.begin() + first, m_partial.begin() + last, f.begin() + first);
  }
}

void TotalLagrangianSph::update_gradients(const BlockSet& blocks, const State& s,
                                          const Executor& executor) {
  for_blocks(blocks, executor, [&](std::size_t, std::size_t first, std::size_t last) {
    m_loops.gradients(m_rows, first, last, s);
  });
  m_points.reflect_tensors(m_H, executor);
}

/// H_a without out-of-plane part.
Mat3 TotalLagrangianSph::plane_gradient(Index a) const {
  return particle::tensor_at(m_H, m_body.dim, a);
}

void TotalLagrangianSph::gradients(std::span<const double> u, std::span<Mat3> H) {
  const Executor one_thread(1);
  update_gradients(all_blocks(), state(all_blocks(), u, {}, {}, one_thread), one_thread);
  for (Index a = 0; a < m_body.n; ++a) H[a] = m_constitution.complete(plane_gradient(a));
}

/// l_ab (TLS.8) from the gradients last computed.
Vec3 TotalLagrangianSph::local_displacement(Index a, Index b) const {
  Vec3 u_ab = Vec3::Zero();
  const std::size_t stride = m_body.stride;
  for (int i = 0; i < m_body.dim; ++i)
    u_ab[i] = m_state[(2 * b + 1) * stride + i] - m_state[(2 * a + 1) * stride + i];
  return u_ab - 0.5 * (plane_gradient(a) + plane_gradient(b)) *
                    (m_points.position(b) - m_points.position(a));
}

particle::Energies TotalLagrangianSph::energies(std::span<const double> u,
                                                const Executor& executor) {
  update_gradients(all_blocks(), state(all_blocks(), u, {}, {}, executor), executor);
  particle::Energies e;
  add_internal_energy(e, executor, [&](Index a) { return plane_gradient(a); });
  if (penalty() == PenaltyForm::potential) e.stabilisation = penalty_energy(executor);
  return e;
}

/// sum over pairs of 1/2 k_ab |l_ab|^2 (TLS.11). A pair of two blocks stands in two rows, as do
/// a pair with an image and its reflection. A particle and its own image stand in one: theirs
/// is half a pair (TLS.16).
double TotalLagrangianSph::penalty_energy(const Executor& executor) const {
  return executor.sum(m_body.n, [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (auto a = static_cast<Index>(first); a < static_cast<Index>(last); ++a) {
      for (std::size_t k = m_rows.begin[a]; k < m_rows.begin[a + 1]; ++k) {
        sum += (k < m_rows.cut[a] ? 0.5 : 0.25) * m_rows.stiffness[k] *
               local_displacement(a, m_rows.other[k]).squaredNorm();
      }
    }
    return sum;
  });
}

double TotalLagrangianSph::viscous_damping_ratio(double omega_max) const {
  return viscous() ? damping_ratio(m_viscosity.linear, omega_max) : 0;
}

double TotalLagrangianSph::damping_ratio(double linear, double omega_max) const {
  std::vector<double> sums(m_body.n, 0.0);  // sum_b c_ab
  for (Index a = 0; a < m_body.n; ++a) {
    for (std::size_t k = m_rows.begin[a]; k < m_rows.begin[a + 1]; ++k) {
      sums[a] += m_rows.weight[k];
      if (k < m_rows.cut[a]) sums[m_rows.other[k]] += m_rows.weight[k];
    }
  }
  double largest = 0;
  for (Index a = 0; a < m_body.n; ++a) largest = std::max(largest, sums[a] / m_body.V[a]);
  return linear / m_rho0 * largest / omega_max;  // (TLS.13)
}

Neighbours& TotalLagrangianSph::change_neighbours() {
  m_tangent.reset();
  return m_rows;
}

void TotalLagrangianSph::add_up(ForceLoop loop, const Viscosity& eta, std::span<const double> v,
                                std::span<double> f, const Executor& executor) {
  const State s{m_state.data(), v.data(), m_body.V.data(), m_H.data(), m_T.data(), f.data()};
  for_blocks(all_blocks(), executor, [&](std::size_t, std::size_t first, std::size_t last) {
    loop(m_rows, first, last, eta, s);
  });
}

}  // namespace concord::sph
