#include "particle/core/rest_regions.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace concord::particle {
namespace {

/// Particles on which loads or prescribed motion act at some time.
std::vector<char> acted_on(const Body& body, const Constraints& constraints,
                           const ExternalLoads& loads) {
  std::vector<char> acted(body.n, 0);
  if (loads.any_constant()) {
    Column load(body.X.size(), 0.0);
    loads.add_constant(load);
    for (std::size_t k = 0; k < load.size(); ++k) {
      if (load[k] != 0) acted[k / body.stride] = 1;
    }
  }
  for (const Index a : loads.varying_particles()) acted[a] = 1;
  if (constraints.moving()) {
    for (const PrescribedDof& dof : constraints.dofs()) acted[dof.particle] = 1;
  }
  return acted;
}

bool all_bits_zero(std::span<const double> column) {
  return std::all_of(column.begin(), column.end(),
                     [](double x) { return std::bit_cast<std::uint64_t>(x) == 0; });
}

}  // namespace

RestRegions::RestRegions(const ForceModel& model, const Constraints& constraints,
                         const ExternalLoads& loads, std::span<const double> u,
                         std::span<const double> v)
    : m_n(model.body().n), m_stride(model.body().stride) {
  for (Index first = 0; first < m_n; first += block) {
    const ParticleRange reach = model.reach({first, std::min(m_n, first + block)});
    m_reach.push_back({reach.first / block, (reach.last + block - 1) / block});
  }
  m_acted.assign(m_reach.size(), 0);
  const std::vector<char> acted = acted_on(model.body(), constraints, loads);
  for (Index a = 0; a < m_n; ++a) m_acted[a / block] |= acted[a];
  for (Index k = 0; k < blocks(); ++k) m_moved.push_back(!at_rest(k, u, v));
  update();
}

bool RestRegions::at_rest(Index k, std::span<const double> u, std::span<const double> v) const {
  const auto first = static_cast<std::size_t>(k) * block * m_stride;
  const auto count = std::min<std::size_t>(static_cast<std::size_t>(block) * m_stride,
                                           static_cast<std::size_t>(m_n) * m_stride - first);
  return all_bits_zero(u.subspan(first, count)) && all_bits_zero(v.subspan(first, count));
}

void RestRegions::look(std::span<const double> u, std::span<const double> v) {
  bool changed = false;
  for (const Index k : m_watched) {
    if (at_rest(k, u, v)) continue;
    m_moved[k] = 1;
    changed = true;
  }
  if (changed) update();
}

void RestRegions::update() {
  std::vector<Index> moved_before(1, 0);
  for (const char moved : m_moved) moved_before.push_back(moved_before.back() + moved);
  m_watched.clear();
  m_awake.clear();
  for (Index k = 0; k < blocks(); ++k) {
    const bool reached = moved_before[m_reach[k].last] > moved_before[m_reach[k].first];
    if (!reached && !m_acted[k]) continue;
    if (!m_moved[k]) m_watched.push_back(k);
    const ParticleRange range{k * block, std::min(m_n, (k + 1) * block)};
    if (!m_awake.empty() && m_awake.back().last == range.first)
      m_awake.back().last = range.last;
    else
      m_awake.push_back(range);
  }
  m_all = m_awake.size() == 1 && m_awake[0] == ParticleRange{0, m_n};
}

}  // namespace concord::particle
