#include "particle/delaunay/sweep.hpp"

#include <algorithm>
#include <bit>

namespace concord::particle::delaunay {

Reach::Reach(const Bonds& bonds) : m_n(bonds.particles()) {
  const Index count = (m_n + chunk - 1) / chunk;
  m_top.assign(count, 0);
  m_bottom.assign(count, m_n);
  for (Index a = 0; a < m_n; ++a) {
    const Index c = a / chunk;
    m_top[c] = std::max(m_top[c], a + 1);
    m_bottom[c] = std::min(m_bottom[c], a);
    for (Index k = bonds.begin[a]; k < bonds.begin[a + 1]; ++k) {
      const Index b = bonds.other[k];
      m_top[c] = std::max(m_top[c], b + 1);
      m_bottom[b / chunk] = std::min(m_bottom[b / chunk], a);
    }
  }
  for (Index c = 1; c < count; ++c) m_top[c] = std::max(m_top[c], m_top[c - 1]);
  for (Index c = count - 2; c >= 0; --c) m_bottom[c] = std::min(m_bottom[c], m_bottom[c + 1]);
  // Forces of a chunk wait for stresses, and these for gradients, both up to a chunk further.
  Index most = 1;
  for (Index first = 0; first < m_n; first += chunk) {
    const auto ahead = [&](Index last) { return top(std::min(m_n, last + 2 * chunk)); };
    most = std::max(most, ahead(ahead(first)) - first);
  }
  m_window = std::bit_ceil(static_cast<std::size_t>(most));
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

}  // namespace concord::particle::delaunay
