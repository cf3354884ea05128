#pragma once
// Stress of W particles at a time, in lanes: the vectorised form of scene/material.hpp's laws,
// tested against it.

#include "particle/core/plasticity.hpp"
#include "particle/core/simd.hpp"

#include <algorithm>
#include <cmath>

namespace concord::particle {

/// Lame constants as the kernels want them.
struct LameConstants {
  double lambda, mu;  ///< [Pa]
};

/// The laws of scene/material.hpp; `isochoric` is NeoHookeanIsochoric. Where plane strain and
/// plane stress share a form, they share a law.
enum class StressLaw {
  neo_hookean,
  neo_hookean_plane_stress,
  isochoric,
  isochoric_plane_stress,
  st_venant_kirchhoff,
  j2_hencky  ///< with history: PlasticHistory
};

/// What the stress of a group of particles depends on beside H.
struct StressConstants {
  LameConstants lame;
  PlasticHistory* history = nullptr;  ///< of plastic laws, else unused
  bool keep_trial = true;             ///< plastic laws: whether the trial state is written
};

template <StressLaw Law>
inline constexpr bool is_isochoric =
    Law == StressLaw::isochoric || Law == StressLaw::isochoric_plane_stress;
/// Whether the loops solve for C_33 of the isochoric law; a plane-stress law means its solid
/// form in 3D.
template <int Dim, StressLaw Law>
inline constexpr bool condenses_isochoric =
    Dim == 2 && Law == StressLaw::isochoric_plane_stress;

/// Lanes a pass works on: one AVX-512 register, two AVX2 registers.
inline constexpr int stress_width = plastic_width;

/// ln(1 + j) for |j| <= 1/4 by 2 artanh(j/(2+j)), eleven terms: truncation below 1e-18,
/// relative error about 3e-16.
CONCORD_INLINE double log1p_near_one(double j) {
  const double s = j / (2.0 + j), z = s * s;
  double sum = 1.0 / 21;
  sum = sum * z + 1.0 / 19;
  sum = sum * z + 1.0 / 17;
  sum = sum * z + 1.0 / 15;
  sum = sum * z + 1.0 / 13;
  sum = sum * z + 1.0 / 11;
  sum = sum * z + 1.0 / 9;
  sum = sum * z + 1.0 / 7;
  sum = sum * z + 1.0 / 5;
  sum = sum * z + 1.0 / 3;
  sum = sum * z + 1.0;
  return 2.0 * s * sum;
}

/// e^x - 1 for |x| <= 1/5 by eleven terms of its series: truncation below 1e-17, relative error
/// about 2e-16.
CONCORD_INLINE double expm1_near_zero(double x) {
  double sum = 1.0 / 39916800;
  sum = sum * x + 1.0 / 3628800;
  sum = sum * x + 1.0 / 362880;
  sum = sum * x + 1.0 / 40320;
  sum = sum * x + 1.0 / 5040;
  sum = sum * x + 1.0 / 720;
  sum = sum * x + 1.0 / 120;
  sum = sum * x + 1.0 / 24;
  sum = sum * x + 1.0 / 6;
  sum = sum * x + 1.0 / 2;
  sum = sum * x + 1.0;
  return sum * x;
}

/// e^x likewise.
CONCORD_INLINE double exp_near_zero(double x) { return expm1_near_zero(x) + 1.0; }

/// ln J of a plane-stress neo-Hookean state from the in-plane ln J_2: solves P_33 = 0, i.e.
/// mu (exp(2s) - 1) + lambda (ln J_2 + s) = 0 for s = ln F_33 (monotone; Newton from the
/// linearised solution).
inline double plane_stress_log(const LameConstants& c, double log_j2) {
  double s = -c.lambda * log_j2 / (c.lambda + 2 * c.mu);
  for (int it = 0; it < 50; ++it) {
    const double g = c.mu * std::expm1(2 * s) + c.lambda * (log_j2 + s);
    const double step = g / (2 * c.mu * std::exp(2 * s) + c.lambda);
    s -= step;
    if (!(std::abs(step) > 1e-16 * (std::abs(s) + std::abs(log_j2)))) break;
  }
  return log_j2 + s;
}

/// What the third direction adds in plane stress, isochoric law.
struct PlaneStressState {
  double power;   ///< J^(-2/3), J of three dimensions
  double strain;  ///< C_33 - 1
};

/// P_33 = 0 in the form ln A(s) - ln B(s) = 0, s = ln F_33, of scene/material.hpp; Newton
/// converges from everywhere. strain = C_11 + C_22 - 2.
inline PlaneStressState plane_stress_state(const LameConstants& c, double log_j2,
                                           double strain) {
  const double half_kappa = 0.5 * c.lambda + c.mu / 3;
  double s = -c.lambda * log_j2 / (c.lambda + 2 * c.mu);
  for (int it = 0; it < 50; ++it) {
    const double b = c.mu / 3 * std::exp(-2.0 / 3 * (log_j2 + s)), e = std::expm1(2 * s);
    const double q = std::expm1(2 * (log_j2 + s)),
                 difference = b * (2 * e - strain) + half_kappa * q;  // A - B
    const double B = b * (strain + 2) + half_kappa, A = B + difference;
    const double slope =
        (8 * b * (e + 1) / 3 + 2 * half_kappa * (q + 1)) / A + 2 * b * (strain + 2) / (3 * B);
    const double step = std::log1p(difference / B) / slope;
    s -= step;
    if (!(std::abs(step) > 1e-16 * (std::abs(s) + std::abs(log_j2)))) break;
  }
  return {std::exp(-2.0 / 3 * (log_j2 + s)), std::expm1(2 * s)};
}

/// J - 1 of W lanes from H = F - I, H_ij = h[Dim j + i].
template <int Dim>
CONCORD_INLINE void volume_change(const double (&h)[Dim * Dim][stress_width],
                                  double (&j)[stress_width]) {
#pragma omp simd
  for (int l = 0; l < stress_width; ++l) {
    if constexpr (Dim == 3) {
      const double a = h[0][l], b = h[3][l], c = h[6][l], d = h[1][l], e = h[4][l], f = h[7][l],
                   g = h[2][l], k = h[5][l], m = h[8][l];
      const double minors = (a * e - b * d) + (a * m - c * g) + (e * m - f * k);
      const double det = a * (e * m - f * k) - b * (d * m - f * g) + c * (d * k - e * g);
      j[l] = (a + e + m) + minors + det;
    } else {
      j[l] = h[0][l] + h[3][l] + (h[0][l] * h[3][l] - h[2][l] * h[1][l]);
    }
  }
}

template <StressLaw Law>
CONCORD_INLINE void logarithms(const LameConstants& c, const double (&j)[stress_width],
                               double (&log_j)[stress_width]) {
  double largest = 0;
#pragma omp simd reduction(max : largest)
  for (int l = 0; l < stress_width; ++l) {
    log_j[l] = log1p_near_one(j[l]);
    largest = std::max(largest, std::abs(j[l]));
  }
  if (largest > 0.25) {  // each lane by its own size: no lane looks at another's values
    for (int l = 0; l < stress_width; ++l) {
      if (std::abs(j[l]) > 0.25) log_j[l] = std::log1p(std::max(j[l], -1.0));
    }
  }
  if constexpr (Law == StressLaw::neo_hookean_plane_stress) {
    for (int l = 0; l < stress_width; ++l) log_j[l] = plane_stress_log(c, log_j[l]);
  }
}

/// J^(-2/3) of W lanes from ln J.
CONCORD_INLINE void isochoric_powers(const double (&log_j)[stress_width],
                                     double (&power)[stress_width]) {
  int far = 0;
  for (int l = 0; l < stress_width; ++l) {
    power[l] = exp_near_zero(-2.0 / 3 * log_j[l]);
    far |= std::abs(log_j[l]) > 0.3;
  }
  if (far != 0) {
    for (int l = 0; l < stress_width; ++l) {
      if (std::abs(log_j[l]) > 0.3) power[l] = std::exp(-2.0 / 3 * log_j[l]);
    }
  }
}

/// J^(-2/3) and C_33 - 1 of W lanes in plane stress, from ln J_2 and H.
inline void plane_stress_states(const LameConstants& c, const double (&h)[4][stress_width],
                                const double (&log_j2)[stress_width],
                                double (&power)[stress_width],
                                double (&strain_33)[stress_width]) {
  for (int l = 0; l < stress_width; ++l) {
    const double h00 = h[0][l], h10 = h[1][l], h01 = h[2][l], h11 = h[3][l];
    const double strain = 2 * h00 + h00 * h00 + h10 * h10 + 2 * h11 + h01 * h01 + h11 * h11;
    const PlaneStressState state = plane_stress_state(c, log_j2[l], strain);
    power[l] = state.power, strain_33[l] = state.strain;
  }
}

/// First Piola-Kirchhoff stress of W particles, p like h. With 2E = H + H^T + H^T H (no
/// cancellation at small strain): neo-Hookean (53) in the form P = F^-T (2 mu E + lambda ln J
/// I); St Venant-Kirchhoff P = F (lambda tr E I + 2 mu E); isochoric P = F^-T (mu J^(-2/3) (2E
/// - tr(2E)/3 I) + kappa/2 (J^2 - 1) I), where in plane stress P_33 = 0 turns the diagonal part
/// into -mu J^(-2/3) (C_33 - 1) I. j receives J - 1. About 130 flops a particle in 3D,
/// isochoric 170.
template <int Dim, StressLaw Law>
CONCORD_INLINE void stress(const LameConstants& c, const double (&h)[Dim * Dim][stress_width],
                           double (&p)[Dim * Dim][stress_width], double (&j)[stress_width]) {
  volume_change<Dim>(h, j);
  double log_j[stress_width];
  if constexpr (Law != StressLaw::st_venant_kirchhoff) logarithms<Law>(c, j, log_j);
  double power[stress_width], strain_33[stress_width];
  if constexpr (condenses_isochoric<Dim, Law>)
    plane_stress_states(c, h, log_j, power, strain_33);
  else if constexpr (is_isochoric<Law>)
    isochoric_powers(log_j, power);
#pragma omp simd
  for (int l = 0; l < stress_width; ++l) {
    if constexpr (Dim == 3) {
      const double h00 = h[0][l], h10 = h[1][l], h20 = h[2][l], h01 = h[3][l], h11 = h[4][l],
                   h21 = h[5][l], h02 = h[6][l], h12 = h[7][l], h22 = h[8][l];
      double m00 = c.mu * (2 * h00 + h00 * h00 + h10 * h10 + h20 * h20);
      double m11 = c.mu * (2 * h11 + h01 * h01 + h11 * h11 + h21 * h21);
      double m22 = c.mu * (2 * h22 + h02 * h02 + h12 * h12 + h22 * h22);
      double m01 = c.mu * (h01 + h10 + h00 * h01 + h10 * h11 + h20 * h21);
      double m02 = c.mu * (h02 + h20 + h00 * h02 + h10 * h12 + h20 * h22);
      double m12 = c.mu * (h12 + h21 + h01 * h02 + h11 * h12 + h21 * h22);
      if constexpr (is_isochoric<Law>) {
        m00 *= power[l], m11 *= power[l], m22 *= power[l], m01 *= power[l], m02 *= power[l],
            m12 *= power[l];
      }
      const double f00 = 1 + h00, f11 = 1 + h11, f22 = 1 + h22;
      double a00, a10, a20, a01, a11, a21, a02, a12, a22, scale;
      if constexpr (Law == StressLaw::st_venant_kirchhoff) {
        const double volumetric = c.lambda / (2 * c.mu) * (m00 + m11 + m22);
        m00 += volumetric, m11 += volumetric, m22 += volumetric;
        a00 = f00, a10 = h10, a20 = h20, a01 = h01, a11 = f11, a21 = h21, a02 = h02, a12 = h12,
        a22 = f22;
        scale = 1;
      } else {
        double volumetric;
        if constexpr (is_isochoric<Law>)
          volumetric =
              (0.5 * c.lambda + c.mu / 3) * (j[l] * (2 + j[l])) - (m00 + m11 + m22) / 3;
        else
          volumetric = c.lambda * log_j[l];
        m00 += volumetric, m11 += volumetric, m22 += volumetric;
        a00 = f11 * f22 - h21 * h12, a10 = h21 * h02 - h01 * f22,
        a20 = h01 * h12 - f11 * h02;  // f_1 x f_2
        a01 = h12 * h20 - f22 * h10, a11 = f22 * f00 - h02 * h20,
        a21 = h02 * h10 - h12 * f00;  // f_2 x f_0
        a02 = h10 * h21 - h20 * f11, a12 = h20 * h01 - f00 * h21,
        a22 = f00 * f11 - h10 * h01;  // f_0 x f_1
        scale = 1 / (1 + j[l]);
      }
      p[0][l] = scale * (a00 * m00 + a01 * m01 + a02 * m02);
      p[1][l] = scale * (a10 * m00 + a11 * m01 + a12 * m02);
      p[2][l] = scale * (a20 * m00 + a21 * m01 + a22 * m02);
      p[3][l] = scale * (a00 * m01 + a01 * m11 + a02 * m12);
      p[4][l] = scale * (a10 * m01 + a11 * m11 + a12 * m12);
      p[5][l] = scale * (a20 * m01 + a21 * m11 + a22 * m12);
      p[6][l] = scale * (a00 * m02 + a01 * m12 + a02 * m22);
      p[7][l] = scale * (a10 * m02 + a11 * m12 + a12 * m22);
      p[8][l] = scale * (a20 * m02 + a21 * m12 + a22 * m22);
    } else {
      const double h00 = h[0][l], h10 = h[1][l], h01 = h[2][l], h11 = h[3][l];
      double m00 = c.mu * (2 * h00 + h00 * h00 + h10 * h10);
      double m11 = c.mu * (2 * h11 + h01 * h01 + h11 * h11);
      double m01 = c.mu * (h01 + h10 + h00 * h01 + h10 * h11);
      if constexpr (is_isochoric<Law>) m00 *= power[l], m11 *= power[l], m01 *= power[l];
      const double f00 = 1 + h00, f11 = 1 + h11;
      double a00, a10, a01, a11, scale;
      if constexpr (Law == StressLaw::st_venant_kirchhoff) {
        const double volumetric = c.lambda / (2 * c.mu) * (m00 + m11);
        m00 += volumetric, m11 += volumetric;
        a00 = f00, a10 = h10, a01 = h01, a11 = f11, scale = 1;
      } else {
        double volumetric;
        if constexpr (condenses_isochoric<Dim, Law>)
          volumetric = -c.mu * power[l] * strain_33[l];
        else if constexpr (is_isochoric<Law>)
          volumetric = (0.5 * c.lambda + c.mu / 3) * (j[l] * (2 + j[l])) - (m00 + m11) / 3;
        else
          volumetric = c.lambda * log_j[l];
        m00 += volumetric, m11 += volumetric;
        a00 = f11, a10 = -h01, a01 = -h10, a11 = f00, scale = 1 / (1 + j[l]);
      }
      p[0][l] = scale * (a00 * m00 + a01 * m01);
      p[1][l] = scale * (a10 * m00 + a11 * m01);
      p[2][l] = scale * (a00 * m01 + a01 * m11);
      p[3][l] = scale * (a10 * m01 + a11 * m11);
    }
  }
}

/// Stress of the lanes of `count` <= W consecutive particles from `first` on, h and p as in
/// stress(). Returns a bit a particle with det F <= 0 or NaN.
template <int Dim, StressLaw Law>
CONCORD_INLINE unsigned stress_of_lanes(const StressConstants& c, Index first, int count,
                                        const double (&h)[Dim * Dim][stress_width],
                                        double (&p)[Dim * Dim][stress_width]) {
  double j[stress_width];
  if constexpr (Law == StressLaw::j2_hencky)
    c.history->stress(first, count, h, p, j, c.keep_trial);
  else
    stress<Dim, Law>(c.lame, h, p, j);
  unsigned bad = 0;
  for (int l = 0; l < count; ++l) bad |= (j[l] > -1.0 ? 0u : 1u) << l;
  return bad;
}

/// Stress of `count` <= W consecutive particles. H holds V_a H_a on entry and H_a on return; P
/// is written; both are columns of Dim vectors a particle. Returns a bit a particle with det F
/// <= 0 or NaN.
template <int Dim, StressLaw Law>
CONCORD_INLINE unsigned stress_of_group(const StressConstants& c, Index first, int count,
                                        const double* inverse_V, double* H, double* P) {
  constexpr int S = Lanes<Dim>::stride;
  double h[Dim * Dim][stress_width], p[Dim * Dim][stress_width];
  for (int l = 0; l < stress_width; ++l) {
    const int a = l < count ? l : count - 1;
    const double scale = inverse_V[a];
    double* Ha = H + static_cast<std::size_t>(a) * Dim * S;
    for (int k = 0; k < Dim; ++k) {
      const Vec<Dim> column = load<Vec<Dim>>(Ha + k * S) * broadcast(scale, Vec<Dim>{});
      if (l < count) store(Ha + k * S, column);
      for (int i = 0; i < Dim; ++i) h[k * Dim + i][l] = l < count ? column[i] : 0.0;
    }
  }
  const unsigned bad = stress_of_lanes<Dim, Law>(c, first, count, h, p);
  for (int l = 0; l < count; ++l) {
    double* Pa = P + static_cast<std::size_t>(l) * Dim * S;
    for (int k = 0; k < Dim; ++k) {
      Vec<Dim> column{};
      for (int i = 0; i < Dim; ++i) column[i] = p[k * Dim + i][l];
      store(Pa + k * S, column);
    }
  }
  return bad;
}

}  // namespace concord::particle
