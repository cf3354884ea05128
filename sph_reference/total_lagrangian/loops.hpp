#pragma once
// The loops of one force evaluation, as functions chosen once for a dimension, a stress law and
// what is switched on.

#include "particle/core/stress_kernel.hpp"
#include "sph_reference/total_lagrangian/neighbours.hpp"

namespace concord::sph {

using particle::StressConstants;
using particle::StressLaw;

/// What the loops read and write. Vectors are columns of `stride` doubles a particle, tensors
/// `dim` of them; a point is [X | u], a cache line in 3D.
struct State {
  const double *points, *v;  ///< v: read with viscosity only
  const double* V;           ///< volumes, with thickness [m^3]
  double* H;                 ///< H_a
  double* T;                 ///< T_a = P_a K_a^-1
  double* f;
};

/// Monaghan's viscosity as the force loop wants it (TLS.12).
struct Viscosity {
  double linear = 0;     ///< alpha rho0 c_p h [Pa s]
  double quadratic = 0;  ///< beta rho0 h^2 [Pa s^2]
  double softening = 0;  ///< 0.01 h^2 [m^2]
};

enum class PenaltyForm {
  none,
  ganzenmueller,  ///< (28) of the Continuum Bond Method paper: along the current bond, no
                  ///< potential (TLS.10)
  potential       ///< 1/2 k_ab |l_ab|^2 a pair, with all its derivatives (TLS.11)
};

/// Instruction sets that the loops are compiled for. AVX-512: its 32 registers of four lanes.
enum class Isa { baseline, avx2, avx512 };
/// The widest one that this machine runs.
Isa best_isa();

/// Forces on one block of particles [first, last), from H and T of all particles.
using ForceLoop = void (*)(const Neighbours& rows, std::size_t first, std::size_t last,
                           const Viscosity& eta, const State& s);

/// Each function works on one block of particles [first, last) and writes to these alone.
struct Loops {
  /// H_a (TLS.5).
  void (*gradients)(const Neighbours& rows, std::size_t first, std::size_t last,
                    const State& s);
  /// H_a, P_a and T_a = P_a K_a^-1 (TLS.6), in groups of stress_width from `first`. With a
  /// potential penalty H_a of all particles must be there; Q_a/V_a is added to P_a, and f_a set
  /// to the penalty's direct force (TLS.11). Returns the first particle with det F <= 0 or NaN,
  /// or -1.
  Index (*stresses)(const Neighbours& rows, std::size_t first, std::size_t last,
                    const StressConstants& c, const State& s);
  /// f_a (TLS.7).
  ForceLoop forces;
};

Loops choose_loops(int dim, StressLaw law, PenaltyForm penalty, bool viscous,
                   Isa isa = best_isa());

/// The damping of pairs that can break, (TLS.21), by itself: `eta` has its linear coefficient,
/// 2 beta l_c rho0 c_0, and .01 l_c^2. Reads neither H nor T.
ForceLoop choose_damping(int dim, Isa isa = best_isa());

}  // namespace concord::sph
