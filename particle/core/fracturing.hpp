#pragma once
// What the integrator and the recorder need of a model whose bonds can break.

#include "particle/core/parallel.hpp"

#include <limits>
#include <span>
#include <vector>

namespace concord::particle {

/// A bond that the criterion broke.
struct BrokenBond {
  double t;  ///< [s]
  Index a, b;
};

/// A simplex of the body that is gone.
struct DeadSimplex {
  double t;  ///< [s]; before_start: a pre-crack took it
  Index simplex;
};
inline constexpr double before_start = -std::numeric_limits<double>::infinity();

/// What has broken so far, in the order of times.
struct FractureRecord {
  std::vector<BrokenBond> broken;
  std::vector<DeadSimplex> dead;
  double released = 0;  ///< energy that deletion took, with its effect on the step's kick [J]
  long flat = 0;        ///< of the dead: those that no bond took with it, too flat to be held
};

/// A bound of frequencies, and the particle it comes from.
struct FrequencyBound {
  double omega = 0;  ///< [rad/s]
  Index particle = -1;
};

/// A force model that can break is one of these too (ForceModel::fracturing).
class Fracturing {
 public:
  virtual ~Fracturing() = default;

  /// After the step dt v that led to u at time t (dt = 0: at the start): removes what meets the
  /// criterion at u, then gives the forces, as ForceModel::forces. Throws BadState.
  virtual void advance(double t, double dt, std::span<const double> u,
                       std::span<const double> v, std::span<double> f,
                       const Executor& executor) = 0;

  /// Takes back all that the last advance() removed, of a step that is undone.
  virtual void take_back() {}

  /// Above the frequencies about u of all modes that could rise by what has been removed since
  /// it was asked last; omega 0: of a model that does not tell.
  virtual FrequencyBound stiffened([[maybe_unused]] std::span<const double> u) { return {}; }

  /// The largest rate of damping about the present state [1/s], as the integrator has found it
  /// (SpectralRadius::damping_max): ForceModel::viscous_damping_ratio() goes by it from now on.
  virtual void set_damping([[maybe_unused]] double rate) {}

  /// The viscous part of the forces that the last advance() gave [N]; empty without viscosity.
  virtual std::span<const double> viscous_forces() const = 0;

  virtual const FractureRecord& record() const = 0;

  /// Averaging volume over the volume at the start, of every particle: 1 where nothing is
  /// missing, 0 for an isolated particle.
  virtual void intact_share(std::span<double> share) const = 0;
};

}  // namespace concord::particle
