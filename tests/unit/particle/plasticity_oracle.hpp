#pragma once
// Algorithm 2 of the Continuum Bond Method paper written once more, line by line and for any
// number type, with a logarithm and an exponential of matrices that know no eigenvalues: the
// oracle of the plasticity tests. Also their material and random tensors.

#include "particle/core/plasticity.hpp"
#include "scene/geometry.hpp"
#include "scene/material.hpp"

#include <Eigen/Geometry>
#include <unsupported/Eigen/AutoDiff>

#include <algorithm>
#include <cmath>

namespace concord::particle::plasticity_test {

using scene::Tensor3;
using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 9, 1>>;

inline double value_of(double x) { return x; }
inline double value_of(const Dual& x) { return x.value(); }

/// Table 1 of the paper, with another hardening where one is given.
inline scene::Material steel(scene::Hardening hardening = {450e6, 715e6, 129e6, 16.93}) {
  scene::Material m;
  const double kappa = 164.21e9;
  m.model = scene::MaterialModel::j2_hencky;
  m.mu = 80.19e9, m.lambda = kappa - 2 * m.mu / 3, m.rho0 = 7800;
  m.E = 9 * kappa * m.mu / (3 * kappa + m.mu), m.nu = m.E / (2 * m.mu) - 1;
  m.hardening = hardening;
  return m;
}

inline Mat3 random_matrix(std::uint64_t seed, double size, bool plane = false) {
  Mat3 H = Mat3::Zero();
  for (int i = 0; i < 9; ++i) {
    if (plane && (i / 3 == 2 || i % 3 == 2)) continue;
    H(i / 3, i % 3) =
        size * (2 * scene::uniform_random(seed, static_cast<std::uint64_t>(i), 0) - 1);
  }
  return H;
}

inline Mat3 random_rotation(std::uint64_t seed, bool plane = false) {
  const auto u = [&](int k) {
    return 2 * scene::uniform_random(seed, static_cast<std::uint64_t>(100 + k), 0) - 1;
  };
  const Vec3 axis = plane ? Vec3(0, 0, 1) : Vec3(u(0), u(1), u(2)).normalized();
  return Eigen::AngleAxisd(3.1 * u(3), axis).toRotationMatrix();
}

template <class T> Tensor3<T> inverse(const Tensor3<T>& B) {
  return scene::inverse_transpose(B).transpose();
}

template <class T> double distance(const Tensor3<T>& B, const Tensor3<T>& C) {
  double sum = 0;
  for (int i = 0; i < 9; ++i) {
    const double d = value_of(B(i / 3, i % 3)) - value_of(C(i / 3, i % 3));
    sum += d * d;
  }
  return std::sqrt(sum);
}

/// B^(1/2) by Denman and Beavers' iteration, which halves large and small eigenvalues towards
/// the root before it converges quadratically; the derivatives converge an iteration later.
template <class T> Tensor3<T> square_root(const Tensor3<T>& B) {
  Tensor3<T> Y = B, Z = Tensor3<T>::Identity();
  for (int it = 0; it < 24; ++it) {
    const Tensor3<T> next = T(0.5) * (Y + inverse(Z));
    Z = T(0.5) * (Z + inverse(Y));
    Y = next;
  }
  return Y;
}

/// ln B: square roots until B is near I, then 2 artanh((B - I)(B + I)^-1).
template <class T> Tensor3<T> logarithm(Tensor3<T> B) {
  const Tensor3<T> one = Tensor3<T>::Identity();
  double scale = 2;
  for (; distance(B, one) > 0.2; scale *= 2) B = square_root(B);
  const Tensor3<T> S = (B - one) * inverse(Tensor3<T>(B + one)), S2 = S * S;
  Tensor3<T> sum = Tensor3<T>::Zero();
  for (int k = 19; k >= 1; k -= 2) sum = T(1.0 / k) * one + S2 * sum;
  return T(scale) * S * sum;
}

/// e^B by its series at B/2^k and k squarings.
template <class T> Tensor3<T> exponential(Tensor3<T> B) {
  const Tensor3<T> one = Tensor3<T>::Identity();
  int squarings = 0;
  for (; distance(B, Tensor3<T>(Tensor3<T>::Zero())) > 0.2; ++squarings) B *= T(0.5);
  Tensor3<T> sum = one;
  for (int k = 14; k >= 1; --k) sum = one + T(1.0 / k) * (B * sum);
  for (; squarings > 0; --squarings) sum = (sum * sum).eval();
  return sum;
}

template <class T> struct OracleUpdate {
  Tensor3<T> P;
  T tau_eq, energy;  ///< energy: K/2 tr^2 e + mu dev e : dev e + Psi_p
  PlasticState state;
  bool yields = false;
};

/// tau_y0 + h(eps_p), Eq. (24).
template <class T> T oracle_flow_stress(const scene::Hardening& h, const T& eps) {
  using std::exp;
  return T(h.yield_stress) + T(h.modulus) * eps +
         T(h.saturation_stress - h.yield_stress) * (T(1.0) - exp(T(-h.exponent) * eps));
}

/// Line 7 to 12 of Algorithm 2, with a Newton iteration that carries the derivatives.
template <class T> T oracle_increment(const scene::Material& m, const T& tau_eq, double eps_p) {
  const scene::Hardening& h = m.hardening;
  T d(0.0);
  for (int it = 0; it < 60; ++it) {
    const T r = tau_eq - T(3 * m.mu) * d - oracle_flow_stress(h, T(T(eps_p) + d));
    const double slope = h.modulus + (h.saturation_stress - h.yield_stress) * h.exponent *
                                         std::exp(-h.exponent * (eps_p + value_of(d)));
    d += r / T(3 * m.mu + slope);
  }
  return d;
}

template <class T>
OracleUpdate<T> oracle_update(const scene::Material& m, const Tensor3<T>& F,
                              const PlasticState& old) {
  using std::sqrt;
  const double kappa = m.lambda + 2 * m.mu / 3;
  const Tensor3<T> one = Tensor3<T>::Identity();
  const Tensor3<T> C = (old.A + Mat3::Identity()).cast<T>();
  Tensor3<T> e = T(0.5) * logarithm(Tensor3<T>(F * C * F.transpose()));
  const T trace = e(0, 0) + e(1, 1) + e(2, 2);
  Tensor3<T> s = T(2 * m.mu) * (e - trace / T(3.0) * one);
  OracleUpdate<T> u;
  u.state = old;
  u.tau_eq = sqrt(T(T(1.5) * s.cwiseProduct(s).sum()));
  T eps(old.eps_p);
  u.yields = value_of(u.tau_eq) > oracle_flow_stress(m.hardening, old.eps_p);
  if (u.yields) {
    const T d = oracle_increment(m, u.tau_eq, old.eps_p);
    const Tensor3<T> N = T(1.5) / u.tau_eq * s;
    eps += d;
    e -= d * N;
    s -= T(2 * m.mu) * d * N;
    u.tau_eq -= T(3 * m.mu) * d;
    const Tensor3<T> G = inverse(F);
    const Tensor3<T> A = G * exponential(Tensor3<T>(T(2.0) * e)) * G.transpose() - one;
    for (int i = 0; i < 9; ++i) u.state.A(i / 3, i % 3) = value_of(A(i / 3, i % 3));
    u.state.eps_p = value_of(eps);
  }
  u.P = (s + T(kappa) * trace * one) * inverse(F).transpose();
  u.energy = T(0.5 * kappa) * trace * trace + T(1 / (4 * m.mu)) * s.cwiseProduct(s).sum();
  return u;
}

/// F with its nine components as the variables.
inline Tensor3<Dual> active(const Mat3& F) {
  Tensor3<Dual> A;
  for (int i = 0; i < 9; ++i) A(i / 3, i % 3) = Dual(F(i / 3, i % 3), 9, i);
  return A;
}

}  // namespace concord::particle::plasticity_test
