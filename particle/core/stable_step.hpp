#pragma once
// The critical time step of central differences, from the largest eigenvalue of M^-1 K.

#include "particle/core/boundary.hpp"
#include "particle/core/force_model.hpp"

namespace concord::particle {

/// Largest angular frequency of the free particles about the current displacement, by Lanczos
/// iteration on M^-1/2 K M^-1/2 (power iteration that keeps what it has seen). K w is taken as
/// the central difference of the forces along w, so it holds for every formulation and
/// deformation; the estimate approaches omega_max from below.
class SpectralRadius {
 public:
  SpectralRadius(ForceModel& model, const Constraints& constraints, const Executor& executor);

  /// omega_max [rad/s] at displacement u. Starts from a fixed random vector. Stops when the
  /// estimate rose by less than `tolerance` over the last five iterations, at most `most`
  /// iterations (two force evaluations each).
  double omega_max(std::span<const double> u, double tolerance = 2e-3, int most = 60);

 private:
  Column start() const;  ///< the same random vector for every number of threads
  void apply(std::span<const double> u, const Column& w, Column& result);

  ForceModel& m_model;
  const Constraints& m_constraints;
  const Executor& m_executor;
  std::vector<double> m_root;  ///< sqrt(m_a)
  Column m_shifted, m_force, m_velocity;
};

}  // namespace concord::particle
