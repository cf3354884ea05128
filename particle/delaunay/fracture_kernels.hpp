#pragma once
// The loops of one force evaluation on bonds that can break, over a few rows at a time, as in
// kernels.hpp: each bond once, in the row of its lower-numbered particle, adding to both ends.
// (CBM.n) are equations of the Continuum Bond Method paper.

#include "particle/delaunay/fracture_records.hpp"

#include <cmath>

namespace concord::particle::delaunay {

/// Pressures and lengths of bonds: what is read and written of each.
template <int Dim> struct BondPressures {
  const double* X[Dim];        ///< components of X_ab
  const double* limit;         ///< of |x_ab|^2; a bond that is not below it fails
  double viscosity;            ///< beta l_c rho c_0 [Pa s]
  double softening;            ///< .01 l_c^2
  double *minus_pi, *lengths;  ///< aligned, written in whole fours
};

/// Of four bonds, one in each lane.
template <int Dim> struct FourBonds {
  v4d u[Dim], v[Dim], X[Dim];  ///< u_ab, v_ab, X_ab
  v4d limit;

  CONCORD_INLINE FourBonds(const Twin<Dim> (&motions)[4]) {
    v4d row[4];
    if constexpr (Dim == 2) {
      for (int l = 0; l < 4; ++l) row[l] = motions[l];
      transpose(row[0], row[1], row[2], row[3]);
      u[0] = row[0], u[1] = row[1], v[0] = row[2], v[1] = row[3];
    } else {
      for (int l = 0; l < 4; ++l) row[l] = low(motions[l]);
      transpose(row[0], row[1], row[2], row[3]);
      for (int i = 0; i < 3; ++i) u[i] = row[i];
      for (int l = 0; l < 4; ++l) row[l] = high(motions[l]);
      transpose(row[0], row[1], row[2], row[3]);
      for (int i = 0; i < 3; ++i) v[i] = row[i];
    }
  }

  /// -pi_ab = viscosity v_ab.x_ab / (|x_ab|^2 + softening) (CBM.21), and |x_ab|^2. Returns
  /// |x_ab|^2 - limit.
  CONCORD_INLINE v4d press(const BondPressures<Dim>& p, std::size_t first) const {
    v4d x2{}, vx{};
    for (int i = 0; i < Dim; ++i) {
      const v4d x = X[i] + u[i];
      x2 += x * x;
      vx += v[i] * x;
    }
    store(p.minus_pi + first, p.viscosity * vx / (x2 + p.softening));
    store(p.lengths + first, x2);
    return x2 - limit;
  }
};

/// Adds a bond's part to the gradients of both ends; u_ba (x) zeta_ba is u_ab (x) zeta_ab.
/// Returns {u_ab, v_ab}.
template <int Dim>
CONCORD_INLINE Twin<Dim> add_to_gradients(const SomeBonds<Dim>& bonds, std::size_t k,
                                          const double* v, Window<Dim> H) {
  double *record_a = record_at(H, bonds.places[k].a),
         *record_b = record_at(H, bonds.places[k].b);
  const Twin<Dim> motion_ab =
      motion<Dim>(record_b, v, bonds.ends[k].b) - motion<Dim>(record_a, v, bonds.ends[k].a);
  const Outer<Dim> H_ab(motion_ab, bonds.z + k * Dim);
  H_ab.add_to(record_a);
  H_ab.add_to(record_b);
  return motion_ab;
}

/// Omega_a H_a = sum_b u_ab (x) zeta_ab, which is (CBM.8) less the identity, and the pressures
/// of the bonds. One loop over all bonds, with both ends in memory: rows are so short in the
/// plane that their ends would be guessed wrong every other time. Returns the largest |x_ab|^2
/// - limit, at least -1.
template <int Dim>
CONCORD_CLONES double breakable_gradients(const SomeBonds<Dim>& some, const double* v,
                                          Window<Dim> H, const BondPressures<Dim>& to) {
  const SomeBonds<Dim> bonds = some;  // copies, which no store can change
  const BondPressures<Dim> pressures = to;
  v4d most{-1, -1, -1, -1};
  std::size_t k = 0;
  for (; k + 4 <= bonds.count; k += 4) {
    Twin<Dim> motions[4];
    for (std::size_t l = 0; l < 4; ++l) motions[l] = add_to_gradients<Dim>(bonds, k + l, v, H);
    FourBonds<Dim> four(motions);
    for (int i = 0; i < Dim; ++i) four.X[i] = load_anywhere(pressures.X[i] + k);
    four.limit = load_anywhere(pressures.limit + k);
    const v4d excess = four.press(pressures, k);
    most = excess > most ? excess : most;
  }
  if (k < bonds.count) {
    Twin<Dim> motions[4] = {};
    v4d X[Dim] = {}, limit{1, 1, 1, 1};
    for (std::size_t l = 0; k + l < bonds.count; ++l) {
      motions[l] = add_to_gradients<Dim>(bonds, k + l, v, H);
      for (int i = 0; i < Dim; ++i) X[i][l] = pressures.X[i][k + l];
      limit[l] = pressures.limit[k + l];
    }
    FourBonds<Dim> four(motions);
    std::copy(X, X + Dim, four.X);
    four.limit = limit;
    const v4d excess = four.press(pressures, k);
    most = excess > most ? excess : most;
  }
  for (const SkewBond<Dim>* bond = bonds.skew; bond != bonds.skew_end; ++bond) {
    double *record_a = H.at(bond->a), *record_b = H.at(bond->b);
    const Outer<Dim> H_ab(motion<Dim>(record_b, v, bond->b) - motion<Dim>(record_a, v, bond->a),
                          bond->s);
    H_ab.add_to(record_a);
    H_ab.take_from(record_b);
  }
  return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
}

/// H_a of the particles [first, last), whose sums are complete.
template <int Dim>
CONCORD_CLONES void divide_by_omega(Index first, Index last, const double* inverse_omega,
                                    Window<Dim> H) {
  for (Index a = first; a < last; ++a) {
    double* record = H.at(a);
    const v4d w = broadcast(inverse_omega[a], v4d{});
    for (int k = 0; k < (Dim == 3 ? 3 : 1); ++k)
      store(record + 4 * k, load<v4d>(record + 4 * k) * w);
  }
}

/// cof F = J F^-T of F = I + H.
template <int Dim> CONCORD_INLINE Tensor<Dim> cofactor_of(const Tensor<Dim>& H) {
  Tensor<Dim> G;
  if constexpr (Dim == 2) {
    const v2d c0 = H.column[0], c1 = H.column[1];
    G.column[0] = __builtin_shufflevector(c1, c1, 1, 0) * v2d{1, -1} + v2d{1, 0};
    G.column[1] = __builtin_shufflevector(c0, c0, 1, 0) * v2d{-1, 1} + v2d{0, 1};
  } else {
    const v4d F[3] = {H.column[0] + v4d{1, 0, 0, 0}, H.column[1] + v4d{0, 1, 0, 0},
                      H.column[2] + v4d{0, 0, 1, 0}};
    for (int k = 0; k < 3; ++k) {  // G_k = F_(k+1) x F_(k+2)
      const v4d p = F[(k + 1) % 3], q = F[(k + 2) % 3];
      const v4d r = p * __builtin_shufflevector(q, q, 1, 2, 0, 3) -
                    __builtin_shufflevector(p, p, 1, 2, 0, 3) * q;
      G.column[k] = __builtin_shufflevector(r, r, 1, 2, 0, 3);
    }
  }
  return G;
}

/// Puts P_a, with contact + Q_a/V_a from sum q (x) X in Q, and cof F_a = J_a F_a^-T into a
/// window; the force begins with the sum of p, or zero.
template <int Dim, bool Contact> struct PutTwins {
  const double* inverse_omega;
  Window<Dim> H, Q;
  StressWindow<Dim> stresses;
  CONCORD_INLINE void operator()(Index a, Tensor<Dim>& P_a) const {
    const Tensor<Dim> cofactor = cofactor_of<Dim>(Tensor<Dim>::load(H.at(a)));
    double* record = stresses.at(a);
    Vec<Dim> f{};
    if constexpr (Contact) {
      const double* contact = Q.at(a);
      const Tensor<Dim> twice = Tensor<Dim>::load(contact);
      const Vec<Dim> w = broadcast(-0.5 * inverse_omega[a], Vec<Dim>{});
      for (int k = 0; k < Dim; ++k) P_a.column[k] += twice.column[k] * w;
      f = load<Vec<Dim>>(contact + vector_place<Dim>);
    }
    for (int k = 0; k < Dim; ++k)
      store(record + k * twin_size<Dim>, twin(P_a.column[k], cofactor.column[k]));
    store(record + force_place<Dim>, twin(f, Vec<Dim>{}));
  }
};

/// P and cof F of [first, last). Returns the first particle with det F <= 0 or NaN, or -1.
template <int Dim, StressLaw Law, bool Contact>
CONCORD_CLONES Index breakable_stresses(const StressConstants& c, Index first, Index last,
                                        const double* inverse_omega, Window<Dim> H,
                                        Window<Dim> Q, StressWindow<Dim> stresses) {
  return stress_rows<Dim, Law>(c, first, last, H,
                               PutTwins<Dim, Contact>{inverse_omega, H, Q, stresses});
}

/// The works of the stress along bonds, n.P N eps_ab/2 [J/m^3], with the mean P of their ends,
/// N and n the direction before and now, eps_ab the strain (CBM.20). Returns the largest work -
/// limit of any bond.
template <int Dim>
CONCORD_CLONES double bond_works(const SomeBonds<Dim>& bonds, const double* X, const double* u,
                                 StressWindow<Dim> stresses, const double* limit,
                                 double* works) {
  constexpr std::size_t S = Lanes<Dim>::stride;
  double excess = -1;
  for (std::size_t k = 0; k < bonds.count; ++k) {
    const Ends& ends = bonds.ends[k];
    const auto a = static_cast<std::size_t>(ends.a), b = static_cast<std::size_t>(ends.b);
    const double *P_a = stresses.at(ends.a), *P_b = stresses.at(ends.b);
    const Vec<Dim> X_ab = load<Vec<Dim>>(X + b * S) - load<Vec<Dim>>(X + a * S),
                   x_ab = X_ab + load<Vec<Dim>>(u + b * S) - load<Vec<Dim>>(u + a * S);
    Tensor<Dim> P;
    for (int i = 0; i < Dim; ++i) {
      P.column[i] =
          load<Vec<Dim>>(P_a + i * twin_size<Dim>) + load<Vec<Dim>>(P_b + i * twin_size<Dim>);
    }
    const v2d sums = lane_sums(x_ab * P.times(X_ab), x_ab * x_ab);
    const double x2 = sums[1], L2 = lane_sum(X_ab * X_ab), L = std::sqrt(L2), l = std::sqrt(x2);
    const double strain = (x2 - L2) / (L * (l + L));
    works[k] = 0.25 * sums[0] / (l * L) * std::max(strain, 0.0);
    excess = std::max(excess, works[k] - limit[k]);
  }
  return excess;
}

/// t with its second vector times s.
CONCORD_INLINE v4d second_times(v4d t, double s) {
  return __builtin_shufflevector(t, t * s, 0, 1, 6, 7);
}
CONCORD_INLINE v8d second_times(v8d t, double s) {
  return __builtin_shufflevector(t, t * s, 0, 1, 2, 3, 12, 13, 14, 15);
}

/// Adds t to the force on a and takes it from that on b; the viscous half times -pi.
template <int Dim>
CONCORD_INLINE void add_pair(double* record_a, double* record_b, Twin<Dim> t, double minus_pi) {
  t = second_times(t, minus_pi);
  double *f_a = record_a + force_place<Dim>, *f_b = record_b + force_place<Dim>;
  store(f_a, load<Twin<Dim>>(f_a) + t);
  store(f_b, load<Twin<Dim>>(f_b) - t);
}

/// Force on a by b, -(CBM.18) - (CBM.23): P~_a zeta_ab - P~_b zeta_ba = (P~_a + P~_b) z + (P~_a
/// - P~_b) s with P~ = P - pi_ab J F^-T. The sign of pi is the one that takes energy; (23) with
/// (19) as printed feeds it.
template <int Dim>
CONCORD_CLONES void breakable_forces(const SomeBonds<Dim>& bonds, const double* minus_pi,
                                     StressWindow<Dim> stresses) {
  constexpr std::size_t T = twin_size<Dim>;
  const Places* places = bonds.places;
  const double* z = bonds.z;
  for (std::size_t k = 0; k < bonds.count; ++k, z += Dim) {
    double *record_a = record_at(stresses, places[k].a),
           *record_b = record_at(stresses, places[k].b);
    Twin<Dim> t = (load<Twin<Dim>>(record_a) + load<Twin<Dim>>(record_b)) * z[0];
    for (int i = 1; i < Dim; ++i)
      t += (load<Twin<Dim>>(record_a + i * T) + load<Twin<Dim>>(record_b + i * T)) * z[i];
    add_pair<Dim>(record_a, record_b, t, minus_pi[k]);
  }
  for (const SkewBond<Dim>* bond = bonds.skew; bond != bonds.skew_end; ++bond) {
    double *record_a = stresses.at(bond->a), *record_b = stresses.at(bond->b);
    Twin<Dim> t{};
    for (int i = 0; i < Dim; ++i) {
      t += (load<Twin<Dim>>(record_a + i * T) - load<Twin<Dim>>(record_b + i * T)) * bond->s[i];
    }
    add_pair<Dim>(record_a, record_b, t, minus_pi[bond->bond - bonds.first]);
  }
}

/// Forces of [first, last): elastic + viscous part, and the viscous part by itself.
template <int Dim>
CONCORD_CLONES void copy_forces(StressWindow<Dim> stresses, Index first, Index last, double* f,
                                double* viscous) {
  constexpr std::size_t S = Lanes<Dim>::stride;
  for (Index a = first; a < last; ++a) {
    const Twin<Dim> parts = load<Twin<Dim>>(stresses.at(a) + force_place<Dim>);
    store(f + static_cast<std::size_t>(a) * S, low(parts) + high(parts));
    store(viscous + static_cast<std::size_t>(a) * S, high(parts));
  }
}

}  // namespace concord::particle::delaunay
