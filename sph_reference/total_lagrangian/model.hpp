#pragma once
// Total-Lagrangian SPH with corrected gradients, after Ganzenmueller (2015) and Eqs. (27), (28)
// of the Continuum Bond Method paper; equations (TLS.n) in README.md of this folder.

#include "particle/core/elastic.hpp"
#include "particle/core/force_model.hpp"
#include "particle/core/tangent.hpp"
#include "scene/material.hpp"
#include "sph_reference/total_lagrangian/loops.hpp"

#include <optional>

namespace concord::sph {

struct TlsphOptions {
  KernelShape kernel = KernelShape::cubic_spline;
  double support = 3;  ///< R / h
  PenaltyForm penalty = PenaltyForm::ganzenmueller;
  double psi = 0.07;            ///< penalty factor; 0: no penalty, and no cost
  double alpha = 0;             ///< linear viscosity; 0: none
  double beta = 0;              ///< quadratic viscosity
  std::vector<Plane> planes{};  ///< with mirror particles behind them
};

class TotalLagrangianSph final : public particle::ForceModel {
 public:
  /// Throws InputError (key tlsph.support) where the neighbours of a particle do not span the
  /// space.
  TotalLagrangianSph(const Body& body, const scene::Problem& problem,
                     const TlsphOptions& options, const Executor& executor);

  void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor& executor) override;
  particle::Energies energies(std::span<const double> u, const Executor& executor) override;
  void gradients(std::span<const double> u, std::span<Mat3> H) override;
  const Stiffness& tangent(std::span<const double> u) override;
  bool has_potential() const override { return penalty() != PenaltyForm::ganzenmueller; }
  bool viscous() const override { return m_options.alpha > 0 || m_options.beta > 0; }
  /// Bound on the damping ratio at omega_max by the linear term at alpha (TLS.13).
  double viscous_damping_ratio(double omega_max) const override;
  std::size_t interactions() const override { return m_rows.directed; }

  const Neighbours& neighbours() const { return m_rows; }
  const Kernel& kernel() const { return m_kernel; }
  const Points& points() const { return m_points; }

 private:
  PenaltyForm penalty() const {
    return m_options.psi > 0 ? m_options.penalty : PenaltyForm::none;
  }
  Mat3 plane_gradient(Index a) const;
  /// State at u and v, continued to the images.
  State state(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor& executor);
  template <class Loop> void for_blocks(const Executor& executor, const Loop& loop) const;
  Column make_tensors() const;
  /// H_a of all points.
  void update_gradients(const State& s, const Executor& executor);
  Vec3 local_displacement(Index a, Index b) const;
  double penalty_energy(const Executor& executor) const;

  TlsphOptions m_options;
  Kernel m_kernel;
  double m_rho0;
  Viscosity m_viscosity;
  Points m_points;
  Neighbours m_rows;
  Loops m_loops;
  Column m_state;   ///< [X | u] of all points
  Column m_H, m_T;  ///< of all points, see State
  Column m_v;       ///< of all points, with viscosity and images
  std::optional<particle::TangentAssembly> m_tangent;  ///< made when first asked for
  std::vector<Index> m_bad;                            ///< first bad particle of each block
};

}  // namespace concord::sph
