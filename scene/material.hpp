#pragma once
// Stress laws of the scenes: energy per reference volume, first Piola stress and tangent of two
// compressible neo-Hookean solids and the St Venant-Kirchhoff solid. They take the displacement
// gradient H = F - I, so that tiny strains keep their full relative accuracy. These are the
// reference versions; the kernels of the methods are tested against them.

#include "scene/problem.hpp"

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

namespace concord::scene {

template <class T> using Tensor3 = Eigen::Matrix<T, 3, 3>;
/// dP/dF; row 3 i + j belongs to P_ij, column 3 k + l to F_kl.
using Tangent = Eigen::Matrix<double, 9, 9>;

/// ln(1 + x); full relative accuracy near 0 for floating-point T.
template <class T> T log_one_plus(const T& x) {
  using std::log;
  if constexpr (std::is_floating_point_v<T>)
    return std::log1p(x);
  else
    return log(T(1.0) + x);
}

/// e^x - 1; full relative accuracy near 0 for floating-point T.
template <class T> T exp_minus_one(const T& x) {
  using std::exp;
  if constexpr (std::is_floating_point_v<T>)
    return std::expm1(x);
  else
    return exp(x) - T(1.0);
}

/// x - ln(1 + x) without cancellation: sum_k (-x)^k/k from k = 2, where |x| < 0.1 (18 terms
/// leave 0.1^19/19, below round-off).
template <class T> T minus_log_one_plus(const T& x) {
  if (!(x < 0.1 && x > -0.1)) return x - log_one_plus(x);
  T sum(0.0);
  for (int k = 20; k >= 2; --k) sum = T(1.0 / k) - x * sum;
  return x * x * sum;
}

/// Second invariant (tr^2 A - tr A^2)/2.
template <class T> T second_invariant(const Tensor3<T>& A) {
  return A(0, 0) * A(1, 1) + A(1, 1) * A(2, 2) + A(2, 2) * A(0, 0) - A(0, 1) * A(1, 0) -
         A(1, 2) * A(2, 1) - A(2, 0) * A(0, 2);
}

template <class T> T determinant(const Tensor3<T>& A) {
  return A(0, 0) * (A(1, 1) * A(2, 2) - A(1, 2) * A(2, 1)) -
         A(0, 1) * (A(1, 0) * A(2, 2) - A(1, 2) * A(2, 0)) +
         A(0, 2) * (A(1, 0) * A(2, 1) - A(1, 1) * A(2, 0));
}

/// J - 1 = tr H + I2(H) + det H.
template <class T> T volume_change(const Tensor3<T>& H) {
  return H(0, 0) + H(1, 1) + H(2, 2) + second_invariant(H) + determinant(H);
}

/// Green-Lagrange strain (H + H^T + H^T H)/2.
template <class T> Tensor3<T> green_strain(const Tensor3<T>& H) {
  return T(0.5) * (H + H.transpose() + H.transpose() * H);
}

/// F^-T by cofactors.
template <class T> Tensor3<T> inverse_transpose(const Tensor3<T>& F) {
  Tensor3<T> C;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      C(i, j) = F(a, c) * F(b, d) - F(a, d) * F(b, c);
    }
  const T J = F(0, 0) * C(0, 0) + F(0, 1) * C(0, 1) + F(0, 2) * C(0, 2);
  return C / J;
}

/// Compressible neo-Hookean solid, Eqs. (51)-(53) of the Delaunay paper:
/// W = lambda/2 ln^2 J - mu ln J + mu/2 (tr C - 3). NaN where J <= 0.
struct NeoHookean {
  double lambda = 0, mu = 0;

  /// W [J/m^3]. tr C - 3 - 2 ln J = (j - ln(1 + j)) - 4 I2(E) - 8 det E with j = J^2 - 1
  /// = 2 tr E + 4 I2(E) + 8 det E: every term is of second order in the strain.
  template <class T> T energy(const Tensor3<T>& H) const {
    if (!(volume_change(H) > -1.0)) return T(std::numeric_limits<double>::quiet_NaN());
    const Tensor3<T> E = green_strain(H);
    const T rest = T(4.0) * second_invariant(E) + T(8.0) * determinant(E);
    const T j = T(2.0) * (E(0, 0) + E(1, 1) + E(2, 2)) + rest;
    const T log_J = T(0.5) * log_one_plus(j);
    return T(0.5 * mu) * (minus_log_one_plus(j) - rest) + T(0.5 * lambda) * log_J * log_J;
  }
  /// P = [mu (H + H^T + H H^T) + lambda ln J I] F^-T [Pa], which is (53).
  template <class T> Tensor3<T> stress(const Tensor3<T>& H) const {
    const T log_J = log_one_plus(volume_change(H));
    Tensor3<T> tau = T(mu) * (H + H.transpose() + H * H.transpose());
    for (int i = 0; i < 3; ++i) tau(i, i) += T(lambda) * log_J;
    const Tensor3<T> F = H + Tensor3<T>::Identity();
    return tau * inverse_transpose(F);
  }
  /// mu d_ik d_jl + lambda G_ij G_kl + (mu - lambda ln J) G_il G_kj, G = F^-T [Pa].
  Tangent tangent(const Mat3& H) const;
  /// F_33 - 1 with P_33 = 0: mu (F_33^2 - 1) + lambda (ln J_2 + ln F_33) = 0 by Newton in
  /// ln F_33; the function is convex and increasing, so it converges from everywhere.
  template <class T> T plane_stress_stretch(const Tensor3<T>& H) const {
    using std::abs;
    using std::exp;
    const T j2 = H(0, 0) + H(1, 1) + H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0);
    if (!(j2 > -1.0)) return T(std::numeric_limits<double>::quiet_NaN());
    const T log_J2 = log_one_plus(j2);
    T g = T(-lambda / (lambda + 2 * mu)) * log_J2;
    for (int i = 0; i < 60; ++i) {
      const T e = exp_minus_one(T(T(2.0) * g));
      const T step =
          (T(mu) * e + T(lambda) * (log_J2 + g)) / (T(2 * mu) * (e + T(1.0)) + T(lambda));
      g -= step;
      if (i > 3 && abs(step) <= 1e-17 + 1e-16 * abs(g)) break;
    }
    return exp_minus_one(g);
  }
};

/// Neo-Hookean solid with isochoric and volumetric parts split, kappa = lambda + 2 mu/3:
/// W = mu/2 (J^(-2/3) tr C - 3) + kappa/4 (J^2 - 1 - 2 ln J), C and J of three dimensions. The
/// law of deal.II's code gallery, "Quasi-Static Finite-Strain Compressible Elasticity" (doi
/// 10.5281/zenodo.1228964). Same moduli at small strain as NeoHookean. NaN where J <= 0.
struct NeoHookeanIsochoric {
  double lambda = 0, mu = 0;
  double bulk_modulus() const { return lambda + 2 * mu / 3; }

  /// W [J/m^3]. With C = c (I + K), c = tr C/3, tr K = 0: J^(-2/3) tr C = 3 (1 + d)^(-1/3) with
  /// d = det(I + K) - 1 = det K - K:K/2, of second order in the strain; and the volumetric part
  /// is kappa/4 (q - ln(1 + q)) with q = J^2 - 1.
  template <class T> T energy(const Tensor3<T>& H) const {
    if (!(volume_change(H) > -1.0)) return T(std::numeric_limits<double>::quiet_NaN());
    const Tensor3<T> E = green_strain(H);
    const T trace = E(0, 0) + E(1, 1) + E(2, 2);
    const T q = T(2.0) * trace + T(4.0) * second_invariant(E) + T(8.0) * determinant(E);
    Tensor3<T> K = E;
    for (int i = 0; i < 3; ++i) K(i, i) -= trace / T(3.0);
    K *= T(2.0) / (T(1.0) + trace * T(2.0) / T(3.0));
    const T d = determinant(K) - T(0.5) * K.cwiseProduct(K).sum();
    const T isochoric = exp_minus_one(T(log_one_plus(d) / T(-3.0)));
    return T(1.5 * mu) * isochoric + T(0.25 * bulk_modulus()) * minus_log_one_plus(q);
  }
  /// P = [mu J^(-2/3) dev(H + H^T + H H^T) + kappa/2 j (2 + j) I] F^-T, j = J - 1 [Pa].
  template <class T> Tensor3<T> stress(const Tensor3<T>& H) const {
    using std::exp;
    const T j = volume_change(H);
    const T power = exp(T(log_one_plus(j) * T(-2.0) / T(3.0)));
    Tensor3<T> tau = T(mu) * power * (H + H.transpose() + H * H.transpose());
    const T mean = (tau(0, 0) + tau(1, 1) + tau(2, 2)) / T(3.0);
    const T volumetric = T(0.5 * bulk_modulus()) * j * (T(2.0) + j);
    for (int i = 0; i < 3; ++i) tau(i, i) += volumetric - mean;
    const Tensor3<T> F = H + Tensor3<T>::Identity();
    return tau * inverse_transpose(F);
  }
  /// With G = F^-T, c = mu J^(-2/3): c (d_ik d_jl - 2/3 (F_ij G_kl + G_ij F_kl))
  /// + (2/9 c tr C + kappa J^2) G_ij G_kl + (c tr C/3 - kappa/2 (J^2 - 1)) G_il G_kj [Pa].
  Tangent tangent(const Mat3& H) const;
  /// F_33 - 1 with P_33 = 0, by Newton in s = ln F_33. P_33 = 0 says A(s) = B(s) with
  /// A = 2/3 c e^(2s) + kappa/2 J^2, B = c (C_11 + C_22)/3 + kappa/2, J = J_2 e^s and c as
  /// above. The slope of f = ln A - ln B lies between 4/3 and 8/3, so that every step reduces
  /// the error, from everywhere; A - B is taken from the strains, without cancellation.
  template <class T> T plane_stress_stretch(const Tensor3<T>& H) const {
    using std::abs;
    using std::exp;
    const T j2 = H(0, 0) + H(1, 1) + H(0, 0) * H(1, 1) - H(0, 1) * H(1, 0);
    if (!(j2 > -1.0)) return T(std::numeric_limits<double>::quiet_NaN());
    const T log_J2 = log_one_plus(j2);
    const T strain = T(2.0) * (H(0, 0) + H(1, 1)) + H(0, 0) * H(0, 0) + H(1, 0) * H(1, 0) +
                     H(0, 1) * H(0, 1) + H(1, 1) * H(1, 1);  // C_11 + C_22 - 2
    const double half_kappa = 0.5 * bulk_modulus();
    T s = T(-lambda / (lambda + 2 * mu)) * log_J2;  // the linearised solution
    for (int i = 0; i < 60; ++i) {
      const T c = T(mu / 3) * exp(T((log_J2 + s) * T(-2.0) / T(3.0)));
      const T e = exp_minus_one(T(T(2.0) * s));
      const T q = exp_minus_one(T(T(2.0) * (log_J2 + s)));  // J^2 - 1
      const T difference = c * (T(2.0) * e - strain) + T(half_kappa) * q;
      const T c_B = c * (strain + T(2.0)), B = c_B + T(half_kappa), A = B + difference;
      const T slope_A = T(8.0 / 3) * c * (e + T(1.0)) + T(2 * half_kappa) * (q + T(1.0));
      const T slope = slope_A / A + T(2.0 / 3) * c_B / B;
      const T step = log_one_plus(T(difference / B)) / slope;
      s -= step;
      if (i > 3 && abs(step) <= 1e-17 + 1e-16 * abs(s)) break;
    }
    return exp_minus_one(s);
  }
};

/// St Venant-Kirchhoff solid: W = lambda/2 tr^2 E + mu E:E, S = lambda tr E I + 2 mu E.
struct StVenantKirchhoff {
  double lambda = 0, mu = 0;

  template <class T> T energy(const Tensor3<T>& H) const {
    const Tensor3<T> E = green_strain(H);
    const T trace = E(0, 0) + E(1, 1) + E(2, 2);
    return T(0.5 * lambda) * trace * trace + T(mu) * E.cwiseProduct(E).sum();
  }
  template <class T> Tensor3<T> second_piola(const Tensor3<T>& H) const {
    const Tensor3<T> E = green_strain(H);
    Tensor3<T> S = T(2 * mu) * E;
    const T trace = E(0, 0) + E(1, 1) + E(2, 2);
    for (int i = 0; i < 3; ++i) S(i, i) += T(lambda) * trace;
    return S;
  }
  template <class T> Tensor3<T> stress(const Tensor3<T>& H) const {
    const Tensor3<T> F = H + Tensor3<T>::Identity();
    return F * second_piola(H);
  }
  /// d_ik S_jl + lambda F_ij F_kl + mu ((F F^T)_ik d_jl + F_il F_kj) [Pa].
  Tangent tangent(const Mat3& H) const;
  /// F_33 - 1 with S_33 = 0: E_33 = -lambda (E_11 + E_22)/(lambda + 2 mu).
  template <class T> T plane_stress_stretch(const Tensor3<T>& H) const {
    using std::sqrt;
    Tensor3<T> plane = H;
    plane(2, 2) = T(0.0);
    const Tensor3<T> E = green_strain(plane);
    const T E33 = T(-lambda / (lambda + 2 * mu)) * (E(0, 0) + E(1, 1));
    return T(2.0) * E33 / (T(1.0) + sqrt(T(1.0) + T(2.0) * E33));
  }
};

/// The law of a problem with an elastic material: material model and what the third direction
/// does.
class ElasticLaw {
 public:
  ElasticLaw(const Material& material, Dimension dimension);
  /// H with the out-of-plane part that the dimension asks for: 3D as given; plane strain
  /// H_33 = 0; plane stress H_33 from P_33 = 0.
  Mat3 complete(const Mat3& H) const;
  /// Energy [J/m^3], stress [Pa] and tangent [Pa] at complete(H). In plane stress the tangent
  /// is condensed, A_ijkl - A_ij33 A_33kl / A_3333, so that it is the derivative of the
  /// in-plane stress along the constraint; its 33 row and column vanish.
  double energy(const Mat3& H) const;
  Mat3 stress(const Mat3& H) const;
  Tangent tangent(const Mat3& H) const;

 private:
  /// f(law) of the model at hand.
  template <class F> auto with_model(const F& f) const {
    switch (m_model) {
      case MaterialModel::neo_hookean:
        return f(NeoHookean{m_lambda, m_mu});
      case MaterialModel::neo_hookean_isochoric:
        return f(NeoHookeanIsochoric{m_lambda, m_mu});
      case MaterialModel::st_venant_kirchhoff:
        return f(StVenantKirchhoff{m_lambda, m_mu});
      case MaterialModel::j2_hencky:  // stress depends on history: methods hold that
        break;
    }
    throw std::logic_error("material model without an elastic law");
  }

  MaterialModel m_model;
  Dimension m_dimension;
  double m_lambda, m_mu;
};

/// Cauchy stress P F^T / J [Pa].
Mat3 cauchy_stress(const Mat3& P, const Mat3& F);
/// sqrt(3/2 s:s) of a symmetric stress, s its deviator [Pa].
double von_mises(const Mat3& sigma);
/// -tr sigma / 3 [Pa].
double pressure(const Mat3& sigma);

}  // namespace concord::scene
