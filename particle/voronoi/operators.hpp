#pragma once
// The Voronoi method as linear maps of displacements and energies of what they give, written
// out point by point: assembles the tangent, and is a second, slow implementation of the forces
// that tests compare the kernels with.

#include "particle/core/constitution.hpp"
#include "particle/core/contact.hpp"
#include "particle/core/force_model.hpp"
#include "particle/voronoi/rows.hpp"

namespace concord::particle::voronoi {

/// One share of the energy's second variation and of the forces: with s = trial u, the dual
/// d(s) and its derivative dd/ds,  f -= test^T d,  K += test^T dd/ds trial. In a potential test
/// and trial are the same.
template <int M> struct Element { Rows<M> trial, test; };

/// Elements of the body in one form of the force.
class Operators {
 public:
  /// Keeps references.
  Operators(const Stars& stars, const GhostSystems& ghosts, Form form,
            const ContactFactors& factors);

  /// H_a = F_a - I and its test rows, entry 3 i + J (VOR.4, VOR.9). Dual: V_a P_a.
  Element<9> gradient(Index a) const;
  /// x_ab and y_ab of a bond (29): displacements u_ab, then (H_a + H_b)/2 X_ab.
  Element<6> bond(Index a, const Neighbour& ab) const;
  /// u_ag - H_a X_ag of a ghost: its contact law is linear.
  Element<3> ghost(Index a, std::size_t g) const;

  /// dU/dx_ab, -dU/dy_ab (49), and their derivatives, at u_ab and h = (H_a + H_b)/2 X_ab.
  ContactLaw bond_law(const Neighbour& ab, const Vec3& u_ab, const Vec3& h) const;
  /// D (K_n N (x) N + K_t (I - N (x) N)) D of a ghost (50).
  Mat3 ghost_stiffness(const Ghost& ghost) const;
  bool contact() const { return m_factors.any(); }

  std::vector<Mat3> gradients(std::span<const double> u) const;
  /// Forces on all points, dim doubles each.
  Eigen::VectorXd forces(const Constitution& constitution, std::span<const double> u) const;
  Energies energies(const Constitution& constitution, std::span<const double> u) const;

  using Matrix = ForceModel::Stiffness;
  Matrix pattern() const;
  /// Values into a matrix of pattern().
  void tangent(const Constitution& constitution, std::span<const double> u, Matrix& K) const;

 private:
  Rows<9> face_gradient(const Star& star) const;
  template <class Visit> void for_each_element(const Visit& visit) const;
  const Body& body() const { return m_stars.body(); }
  const GhostSystem& system(Index a) const {
    static const GhostSystem none;
    return m_stars.at_wall(a) ? m_ghosts.system[m_ghosts.row[a]] : none;
  }

  const Stars& m_stars;
  const GhostSystems& m_ghosts;
  Form m_form;
  ContactFactors m_factors;
  std::vector<Rows<9>> m_mean;  ///< H^V of each particle
};

}  // namespace concord::particle::voronoi
