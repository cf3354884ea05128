#include "particle/core/reach.hpp"

#include <algorithm>
#include <bit>

namespace concord::particle {

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

std::vector<std::vector<ParticleRange>> deal(std::span<const ParticleRange> parts,
                                             int workers) {
  std::int64_t total = 0;
  for (const ParticleRange& part : parts) total += part.last - part.first;
  std::vector<std::vector<ParticleRange>> dealt(workers);
  std::int64_t before = 0;  // particles of earlier parts
  for (const ParticleRange& part : parts) {
    Index first = part.first;
    for (int w = 0; w < workers && first < part.last; ++w) {
      const std::int64_t end = total * (w + 1) / workers - before + part.first;
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
