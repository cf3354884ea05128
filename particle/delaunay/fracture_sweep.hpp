#pragma once
// One pass over the particles of a body whose bonds can break: gradients, viscous pressures and
// the check of the bonds run ahead of stresses, these ahead of forces, by what the rows of
// bonds reach, so that tensors stay in cache (see DelaunayModel).

#include "particle/core/elastic.hpp"
#include "particle/core/force_model.hpp"
#include "particle/delaunay/kernels.hpp"
#include "particle/delaunay/network.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace concord::particle::delaunay {

/// What the loops need beside the network.
struct BreakingLaw {
  KernelMaterial material;
  ContactFactors contact{0, 0};
  double viscosity = 0;    ///< beta l_c rho c_0 [Pa s]
  double softening = 0;    ///< .01 l_c^2 [m^2]
  bool by_energy = false;  ///< what a bond's limit is for: |x_ab|^2, or the work along it
  Column limit;            ///< of every bond; infinite where it cannot fail
};

class FractureSweep {
 public:
  /// References must outlive the object.
  static std::unique_ptr<FractureSweep> make(const Body& body, const Network& network,
                                             const BreakingLaw& law);
  virtual ~FractureSweep() = default;

  /// f and its viscous part on the particles of `part`; the same bits whatever the part is.
  /// Bonds that meet the criterion are appended to `failed`, each once if the part is the whole
  /// body; nullptr: not asked. Returns the first particle met with det F <= 0 or NaN, or -1.
  virtual Index forces(ParticleRange part, const double* u, const double* v, double* f,
                       double* viscous, std::vector<Index>* failed) = 0;

  /// use(a, H_a) for all particles, ascending.
  using Use = std::function<void(Index, const Mat3&)>;
  virtual void gradients(const double* u, const Use& use) = 0;

  /// The particles whose forces depend on the displacement gradient or the bonds of particle a.
  virtual ParticleRange influence(Index a) const = 0;
};

}  // namespace concord::particle::delaunay
