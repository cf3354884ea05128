#pragma once
// Gradient vectors B_ab (27) of the Delaunay method, stored as the kernels read them: each bond
// once, in rows.

#include "particle/core/body.hpp"
#include "particle/core/tangent.hpp"

#include <vector>

namespace concord::particle::delaunay {

/// Doubles in a bond record: B_ab (dim), then A_ab / L_ab of Eq. (60) (0 without contact), then
/// zero.
inline constexpr int bond_record = 4;

/// Bonds of the particles of one block, by rows of the lower-numbered particle (inner bonds),
/// followed by bonds that leave the block (cut bonds: kept by both blocks, each adds to its own
/// particle only).
struct BondRows {
  std::vector<Index> begin;  ///< row of particle first + r: bonds [begin[r], begin[r+1])
  std::vector<Index> cut;    ///< of these, [cut[r], begin[r+1]) leave the block
  std::vector<Index> other;  ///< b of each bond
  Column B;                  ///< records of bond_record doubles: B_ab and A_ab / L_ab
  Column B_reverse;          ///< surface bonds only: records with B_ba, which is not -B_ab
};

struct BondBlock {
  Index first = 0, last = 0;  ///< particles [first, last)
  BondRows regular;           ///< bonds with B_ba = -B_ab (30)
  BondRows surface;           ///< bonds between two boundary particles
};

/// All bonds of the body: the edges of its triangulation, with thickness included in B (plane
/// problems) [m^2].
struct Bonds {
  std::vector<BondBlock> blocks;
  std::size_t count = 0;  ///< pairs
};

/// One undirected bond with both gradient vectors, before blocking.
struct Bond {
  Index a, b;  ///< a < b
  Vec3 B_ab, B_ba;
};

/// Edges of the triangulation with B_ab = sum_t |t| g_b / (n+1), sorted by (a, b). Equal to Eq.
/// (27).
std::vector<Bond> gradient_vectors(const Body& body);

/// Interface area A_ab of Eq. (60): 4 (|B_ab| + |B_ba|)/2 in 3D. The factor is n + 1: in the
/// plane the same estimate, a length, has 3.
double interface_area(int dim, const Bond& bond);

/// Blocks the bonds. area_over_length: A_ab / L_ab of each bond [m], or empty.
Bonds block_bonds(const Body& body, const std::vector<Bond>& bonds,
                  const std::vector<double>& area_over_length);

/// H_a = sum_b u_ab (x) B_ab / V_a as directed rows, for the tangent.
GradientRows directed_rows(const Body& body, const std::vector<Bond>& bonds);

}  // namespace concord::particle::delaunay
