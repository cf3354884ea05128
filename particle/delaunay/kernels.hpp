#pragma once
// The loops of one force evaluation of the Delaunay method, a block of particles at a time.
// Each reads like the paper; numbers in parentheses are its equations. Columns: Dim vectors a
// particle for tensors.

#include "particle/core/stress_kernel.hpp"
#include "particle/delaunay/bonds.hpp"

namespace concord::particle::delaunay {

/// Tensor of one particle in registers, column by column.
template <int Dim> struct Tensor {
  Vec<Dim> column[Dim];

  static CONCORD_INLINE Tensor load(const double* p) {
    Tensor t;
    for (int k = 0; k < Dim; ++k)
      t.column[k] = particle::load<Vec<Dim>>(p + k * Lanes<Dim>::stride);
    return t;
  }
  CONCORD_INLINE void store(double* p) const {
    for (int k = 0; k < Dim; ++k) particle::store(p + k * Lanes<Dim>::stride, column[k]);
  }
  /// this += d (x) B
  CONCORD_INLINE void add_outer(Vec<Dim> d, const double* B) {
    for (int k = 0; k < Dim; ++k) column[k] += d * broadcast(B[k], Vec<Dim>{});
  }
  /// this += d (x) X, X in a register
  CONCORD_INLINE void add_outer(Vec<Dim> d, Vec<Dim> X) {
    column[0] += d * lane<0>(X);
    column[1] += d * lane<1>(X);
    if constexpr (Dim == 3) column[2] += d * lane<2>(X);
  }
  /// this X, X in a register
  CONCORD_INLINE Vec<Dim> times(Vec<Dim> X) const {
    Vec<Dim> r = column[0] * lane<0>(X) + column[1] * lane<1>(X);
    if constexpr (Dim == 3) r += column[2] * lane<2>(X);
    return r;
  }
  /// this B
  CONCORD_INLINE Vec<Dim> times(const double* B) const {
    Vec<Dim> r = column[0] * broadcast(B[0], Vec<Dim>{});
    for (int k = 1; k < Dim; ++k) r += column[k] * broadcast(B[k], Vec<Dim>{});
    return r;
  }
};

template <int Dim> inline constexpr std::size_t vector_size = Lanes<Dim>::stride;
template <int Dim> inline constexpr std::size_t tensor_size = Dim* Lanes<Dim>::stride;

/// Row r of V_a H_a = sum_b u_ab (x) B_ab (32); inner bonds add to both ends: u_ba (x) B_ba =
/// u_ab (x) B_ab off the surface.
template <int Dim, bool Surface>
CONCORD_INLINE void gradient_row(const BondRows& rows, Index first, Index r, const double* u,
                                 double* H) {
  const Index begin = rows.begin[r], cut = rows.cut[r], end = rows.begin[r + 1];
  if (begin == end) return;
  const Index a = first + r;
  const Vec<Dim> u_a = load<Vec<Dim>>(u + a * vector_size<Dim>);
  Tensor<Dim> H_a = Tensor<Dim>::load(H + a * tensor_size<Dim>);
  for (Index k = begin; k < cut; ++k) {
    const Index b = rows.other[k];
    const double* B = &rows.B[static_cast<std::size_t>(k) * bond_record];
    const Vec<Dim> u_ab = load<Vec<Dim>>(u + b * vector_size<Dim>) - u_a;
    H_a.add_outer(u_ab, B);
    Tensor<Dim> H_b = Tensor<Dim>::load(H + b * tensor_size<Dim>);
    if constexpr (Surface) {
      H_b.add_outer(-u_ab, &rows.B_reverse[static_cast<std::size_t>(k) * bond_record]);
    } else {
      H_b.add_outer(u_ab, B);
    }
    H_b.store(H + b * tensor_size<Dim>);
  }
  for (Index k = cut; k < end; ++k) {
    const Vec<Dim> u_ab = load<Vec<Dim>>(u + rows.other[k] * vector_size<Dim>) - u_a;
    H_a.add_outer(u_ab, &rows.B[static_cast<std::size_t>(k) * bond_record]);
  }
  H_a.store(H + a * tensor_size<Dim>);
}

/// V_a H_a of a block; with u replaced by v, V_a dF_a/dt (34).
template <int Dim>
CONCORD_CLONES void volume_gradients(const BondBlock& block, const double* u, double* H) {
  const Index rows = block.last - block.first;
  std::fill(H + block.first * tensor_size<Dim>, H + block.last * tensor_size<Dim>, 0.0);
  for (Index r = 0; r < rows; ++r) gradient_row<Dim, true>(block.surface, block.first, r, u, H);
  for (Index r = 0; r < rows; ++r)
    gradient_row<Dim, false>(block.regular, block.first, r, u, H);
}

/// H_a and P_a (53) of a block, and f_a = 0. The stress follows as soon as a group of rows is
/// complete, while H is in cache. Returns the first particle with det F <= 0 or NaN, or -1.
template <int Dim, StressLaw Law>
CONCORD_CLONES Index gradients_and_stress(const BondBlock& block, const StressConstants& c,
                                          const double* inverse_V, const double* u, double* H,
                                          double* P, double* f) {
  const Index rows = block.last - block.first;
  std::fill(H + block.first * tensor_size<Dim>, H + block.last * tensor_size<Dim>, 0.0);
  std::fill(f + block.first * vector_size<Dim>, f + block.last * vector_size<Dim>, 0.0);
  for (Index r = 0; r < rows; ++r) gradient_row<Dim, true>(block.surface, block.first, r, u, H);
  Index bad_particle = -1;
  for (Index r = 0; r < rows; r += stress_width) {
    const Index count = std::min<Index>(stress_width, rows - r);
    for (Index i = 0; i < count; ++i)
      gradient_row<Dim, false>(block.regular, block.first, r + i, u, H);
    const Index a = block.first + r;
    const unsigned bad = stress_of_group<Dim, Law>(
        c, a, count, inverse_V + a, H + a * tensor_size<Dim>, P + a * tensor_size<Dim>);
    if (bad != 0 && bad_particle < 0) bad_particle = a + __builtin_ctz(bad);
  }
  return bad_particle;
}

/// One bond of the contact law (56)-(60): u_loc = u_ab - (H_a + H_b) X_ab / 2 (7), with x_ab =
/// X_ab + u_ab. Isotropic: K_n = K_t (59).
template <int Dim, bool Isotropic>
CONCORD_INLINE void contact_law(Vec<Dim> u_ab, Vec<Dim> X_ab, const Tensor<Dim>& H_sum,
                                double K_n, double K_t, Vec<Dim>& p, Vec<Dim>& q) {
  const Vec<Dim> local = u_ab - H_sum.times(X_ab) * broadcast(0.5, Vec<Dim>{});
  if constexpr (Isotropic) {
    p = q = local * broadcast(K_n, Vec<Dim>{});
  } else {
    const Vec<Dim> x_ab = X_ab + u_ab;
    const double s = lane_sum(local * x_ab) / lane_sum(x_ab * x_ab);
    const Vec<Dim> normal = x_ab * broadcast(s, Vec<Dim>{});
    const Vec<Dim> tangential = local - normal;
    q = normal * broadcast(K_n, Vec<Dim>{}) + tangential * broadcast(K_t, Vec<Dim>{});  // (58)
    p = q + tangential * broadcast((K_n - K_t) * s, Vec<Dim>{});                        // (57)
  }
}

/// K_n = normal A_ab / L_ab, K_t = tangential A_ab / L_ab (60): xi_n E and xi_t G [Pa].
struct ContactFactors {
  double normal, tangential;
};

/// State that the contact pass reads and writes.
struct ContactColumns {
  const double *X, *u, *H, *inverse_V;
  double *P, *f;
};

/// f_a += p_ab and P_a += Q_a / V_a with Q_a = -1/2 sum_b q_ab (x) X_ab (the adjoint of the
/// second-neighbour sum in (50)).
template <int Dim, bool Isotropic>
CONCORD_INLINE void contact_row(const BondRows& rows, Index first, Index r,
                                const ContactFactors& factors, const ContactColumns& s) {
  const Index begin = rows.begin[r], cut = rows.cut[r], end = rows.begin[r + 1];
  if (begin == end) return;
  const Index a = first + r;
  const Vec<Dim> u_a = load<Vec<Dim>>(s.u + a * vector_size<Dim>),
                 X_a = load<Vec<Dim>>(s.X + a * vector_size<Dim>);
  const Tensor<Dim> H_a = Tensor<Dim>::load(s.H + a * tensor_size<Dim>);
  Tensor<Dim> P_a = Tensor<Dim>::load(s.P + a * tensor_size<Dim>);
  Vec<Dim> f_a = load<Vec<Dim>>(s.f + a * vector_size<Dim>);
  const double w_a = 0.5 * s.inverse_V[a];
  for (Index k = begin; k < end; ++k) {
    const Index b = rows.other[k];
    const double area_over_length = rows.B[static_cast<std::size_t>(k) * bond_record + Dim];
    const Vec<Dim> u_ab = load<Vec<Dim>>(s.u + b * vector_size<Dim>) - u_a;
    const Vec<Dim> X_ab = load<Vec<Dim>>(s.X + b * vector_size<Dim>) - X_a;
    Tensor<Dim> H_sum = Tensor<Dim>::load(s.H + b * tensor_size<Dim>);
    for (int i = 0; i < Dim; ++i) H_sum.column[i] += H_a.column[i];
    Vec<Dim> p, q;
    contact_law<Dim, Isotropic>(u_ab, X_ab, H_sum, factors.normal * area_over_length,
                                factors.tangential * area_over_length, p, q);
    f_a += p;
    P_a.add_outer(q * broadcast(-w_a, Vec<Dim>{}), X_ab);
    if (k >= cut) continue;
    store(s.f + b * vector_size<Dim>, load<Vec<Dim>>(s.f + b * vector_size<Dim>) - p);
    Tensor<Dim> P_b = Tensor<Dim>::load(s.P + b * tensor_size<Dim>);
    P_b.add_outer(q * broadcast(-0.5 * s.inverse_V[b], Vec<Dim>{}), X_ab);
    P_b.store(s.P + b * tensor_size<Dim>);
  }
  P_a.store(s.P + a * tensor_size<Dim>);
  store(s.f + a * vector_size<Dim>, f_a);
}

template <int Dim, bool Isotropic>
CONCORD_CLONES void contact(const BondBlock& block, const ContactFactors& factors,
                            const ContactColumns& s) {
  const Index rows = block.last - block.first;
  for (Index r = 0; r < rows; ++r)
    contact_row<Dim, Isotropic>(block.surface, block.first, r, factors, s);
  for (Index r = 0; r < rows; ++r)
    contact_row<Dim, Isotropic>(block.regular, block.first, r, factors, s);
}

/// f_a += sum_b (P_a B_ab - P_b B_ba) (46); off the surface (P_a + P_b) B_ab.
template <int Dim, bool Surface>
CONCORD_INLINE void force_row(const BondRows& rows, Index first, Index r, const double* P,
                              double* f) {
  const Index begin = rows.begin[r], cut = rows.cut[r], end = rows.begin[r + 1];
  if (begin == end) return;
  const Index a = first + r;
  const Tensor<Dim> P_a = Tensor<Dim>::load(P + a * tensor_size<Dim>);
  Vec<Dim> f_a = load<Vec<Dim>>(f + a * vector_size<Dim>);
  for (Index k = begin; k < end; ++k) {
    const Index b = rows.other[k];
    const double* B = &rows.B[static_cast<std::size_t>(k) * bond_record];
    Tensor<Dim> P_b = Tensor<Dim>::load(P + b * tensor_size<Dim>);
    Vec<Dim> f_ab;
    if constexpr (Surface) {
      f_ab =
          P_a.times(B) - P_b.times(&rows.B_reverse[static_cast<std::size_t>(k) * bond_record]);
    } else {
      for (int i = 0; i < Dim; ++i) P_b.column[i] += P_a.column[i];
      f_ab = P_b.times(B);
    }
    f_a += f_ab;
    if (k < cut)
      store(f + b * vector_size<Dim>, load<Vec<Dim>>(f + b * vector_size<Dim>) - f_ab);
  }
  store(f + a * vector_size<Dim>, f_a);
}

template <int Dim>
CONCORD_CLONES void internal_force(const BondBlock& block, const double* P, double* f) {
  const Index rows = block.last - block.first;
  for (Index r = 0; r < rows; ++r) force_row<Dim, true>(block.surface, block.first, r, P, f);
  for (Index r = 0; r < rows; ++r) force_row<Dim, false>(block.regular, block.first, r, P, f);
}

}  // namespace concord::particle::delaunay
