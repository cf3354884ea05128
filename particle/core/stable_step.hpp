#pragma once
// The critical time step of central differences, from the largest eigenvalue of M^-1 K.

#include "particle/core/boundary.hpp"
#include "particle/core/force_model.hpp"

#include <functional>

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

  /// Largest eigenvalue [1/s] of M^-1 C at displacement u, C = -df/dv at v = 0, found likewise:
  /// the damping of a mode with ratio zeta and frequency omega is 2 zeta omega. For models
  /// whose forces are linear in the velocity. C need only be nearly symmetric.
  double damping_max(std::span<const double> u, double tolerance = 2e-3, int most = 60);

 private:
  using Apply = std::function<void(const Column& w, Column& result)>;
  double largest_eigenvalue(std::size_t size, const Apply& apply, double tolerance, int most);
  Column start() const;  ///< the same random vector for every number of threads
  void apply_stiffness(std::span<const double> u, const Column& w, Column& result);
  void apply_damping(std::span<const double> u, const Column& w, Column& result);
  double largest_per_root(const Column& w) const;

  ForceModel& m_model;
  const Constraints& m_constraints;
  const Executor& m_executor;
  std::vector<double> m_root;  ///< sqrt(m_a)
  Column m_shifted, m_force, m_velocity;
};

}  // namespace concord::particle
