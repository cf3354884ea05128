#pragma once
// Ghosts: mirror images of boundary particles behind the walls, whose current places follow
// from prescribed displacements and, where free, from least squares (Sec. 2.4 of the paper),
// here with the exact constrained minimiser.

#include "particle/core/body.hpp"
#include "particle/voronoi/boundary_pieces.hpp"

#include <vector>

namespace concord::particle::voronoi {

/// One ghost g of a particle a: its wall piece as the formulas see it.
struct Ghost {
  Vec3 X = Vec3::Zero();      ///< X_ag = 2 (W_ag - X_a) [m]
  Vec3 N = Vec3::Zero();      ///< outward unit normal
  Vec3 t = Vec3::Zero();      ///< t_ag = C_ag - W_ag, zero where they count as one point [m]
  double A = 0;               ///< A_ag [m^2]
  Mat3 D = Mat3::Zero();      ///< D_ag (14)
  Mat3 free = Mat3::Zero();   ///< I - D_ag; in the plane without the third direction
  Index centroid_point = -1;  ///< point of the body with u(C_ag); -1 where D = 0
  Index wall_point = -1;      ///< point of the body with u(W_ag)
  bool mirror = false;        ///< may be a true mirror image
  Index piece = -1;           ///< index into Boundary::pieces
  double length() const { return X.norm(); }
  Vec3 gradient_vector() const { return A / length() * (0.5 * X + t); }  ///< B_ag (7)
};

/// A neighbour that is a particle: t_ab = C_ab - (X_a + X_b)/2 is the same seen from a and b.
struct Neighbour {
  Index b = -1;
  Vec3 X = Vec3::Zero();                                                 ///< X_ab [m]
  Vec3 t = Vec3::Zero();                                                 ///< t_ab [m]
  double A = 0;                                                          ///< A_ab [m^2]
  Vec3 gradient_vector() const { return A / X.norm() * (0.5 * X + t); }  ///< B_ab (7)
};

/// A cell as its particle sees it, neighbours in ascending order.
struct Star {
  Index a = -1;
  double V = 0;
  std::vector<Neighbour> neighbours;
  std::vector<Ghost> ghosts;
};

/// Stars of all particles, on demand.
class Stars {
 public:
  /// Keeps references to its arguments.
  Stars(const Body& body, const Cells& cells, const Boundary& boundary);
  Star operator()(Index a) const;
  bool at_wall(Index a) const { return m_begin_wall[a] < m_begin_wall[a + 1]; }
  Index particles() const { return static_cast<Index>(m_cells.V.size()); }
  const Body& body() const { return m_body; }

 private:
  const Body& m_body;
  const Cells& m_cells;
  const Boundary& m_boundary;
  std::vector<Index> m_begin, m_face;  ///< interior faces of each particle
  std::vector<Index> m_begin_wall;     ///< pieces of each particle, in Boundary::pieces
};

/// t_ab of an interior face; zero below 1e-12 L_ab, which is round-off of the cells.
Vec3 offset_of(const Face& face, const Vec3& X_a, const Vec3& X_b);

/// Least over greatest eigenvalue of A from which ghosts count as determined. Measured, worst
/// particle of cubes, L-blocks and plates of two layers and more, free all round: from .21
/// perturbed by 1 %, from .064 by 25 %; by 45 % some in a hundred are below 1e-2. Plates of one
/// layer, whose neighbours hardly say how it turns: at most 2.5e-3 up to 10 %; at 25 % above
/// 1e-2 in 2 of 200 arrangements (1.2e-2).
inline constexpr double least_condition = 1e-2;

/// Where the ghosts of one particle are: with u_ac = u_c - u_a and w_h = u(W_h) - u_a
///   u_ag = sum_c T_gc u_ac + sum_h R_gh w_h                                        (VOR.6)
struct GhostSystem {
  std::vector<Mat3> T;   ///< ghosts x neighbours
  std::vector<Mat3> R;   ///< ghosts x ghosts; R_gh = 2 S_gh D_h
  double condition = 1;  ///< least over greatest eigenvalue of A
  bool determined() const { return condition >= least_condition; }
  std::vector<bool> mirrored;  ///< of each ghost: a true mirror image
};

/// Minimises sum_c |x_ac - F_a X_ac|^2 (15) over the free components of the ghosts. Ghosts
/// behind parallel planes of symmetry or antisymmetry on both sides of the particle are true
/// mirror images, which have no free component. Where the rest is undetermined, ghosts behind
/// the plane that takes the largest part in the undetermined motion become mirror images too,
/// plane after plane; where that does not help, the system is not determined and T and R are
/// empty.
GhostSystem solve_ghosts(const Star& star);

/// The ghost systems of all particles at walls, ascending.
struct GhostSystems {
  std::vector<Index> particle;
  std::vector<GhostSystem> system;
  std::vector<Index> row;  ///< of each particle, or -1
};

/// Throws InputError at `where` for the first particle whose ghosts are undetermined.
GhostSystems solve_all_ghosts(const Stars& stars, const SourcePosition& where,
                              const Executor& executor);

}  // namespace concord::particle::voronoi
