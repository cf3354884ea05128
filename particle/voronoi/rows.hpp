#pragma once
// What the method computes from displacements, linear maps all of it, written out point by
// point.

#include "particle/voronoi/ghosts.hpp"
#include "particle/voronoi/voronoi.hpp"

namespace concord::particle::voronoi {

/// M numbers linear in displacements: sum_p block[p] u_p, points ascending. A tensor H counts
/// as nine, entry 3 i + J.
template <int M> struct Rows {
  using Block = Eigen::Matrix<double, M, 3>;
  std::vector<Index> point;
  std::vector<Block> block;

  void add(Index p, const Block& value) { point.push_back(p), block.push_back(value); }
  /// Sorts by point and adds up blocks of one point; drops those that are exactly zero.
  void compress();
};

/// d(M u (x) B)/du: entry (3 i + J, k) = M_ik B_J.
Rows<9>::Block outer(const Mat3& M, const Vec3& B);
/// d(H t)/du from dH/du.
Mat3 times(const Rows<9>::Block& H, const Vec3& t);

/// u_ag of ghost g (VOR.6).
Rows<3> ghost_rows(const Star& star, const GhostSystem& system, std::size_t g);
/// H^V_a = 1/V_a [ sum_b u_ab (x) B_ab + sum_g u_ag (x) B_ag ] (6), (26).
Rows<9> mean_gradient(const Star& star, const GhostSystem& system);
/// Its derivative as the paper's forces take it: prescribed parts of ghosts held (43).
Rows<9> mean_gradient_test(const Star& star, const GhostSystem& system);
/// Internal forces of the paper's forms are -V_a P_a times these: static (42), conserving (43),
/// both with the reaction D P A of prescribed faces.
Rows<9> paper_test(const Star& star, const GhostSystem& system, Form form);
/// Displacement of the centroid of wall face g, where it is free: (I - D) (u_a + u_ag/2 + H^V_a
/// t_ag) (VOR.13); `mean`: H^V_a.
Rows<3> face_displacement(const Star& star, const GhostSystem& system, std::size_t g,
                          const Rows<9>& mean);

/// Loads of all tractions.
std::vector<LoadTerm> load_terms(const Stars& stars, const GhostSystems& ghosts,
                                 const Boundary& boundary, Form form);

}  // namespace concord::particle::voronoi
