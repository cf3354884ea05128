#pragma once
// Bonds that break, in the plane and in 3D: deletion by (CBM.20), (CBM.32), (CBM.9), (CBM.1);
// artificial damping (CBM.21)-(CBM.23). (CBM.n) are equations of the Continuum Bond Method
// paper.

#include "particle/core/force_model.hpp"
#include "particle/core/tangent.hpp"
#include "particle/delaunay/fracture_sweep.hpp"
#include "particle/delaunay/stiffening.hpp"

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
  void set_damping(double rate) override { m_damping = rate; }
  void take_back() override;
  FrequencyBound stiffened(std::span<const double> u) override;
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
  enum class At { begin, end };  ///< of a step
  /// What an advance() has removed, and the record before it.
  struct Removal {
    std::vector<Index> simplices, bonds;
    std::size_t broken = 0, dead = 0;
    double released = 0;
    long flat = 0;
  };
  void set_limits(const scene::Problem& problem);
  double limit_of(Index bond) const;
  void cut(const scene::Fracture& fracture);
  void sweep(ParticleRange part, std::span<const double> u, std::span<const double> v,
             std::span<double> f, Column& viscous, std::vector<Index>* failed);
  std::vector<Index> inside_out(Index first, const Step& step);
  std::vector<Index> going(const std::vector<Index>& bonds, const std::vector<Index>& inverted,
                           std::span<const double> u) const;
  bool too_flat(Index particle, const Stencil& sum, std::span<const double> u) const;
  std::vector<Index> break_bonds(const std::vector<Index>& bonds,
                                 const std::vector<Index>& inverted, const Step& step);
  void remove(const std::vector<Index>& bonds, const std::vector<Index>& simplices, double t);
  std::vector<ParticleRange> influenced(const std::vector<Index>& particles) const;
  void unlimit(const std::vector<Index>& bonds);
  Mat3 gradient(Index particle, std::span<const double> column) const;
  Vec3 along(Index bond, std::span<const double> column) const;
  ContactLaw contact(Index bond, const Vec3& u_ab, const Mat3& H_a, const Mat3& H_b) const;
  double held_energy(const std::vector<Index>& particles, const Step& step, At at) const;
  double held_by_particle(Index particle, const Step& step, At at) const;
  double held_by_contact(Index bond, const Step& step, At at) const;

  double m_l;            ///< l_c [m]
  double m_density;      ///< G_f/l_c [J/m^3]
  double m_critical;     ///< eps_crit
  double m_damping = 0;  ///< largest rate of damping [1/s]; 0: not known
  double m_flatness;     ///< of (DEL.8)
  Network m_network;
  BreakingLaw m_law;
  std::unique_ptr<FractureSweep> m_sweep;
  std::vector<Index> m_failed;
  Removal m_removal;                       ///< of the last advance()
  std::vector<Index> m_touched;            ///< by removals since stiffened() was asked last
  std::optional<Stiffening> m_stiffening;  ///< once it was asked
  Column m_still;                          ///< velocities, where none are given
  Column m_viscous, m_kept_viscous;        ///< of the last forces() and the last advance() [N]
  FractureRecord m_record;
  std::optional<TangentAssembly> m_tangent;
};

}  // namespace concord::particle::delaunay
