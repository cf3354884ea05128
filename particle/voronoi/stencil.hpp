#pragma once
// Cells and ghosts as the loops read them: each bond once, in the row of its lower-numbered
// particle, and the boundary in lists of its own.

#include "particle/core/window.hpp"
#include "particle/voronoi/ghosts.hpp"

namespace concord::particle::voronoi {

/// All bonds. With S = A_ab/L_ab the area vector is S X_ab, B_ab = S/2 (X_ab + 2 t_ab) and B_ba
/// = S/2 (-X_ab + 2 t_ab); X_ab comes from the positions of the particles.
struct Bonds {
  std::vector<Index> begin;  ///< row of particle a: bonds [begin[a], begin[a+1])
  std::vector<Index> other;  ///< b > a of each bond, ascending in a row
  Column shape;              ///< four doubles a bond: 2 t_ab [m] and, in the last, S/2 [m]

  std::size_t count() const { return other.size(); }
  Index particles() const { return static_cast<Index>(begin.size()) - 1; }
};
/// Doubles in the shape of a bond, and where in it S/2 is.
inline constexpr std::size_t shape_size = 4, ratio_at = 3;

/// One ghost.
template <int Dim> struct GhostRecord {
  Tensor<Dim> D;        ///< projection onto the prescribed components
  Tensor<Dim> K;        ///< contact stiffness D (K_n N (x) N + K_t (I - N (x) N)) D [N/m]
  Vec<Dim> X, t, A, B;  ///< X_ag, t_ag [m], A_ag N, B_ag [m^2]
  Index centroid;       ///< boundary point at C_ag, -1 on free faces
  Index wall;           ///< boundary point at W_ag
  bool prescribed() const { return centroid >= 0; }
};

/// Ghosts of all particles, and what their places (VOR.6) depend on. The tensors T and R are
/// diagonal where D is, that is unless a plane of symmetry is oblique: then their diagonals are
/// stored alone.
template <int Dim> struct Ghosts {
  std::vector<Index> begin;  ///< ghosts of particle a: [begin[a], begin[a+1])
  std::vector<GhostRecord<Dim>, CacheAligned<GhostRecord<Dim>>> record;
  bool diagonal = true;

  /// What prescribed walls give: u_ag += R (u(W) - u_a).
  std::vector<Index> R_begin;  ///< of each ghost: [R_begin[g], R_begin[g+1])
  std::vector<Index> R_wall;   ///< boundary point at W
  Column R;

  /// What bonds of row a give: u_g += T u_ab, g one of a's or b's. Rows of particles with any;
  /// the last entry of `particle` is n.
  std::vector<Index> particle, T_begin;
  std::vector<Index> T_other, T_ghost;
  Column T;

  std::size_t count() const { return record.size(); }
};

Bonds make_bonds(const Body& body, const Cells& cells);

/// factors: K_n = normal A/L, K_t = tangential A/L.
template <int Dim>
Ghosts<Dim> make_ghosts(const Stars& stars, const GhostSystems& systems, double normal,
                        double tangential);

}  // namespace concord::particle::voronoi
