#pragma once
// The Delaunay particle method: nearest-neighbour gradient vectors, contact stabilisation,
// artificial viscosity.

#include "particle/core/elastic.hpp"
#include "particle/core/force_model.hpp"
#include "particle/core/tangent.hpp"
#include "particle/delaunay/bonds.hpp"

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
/// (displacement).
class DelaunayModel final : public ForceModel {
 public:
  DelaunayModel(const Body& body, const scene::Problem& problem, const Parameters& parameters);

  void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor& executor) override;
  Energies energies(std::span<const double> u, const Executor& executor) override;
  void gradients(std::span<const double> u, std::span<Mat3> H) override;
  const Stiffness& tangent(std::span<const double> u) override;
  bool viscous() const override { return m_viscosity.has_value(); }
  double viscous_damping_ratio(double omega_max) const override;
  std::size_t interactions() const override { return m_bonds.count; }

  const Bonds& bonds() const { return m_bonds; }

 private:
  struct Viscosity {
    double linear;     ///< rho0 c1 c_p h [Pa s]
    double quadratic;  ///< rho0 c2 h^2 [Pa s^2]
  };
  template <int Dim>
  void forces_in(const double* u, const double* v, double* f, const Executor& executor);
  template <int Dim> void add_viscous_stress(const BondBlock& block, const double* v);
  void compute_gradients(std::span<const double> u, const Executor& executor);

  /// A pair as the contact law sees it, from m_H.
  struct Local {
    Vec3 X_ab, x_ab, u_loc;
    double K_n, K_t;
  };
  Local local_displacement(std::size_t pair, std::span<const double> u) const;
  double contact_energy(std::size_t pair, std::span<const double> u) const;
  PairTangent contact_tangent(std::size_t pair, std::span<const double> u) const;

  std::vector<Bond> m_pairs;        ///< unblocked, for energies and tangent
  std::vector<double> m_stiffness;  ///< A_ab / L_ab of each pair [m]; empty without contact
  double m_normal_factor = 0;       ///< xi_n E
  double m_tangential_factor = 0;   ///< xi_t G
  bool m_contact = false;
  Bonds m_bonds;
  std::optional<TangentAssembly> m_tangent;  ///< made when the first tangent is asked for
  std::optional<Viscosity> m_viscosity;
  std::vector<double> m_inverse_V;
  Column m_H, m_P, m_rate;
  std::vector<Index> m_bad;  ///< per block
};

}  // namespace concord::particle::delaunay
