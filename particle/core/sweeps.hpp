#pragma once
// What every model that sweeps over its particles does around a sweep: parts for workers, the
// first bad particle of all of them, sums of energies.

#include "particle/core/constitution.hpp"
#include "particle/core/reach.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>

namespace concord::particle {

/// visit(first, last, whether they belong to `part`) for [first, last) in ascending pieces.
template <class Visit>
void by_ownership(ParticleRange part, Index first, Index last, const Visit& visit) {
  const Index own = std::clamp(part.first, first, last),
              beyond = std::clamp(part.last, own, last);
  if (first < own) visit(first, own, false);
  if (own < beyond) visit(own, beyond, true);
  if (beyond < last) visit(beyond, last, false);
}

/// One Space a worker, made when it is first needed.
template <class Space> class Spaces {
 public:
  /// make() gives a unique_ptr<Space>.
  template <class Make> void provide(int workers, const Make& make) {
    while (m_spaces.size() < static_cast<std::size_t>(workers)) m_spaces.push_back(make());
  }

  /// work(space, part) for ranges that make up `parts`, cut at whole chunks, on all of the
  /// executor's threads; as many spaces have been provided. `overlap`: of the work on a part.
  template <class Work>
  void for_parts(std::span<const ParticleRange> parts, const Executor& executor,
                 Overlap overlap, const Work& work) const {
    if (executor.threads() == 1) {
      for (const ParticleRange& part : parts) work(*m_spaces[0], part);
      return;
    }
    const auto dealt = deal(parts, executor.threads(), overlap);
    executor.for_each(dealt.size(), [&](std::size_t w) {
      for (const ParticleRange& part : dealt[w]) work(*m_spaces[w], part);
    });
  }

 private:
  std::vector<std::unique_ptr<Space>> m_spaces;
};

/// The lowest particle that any worker met with det F <= 0 or NaN.
class FirstBad {
 public:
  /// particle: -1 for none.
  void tell(Index particle) {
    Index known = m_first.load();
    while (particle >= 0 && particle < known && !m_first.compare_exchange_weak(known, particle))
      continue;
  }
  void check() const {
    if (m_first.load() != none) throw BadState{"det F", m_first};
  }

 private:
  static constexpr Index none = std::numeric_limits<Index>::max();
  std::atomic<Index> m_first{none};
};

/// Energies summed by chunks of particles and then over chunks, the same for any number of
/// threads.
class ChunkedEnergies {
 public:
  explicit ChunkedEnergies(Index particles) : m_chunks(particles / Reach::chunk + 1) {}

  /// V U(H_a) and V Psi_p of particle a, and its contact energy; one worker a chunk at a time.
  void add(Index a, double V, const Constitution::PointEnergy& point, double contact) {
    Energies& e = m_chunks[a / Reach::chunk];
    e.internal += V * point.stored;
    e.plastic += V * point.plastic;
    e.stabilisation += contact;
  }
  Energies total() const {
    Energies total;
    for (const Energies& e : m_chunks) {
      total.internal += e.internal;
      total.plastic += e.plastic;
      total.stabilisation += e.stabilisation;
    }
    return total;
  }

 private:
  std::vector<Energies> m_chunks;
};

}  // namespace concord::particle
