#include "particle/core/reach.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace concord::particle {
namespace {

/// Where the workers' runs end, counted in particles from the first one.
std::vector<std::int64_t> ends_of_runs(std::int64_t total, int workers, Overlap overlap) {
  const double work =
      static_cast<double>(total) + (workers - 1) * (overlap.below + overlap.above);
  std::vector<std::int64_t> ends;
  double end = 0;
  for (int w = 0; w < workers; ++w) {
    const double beside = (w > 0 ? overlap.below : 0) + (w + 1 < workers ? overlap.above : 0);
    end += std::max(0.0, work / workers - beside);
    ends.push_back(std::min(total, static_cast<std::int64_t>(std::llround(end))));
  }
  ends.back() = total;
  return ends;
}

}  // namespace

Reach::Reach(std::span<const Index> begin, std::span<const Index> other)
    : m_n(static_cast<Index>(begin.size()) - 1) {
  const Index count = (m_n + chunk - 1) / chunk;
  m_top.assign(count, 0);
  m_bottom.assign(count, m_n);
  for (Index a = 0; a < m_n; ++a) {
    const Index c = a / chunk;
    m_top[c] = std::max(m_top[c], a + 1);
    m_bottom[c] = std::min(m_bottom[c], a);
    for (Index k = begin[a]; k < begin[a + 1]; ++k) {
      const Index b = other[k];
      m_top[c] = std::max(m_top[c], b + 1);
      m_bottom[b / chunk] = std::min(m_bottom[b / chunk], a);
    }
  }
  for (Index c = 1; c < count; ++c) m_top[c] = std::max(m_top[c], m_top[c - 1]);
  for (Index c = count - 2; c >= 0; --c) m_bottom[c] = std::min(m_bottom[c], m_bottom[c + 1]);
}

std::size_t Reach::window(int levels) const {
  Index most = 1;
  for (Index first = 0; first < m_n; first += chunk) {
    // Each loop waits for the one before it, up to a chunk further than it needs.
    Index last = first;
    for (int level = 0; level < levels; ++level) last = top(std::min(m_n, last + 2 * chunk));
    most = std::max(most, last - first);
  }
  return std::bit_ceil(static_cast<std::size_t>(most));
}

double Reach::mean() const {
  double sum = 0;
  for (std::size_t c = 0; c < m_top.size(); ++c)
    sum += m_top[c] - std::min(m_n, static_cast<Index>(c + 1) * chunk);
  return m_top.empty() ? 0 : sum / static_cast<double>(m_top.size());
}

std::vector<std::vector<ParticleRange>> deal(std::span<const ParticleRange> parts, int workers,
                                             Overlap overlap) {
  std::int64_t total = 0;
  for (const ParticleRange& part : parts) total += part.last - part.first;
  const std::vector<std::int64_t> ends = ends_of_runs(total, workers, overlap);
  std::vector<std::vector<ParticleRange>> dealt(workers);
  std::int64_t before = 0;  // particles of earlier parts
  for (const ParticleRange& part : parts) {
    Index first = part.first;
    for (int w = 0; w < workers && first < part.last; ++w) {
      const std::int64_t end = ends[w] - before + part.first;
      Index last = part.last;
      if (end < part.last) last = static_cast<Index>(end) / Reach::chunk * Reach::chunk;
      if (last <= first) continue;
      dealt[w].push_back({first, last});
      first = last;
    }
    before += part.last - part.first;
  }
  return dealt;
}

}  // namespace concord::particle
