#pragma once
// Total-Lagrangian SPH with corrected gradients, after Ganzenmueller (2015) and Eqs. (27), (28)
// of the Continuum Bond Method paper; equations (TLS.n) in README.md of this folder.

#include "particle/core/elastic.hpp"
#include "particle/core/force_model.hpp"
#include "particle/core/tangent.hpp"
#include "scene/material.hpp"
#include "sph_reference/total_lagrangian/loops.hpp"

#include <bitset>
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
  bool local = false;           ///< R_a follows the local spacing: local_sizes()
};

class TotalLagrangianSph final : public particle::ForceModel {
 public:
  /// Throws InputError (key tlsph.support) where the neighbours of a particle do not span the
  /// space.
  TotalLagrangianSph(const Body& body, const scene::Problem& problem,
                     const TlsphOptions& options, const Executor& executor);

  void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor& executor) override;
  bool has_parts() const override { return true; }
  /// Computes whole blocks and copies the parts: cut along blocks they cost least.
  void forces_of(std::span<const particle::ParticleRange> parts, std::span<const double> u,
                 std::span<const double> v, std::span<double> f,
                 const Executor& executor) override;
  particle::ParticleRange reach(particle::ParticleRange part) const override;
  particle::Energies energies(std::span<const double> u, const Executor& executor) override;
  void gradients(std::span<const double> u, std::span<Mat3> H) override;
  const Stiffness& tangent(std::span<const double> u) override;
  bool has_potential() const override { return penalty() != PenaltyForm::ganzenmueller; }
  bool viscous() const override { return m_options.alpha > 0 || m_options.beta > 0; }
  /// Bound on the damping ratio at omega_max by the linear term at alpha (TLS.13).
  double viscous_damping_ratio(double omega_max) const override;
  std::size_t interactions() const override { return m_rows.directed; }

  /// Bound on the damping ratio at omega_max by dashpots c_ab `linear` [Pa s] (TLS.13).
  double damping_ratio(double linear, double omega_max) const;

  const Neighbours& neighbours() const { return m_rows; }
  /// For models whose pairs break: weights, stiffnesses and inverse moments may be changed.
  Neighbours& change_neighbours();
  /// Sets f to the forces of `loop` at the displacements of the last evaluation and at v.
  /// Without images.
  void add_up(ForceLoop loop, const Viscosity& eta, std::span<const double> v,
              std::span<double> f, const Executor& executor);
  PenaltyForm penalty() const {
    return m_options.psi > 0 ? m_options.penalty : PenaltyForm::none;
  }
  const Kernel& kernel() const { return m_kernel; }
  const Points& points() const { return m_points; }

 private:
  Mat3 plane_gradient(Index a) const;
  /// Blocks of the neighbour lists, a bit each.
  using BlockSet = std::bitset<max_blocks>;
  BlockSet all_blocks() const;
  BlockSet blocks_over(particle::ParticleRange range) const;
  /// Blocks whose particles the rows of `blocks` read.
  BlockSet neighbours_of(const BlockSet& blocks) const;
  /// What the forces on `blocks` depend on: blocks of which u is read, H and T are needed.
  struct Needs {
    BlockSet u, H, T;
  };
  Needs needs_of(const BlockSet& blocks) const;
  /// State at u in `blocks` and at v, continued to the images.
  State state(const BlockSet& blocks, std::span<const double> u, std::span<const double> v,
              std::span<double> f, const Executor& executor);
  void evaluate(const BlockSet& blocks, const Needs& needs, const State& s,
                const Executor& executor);
  template <class Loop>
  void for_blocks(const BlockSet& blocks, const Executor& executor, const Loop& loop) const;
  Column make_tensors() const;
  /// H_a of `blocks` and of the images.
  void update_gradients(const BlockSet& blocks, const State& s, const Executor& executor);
  Vec3 local_displacement(Index a, Index b) const;
  double penalty_energy(const Executor& executor) const;

  TlsphOptions m_options;
  Kernel m_kernel;
  double m_rho0;
  std::vector<double> m_sizes;  ///< with options.local
  Viscosity m_viscosity;
  Points m_points;
  Neighbours m_rows;
  Loops m_loops;
  Column m_state;    ///< [X | u] of all points
  Column m_H, m_T;   ///< of all points, see State
  Column m_partial;  ///< forces of blocks of which parts are asked for; made when first needed
  Column m_v;        ///< of all points, with viscosity and images
  std::optional<particle::TangentAssembly> m_tangent;  ///< made when first asked for
  std::vector<BlockSet> m_near;                        ///< neighbours_of() each block
  std::vector<Index> m_bad;                            ///< first bad particle of each block
};

}  // namespace concord::sph
