#pragma once
// The loops of one force evaluation on a network of bonds in the plane. Each bond is visited
// once, in the row of its lower-numbered particle, and adds to both ends. Numbers in
// parentheses are equations of the Continuum Bond Method paper.

#include "particle/cbm/network.hpp"
#include "particle/core/elastic.hpp"

namespace concord::particle::cbm {

/// What the loops work on, beside the network.
struct Buffers {
  Column gradient;  ///< Omega_i H_i, four doubles a particle, column by column
  Column stress;    ///< {P, J F^-T} column by column, eight doubles a particle
  Column force;     ///< elastic and viscous force, four doubles a particle [N]
  Column measures;  ///< of every bond: v_ip.x_ip, and what is compared with its limit
  Column pressure;  ///< pi_ip of every bond [Pa]
  Column squares;   ///< |X_ip|^2 of every bond [m^2]; with the energy criterion

  Buffers(Index particles, std::size_t bonds)
      : gradient(4 * static_cast<std::size_t>(particles), 0.0),
        stress(2 * gradient.size(), 0.0), force(gradient), measures(2 * bonds, 1.0),
        pressure(bonds, 0.0) {}
};

/// Omega_i H_i = sum_p u_ip (x) zeta_ip, which is (8) less the identity; the measures become
/// v_ip.x_ip and |x_ip|^2. 24 flops a bond.
void gradient_rows(const Network& network, Index n, const double* X, const double* u,
                   const double* v, Buffers& buffers);

/// pi_ip = -viscosity v_ip.x_ip / (|x_ip|^2 + softening) (21), with viscosity = beta l_c rho
/// c_0 [Pa s] and softening = .01 l_c^2. Returns the largest measure - limit of any bond; a
/// bond whose difference is not below 0 fails.
double pressures(std::size_t bonds, double viscosity, double softening, const double* limit,
                 Buffers& buffers);

/// P_i and J_i F_i^-T = cof F_i of [first, last); their forces become zero. Returns the first
/// particle with det F <= 0 or NaN, or -1.
Index stress_rows(const KernelMaterial& material, Index first, Index last,
                  const double* inverse_omega, Buffers& buffers);

/// The measures become the work of the stress along the bond, n.P N eps_ip/2 [J/m^3], with the
/// mean P of its ends, N and n its direction before and now, eps_ip its strain (20). Returns
/// the largest measure - limit.
double bond_works(const Network& network, Index n, const double* X, const double* u,
                  const double* limit, Buffers& buffers);

/// Force on i by p, -(18) - (23): P~_i zeta_ip - P~_p zeta_pi with P~ = P - pi_ip J F^-T. The
/// sign of pi is the one that takes energy; (23) with (19) as printed feeds it. Elastic and
/// viscous part apart. 40 flops a bond.
void force_rows(const Network& network, Index n, Buffers& buffers);

/// f = elastic + viscous part, and the viscous part by itself; two doubles a particle.
void split_forces(Index n, const Buffers& buffers, double* f, double* viscous);

}  // namespace concord::particle::cbm
