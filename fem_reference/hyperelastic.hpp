#pragma once
// The stress laws of the reference, in deal.II's tensors, written without a look at those of
// the methods that it judges.

#include "scene/problem.hpp"

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <cmath>
#include <stdexcept>

namespace concord::fem {

/// Isotropic hyperelastic law, per reference volume:
///   compressible neo-Hookean   W = lambda/2 (ln J)^2 - mu ln J + mu/2 (tr C - 3)   (51)
///                              P = (lambda ln J - mu) F^-T + mu F                  (53)
///   St Venant-Kirchhoff        W = lambda/2 (tr E)^2 + mu E:E,  P = F (lambda tr E I + 2 mu E)
///   split neo-Hookean          W = mu/2 (J^-2/3 tr C - 3) + kappa/4 (J^2 - 1 - 2 ln J),
///                              P = mu J^-2/3 (F - tr C/3 F^-T) + kappa/2 (J^2 - 1) F^-T
/// (numbers: Delaunay paper; the split law, kappa = lambda + 2/3 mu, is that of deal.II's code
/// gallery, "Quasi-static finite-strain compressible elasticity": the model
/// neo-hookean-isochoric of the scenes, or `split` in place of the scene's). Tensors have the
/// space dimension `dim`; in plane strain F_33 = 1, in plane stress F_33 follows from P_33 = 0.
/// Functions that return bool return false, and leave their outputs alone, when det F <= 0,
/// NaN, or no F_33 exists.
template <int dim> class Hyperelastic {
 public:
  using Tensor2 = dealii::Tensor<2, dim>;
  using Tensor4 = dealii::Tensor<4, dim>;

  explicit Hyperelastic(const scene::Problem& problem, bool split = false);

  /// First Piola-Kirchhoff stress P_iJ [Pa].
  bool stress(const Tensor2& F, Tensor2& P) const;
  /// P and its derivative A_iJkL = dP_iJ/dF_kL [Pa]; in plane stress with F_33 condensed:
  /// A - A_..33 A_33.. / A_3333.
  bool tangent(const Tensor2& F, Tensor2& P, Tensor4& A) const;
  /// W(F) [J/m^3]; NaN where stress() returns false.
  double energy(const Tensor2& F) const;
  /// F with its out-of-plane stretch.
  bool complete(const Tensor2& F, dealii::Tensor<2, 3>& F3) const;
  /// Cauchy stress P F^T / J [Pa].
  bool cauchy(const Tensor2& F, dealii::SymmetricTensor<2, 3>& sigma) const;

 private:
  bool stretch_33(const dealii::Tensor<2, 3>& F, double& F33) const;
  void stress_3(const dealii::Tensor<2, 3>& F, double J, dealii::Tensor<2, 3>& P) const;
  void tangent_3(const dealii::Tensor<2, 3>& F, double J, dealii::Tensor<4, 3>& A) const;

  enum class Law { neo_hookean, st_venant_kirchhoff, split };
  static Law law_of(scene::MaterialModel model);
  bool split_stretch_33(const dealii::Tensor<2, 3>& F, double J2, double& F33) const;
  Law m_law;
  bool m_plane_stress;
  double m_lambda, m_mu;
};

template <int dim>
typename Hyperelastic<dim>::Law Hyperelastic<dim>::law_of(scene::MaterialModel model) {
  switch (model) {
    case scene::MaterialModel::neo_hookean:
      return Law::neo_hookean;
    case scene::MaterialModel::neo_hookean_isochoric:
      return Law::split;
    case scene::MaterialModel::st_venant_kirchhoff:
      return Law::st_venant_kirchhoff;
    case scene::MaterialModel::j2_hencky:
      break;  // has a history: elastoplastic.hpp
  }
  throw std::logic_error("material model without a law");
}

template <int dim>
Hyperelastic<dim>::Hyperelastic(const scene::Problem& problem, bool split)
    : m_law(split ? Law::split : law_of(problem.material.model)),
      m_plane_stress(problem.dimension == Dimension::plane_stress) {
  const double E = problem.material.E, nu = problem.material.nu;
  m_lambda = nu * E / ((1 + nu) * (1 - 2 * nu));  // (54)
  m_mu = E / (2 * (1 + nu));
}

/// Split law: W as a function of s = ln F_33 at fixed C_11 + C_22 = c,
///   W(s) = mu/2 J_2^(-2/3) (c e^(-2s/3) + e^(4s/3)) + kappa/4 (J_2^2 e^(2s) - 2 s) + const,
/// is convex, a sum of exponentials; P_33 F_33 = W'(s) = 0 by Newton, with steps halved while
/// they do not bring W' closer to zero.
template <int dim>
bool Hyperelastic<dim>::split_stretch_33(const dealii::Tensor<2, 3>& F, double J2,
                                         double& F33) const {
  const double c =
      F[0][0] * F[0][0] + F[1][0] * F[1][0] + F[0][1] * F[0][1] + F[1][1] * F[1][1];
  const double kappa = m_lambda + 2 * m_mu / 3, shear = m_mu / std::cbrt(J2 * J2);
  const auto slope = [&](double s) {
    return shear / 3 * (2 * std::exp(4 * s / 3) - c * std::exp(-2 * s / 3)) +
           kappa / 2 * (J2 * J2 * std::exp(2 * s) - 1);
  };
  double s = -m_lambda * std::log(J2) / (m_lambda + 2 * m_mu), W1 = slope(s);
  for (int k = 0; k < 100; ++k) {
    const double W2 = shear / 9 * (8 * std::exp(4 * s / 3) + 2 * c * std::exp(-2 * s / 3)) +
                      kappa * J2 * J2 * std::exp(2 * s);
    double step = -W1 / W2;
    while (std::abs(step) > 4e-16 * (1 + std::abs(s)) &&
           !(std::abs(slope(s + step)) < std::abs(W1))) {
      step /= 2;
    }
    s += step;
    W1 = slope(s);
    if (!std::isfinite(s)) return false;
    if (std::abs(step) <= 4e-16 * (1 + std::abs(s))) break;
  }
  F33 = std::exp(s);
  return true;
}

/// Neo-Hookean: lambda (ln J_2 + s) - mu + mu e^(2s) = 0 for s = ln F_33, by Newton (increasing
/// and convex in s for lambda >= 0). St Venant-Kirchhoff: E_33 = -lambda (E_11 + E_22)/(lambda
/// + 2 mu).
template <int dim>
bool Hyperelastic<dim>::stretch_33(const dealii::Tensor<2, 3>& F, double& F33) const {
  const double J2 = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  if (!(J2 > 0)) return false;
  if (m_law == Law::st_venant_kirchhoff) {
    const double in_plane = 0.5 * (F[0][0] * F[0][0] + F[1][0] * F[1][0] + F[0][1] * F[0][1] +
                                   F[1][1] * F[1][1] - 2);
    const double square = 1 - 2 * m_lambda * in_plane / (m_lambda + 2 * m_mu);
    if (!(square > 0)) return false;
    F33 = std::sqrt(square);
    return true;
  }
  if (m_law == Law::split) return split_stretch_33(F, J2, F33);
  const double log_J2 = std::log(J2);
  double s = -m_lambda * log_J2 / (m_lambda + 2 * m_mu);  // the linearised solution
  for (int k = 0; k < 60; ++k) {
    const double e = m_mu * std::exp(2 * s);
    const double step = (m_lambda * (log_J2 + s) - m_mu + e) / (m_lambda + 2 * e);
    s -= step;
    if (std::abs(step) <= 4e-16 * (1 + std::abs(s))) break;
    if (!std::isfinite(s)) return false;
  }
  F33 = std::exp(s);
  return true;
}

template <int dim>
inline bool Hyperelastic<dim>::complete(const Tensor2& F, dealii::Tensor<2, 3>& F3) const {
  if constexpr (dim == 3) {
    F3 = F;
    return true;
  } else {
    F3 = 0;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) F3[i][j] = F[i][j];
    }
    F3[2][2] = 1;
    return m_plane_stress ? stretch_33(F3, F3[2][2]) : true;
  }
}

template <int dim>
inline void Hyperelastic<dim>::stress_3(const dealii::Tensor<2, 3>& F, double J,
                                        dealii::Tensor<2, 3>& P) const {
  if (m_law == Law::neo_hookean) {
    P = (m_lambda * std::log(J) - m_mu) * transpose(invert(F)) + m_mu * F;  // (53)
  } else if (m_law == Law::split) {
    const double c = m_mu / std::cbrt(J * J), kappa = m_lambda + 2 * m_mu / 3;
    const dealii::Tensor<2, 3> G = transpose(invert(F));
    P = c * F + (0.5 * kappa * (J * J - 1) - c * F.norm_square() / 3) * G;
  } else {
    dealii::Tensor<2, 3> E = 0.5 * (transpose(F) * F - dealii::unit_symmetric_tensor<3>());
    P = F * (m_lambda * trace(E) * dealii::unit_symmetric_tensor<3>() + 2 * m_mu * E);
  }
}

template <int dim> inline bool Hyperelastic<dim>::stress(const Tensor2& F, Tensor2& P) const {
  dealii::Tensor<2, 3> F3, P3;
  if (!complete(F, F3)) return false;
  const double J = determinant(F3);
  if (!(J > 0)) return false;
  stress_3(F3, J, P3);
  for (int i = 0; i < dim; ++i) {
    for (int j = 0; j < dim; ++j) P[i][j] = P3[i][j];
  }
  return true;
}

/// With G = F^-1:
/// neo-Hookean: A_iJkL = mu d_ik d_JL + lambda G_Ji G_Lk + (mu - lambda ln J) G_Jk G_Li.
/// St Venant-Kirchhoff: A_iJkL = d_ik S_JL + lambda F_iJ F_kL + mu ((F F^T)_ik d_JL + F_iL
/// F_kJ). Split, c = mu J^-2/3: A_iJkL = c (d_ik d_JL - 2/3 (F_iJ G_Lk + F_kL G_Ji))
///   + (2/9 c tr C + kappa J^2) G_Ji G_Lk + (c tr C/3 - kappa/2 (J^2 - 1)) G_Jk G_Li.
template <int dim>
void Hyperelastic<dim>::tangent_3(const dealii::Tensor<2, 3>& F, double J,
                                  dealii::Tensor<4, 3>& A) const {
  const dealii::Tensor<2, 3> I = dealii::unit_symmetric_tensor<3>();
  const bool svk = m_law == Law::st_venant_kirchhoff, split = m_law == Law::split;
  const dealii::Tensor<2, 3> G = svk ? F * transpose(F) : invert(F);
  const dealii::Tensor<2, 3> E = 0.5 * (transpose(F) * F - I);
  const dealii::Tensor<2, 3> S = m_lambda * trace(E) * I + 2 * m_mu * E;
  const double kappa = m_lambda + 2 * m_mu / 3, tr_C = F.norm_square();
  const double c = split ? m_mu / std::cbrt(J * J) : m_mu;
  const double b = split ? -2 * c / 3 : 0;  // mixed F, G terms
  const double g = split ? 2 * c * tr_C / 9 + kappa * J * J : m_lambda;
  const double h =
      split ? c * tr_C / 3 - 0.5 * kappa * (J * J - 1) : m_mu - m_lambda * std::log(J);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) {
          A[i][j][k][l] = svk ? I[i][k] * S[j][l] + m_lambda * F[i][j] * F[k][l] +
                                    m_mu * (G[i][k] * I[j][l] + F[i][l] * F[k][j])
                              : c * I[i][k] * I[j][l] +
                                    b * (F[i][j] * G[l][k] + F[k][l] * G[j][i]) +
                                    g * G[j][i] * G[l][k] + h * G[j][k] * G[l][i];
        }
}

template <int dim>
bool Hyperelastic<dim>::tangent(const Tensor2& F, Tensor2& P, Tensor4& A) const {
  dealii::Tensor<2, 3> F3, P3;
  if (!complete(F, F3)) return false;
  const double J = determinant(F3);
  if (!(J > 0)) return false;
  dealii::Tensor<4, 3> A3;
  stress_3(F3, J, P3);
  tangent_3(F3, J, A3);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      P[i][j] = P3[i][j];
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) {
          A[i][j][k][l] = A3[i][j][k][l];
          if (m_plane_stress) {
            A[i][j][k][l] -= A3[i][j][2][2] * A3[2][2][k][l] / A3[2][2][2][2];
          }
        }
    }
  return true;
}

// From H = F - I, so that small strains do not drown in the 1 of F:
// J - 1 = tr H + ((tr H)^2 - tr H^2)/2 + det H and tr C - 3 = 2 tr H + H:H.
template <int dim> inline double Hyperelastic<dim>::energy(const Tensor2& F) const {
  dealii::Tensor<2, 3> F3;
  if (!complete(F, F3)) return std::nan("");
  const dealii::Tensor<2, 3> H = F3 - dealii::unit_symmetric_tensor<3>();
  const double tr_H = trace(H);
  const double J_1 = tr_H + 0.5 * (tr_H * tr_H - trace(H * H)) + determinant(H);
  if (!(J_1 > -1)) return std::nan("");
  if (m_law == Law::split) {
    const double J = 1 + J_1, kappa = m_lambda + 2 * m_mu / 3;
    return 0.5 * m_mu * (F3.norm_square() / std::cbrt(J * J) - 3) +
           0.25 * kappa * (J * J - 1 - 2 * std::log(J));
  }
  if (m_law == Law::neo_hookean) {
    const double log_J = std::log1p(J_1);
    return 0.5 * m_lambda * log_J * log_J - m_mu * (log_J - tr_H) +
           0.5 * m_mu * scalar_product(H, H);  // (51)
  }
  const dealii::Tensor<2, 3> E = 0.5 * (H + transpose(H) + transpose(H) * H);
  return 0.5 * m_lambda * trace(E) * trace(E) + m_mu * scalar_product(E, E);
}

template <int dim>
bool Hyperelastic<dim>::cauchy(const Tensor2& F, dealii::SymmetricTensor<2, 3>& sigma) const {
  dealii::Tensor<2, 3> F3, P3;
  if (!complete(F, F3)) return false;
  const double J = determinant(F3);
  if (!(J > 0)) return false;
  stress_3(F3, J, P3);
  sigma = symmetrize(P3 * transpose(F3)) / J;
  return true;
}

}  // namespace concord::fem
