#pragma once
// The loops of one force evaluation, a range of particles at a time. Every particle sums over its own row of neighbours: no
// two threads write to one place, and the bits do not depend on how rows are dealt out. Numbers: README.md of this folder.

#include "particle/core/stress_kernel.hpp"
#include "sph_reference/total_lagrangian/neighbours.hpp"

namespace concord::sph {

using particle::broadcast;
using particle::lane_sum;
using particle::LameConstants;
using particle::Lanes;
using particle::load;
using particle::store;
using particle::stress_width;
using particle::StressLaw;
using particle::Vec;

typedef double v8d __attribute__((vector_size(64)));
using particle::v2d;
using particle::v4d;

/// Two spatial vectors in one register: T in the low half, H in the high half.
template <int Dim>
struct Twin;
template <>
struct Twin<3> {
  using type = v8d;
};
template <>
struct Twin<2> {
  using type = v4d;
};
CONCORD_INLINE v8d broadcast(double s, v8d) { return v8d{s, s, s, s, s, s, s, s}; }
CONCORD_INLINE v4d low(v8d a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); }
CONCORD_INLINE v4d high(v8d a) { return __builtin_shufflevector(a, a, 4, 5, 6, 7); }
CONCORD_INLINE v2d low(v4d a) { return __builtin_shufflevector(a, a, 0, 1); }
CONCORD_INLINE v2d high(v4d a) { return __builtin_shufflevector(a, a, 2, 3); }

/// State records: column k of a particle is [T_k | H_k], a cache line in 3D, so that one product with X_ab gives T X_ab and
/// H X_ab together.
template <int Dim>
inline constexpr std::size_t vector_size = Lanes<Dim>::stride;
template <int Dim>
inline constexpr std::size_t tensor_size = Dim * Lanes<Dim>::stride;
template <int Dim>
inline constexpr std::size_t record_size = 2 * tensor_size<Dim>;

/// Tensor of one particle in registers, column by column.
template <int Dim>
struct Tensor {
  Vec<Dim> column[Dim] = {};

  static CONCORD_INLINE Tensor load(const double* p, std::size_t step = vector_size<Dim>) {
    Tensor t;
    for (int k = 0; k < Dim; ++k) t.column[k] = particle::load<Vec<Dim>>(p + k * step);
    return t;
  }
  CONCORD_INLINE void store(double* p, std::size_t step = vector_size<Dim>) const {
    for (int k = 0; k < Dim; ++k) particle::store(p + k * step, column[k]);
  }
  /// this times the tensor in the columns at K
  CONCORD_INLINE Tensor times(const double* K) const {
    Tensor t;
    for (int j = 0; j < Dim; ++j) {
      for (int i = 0; i < Dim; ++i) t.column[j] += column[i] * broadcast(K[j * vector_size<Dim> + i], Vec<Dim>{});
    }
    return t;
  }
};

/// What the loops read and write; columns and records as above.
struct State {
  const double *X, *u, *v;  ///< v: only with viscosity
  const double* V;          ///< volumes, with thickness [m^3]
  double* records;
  double* f;
};

/// sum_b w_ab u_ab (x) X_ab over a row: H_a K_a (TLS.5). Two partial sums hide the latency of additions.
template <int Dim>
CONCORD_INLINE Tensor<Dim> moment_row(const Neighbours& rows, std::size_t a, const double* X, const double* u) {
  using V = Vec<Dim>;
  const V u_a = load<V>(u + a * vector_size<Dim>);
  V X_a[Dim];
  for (int i = 0; i < Dim; ++i) X_a[i] = broadcast(X[a * vector_size<Dim> + i], V{});
  Tensor<Dim> sum[2];
  const auto add = [&](std::size_t k, Tensor<Dim>& t) __attribute__((always_inline)) {
    const auto b = static_cast<std::size_t>(rows.other[k]);
    const V d = (load<V>(u + b * vector_size<Dim>) - u_a) * broadcast(rows.weight[k], V{});
    for (int i = 0; i < Dim; ++i) t.column[i] += d * (broadcast(X[b * vector_size<Dim> + i], V{}) - X_a[i]);
  };
  std::size_t k = rows.begin[a];
  const std::size_t end = rows.begin[a + 1];
  for (; k + 1 < end; k += 2) {
    add(k, sum[0]);
    add(k + 1, sum[1]);
  }
  if (k < end) add(k, sum[0]);
  for (int i = 0; i < Dim; ++i) sum[0].column[i] += sum[1].column[i];
  return sum[0];
}

/// H_a of particles [first, last) into their records: all that the penalty with a potential needs before the stress.
template <int Dim>
CONCORD_CLONES void gradients(const Neighbours& rows, std::size_t first, std::size_t last, const State& s) {
  for (std::size_t a = first; a < last; ++a) {
    const Tensor<Dim> H = moment_row<Dim>(rows, a, s.X, s.u).times(&rows.inverse_moment[a * tensor_size<Dim>]);
    H.store(s.records + a * record_size<Dim> + vector_size<Dim>, 2 * vector_size<Dim>);
  }
}

/// The penalty with a potential (TLS.11) on one row: f_a = sum_b k_ab l, and Q_a/V_a = -1/2 sum_b k_ab/V_a l (x) X_ab.
template <int Dim>
CONCORD_INLINE Tensor<Dim> potential_row(const Neighbours& rows, std::size_t a, const State& s) {
  using V = Vec<Dim>;
  constexpr std::size_t S = vector_size<Dim>, half = S, step = 2 * S;
  const V u_a = load<V>(s.u + a * S);
  const Tensor<Dim> H_a = Tensor<Dim>::load(s.records + a * record_size<Dim> + half, step);
  Tensor<Dim> Q;
  V f{};
  for (std::size_t k = rows.begin[a]; k < rows.begin[a + 1]; ++k) {
    const auto b = static_cast<std::size_t>(rows.other[k]);
    const double* H_b = s.records + b * record_size<Dim> + half;
    V l = (load<V>(s.u + b * S) - u_a) * broadcast(2.0, V{}), X_ab[Dim];
    for (int i = 0; i < Dim; ++i) {
      X_ab[i] = broadcast(s.X[b * S + i] - s.X[a * S + i], V{});
      l -= (load<V>(H_b + i * step) + H_a.column[i]) * X_ab[i];
    }
    l *= broadcast(0.5 * rows.stiffness[k], V{});
    f += l;
    l *= broadcast(-0.5, V{});
    for (int i = 0; i < Dim; ++i) Q.column[i] += l * X_ab[i];
  }
  store(s.f + a * S, f * broadcast(s.V[a], V{}));
  return Q;
}

/// H_a (TLS.5), P_a and T_a = P_a K_a^-1 (TLS.6) of particles [first, last), eight at a time. Potential: H_a is in the records
/// already; adds Q_a/V_a to P_a and sets f_a to the penalty force. Returns the first particle with det F <= 0 or NaN, or -1.
template <int Dim, StressLaw Law, bool Potential>
CONCORD_CLONES Index stresses(const Neighbours& rows, std::size_t first, std::size_t last, const LameConstants& c,
                              const State& s) {
  constexpr std::size_t S = vector_size<Dim>, step = 2 * S;
  alignas(64) double H[stress_width * tensor_size<Dim>], P[stress_width * tensor_size<Dim>];
  double one[stress_width];
  std::fill(one, one + stress_width, 1.0);
  Index bad_particle = -1;
  for (std::size_t group = first; group < last; group += stress_width) {
    const int count = static_cast<int>(std::min<std::size_t>(stress_width, last - group));
    for (int l = 0; l < count; ++l) {
      const std::size_t a = group + l;
      double* record = s.records + a * record_size<Dim>;
      if constexpr (Potential) {
        Tensor<Dim>::load(record + S, step).store(H + l * tensor_size<Dim>);
      } else {
        const Tensor<Dim> H_a = moment_row<Dim>(rows, a, s.X, s.u).times(&rows.inverse_moment[a * tensor_size<Dim>]);
        H_a.store(H + l * tensor_size<Dim>);
        H_a.store(record + S, step);
      }
    }
    const unsigned bad = particle::stress_of_group<Dim, Law>(c, count, one, H, P);
    if (bad != 0 && bad_particle < 0) bad_particle = static_cast<Index>(group) + __builtin_ctz(bad);
    for (int l = 0; l < count; ++l) {
      const std::size_t a = group + l;
      Tensor<Dim> P_a = Tensor<Dim>::load(P + l * tensor_size<Dim>);
      if constexpr (Potential) {
        const Tensor<Dim> Q = potential_row<Dim>(rows, a, s);
        for (int i = 0; i < Dim; ++i) P_a.column[i] += Q.column[i];
      }
      P_a.times(&rows.inverse_moment[a * tensor_size<Dim>]).store(s.records + a * record_size<Dim>, step);
    }
  }
  return bad_particle;
}

/// Monaghan's viscosity as the force loop wants it (TLS.12).
struct Viscosity {
  double linear = 0;     ///< alpha rho0 c_p h [Pa s]
  double quadratic = 0;  ///< beta rho0 h^2 [Pa s^2]
  double softening = 0;  ///< 0.01 h^2 [m^2]
};

/// What a force loop adds to the stress force of a neighbour.
struct WithoutPenalty {
  static constexpr bool adds_to_f = false, active = false;
};
struct AfterPotential : WithoutPenalty {
  static constexpr bool adds_to_f = true;
};
struct Ganzenmueller : WithoutPenalty {
  static constexpr bool active = true;
};

/// c so that c x_ab is the viscous force over V_a: -w_ab Pi, Pi = -linear d + quadratic d^2 for approaching particles, d =
/// v_ab.x_ab / (|x_ab|^2 + softening) < 0; zero for parting ones.
CONCORD_INLINE double viscous_factor(const Viscosity& eta, double w, double vx, double xx) {
  const double d = std::min(vx, 0.0) / (xx + eta.softening);
  return w * d * (eta.linear - eta.quadratic * d);
}

/// Row of (TLS.7): f_a = V_a sum_b { w_ab (T_a + T_b) X_ab + [kappa_ab (l_ab.x_ab)/|x_ab|^2 + viscous] x_ab }, with the local
/// displacement l_ab = u_ab - (H_a + H_b) X_ab / 2 (TLS.8) and x_ab = X_ab + u_ab.
template <int Dim, class Penalty, bool Viscous>
CONCORD_INLINE void force_row(const Neighbours& rows, std::size_t a, const Viscosity& eta, const State& s) {
  using V = Vec<Dim>;
  constexpr std::size_t S = vector_size<Dim>, step = 2 * S;
  constexpr bool twin = Penalty::active;
  using W = std::conditional_t<twin, typename Twin<Dim>::type, V>;
  const double* record = s.records + a * record_size<Dim>;
  const V X_a = load<V>(s.X + a * S), u_a = load<V>(s.u + a * S);
  W C_a[Dim], X_ai[Dim];
  for (int i = 0; i < Dim; ++i) {
    C_a[i] = load<W>(record + i * step);
    X_ai[i] = broadcast(s.X[a * S + i], W{});
  }
  V f{};
  for (std::size_t k = rows.begin[a]; k < rows.begin[a + 1]; ++k) {
    const auto b = static_cast<std::size_t>(rows.other[k]);
    const double* C_b = s.records + b * record_size<Dim>;
    W r{};  // [(T_a + T_b) X_ab | (H_a + H_b) X_ab]
    for (int i = 0; i < Dim; ++i) {
      r += (load<W>(C_b + i * step) + C_a[i]) * (broadcast(s.X[b * S + i], W{}) - X_ai[i]);
    }
    const double w = rows.weight[k];
    if constexpr (!twin) f += r * broadcast(w, V{});
    if constexpr (twin) f += low(r) * broadcast(w, V{});
    if constexpr (twin || Viscous) {
      const V u_ab = load<V>(s.u + b * S) - u_a, x = load<V>(s.X + b * S) - X_a + u_ab;
      const double xx = lane_sum(x * x);
      double factor = 0;
      if constexpr (twin) {
        const V l = u_ab - high(r) * broadcast(0.5, V{});
        factor = rows.stiffness[k] * lane_sum(l * x) / xx;  // (TLS.10)
      }
      if constexpr (Viscous) {
        const V v_ab = load<V>(s.v + b * S) - load<V>(s.v + a * S);
        factor += viscous_factor(eta, w, lane_sum(v_ab * x), xx);
      }
      f += x * broadcast(factor, V{});
    }
  }
  f *= broadcast(s.V[a], V{});
  if constexpr (Penalty::adds_to_f) f += load<V>(s.f + a * S);
  store(s.f + a * S, f);
}

/// Forces of particles [first, last) from the records of all.
template <int Dim, class Penalty, bool Viscous>
CONCORD_CLONES void forces(const Neighbours& rows, std::size_t first, std::size_t last, const Viscosity& eta,
                           const State& s) {
  for (std::size_t a = first; a < last; ++a) force_row<Dim, Penalty, Viscous>(rows, a, eta, s);
}

}  // namespace concord::sph
