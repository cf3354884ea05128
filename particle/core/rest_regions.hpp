#pragma once
// Regions of a body that no wave has reached yet: exactly at rest, so that their forces are
// known to be zero.

#include "particle/core/boundary.hpp"
#include "particle/core/force_model.hpp"

#include <span>
#include <vector>

namespace concord::particle {

/// Which particles an explicit integrator must work on. A block of particles counts as moved
/// from the first time that any bit of their displacements or velocities is set (so -0 is not
/// rest), for good. A block whose forces reach no block that has moved, and on which neither
/// loads nor prescribed motion act, has f = +0 and stays where it is: leaving it out changes no
/// bit of the rest. Needs a model that computes parts.
class RestRegions {
 public:
  RestRegions(const ForceModel& model, const Constraints& constraints,
              const ExternalLoads& loads, std::span<const double> u, std::span<const double> v);

  /// The particles to work on: ranges, ascending and apart.
  const std::vector<ParticleRange>& awake() const { return m_awake; }
  /// Whether these are all; then there is no more use for this object.
  bool all_awake() const { return m_all; }
  /// To be called after u and v have changed. Looks at the particles that are worked on but
  /// have not moved yet: those at the front of a wave.
  void look(std::span<const double> u, std::span<const double> v);

 private:
  static constexpr Index block = 256;  ///< particles; 8 kB of a column in 3D
  Index blocks() const { return static_cast<Index>(m_reach.size()); }
  bool at_rest(Index k, std::span<const double> u, std::span<const double> v) const;
  void update();

  Index m_n, m_stride;
  std::vector<ParticleRange> m_reach;  ///< in blocks, of each block's forces
  std::vector<char> m_acted;           ///< loads or prescribed motion act on the block
  std::vector<char> m_moved;
  std::vector<Index> m_watched;  ///< blocks worked on that have not moved
  std::vector<ParticleRange> m_awake;
  bool m_all = false;
};

}  // namespace concord::particle
