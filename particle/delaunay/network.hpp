#pragma once
// Bonds and simplices of a body that can be removed: bond vectors zeta_ip, which are B_ip, and
// averaging volumes Omega_i, which are V_i, rebuilt where something goes. Numbers (CBM.n) are
// equations of the Continuum Bond Method paper.

#include "particle/delaunay/bonds.hpp"

#include <span>
#include <vector>

namespace concord::particle::delaunay {

/// Ends of a bond, a < b.
struct Ends {
  Index a, b;
};

/// A bond on the surface: zeta_ab = z + s and zeta_ba = -z + s, where s is not zero.
template <int Dim> struct SkewBond {
  alignas(32) double s[Lanes<Dim>::stride];
  Index bond, a, b;
};

/// What a particle sums over: F_i = I + sum_p (u_p - u_i) (x) zeta_ip / Omega_i.
struct Stencil {
  double omega = 0;           ///< Omega_i [m^3]
  std::vector<Index> points;  ///< all vertices of its simplices, itself too if it has any
  std::vector<Vec3> zeta;     ///< zeta_ip of each; they sum to zero [m^2]
};

/// Each bond once, in the row of its lower-numbered particle a, rows ascending. What is left
/// depends on which simplices are gone, not on the order in which they went.
class Network {
 public:
  /// All simplices of the body's triangulation. `contact`: whether A_ab/L_ab is kept.
  Network(const Body& body, bool contact);

  std::size_t bonds() const { return m_ends.size(); }
  const Ends& ends(Index bond) const { return m_ends[bond]; }
  /// Rows, z = (zeta_ab - zeta_ba)/2 of every bond (B), dim doubles, thickness included [m^2],
  /// and, with contact, A_ab/L_ab of (60); 0 without a simplex. No surface: skew() is it.
  const Bonds& rows() const { return m_rows; }
  /// Bonds at whose facets the body ends, with s = (zeta_ab + zeta_ba)/2: on all others it is
  /// zero, (30). Ascending.
  template <int Dim> const std::vector<SkewBond<Dim>>& skew() const {
    if constexpr (Dim == 3)
      return m_skew_3;
    else
      return m_skew_2;
  }
  /// zeta of a bond in the sum of one of its ends.
  Vec3 zeta(Index bond, Index particle) const;
  const std::vector<double>& omega() const { return m_omega; }  ///< Omega_i [m^3]
  /// 1/Omega_i; 0 for isolated particles, whose gradients are zero.
  const std::vector<double>& inverse_omega() const { return m_inverse_omega; }

  /// Bonds at particle i, ascending.
  std::span<const Index> bonds_of(Index i) const {
    return row(m_incident_begin, m_incident, i);
  }
  bool connected(Index bond) const;  ///< has a simplex left
  bool alive(Index simplex) const { return m_alive[simplex] != 0; }

  /// Simplices that the removal of these bonds takes with it, ascending.
  std::vector<Index> simplices_of(std::span<const Index> bonds) const;
  /// Vertices of simplices, each once, ascending.
  std::vector<Index> vertices_of(std::span<const Index> simplices) const;
  /// Removes simplices; rebuilds the bond vectors of their edges and the averaging volumes of
  /// their vertices. Masses stay. Returns the bonds that have no simplex left by it.
  std::vector<Index> remove(std::span<const Index> simplices);

  /// Puts simplices back that remove() took, to the bit.
  void restore(std::span<const Index> simplices);

  /// Simplices left at a particle, ascending.
  std::vector<Index> simplices_at(Index particle) const;
  /// Whether a particle has all its simplices.
  bool whole(Index particle) const;
  /// What a particle would sum over without some simplices (ascending).
  Stencil stencil(Index particle, std::span<const Index> without = {}) const;

  /// Bonds that cross the segment, in 3D the plane through it that is normal to X-Y; a particle
  /// on its line counts as lying to its left.
  std::vector<Index> crossing(const Vec3& from, const Vec3& to) const;

 private:
  static std::span<const Index> row(const std::vector<Index>& begin,
                                    const std::vector<Index>& values, Index r) {
    return {values.data() + begin[r], static_cast<std::size_t>(begin[r + 1] - begin[r])};
  }
  const Index* vertices(Index simplex) const {
    return &m_body.triangulation.simplices[static_cast<std::size_t>(simplex) * (m_dim + 1)];
  }
  void find_bonds();
  void find_simplices();
  bool closed(Index bond) const;
  std::vector<Index> rebuild(std::span<const Index> simplices);
  void rebuild_bond(Index bond);
  template <int Dim> void set_skew(std::vector<SkewBond<Dim>>& skew, Index bond, const Vec3& s);
  void rebuild_volume(Index particle);
  Index bond_between(Index a, Index b) const;

  const Body& m_body;
  int m_dim;
  Bonds m_rows;
  std::vector<Ends> m_ends;
  std::vector<SkewBond<2>> m_skew_2;
  std::vector<SkewBond<3>> m_skew_3;
  std::vector<Index> m_simplices_begin, m_simplices;  ///< at a bond, ascending
  std::vector<Index> m_edges;                         ///< bonds of every simplex
  std::vector<Index> m_star_begin, m_star;            ///< simplices at a particle, ascending
  std::vector<Index> m_incident_begin, m_incident;    ///< bonds at a particle
  std::vector<char> m_alive;                          ///< of simplices
  std::vector<double> m_omega, m_inverse_omega;
};

}  // namespace concord::particle::delaunay
