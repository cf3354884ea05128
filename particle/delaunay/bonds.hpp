#pragma once
// Gradient vectors B_ab (27) of the Delaunay method, stored as the loops read them: each bond
// once, in the row of its lower-numbered particle.

#include "particle/core/body.hpp"
#include "particle/core/parallel.hpp"
#include "particle/core/tangent.hpp"

#include <vector>

namespace concord::particle::delaunay {

/// One undirected bond with both gradient vectors.
struct Bond {
  Index a, b;  ///< a < b
  Vec3 B_ab, B_ba;
};

/// Bonds between boundary particles differ from B_ba = -B_ab (30) by their symmetric part, and
/// boundary particles have a B_aa: rows of these corrections.
struct SurfaceBonds {
  std::vector<Index> particle;  ///< boundary particles, ascending; the last entry is n
  std::vector<Index> begin;     ///< row of particle[s]: [begin[s], begin[s+1])
  std::vector<Index> other;     ///< b > particle[s]
  Column B_symmetric;           ///< (B_ab + B_ba)/2, dim doubles a bond [m^2]
  Column B_self;                ///< B_aa, dim doubles a boundary particle [m^2]
};

/// All bonds of the body: the edges of its triangulation, with thickness included in B (plane
/// problems).
struct Bonds {
  std::vector<Index> begin;  ///< row of particle a: bonds [begin[a], begin[a+1])
  std::vector<Index> other;  ///< b > a of each bond, ascending in a row
  Column B;                 ///< (B_ab - B_ba)/2, B_ab off the surface; dim doubles a bond [m^2]
  Column area_over_length;  ///< A_ab/L_ab of Eq. (60) [m]; empty without contact
  SurfaceBonds surface;

  std::size_t count() const { return begin.empty() ? 0 : begin.back(); }
  Index particles() const { return static_cast<Index>(begin.size()) - 1; }
};

/// Doubles behind the last bond, so that a group of bonds may be read past it.
inline constexpr std::size_t bond_padding = 8;

/// Edges of the triangulation with B_ab = sum_t |t| g_b / (n+1), sorted by (a, b). Equal to Eq.
/// (27).
std::vector<Bond> gradient_vectors(const Body& body);

/// Interface area A_ab of Eq. (60): 4 (|B_ab| + |B_ba|)/2 in 3D. The factor is n + 1: in the
/// plane the same estimate, a length, has 3.
double interface_area(int dim, const Bond& bond);

/// The bonds of gradient_vectors() as the loops read them; A_ab/L_ab with contact only.
Bonds make_bonds(const Body& body, bool contact, const Executor& executor);

/// Both gradient vectors of bond k in row a.
Bond bond_of(const Bonds& bonds, int dim, Index a, Index k);

/// H_a = sum_b u_ab (x) B_ab / V_a as directed rows, for the tangent.
GradientRows directed_rows(const Body& body, const Bonds& bonds);

}  // namespace concord::particle::delaunay
