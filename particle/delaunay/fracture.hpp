#pragma once
// Bonds that break, in the plane and in 3D: deletion by (CBM.20), (CBM.32), (CBM.9), (CBM.1);
// artificial damping (CBM.21)-(CBM.23). (CBM.n) are equations of the Continuum Bond Method
// paper.

#include "particle/core/force_model.hpp"
#include "particle/core/tangent.hpp"
#include "particle/delaunay/fracture_sweep.hpp"

#include <optional>

namespace concord::particle::delaunay {

/// Dimensionless parameters.
struct FractureParameters {
  double beta = 0.5;          ///< damping control parameter of (CBM.21)
  double xi_n = 0, xi_t = 0;  ///< contact stiffness (60), as in Parameters
};

/// Forces on a network of bonds that can break. The loops run on one thread.
class FractureModel final : public ForceModel, public Fracturing {
 public:
  /// A problem with fracture.
  FractureModel(const Body& body, const scene::Problem& problem,
                const FractureParameters& parameters);

  void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor& executor) override;
  Energies energies(std::span<const double> u, const Executor& executor) override;
  void gradients(std::span<const double> u, std::span<Mat3> H) override;
  const Stiffness& tangent(std::span<const double> u) override;
  bool viscous() const override { return m_law.viscosity > 0; }
  double viscous_damping_ratio(double omega_max) const override;
  std::size_t interactions() const override { return m_network.bonds(); }
  Fracturing* fracturing() override { return this; }

  void advance(double t, double dt, std::span<const double> u, std::span<const double> v,
               std::span<double> f, const Executor& executor) override;
  std::span<const double> viscous_forces() const override { return m_kept_viscous; }
  const FractureRecord& record() const override { return m_record; }
  void intact_share(std::span<double> share) const override;
  void keep(scene::Checkpoint& state) override;

  const Network& network() const { return m_network; }

 private:
  /// A step: dt v led to u at time t.
  struct Step {
    double t, dt;
    std::span<const double> u, v;
  };
  void set_limits(const scene::Problem& problem);
  void cut(const scene::Fracture& fracture);
  void sweep(ParticleRange part, std::span<const double> u, std::span<const double> v,
             std::span<double> f, Column& viscous, std::vector<Index>* failed);
  std::vector<Index> break_bonds(const std::vector<Index>& bonds, const Step& step);
  std::vector<ParticleRange> influenced(const std::vector<Index>& particles) const;
  void unlimit(const std::vector<Index>& bonds);
  Mat3 gradient(Index particle, std::span<const double> column) const;
  Vec3 along(Index bond, std::span<const double> column) const;
  ContactLaw contact(Index bond, std::span<const double> u, const Mat3& H_a,
                     const Mat3& H_b) const;
  double held_energy(const std::vector<Index>& particles, const Step& step) const;
  double held_by_particle(Index particle, const Step& step) const;
  double held_by_contact(Index bond, const Step& step) const;

  double m_l;  ///< l_c [m]
  Network m_network;
  BreakingLaw m_law;
  std::unique_ptr<FractureSweep> m_sweep;
  std::vector<Index> m_failed;
  Column m_still;                    ///< velocities, where none are given
  Column m_viscous, m_kept_viscous;  ///< of the last forces() and the last advance() [N]
  FractureRecord m_record;
  std::optional<TangentAssembly> m_tangent;
};

}  // namespace concord::particle::delaunay
