#pragma once
// The Continuum Bond Method with bonds that break, in the plane: deletion by (20), (32), (9),
// (1); artificial damping (21)-(23). Numbers are equations of the paper.

#include "particle/cbm/kernels.hpp"
#include "particle/core/force_model.hpp"
#include "particle/core/tangent.hpp"

#include <optional>

namespace concord::particle::cbm {

/// Forces on a network of bonds that can break. The loops run on one thread.
class FractureModel final : public ForceModel, public Fracturing {
 public:
  /// A plane problem with fracture; `beta`: damping control parameter of (21).
  FractureModel(const Body& body, const scene::Problem& problem, double beta);

  void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor& executor) override;
  Energies energies(std::span<const double> u, const Executor& executor) override;
  void gradients(std::span<const double> u, std::span<Mat3> H) override;
  const Stiffness& tangent(std::span<const double> u) override;
  bool viscous() const override { return m_viscosity > 0; }
  double viscous_damping_ratio(double omega_max) const override;
  std::size_t interactions() const override { return m_network.bonds(); }
  Fracturing* fracturing() override { return this; }

  void advance(double t, double dt, std::span<const double> u, std::span<const double> v,
               std::span<double> f, const Executor& executor) override;
  std::span<const double> viscous_forces() const override { return m_kept_viscous; }
  const FractureRecord& record() const override { return m_record; }
  void intact_share(std::span<double> share) const override;

  const Network& network() const { return m_network; }

 private:
  /// A step: dt v led to u at time t.
  struct Step {
    double t, dt;
    std::span<const double> u, v;
  };
  void set_limits(const scene::Problem& problem);
  void cut(const std::vector<scene::PreCrack>& cracks);
  double evaluate(std::span<const double> u, std::span<const double> v);
  void stresses(Index first, Index last);
  void pair_forces(std::span<double> f, Column& viscous);
  std::vector<Index> failed() const;
  void break_bonds(const std::vector<Index>& bonds, const Step& step);
  void unlimit(const std::vector<Index>& bonds);
  Mat3 weighted_gradient(Index particle, std::span<const double> column) const;
  double held_energy(Index particle, const Step& step) const;

  double m_l;          ///< l_c [m]
  double m_viscosity;  ///< beta l_c rho c_0 [Pa s]
  bool m_by_energy;    ///< criterion
  Network m_network;
  Buffers m_buffers;
  Column m_limit;                    ///< of a bond's measure; infinite where it cannot fail
  Column m_viscous, m_kept_viscous;  ///< of the last forces() and the last advance() [N]
  FractureRecord m_record;
  std::optional<TangentAssembly> m_tangent;
};

}  // namespace concord::particle::cbm
