#pragma once
// Finite-strain J2 plasticity with logarithmic strains and Kirchhoff stress (Algorithm 2 of the
// Continuum Bond Method paper), shared by all particle methods and SPH: the law of one material
// point, and the history of the particles of a body.

#include "particle/core/simd.hpp"
#include "scene/material.hpp"

#include <vector>

namespace concord::scene {
class Checkpoint;
}

namespace concord::particle {

/// Particles that the stress kernels work on at once (see stress_kernel.hpp).
inline constexpr int plastic_width = 8;

/// History variables of one material point.
struct PlasticState {
  Mat3 A = Mat3::Zero();  ///< C_p^-1 - I = F_p^-1 F_p^-T - I, symmetric: small plastic strains
                          ///< keep their relative accuracy; det(I + A) = 1
  double eps_p = 0;       ///< equivalent plastic strain
};

/// J2 flow theory: F = F_e F_p, b_e = F C_p^-1 F^T, e = 1/2 ln b_e, tau = K tr(e) I + 2 mu dev
/// e, yield sqrt(3/2) |dev tau| <= tau_y(eps_p) (24), radial return in e. The update minimises
/// W_e(e) + Psi_p(eps_p) over the plastic increment, so that P is the derivative of that energy
/// at fixed old state and the consistent tangent is symmetric.
class J2Hencky {
 public:
  explicit J2Hencky(const scene::Material& material);

  double flow_stress(double eps_p) const;  ///< tau_y [Pa], Eq. (24)
  double flow_slope(double eps_p) const;   ///< d tau_y / d eps_p [Pa]
  double flow_energy(double eps_p) const;  ///< Psi_p = integral of tau_y from 0 [J/m^3]

  struct Update {
    PlasticState state;
    Mat3 P = Mat3::Zero();  ///< first Piola-Kirchhoff stress, tau F^-T [Pa]
    double tau_eq = 0;      ///< sqrt(3/2) |dev tau| [Pa]
    double stored = 0;      ///< W_e = K/2 tr(e)^2 + mu dev e : dev e [J/m^3]
    double plastic = 0;     ///< Psi_p(eps_p): plastic work per reference volume [J/m^3]
    bool yields = false;
    bool sound = true;  ///< false: det F <= 0 or not a number; the rest is of no use
  };
  /// State and stress at F = I + H (plane strain: H_33 = 0) from the old state.
  Update update(const Mat3& H, const PlasticState& old) const;

  /// dP/dF of update() at fixed old state [Pa], row 3 i + J, column 3 k + L. A point on the
  /// yield surface to 1e-9 of tau_y with eps_p > 0 counts as loading: the derivative for a step
  /// onwards.
  scene::Tangent tangent(const Mat3& H, const PlasticState& old) const;

  double shear_modulus() const { return m_mu; }
  double bulk_modulus() const { return m_kappa; }
  const scene::Hardening& hardening() const { return m_hardening; }

 private:
  /// eps_p increment d >= 0 with trial - 3 mu d = tau_y(eps_p + d), trial > tau_y(eps_p).
  double plastic_increment(double trial, double eps_p) const;

  double m_mu, m_kappa;
  scene::Hardening m_hardening;
};

/// Committed and trial history of the particles of one body. A force evaluation writes the
/// trial state from the committed one, whatever it was asked before; only commit() moves on.
class PlasticHistory {
 public:
  PlasticHistory(const scene::Problem& problem, Index n);

  const J2Hencky& law() const { return m_law; }
  PlasticState committed(Index a) const;

  /// Stress kernel of `count` <= 8 consecutive particles, the lanes beyond unused: h_ij of
  /// H = F - I in h[Dim j + i][lane], first Piola stress likewise in p, J - 1 in j (NaN where
  /// the law finds no state). Writes the trial state of these particles alone, and none unless
  /// told to keep it.
  void stress(Index first, int count, const double (&h)[9][plastic_width],
              double (&p)[9][plastic_width], double (&j)[plastic_width], bool keep = true);
  void stress(Index first, int count, const double (&h)[4][plastic_width],
              double (&p)[4][plastic_width], double (&j)[plastic_width], bool keep = true);

  /// The trial state of the last force evaluation becomes the committed one. No copy.
  void commit();

  /// While held, no particle flows: forces answer elastically from the committed state, as they
  /// do to a reversal. For the stable time step.
  void hold(bool on);

  /// The committed states, saved or restored.
  void keep(scene::Checkpoint& state);

 private:
  /// The same for one lane, by J2Hencky::update.
  template <int Dim>
  void stress_of(Index first, int lane, const double (&h)[Dim * Dim][plastic_width],
                 double (&p)[Dim * Dim][plastic_width], double (&j)[plastic_width], bool keep);
  void note_trial();

  scene::Material m_material;
  J2Hencky m_law;
  Index m_n;
  int m_components;  ///< 4 in plane strain (11, 22, 33, 12), 6 in 3D (23, 31 too), then eps_p
  std::vector<Column> m_old, m_new;  ///< [component][particle]
  bool m_has_trial = false;          ///< a force evaluation came after the last commit
};

}  // namespace concord::particle
