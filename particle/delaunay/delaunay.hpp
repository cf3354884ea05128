#pragma once
// The Delaunay particle method: nearest-neighbour gradient vectors, contact stabilisation,
// artificial viscosity.

#include "particle/core/elastic.hpp"
#include "particle/core/force_model.hpp"
#include "particle/core/sweeps.hpp"
#include "particle/core/tangent.hpp"
#include "particle/core/viscosity.hpp"
#include "particle/delaunay/kernels.hpp"

#include <optional>

namespace concord::particle::delaunay {

/// Dimensionless parameters of Eqs. (60) and (61).
struct Parameters {
  double xi_n = 1;  ///< K_n = xi_n E A_ab / L_ab
  double xi_t = 1;  ///< K_t = xi_t G A_ab / L_ab
  double c1 = 0;    ///< linear artificial viscosity
  double c2 = 0;    ///< quadratic artificial viscosity
};

/// Forces (46), (50) of the Delaunay method in the pair form of its README, on state u
/// (displacement). The force on a particle is the same to the bit whatever parts, threads or
/// windows it is computed with.
class DelaunayModel final : public ForceModel {
 public:
  DelaunayModel(const Body& body, const scene::Problem& problem, const Parameters& parameters,
                const Executor& executor = Executor(1));
  ~DelaunayModel() override;

  void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor& executor) override;
  bool has_parts() const override { return true; }
  void forces_of(std::span<const ParticleRange> parts, std::span<const double> u,
                 std::span<const double> v, std::span<double> f,
                 const Executor& executor) override;
  ParticleRange reach(ParticleRange part) const override;
  Energies energies(std::span<const double> u, const Executor& executor) override;
  void gradients(std::span<const double> u, std::span<Mat3> H) override;
  const Stiffness& tangent(std::span<const double> u) override;
  bool viscous() const override { return m_viscosity.has_value(); }
  double viscous_damping_ratio(double omega_max) const override;
  std::size_t interactions() const override { return m_bonds.count(); }

  const Bonds& bonds() const { return m_bonds; }

 private:
  class Space;
  template <int Dim> class Sweep;
  template <int Dim>
  void forces_in(std::span<const ParticleRange> parts, const double* u, const double* v,
                 double* f, const Executor& executor);
  template <int Dim> double contact_energies(const double* u, Window<Dim> H, Index a) const;
  template <int Dim, class Use>
  void visit_gradients(const double* u, const Executor& executor, const Use& use);
  PairTangent contact_tangent(Index a, Index k, std::span<const double> u,
                              std::span<const Mat3> H) const;
  void provide_spaces(const Executor& executor);
  Overlap overlap() const;

  bool m_contact = false;
  ContactFactors m_factors{0, 0};
  Bonds m_bonds;
  Reach m_reach;
  std::vector<double> m_inverse_V;
  std::optional<Viscosity> m_viscosity;  ///< (61), (62)
  Spaces<Space> m_spaces;
  std::optional<TangentAssembly> m_tangent;  ///< made when the first tangent is asked for
};

}  // namespace concord::particle::delaunay
