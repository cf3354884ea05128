#include "particle/core/plasticity_plane.hpp"

#include "particle/core/features.hpp"
#include "particle/core/stress_kernel.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace concord::particle {

namespace {

constexpr int W = plastic_width;
using Row = double[W];

/// 1 where |x| <= bound, else 0; 0 where x is not a number.
CONCORD_INLINE double within(double x, double bound) {
  return std::abs(x) <= bound ? 1.0 : 0.0;
}

/// asinh(s)/s from z = s^2 <= 1/64: sum (-z)^n (2n)!/(4^n n!^2 (2n + 1)), nine terms,
/// truncation below 1e-18.
CONCORD_INLINE double asinh_over_argument(double z) {
  double sum = 6435.0 / 557056;
  sum = sum * z - 143.0 / 10240;
  sum = sum * z + 231.0 / 13312;
  sum = sum * z - 63.0 / 2816;
  sum = sum * z + 35.0 / 1152;
  sum = sum * z - 5.0 / 112;
  sum = sum * z + 3.0 / 40;
  sum = sum * z - 1.0 / 6;
  return sum * z + 1.0;
}

/// sinh(x)/x from y = x^2 <= 1/64: truncation y^6/13! below 1e-20.
CONCORD_INLINE double sinh_over_argument(double y) {
  double sum = 1 + y * (1.0 / 110);
  sum = 1 + y * (1.0 / 72) * sum;
  sum = 1 + y * (1.0 / 42) * sum;
  sum = 1 + y * (1.0 / 20) * sum;
  return 1 + y * (1.0 / 6) * sum;
}

/// cosh(x) - 1 likewise: relative truncation below 1e-18.
CONCORD_INLINE double cosh_minus_one(double y) {
  double sum = 1 + y * (1.0 / 90);
  sum = 1 + y * (1.0 / 56) * sum;
  sum = 1 + y * (1.0 / 30) * sum;
  sum = 1 + y * (1.0 / 12) * sum;
  return 0.5 * y * sum;
}

/// e^x for x <= 0 (below -700: e^-700): x = k ln 2 + r, e^x = 2^k (e^(r/2))^2. k is read from
/// the last bits of x/ln 2 + 1.5 2^52.
CONCORD_INLINE double exp_of_negative(double x) {
  constexpr double shift = 0x1.8p52;
  constexpr double ln2_high =
      0x1.62e42feep-1;  // ln 2 in 32 bits: its products with k are exact
  constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  x = x < -700.0 ? -700.0 : x;
  const double shifted = x * std::numbers::log2e + shift, k = shifted - shift;
  const double r = (x - k * ln2_high) - k * ln2_low;
  const double root = exp_near_zero(0.5 * r);
  const auto bits = (std::bit_cast<std::uint64_t>(shifted) + 1023) << 52;
  return root * root * std::bit_cast<double>(bits);
}

/// Trial strains of the lanes. In the plane ln b_e has the mean (ln J - w) and the deviator
/// ratio (half, shear; shear, -half) with ratio = d/r, d = e_1 - e_2 = asinh(r/D).
struct Trial {
  Row metric11, metric22, metric12;  ///< F F^T - I
  Row half, shear;                   ///< (b_11 - b_22)/2, b_12
  Row ratio;                         ///< d/r
  Row d2;                            ///< d^2
  Row v;                             ///< e_33 - tr e/3
  Row log_J, inverse_J;
  Row q;      ///< trial tau_eq [Pa]
  Row decay;  ///< exp(-alpha eps_p)
  Row yield;  ///< tau_y(eps_p) [Pa]
  Row flows;  ///< 1 where q > tau_y(eps_p), else 0
  Row near;   ///< 1 where the series hold, else 0
};

CONCORD_INLINE void trial_strains(const PlaneLaw& law, const double (&h)[4][W],
                                  const PlaneStates& old, double (&j)[W], Trial& t) {
  const scene::Hardening& c = law.hardening;
#pragma omp simd
  for (int l = 0; l < W; ++l) {
    const double h00 = h[0][l], h10 = h[1][l], h01 = h[2][l], h11 = h[3][l];
    const double f00 = 1 + h00, f11 = 1 + h11;
    const double A11 = old.A11[l], A22 = old.A22[l], A12 = old.A12[l], A33 = old.A33[l];
    const double m11 = 2 * h00 + h00 * h00 + h01 * h01;
    const double m22 = 2 * h11 + h10 * h10 + h11 * h11;
    const double m12 = h01 + h10 + h00 * h10 + h01 * h11;
    const double g00 = f00 * A11 + h01 * A12, g01 = f00 * A12 + h01 * A22;  // F A
    const double g10 = h10 * A11 + f11 * A12, g11 = h10 * A12 + f11 * A22;
    const double half =
        0.5 * ((m11 - m22) + ((g00 * f00 + g01 * h01) - (g10 * h10 + g11 * f11)));
    const double shear = m12 + (g00 * h10 + g01 * f11);
    const double change = h00 + h11 + (h00 * h11 - h01 * h10);
    const double inverse_J = 1 / (1 + change);
    const double log_J = log1p_near_one(change), w = 0.5 * log1p_near_one(A33);
    // D^2 = b_1 b_2 = J^2/(1 + A_33).
    const double inverse_D2 = (1 + A33) * inverse_J * inverse_J;
    const double r2 = half * half + shear * shear, z = r2 * inverse_D2;
    const double ratio = asinh_over_argument(z) * std::sqrt(inverse_D2);
    const double d2 = ratio * ratio * r2, v = w - log_J * (1.0 / 3);
    const double decay = exp_of_negative(-c.exponent * old.eps_p[l]);
    t.metric11[l] = m11, t.metric22[l] = m22, t.metric12[l] = m12;
    t.half[l] = half, t.shear[l] = shear, t.ratio[l] = ratio, t.d2[l] = d2, t.v[l] = v;
    t.log_J[l] = log_J, t.inverse_J[l] = inverse_J, t.decay[l] = decay;
    t.q[l] = law.mu * std::sqrt(9 * v * v + 3 * d2);
    t.yield[l] = c.saturation_stress + c.modulus * old.eps_p[l] -
                 (c.saturation_stress - c.yield_stress) * decay;
    t.near[l] = within(change, 0.25) * within(A33, 0.25) * within(z, 1.0 / 64);
    j[l] = change;
  }
}

/// The flowing lanes take the new values, the others keep the old ones bit for bit.
CONCORD_INLINE void choose(const Row& flows, const Row& flowing, const Row& still,
                           Row& chosen) {
#pragma omp simd
  for (int l = 0; l < W; ++l) chosen[l] = flows[l] > 0 ? flowing[l] : still[l];
}

/// Radial return (PLA.3): beta = tau_y(new)/q in flowing lanes, from three steps of Newton's
/// method from d = 0. Converged: q - 3 mu d and tau_y are equal to the round-off of their
/// terms.
CONCORD_INLINE void return_map(const PlaneLaw& law, const PlaneStates& old, Trial& t,
                               PlaneStates& next, Row& beta) {
  const scene::Hardening& c = law.hardening;
  const double rise = c.saturation_stress - c.yield_stress, slope = 3 * law.mu + c.modulus;
  constexpr double tolerance = 16 * std::numeric_limits<double>::epsilon();
  Row ratio, eps_p, near;
#pragma omp simd
  for (int l = 0; l < W; ++l) {
    const double q = t.q[l], before = t.decay[l];
    const double base = c.saturation_stress + c.modulus * old.eps_p[l];
    double d = (q - t.yield[l]) / (slope + rise * c.exponent * before);
    double decay = before * exp_near_zero(-c.exponent * d);
    d += (q - slope * d - (base - rise * decay)) / (slope + rise * c.exponent * decay);
    decay = before * exp_near_zero(-c.exponent * d);
    d += (q - slope * d - (base - rise * decay)) / (slope + rise * c.exponent * decay);
    decay = before * exp_near_zero(-c.exponent * d);
    const double tau = base + c.modulus * d - rise * decay;
    const double rest = q - 3 * law.mu * d - tau;
    near[l] = within(rest, tolerance * q) * within(c.exponent * d, 0.2);
    ratio[l] = tau / q;
    eps_p[l] = old.eps_p[l] + d;
  }
  const Row one = {1, 1, 1, 1, 1, 1, 1, 1};
  choose(t.flows, ratio, one, beta);
  choose(t.flows, eps_p, old.eps_p, next.eps_p);
  choose(t.flows, near, one, near);
  for (int l = 0; l < W; ++l) t.near[l] *= near[l];
}

/// (PLA.4) of flowing lanes, b_e in the trial's axes with strains beta
/// v, beta d; see plastic_metric() in plasticity.cpp.
CONCORD_INLINE void new_metric(const double (&h)[4][W], const PlaneStates& old, Trial& t,
                               const Row& beta, PlaneStates& next) {
  Row a11, a22, a33, a12, near;
#pragma omp simd
  for (int l = 0; l < W; ++l) {
    const double v = beta[l] * t.v[l], d2 = beta[l] * beta[l] * t.d2[l];
    const double twice_e33 = 2 * (v + t.log_J[l] * (1.0 / 3));
    const double log_D = t.log_J[l] * (2.0 / 3) - v;
    const double D = expm1_near_zero(log_D);
    const double mean = D + (1 + D) * cosh_minus_one(d2);  // (b_11 + b_22)/2 - 1
    const double skew = (1 + D) * sinh_over_argument(d2) * beta[l] * t.ratio[l];
    const double m11 = t.metric11[l], m22 = t.metric22[l], m12 = t.metric12[l];
    const double one = 1 - within(m11, 0.5) * within(m22, 0.5) * within(m12, 0.5);  // 1: far
    const bool far = one > 0;
    const double s11 = mean + skew * t.half[l] - (far ? -1.0 : m11);
    const double s22 = mean - skew * t.half[l] - (far ? -1.0 : m22);
    const double s12 = skew * t.shear[l] - (far ? 0.0 : m12);
    const double i = t.inverse_J[l];
    const double a = (1 + h[3][l]) * i, b = -h[2][l] * i;  // F^-1 = (a, b; c, d)
    const double c = -h[1][l] * i, d = (1 + h[0][l]) * i;
    a11[l] = a * a * s11 + 2 * a * b * s12 + b * b * s22 - one;
    a22[l] = c * c * s11 + 2 * c * d * s12 + d * d * s22 - one;
    a12[l] = a * c * s11 + (a * d + b * c) * s12 + b * d * s22;
    a33[l] = expm1_near_zero(twice_e33);
    near[l] = within(log_D, 0.2) * within(twice_e33, 0.2);
  }
  choose(t.flows, a11, old.A11, next.A11);
  choose(t.flows, a22, old.A22, next.A22);
  choose(t.flows, a33, old.A33, next.A33);
  choose(t.flows, a12, old.A12, next.A12);
  const Row one = {1, 1, 1, 1, 1, 1, 1, 1};
  choose(t.flows, near, one, near);
  for (int l = 0; l < W; ++l) t.near[l] *= near[l];
}

/// (PLA.5), tau = kappa ln J I + 2 mu beta dev e.
CONCORD_INLINE void piola_stress(const PlaneLaw& law, const double (&h)[4][W], const Trial& t,
                                 const Row& beta, double (&p)[4][W]) {
#pragma omp simd
  for (int l = 0; l < W; ++l) {
    const double scale = law.mu * beta[l], i = t.inverse_J[l];
    const double mean = law.kappa * t.log_J[l] - scale * t.v[l];
    const double half = scale * t.ratio[l] * t.half[l];
    const double t11 = mean + half, t22 = mean - half, t12 = scale * t.ratio[l] * t.shear[l];
    const double f00 = 1 + h[0][l], h10 = h[1][l], h01 = h[2][l], f11 = 1 + h[3][l];
    p[0][l] = (t11 * f11 - t12 * h01) * i;
    p[1][l] = (t12 * f11 - t22 * h01) * i;
    p[2][l] = (t12 * f00 - t11 * h10) * i;
    p[3][l] = (t22 * f00 - t12 * h10) * i;
  }
}

/// The lanes of a group of which at least one flows; an elastic one takes the values that it
/// has among elastic ones. Out of line: elastic groups have no more of it than the trial state
/// at hand.
__attribute__((noinline)) CONCORD_CLONES void flow(const PlaneLaw& law, const double (&h)[4][W],
                                                   const PlaneStates& old, Trial& t,
                                                   PlaneStates& next, double (&p)[4][W]) {
  if constexpr (!features::return_map) std::abort();
  Row beta;
  return_map(law, old, t, next, beta);
  new_metric(h, old, t, beta, next);
  piola_stress(law, h, t, beta, p);
}

}  // namespace

CONCORD_CLONES unsigned plane_lanes(const PlaneLaw& law, const double (&h)[4][W],
                                    const PlaneStates& old, PlaneStates& next,
                                    double (&p)[4][W], double (&j)[W]) {
  Trial t;
  trial_strains(law, h, old, j, t);
  double flowing = 0;
  for (int l = 0; l < W; ++l) t.flows[l] = t.q[l] > t.yield[l] ? 1 : 0;
  for (int l = 0; l < W; ++l) flowing += t.flows[l];
  if (flowing > 0) {
    flow(law, h, old, t, next, p);
  } else {
    constexpr Row elastic = {1, 1, 1, 1, 1, 1, 1, 1};
    next = old;
    piola_stress(law, h, t, elastic, p);
  }
  unsigned beyond = 0;
  for (int l = 0; l < W; ++l) beyond |= (t.near[l] == 1 ? 0u : 1u) << l;
  return beyond;
}

}  // namespace concord::particle
