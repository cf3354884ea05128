#pragma once
// Bonds and triangles of a plane body that can be removed: bond vectors zeta_ip (9) and
// averaging volumes Omega_i (1), rebuilt where something goes. Numbers are equations of the
// Continuum Bond Method paper.

#include "particle/core/body.hpp"

#include <array>
#include <span>
#include <vector>

namespace concord::particle::cbm {

/// Each bond once, in the row of its lower-numbered particle a, rows ascending.
class Network {
 public:
  /// All triangles of the body's triangulation. Plane bodies.
  explicit Network(const Body& body);

  std::size_t bonds() const { return m_other.size(); }
  /// Row of particle a: bonds [begin()[a], begin()[a+1]).
  const Index* begin() const { return m_begin.data(); }
  const Index* other() const { return m_other.data(); }  ///< b > a of every bond
  Index first(Index k) const { return m_first[k]; }      ///< a of bond k
  Index second(Index k) const { return m_other[k]; }
  /// zeta_ab and zeta_ba, four doubles a bond, thickness included [m^2]; zero where no triangle
  /// is left.
  const double* zeta() const { return m_zeta.data(); }
  const std::vector<double>& omega() const { return m_omega; }  ///< Omega_i [m^3]
  /// 1/Omega_i; 0 for isolated particles, whose gradients are zero.
  const std::vector<double>& inverse_omega() const { return m_inverse_omega; }

  /// Bonds at particle i, ascending.
  std::span<const Index> bonds_of(Index i) const {
    return {&m_incident[m_incident_begin[i]],
            static_cast<std::size_t>(m_incident_begin[i + 1] - m_incident_begin[i])};
  }
  bool connected(Index bond) const;  ///< has a triangle left
  bool alive(Index triangle) const { return m_alive[triangle] != 0; }

  /// Triangles that the removal of these bonds takes with it, ascending.
  std::vector<Index> triangles_of(std::span<const Index> bonds) const;
  /// Vertices of triangles, each once, ascending.
  std::vector<Index> vertices_of(std::span<const Index> triangles) const;
  /// Removes triangles; rebuilds the bond vectors of their edges and the averaging volumes of
  /// their vertices. Masses stay. Returns the bonds that have no triangle left by it.
  std::vector<Index> remove(std::span<const Index> triangles);

  /// Bonds that cross the segment; a particle on its line counts as lying to its left.
  std::vector<Index> crossing(const Vec3& from, const Vec3& to) const;

 private:
  void find_bonds();
  void rebuild_bond(Index bond);
  void rebuild_volume(Index particle);
  Index edge(Index a, Index b) const;

  const Body& m_body;
  std::vector<Index> m_begin, m_first, m_other;
  std::vector<std::array<Index, 2>> m_triangles;  ///< on both sides of a bond; -1: none
  std::vector<std::array<Index, 3>> m_edges;      ///< bonds of a triangle
  std::vector<Index> m_star_begin, m_star;        ///< triangles at a particle
  std::vector<Index> m_incident_begin, m_incident;
  std::vector<char> m_alive;  ///< of triangles
  Column m_zeta;
  std::vector<double> m_omega, m_inverse_omega;
};

}  // namespace concord::particle::cbm
