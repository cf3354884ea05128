#pragma once
// How far a sweep over the particles must run ahead: what the loops over a few rows of bonds
// reach, so that tensors live in windows that stay in cache.

#include "particle/core/force_model.hpp"

#include <span>
#include <vector>

namespace concord::particle {

/// Reach of rows of bonds in a body whose numbering sweeps through it. Each bond {a, b} stands
/// in the row of its lower-numbered particle.
class Reach {
 public:
  Reach() = default;
  /// Row a: other[begin[a]] to other[begin[a + 1] - 1], all above a.
  Reach(std::span<const Index> begin, std::span<const Index> other);

  /// Rows before `last` touch particles before top(last) only; last <= top(last) <= n.
  Index top(Index last) const { return last <= 0 ? 0 : m_top[(last - 1) / chunk]; }
  /// Particles from `first` on are touched by rows from bottom(first) on only.
  Index bottom(Index first) const {
    return first >= m_n ? m_n : std::min(first, m_bottom[first / chunk]);
  }
  /// Records that a sweep in steps of `chunk` keeps at a time for loops of which each waits for
  /// `levels` others further ahead, rounded up to a power of two.
  std::size_t window(int levels) const;

  /// Particles that a row reaches ahead, in the mean: a slab of the sweep.
  double mean() const;

  /// Rows that a loop does at a time.
  static constexpr Index chunk = 64;

 private:
  Index m_n = 0;
  std::vector<Index> m_top, m_bottom;  ///< per chunk
};

/// What a sweep over a part does beside the part, at the end below it and above it, in
/// particles' worth of work.
struct Overlap {
  double below = 0, above = 0;
};

/// The particles of `parts` dealt to `workers` in runs of about the same work, cut at whole
/// chunks: the first worker has nothing beside its run below, the last one nothing above.
std::vector<std::vector<ParticleRange>> deal(std::span<const ParticleRange> parts, int workers,
                                             Overlap overlap = {});

}  // namespace concord::particle
