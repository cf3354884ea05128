#pragma once
// Total-Lagrangian SPH whose pairs break, by pseudo-springs: equations (TLS.18) to (TLS.22) in
// README.md of this folder; (20), (21), (32) are the Continuum Bond Method paper's.

#include "sph_reference/total_lagrangian/model.hpp"
#include "sph_reference/total_lagrangian/springs.hpp"

#include <map>

namespace concord::sph {

struct FractureOptions {
  TlsphOptions sph;  ///< without viscosity and planes
  SpringLayout springs = SpringLayout::edges;
  double beta = 0.5;  ///< damping control parameter of (21), (TLS.21)
};

/// The elastic model with weights that become zero. Loops over rows are the elastic model's;
/// what breaks is taken out on one thread.
class FracturingSph final : public particle::ForceModel, public particle::Fracturing {
 public:
  /// A problem with fracture. Throws InputError as TotalLagrangianSph.
  FracturingSph(const Body& body, const scene::Problem& problem, const FractureOptions& options,
                const Executor& executor);

  void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor& executor) override;
  particle::Energies energies(std::span<const double> u, const Executor& executor) override {
    return m_sph.energies(u, executor);
  }
  void gradients(std::span<const double> u, std::span<Mat3> H) override {
    m_sph.gradients(u, H);
  }
  const Stiffness& tangent(std::span<const double> u) override { return m_sph.tangent(u); }
  bool has_potential() const override { return m_sph.has_potential(); }
  bool viscous() const override { return m_damping.linear > 0; }
  double viscous_damping_ratio(double omega_max) const override {
    return viscous() ? m_sph.damping_ratio(m_damping.linear, omega_max) : 0;
  }
  std::size_t interactions() const override { return m_sph.interactions(); }
  particle::Fracturing* fracturing() override { return this; }

  void advance(double t, double dt, std::span<const double> u, std::span<const double> v,
               std::span<double> f, const Executor& executor) override;
  std::span<const double> viscous_forces() const override { return m_kept_viscous; }
  const particle::FractureRecord& record() const override { return m_record; }
  /// The share of the trace of V_a K_a that is left.
  void intact_share(std::span<double> share) const override;

  void keep(scene::Checkpoint& state) override;

  const Springs& springs() const { return m_springs; }
  const TotalLagrangianSph& elastic() const { return m_sph; }

 private:
  /// A step: dt v led to u at time t.
  struct Step {
    double t, dt;
    std::span<const double> u, v;
  };
  /// H_a, and its change in the step.
  struct Motion {
    Mat3 H, change;
  };
  void set_limits(const scene::Problem& problem);
  void cut(const std::vector<scene::PreCrack>& cracks);
  void add_forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
                  Column& viscous, const Executor& executor);
  std::vector<Index> failed(std::span<const double> u, const Executor& executor);
  void find_works(std::span<const double> u);
  void break_springs(std::vector<Index> springs, std::vector<Index> pairs, const Step& step);
  void mark_dead(std::span<const Index> springs, double t);
  std::vector<Index> rebuild(std::span<const Index> particles);
  Mat3 moment(Index a) const;
  Vec3 difference(std::span<const double> column, Index a, Index b) const;
  Motion motion(Index a, const Step& step) const;
  double held_energy(std::span<const Index> particles, const Step& step) const;
  double held_by_pair(const Springs::Pair& pair, const Motion& a, const Motion& b,
                      const Step& step) const;

  double m_l;        ///< l_c [m]
  bool m_by_energy;  ///< criterion
  TotalLagrangianSph m_sph;
  Springs m_springs;
  Viscosity m_damping;
  ForceLoop m_damping_loop;
  Column m_limit;                    ///< of a spring's measure; infinite where it is gone
  Column m_measure;                  ///< with the energy criterion
  std::vector<Mat3> m_H, m_P;        ///< likewise
  std::vector<double> m_whole;       ///< traces of V_a K_a at the start
  std::vector<char> m_dead;          ///< simplices
  Column m_viscous, m_kept_viscous;  ///< of the last forces() and the last advance() [N]
  particle::FractureRecord m_record;
};

}  // namespace concord::sph
