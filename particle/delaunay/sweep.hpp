#pragma once
// How far a sweep over the particles must run ahead: gradients before contact before forces, so
// that tensors live in a window that stays in cache.

#include "particle/core/force_model.hpp"
#include "particle/delaunay/bonds.hpp"

#include <span>
#include <vector>

namespace concord::particle::delaunay {

/// Reach of rows of bonds in a body whose numbering sweeps through it.
class Reach {
 public:
  Reach() = default;
  explicit Reach(const Bonds& bonds);

  /// Rows before `last` touch particles before top(last) only; last <= top(last) <= n.
  Index top(Index last) const { return last <= 0 ? 0 : m_top[(last - 1) / chunk]; }
  /// Particles from `first` on are touched by rows from bottom(first) on only.
  Index bottom(Index first) const {
    return first >= m_n ? m_n : std::min(first, m_bottom[first / chunk]);
  }
  /// Records that a sweep in steps of `chunk` keeps at a time, rounded up to a power of two.
  std::size_t window() const { return m_window; }

  /// Rows that a loop does at a time.
  static constexpr Index chunk = 64;

 private:
  Index m_n = 0;
  std::vector<Index> m_top, m_bottom;  ///< per chunk
  std::size_t m_window = 0;
};

/// The particles of `parts` dealt to `workers` in runs of about the same length, cut at whole
/// chunks.
std::vector<std::vector<ParticleRange>> deal(std::span<const ParticleRange> parts, int workers);

}  // namespace concord::particle::delaunay
