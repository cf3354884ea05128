#pragma once
// Finite-strain J2 plasticity of the reference, in principal axes and deal.II's tensors,
// written without a look at the law of the methods that it judges.

#include "fem_reference/parameters.hpp"

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <cmath>

namespace concord::fem {

/// History of one point, as Algorithm 2 of the Continuum Bond Method paper loads it.
template <int dim> struct PlasticPoint {
  dealii::SymmetricTensor<2, 3> b_e = dealii::unit_symmetric_tensor<3>();  ///< elastic Finger
  dealii::Tensor<2, dim> F_inverse = dealii::unit_symmetric_tensor<dim>();
  double eps_p = 0;  ///< equivalent plastic strain
  double work = 0;   ///< plastic work, integral of tau : d_p dt [J per m^3 of the reference]
};

/// Algorithm 2 with f = F F_t^-1: trial b* = f b_t f^T = sum b_A n_A (x) n_A, e_A = 1/2 ln b_A;
///   tau_A = kappa tr e + 2 mu theta dev e_A,  theta = 1 - 3 mu dgamma/tau*_eq,
///   3 mu dgamma + m tau_y(eps_p + dgamma) = tau*_eq where tau*_eq > m tau_y(eps_p),
/// tau_y of (24); m = 1 (Kirchhoff) or m = J = exp tr e (Cauchy). P = tau F^-T. In plane strain
/// (dim = 2) F_33 = 1 and b_e keeps its 33 component.
/// Functions that return bool return false when det F <= 0 or anything is not a number; their
/// outputs are then of no use.
template <int dim> class Elastoplastic {
 public:
  using Tensor2 = dealii::Tensor<2, dim>;
  using Tensor4 = dealii::Tensor<4, dim>;
  using Point = PlasticPoint<dim>;

  Elastoplastic(const scene::Material& material, YieldMeasure measure)
      : m_mu(material.E / (2 * (1 + material.nu))),
        m_kappa(material.E / (3 * (1 - 2 * material.nu))), m_hardening(material.hardening),
        m_measure(measure) {}

  /// First Piola-Kirchhoff stress [Pa] and new state at F, from the old state.
  bool stress(const Tensor2& F, const Point& old, Tensor2& P, Point& now) const;
  /// Also A_iJkL = dP_iJ/dF_kL at fixed old state [Pa]. A point that has yielded and lies on
  /// the yield surface to 1e-9 counts as loading. Symmetric for Kirchhoff, not for Cauchy.
  bool tangent(const Tensor2& F, const Point& old, Tensor2& P, Tensor4& A, Point& now) const;

  /// What a state says about its point.
  struct Measures {
    double stored = 0;    ///< W_e = kappa/2 (tr e)^2 + mu dev e : dev e [J/m^3]
    double tau_eq = 0;    ///< sqrt(3/2 dev tau : dev tau), Kirchhoff [Pa]
    double mean_tau = 0;  ///< tr tau / 3 = kappa tr e [Pa]
    double J = 1;         ///< det F
  };
  Measures measures(const Point& point) const;

  double flow_stress(double eps_p) const;  ///< tau_y of (24) [Pa]
  double flow_slope(double eps_p) const;   ///< d tau_y/d eps_p [Pa]
  double flow_work(double eps_p) const;    ///< integral of tau_y from 0 [J/m^3]
  bool symmetric() const { return m_measure == YieldMeasure::kirchhoff; }

 private:
  using Three = std::array<double, 3>;
  struct Trial {
    Tensor2 F_inverse;
    Three b, dev;  ///< principal values of b*, and of the deviator of tau*
    std::array<dealii::Tensor<1, 3>, 3> n;
    double mean = 0, equivalent = 0;  ///< of tau*
    double m = 1;                     ///< 1 or J: factor of the flow stress
  };
  bool make_trial(const Tensor2& F, const Point& old, Trial& trial) const;
  bool increment(const Trial& trial, double eps_p, double& dgamma) const;
  bool loads(const Trial& trial, const Point& old) const;
  void conclude(const Trial& trial, const Point& old, double dgamma, Tensor2& P,
                Point& now) const;
  void principal_moduli(const Trial& trial, double eps_p, double dgamma, bool yields,
                        double (&D)[3][3]) const;
  void rotate_moduli(const Trial& trial, double theta, const double (&D)[3][3],
                     Tensor4& A) const;

  double m_mu, m_kappa;
  scene::Hardening m_hardening;
  YieldMeasure m_measure;
};

template <int dim> double Elastoplastic<dim>::flow_stress(double eps_p) const {
  const scene::Hardening& h = m_hardening;
  return h.yield_stress + h.modulus * eps_p -
         (h.saturation_stress - h.yield_stress) * std::expm1(-h.exponent * eps_p);
}

template <int dim> double Elastoplastic<dim>::flow_slope(double eps_p) const {
  const scene::Hardening& h = m_hardening;
  return h.modulus +
         (h.saturation_stress - h.yield_stress) * h.exponent * std::exp(-h.exponent * eps_p);
}

template <int dim> double Elastoplastic<dim>::flow_work(double eps_p) const {
  const scene::Hardening& h = m_hardening;
  const double rise = h.saturation_stress - h.yield_stress;
  double work = h.yield_stress * eps_p + 0.5 * h.modulus * eps_p * eps_p;
  if (h.exponent > 0) work += rise * (eps_p + std::expm1(-h.exponent * eps_p) / h.exponent);
  return work;
}

template <int dim>
bool Elastoplastic<dim>::make_trial(const Tensor2& F, const Point& old, Trial& trial) const {
  const double J = determinant(F);
  if (!(J > 0) || !std::isfinite(J)) return false;
  trial.F_inverse = invert(F);
  trial.m = m_measure == YieldMeasure::cauchy ? J : 1;
  const Tensor2 in_plane = F * old.F_inverse;  // Algorithm 2, line 1
  dealii::Tensor<2, 3> f;
  f[2][2] = 1;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) f[i][j] = in_plane[i][j];
  const dealii::Tensor<2, 3> b_t = old.b_e;
  const auto axes =  // line 2
      eigenvectors(symmetrize(f * b_t * transpose(f)),
                   dealii::SymmetricTensorEigenvectorMethod::jacobi);
  Three e;
  for (int A = 0; A < 3; ++A) {
    trial.b[A] = axes[A].first;
    trial.n[A] = axes[A].second;
    if (!(trial.b[A] > 0)) return false;
    e[A] = 0.5 * std::log(trial.b[A]);
  }
  const double trace = e[0] + e[1] + e[2];
  trial.mean = m_kappa * trace;  // lines 3 and 4
  double square = 0;
  for (int A = 0; A < 3; ++A) {
    trial.dev[A] = 2 * m_mu * (e[A] - trace / 3);
    square += trial.dev[A] * trial.dev[A];
  }
  trial.equivalent = std::sqrt(1.5 * square);
  return std::isfinite(trial.equivalent);
}

/// Root of r = tau* - 3 mu dgamma - m tau_y(eps_p + dgamma), r(0) > 0 > r(tau*/3 mu), since the
/// flow stress is positive: Newton's steps (lines 7 to 12), halving the bracket where they
/// leave it, until neither moves.
template <int dim>
bool Elastoplastic<dim>::increment(const Trial& trial, double eps_p, double& dgamma) const {
  double low = 0, high = trial.equivalent / (3 * m_mu);
  dgamma = 0;
  for (int k = 0; k < 200; ++k) {
    const double r =
        trial.equivalent - 3 * m_mu * dgamma - trial.m * flow_stress(eps_p + dgamma);
    if (r == 0) return true;
    (r > 0 ? low : high) = dgamma;
    const double slope = 3 * m_mu + trial.m * flow_slope(eps_p + dgamma);
    double next = dgamma + r / slope;
    if (!(next > low && next < high)) {
      // Round-off: Newton asks for less than the bracket can tell.
      if (slope > 0 && std::abs(r / slope) <= 4e-16 * (eps_p + dgamma)) return true;
      next = 0.5 * (low + high);
    }
    if (next == dgamma || next == low || next == high) return true;
    dgamma = next;
  }
  return false;
}

/// Yields, or stands on the yield surface so closely that round-off decides.
template <int dim> bool Elastoplastic<dim>::loads(const Trial& trial, const Point& old) const {
  const double limit = trial.m * flow_stress(old.eps_p);
  return trial.equivalent > limit || (old.eps_p > 0 && trial.equivalent > (1 - 1e-9) * limit);
}

template <int dim>
void Elastoplastic<dim>::conclude(const Trial& trial, const Point& old, double dgamma,
                                  Tensor2& P, Point& now) const {
  const double theta = dgamma > 0 ? 1 - 3 * m_mu * dgamma / trial.equivalent : 1;
  dealii::Tensor<2, 3> b_e;
  Tensor2 tau;
  for (int A = 0; A < 3; ++A) {
    const double tau_A = trial.mean + theta * trial.dev[A];
    // Lines 14 and 15: e_A - dgamma 3/2 dev_A/tau*_eq.
    const double b_A = trial.b[A] * std::exp((theta - 1) * trial.dev[A] / m_mu);
    const dealii::Tensor<1, 3>& n = trial.n[A];
    b_e += b_A * outer_product(n, n);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) tau[i][j] += tau_A * n[i] * n[j];
  }
  P = tau * transpose(trial.F_inverse);
  now.b_e = symmetrize(b_e);
  now.F_inverse = trial.F_inverse;
  now.eps_p = old.eps_p + dgamma;
  now.work = old.work;
  if (dgamma > 0) now.work += trial.m * (flow_work(now.eps_p) - flow_work(old.eps_p));
}

template <int dim>
bool Elastoplastic<dim>::stress(const Tensor2& F, const Point& old, Tensor2& P,
                                Point& now) const {
  Trial trial;
  double dgamma = 0;
  if (!make_trial(F, old, trial)) return false;
  if (trial.equivalent > trial.m * flow_stress(old.eps_p) &&
      !increment(trial, old.eps_p, dgamma)) {
    return false;
  }
  conclude(trial, old, dgamma, P, now);
  return true;
}

/// D_AB = d tau_A/d e_B, the algorithmic moduli in principal axes of Simo (Comput. Methods
/// Appl. Mech. Engrg. 99, 1992), with
///   d tau*_eq = 3 mu dev_B/tau*_eq de_B,  dJ = J de_B,
///   (3 mu + m tau_y') d dgamma = d tau*_eq - tau_y dm.
template <int dim>
void Elastoplastic<dim>::principal_moduli(const Trial& trial, double eps_p, double dgamma,
                                          bool yields, double (&D)[3][3]) const {
  const double theta = dgamma > 0 ? 1 - 3 * m_mu * dgamma / trial.equivalent : 1;
  const double hard = 3 * m_mu + trial.m * flow_slope(eps_p + dgamma);
  const double swell =
      m_measure == YieldMeasure::cauchy ? trial.m * flow_stress(eps_p + dgamma) : 0;
  for (int B = 0; B < 3; ++B) {
    double d_theta = 0;
    if (yields) {
      const double d_equivalent = 3 * m_mu * trial.dev[B] / trial.equivalent;
      const double d_gamma = (d_equivalent - swell) / hard;
      d_theta =
          -3 * m_mu * (d_gamma - dgamma * d_equivalent / trial.equivalent) / trial.equivalent;
    }
    for (int A = 0; A < 3; ++A) {
      D[A][B] =
          m_kappa + 2 * m_mu * theta * ((A == B ? 1 : 0) - 1.0 / 3) + trial.dev[A] * d_theta;
    }
  }
}

/// With l = dF F^-1 in the axes n_A: de_A = l_AA and, off the diagonal,
///   d tau_AB = (tau_A - tau_B)/(b_A - b_B) (b_B l_AB + b_A l_BA),
/// where tau_A - tau_B = mu theta (ln b_A - ln b_B): its quotient is smooth through b_A = b_B.
/// dP = (d tau - tau l^T) F^-T.
template <int dim>
void Elastoplastic<dim>::rotate_moduli(const Trial& trial, double theta,
                                       const double (&D)[3][3], Tensor4& A4) const {
  double c[3][3][3][3] = {};  // [A][B][C][D]: d(tau - tau l^T)_AB / d l_CD
  for (int A = 0; A < 3; ++A) {
    for (int B = 0; B < 3; ++B) {
      c[A][A][B][B] += D[A][B];
      c[A][B][B][A] -= trial.mean + theta * trial.dev[A];
      if (A == B) continue;
      const double x = trial.b[A] / trial.b[B] - 1;
      const double quotient = std::abs(x) > 1e-300 ? std::log1p(x) / x : 1;
      const double g = m_mu * theta * quotient / trial.b[B];
      c[A][B][A][B] += g * trial.b[B];
      c[A][B][B][A] += g * trial.b[A];
    }
  }
  double n[3][dim], N[3][dim];  // n_A, and F^-1 n_A
  for (int A = 0; A < 3; ++A) {
    for (int J = 0; J < dim; ++J) {
      n[A][J] = trial.n[A][J];
      N[A][J] = 0;
      for (int j = 0; j < dim; ++j) N[A][J] += trial.F_inverse[J][j] * trial.n[A][j];
    }
  }
  A4 = 0;
  const auto add = [&](int A, int B, int C, int E) {
    for (int i = 0; i < dim; ++i)
      for (int J = 0; J < dim; ++J)
        for (int k = 0; k < dim; ++k)
          for (int L = 0; L < dim; ++L)
            A4[i][J][k][L] += c[A][B][C][E] * n[A][i] * N[B][J] * n[C][k] * N[E][L];
  };
  for (int A = 0; A < 3; ++A) {
    for (int B = 0; B < 3; ++B) {
      add(A, A, B, B);
      if (A == B) continue;
      add(A, B, A, B);
      add(A, B, B, A);
    }
  }
}

template <int dim>
bool Elastoplastic<dim>::tangent(const Tensor2& F, const Point& old, Tensor2& P, Tensor4& A,
                                 Point& now) const {
  Trial trial;
  double dgamma = 0, D[3][3];
  if (!make_trial(F, old, trial)) return false;
  if (trial.equivalent > trial.m * flow_stress(old.eps_p) &&
      !increment(trial, old.eps_p, dgamma)) {
    return false;
  }
  conclude(trial, old, dgamma, P, now);
  principal_moduli(trial, old.eps_p, dgamma, loads(trial, old), D);
  const double theta = dgamma > 0 ? 1 - 3 * m_mu * dgamma / trial.equivalent : 1;
  rotate_moduli(trial, theta, D, A);
  return true;
}

template <int dim>
typename Elastoplastic<dim>::Measures Elastoplastic<dim>::measures(const Point& point) const {
  const auto axes = eigenvectors(point.b_e, dealii::SymmetricTensorEigenvectorMethod::jacobi);
  Three e;
  for (int A = 0; A < 3; ++A) e[A] = 0.5 * std::log(axes[A].first);
  const double trace = e[0] + e[1] + e[2];
  double square = 0;
  for (int A = 0; A < 3; ++A) square += (e[A] - trace / 3) * (e[A] - trace / 3);
  Measures out;
  out.stored = 0.5 * m_kappa * trace * trace + m_mu * square;
  out.tau_eq = 2 * m_mu * std::sqrt(1.5 * square);
  out.mean_tau = m_kappa * trace;
  out.J = 1 / determinant(point.F_inverse);
  return out;
}

}  // namespace concord::fem
