#pragma once
// The loops of one force evaluation of the Delaunay method, over a few rows of bonds at a time.
// Each reads like the paper; numbers in parentheses are its equations. Each bond is visited
// once, in the row of its lower-numbered particle a, and adds to both ends; what is added to
// one particle comes in ascending order of its neighbours, whoever works on which rows.

#include "particle/core/window.hpp"
#include "particle/delaunay/bonds.hpp"

#include <cstring>

namespace concord::particle::delaunay {

/// Row of corrections of the boundary particle that comes next in a sweep.
struct SurfaceCursor {
  const SurfaceBonds& bonds;
  std::size_t row;
  SurfaceCursor(const SurfaceBonds& surface, Index first)
      : bonds(surface),
        row(static_cast<std::size_t>(
            std::lower_bound(surface.particle.begin(), surface.particle.end(), first) -
            surface.particle.begin())) {}
};

/// Corrections to V_a H_a of a boundary particle: u_ab (x) (B_ab + B_ba)/2, and at b the same
/// with the other sign.
template <int Dim>
CONCORD_INLINE void gradient_correction(const SurfaceBonds& s, std::size_t row, Vec<Dim> u_a,
                                        Tensor<Dim>& H_a, Window<Dim> H) {
  for (Index k = s.begin[row]; k < s.begin[row + 1]; ++k) {
    double* H_b = H.at(s.other[k]);
    const double* B = &s.B_symmetric[static_cast<std::size_t>(k) * Dim];
    const Vec<Dim> u_ab = load<Vec<Dim>>(H_b + vector_place<Dim>) - u_a;
    H_a.add_outer(u_ab, B);
    scatter_outer<Dim>(H_b, -u_ab, B);
  }
}

/// V_a H_a = sum_b u_ab (x) B_ab (32); off the surface u_ba (x) B_ba = u_ab (x) B_ab. H holds u
/// in its vectors; the rows' own particles are complete after it and get H_a = F_a - I. With v
/// in place of u: dF_a/dt (34).
template <int Dim>
CONCORD_CLONES void gradient_rows(const Bonds& bonds, Index first, Index last,
                                  const double* inverse_V, Window<Dim> H) {
  SurfaceCursor surface(bonds.surface, first);
  const Index* begin = bonds.begin.data();
  const Index* other = bonds.other.data();
  const double* B_all = bonds.B.data();
  for (Index a = first; a < last; ++a) {
    double* record = H.at(a);
    const Vec<Dim> u_a = load<Vec<Dim>>(record + vector_place<Dim>);
    Tensor<Dim> H_a = Tensor<Dim>::load(record);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      double* H_b = H.at(other[k]);
      const double* B = B_all + static_cast<std::size_t>(k) * Dim;
      const Vec<Dim> u_ab = load<Vec<Dim>>(H_b + vector_place<Dim>) - u_a;
      H_a.add_outer(u_ab, B);
      scatter_outer<Dim>(H_b, u_ab, B);
    }
    if (a == surface.bonds.particle[surface.row])
      gradient_correction<Dim>(surface.bonds, surface.row++, u_a, H_a, H);
    for (auto& column : H_a.column) column *= broadcast(inverse_V[a], Vec<Dim>{});
    H_a.store(record);
  }
}

/// K_n = normal A_ab / L_ab, K_t = tangential A_ab / L_ab (60): xi_n E and xi_t G [Pa].
struct ContactFactors {
  double normal, tangential;
};

/// Bonds of a group of rows between the two halves of the contact law.
struct ContactBuffer {
  Column local, x, X;  ///< u_loc, x_ab, X_ab: a vector a bond
  Column products;     ///< u_loc.x_ab and |x_ab|^2
  Column K, share, s;  ///< K_t, (K_n - K_t) s, s = u_loc.x_ab / |x_ab|^2

  ContactBuffer(const Bonds& bonds, int dim, bool contact) {
    if (!contact) return;
    Index most = 0;
    const Index n = bonds.particles();
    for (Index a = 0; a < n; ++a)
      most = std::max(most, bonds.begin[std::min(n, a + stress_width)] - bonds.begin[a]);
    const std::size_t size = static_cast<std::size_t>(most) + bond_padding;
    local.assign(size * stride_of(dim), 0.0);
    x = X = local;
    products.assign(2 * size, 1.0);
    K.assign(size, 0.0);
    share = s = K;
  }
};

/// First half for rows [first, last): u_loc = u_ab - (H_a + H_b) X_ab / 2 (7), with x_ab = X_ab
/// + u_ab, and its products.
template <int Dim>
CONCORD_INLINE void local_displacements(const Bonds& bonds, Index first, Index last,
                                        const double* X, Window<Dim> H, ContactBuffer& buffer) {
  constexpr std::size_t S = Lanes<Dim>::stride;
  const Index* begin = bonds.begin.data();
  const Index* other = bonds.other.data();
  const Vec<Dim> half = broadcast(0.5, Vec<Dim>{});
  double *local_out = buffer.local.data(), *x_out = buffer.x.data(), *X_out = buffer.X.data(),
         *products = buffer.products.data();
  for (Index a = first; a < last; ++a) {
    const double* record = H.at(a);
    const Tensor<Dim> H_a = Tensor<Dim>::load(record);
    const Vec<Dim> u_a = load<Vec<Dim>>(record + vector_place<Dim>),
                   X_a = load<Vec<Dim>>(X + static_cast<std::size_t>(a) * S);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      const double* H_b = H.at(other[k]);
      const Vec<Dim> X_ab = load<Vec<Dim>>(X + static_cast<std::size_t>(other[k]) * S) - X_a;
      const Vec<Dim> u_ab = load<Vec<Dim>>(H_b + vector_place<Dim>) - u_a;
      Tensor<Dim> sum = Tensor<Dim>::load(H_b);
      for (int i = 0; i < Dim; ++i) sum.column[i] += H_a.column[i];
      const Vec<Dim> local = u_ab - sum.times(X_ab) * half, x_ab = X_ab + u_ab;
      store(local_out, local), store(x_out, x_ab), store(X_out, X_ab);
      store(products, lane_sums(local * x_ab, x_ab * x_ab));
      local_out += S, x_out += S, X_out += S, products += 2;
    }
  }
}

/// Scalars of the law for `count` bonds from bond `first` on, four at a time.
CONCORD_INLINE void contact_scalars(const Bonds& bonds, Index first, Index count,
                                    const ContactFactors& factors, ContactBuffer& buffer) {
  typedef long long v4i __attribute__((vector_size(32)));
  const double* area_over_length = bonds.area_over_length.data() + first;
  const v4d tangential = broadcast(factors.tangential, v4d{}),
            difference = broadcast(factors.normal - factors.tangential, v4d{});
  for (Index k = 0; k < count; k += 4) {
    const v4d low = load<v4d>(&buffer.products[2 * k]),
              high = load<v4d>(&buffer.products[2 * k + 4]);
    const v4d s = __builtin_shuffle(low, high, v4i{0, 2, 4, 6}) /
                  __builtin_shuffle(low, high, v4i{1, 3, 5, 7});
    v4d ratio;
    std::memcpy(&ratio, area_over_length + k, sizeof(v4d));
    store(&buffer.K[k], tangential * ratio);
    store(&buffer.share[k], difference * ratio * s);
    store(&buffer.s[k], s);
  }
}

/// Second half: with w = u_loc - s x_ab, q = K_t u_loc + (K_n - K_t) s x_ab (58) and p = q +
/// (K_n
/// - K_t) s w (57). Adds p to f_a and -p to f_b, q (x) X_ab to the tensors of both: -2 Q_a, Q_a
/// = -1/2 sum_b q_ab (x) X_ab the adjoint of the second-neighbour sum in (50).
template <int Dim>
CONCORD_INLINE void contact_forces(const Bonds& bonds, Index first, Index last, Window<Dim> P,
                                   const ContactBuffer& buffer) {
  constexpr std::size_t S = Lanes<Dim>::stride;
  const Index* begin = bonds.begin.data();
  const Index* other = bonds.other.data();
  const double *local_in = buffer.local.data(), *x_in = buffer.x.data(), *X = buffer.X.data();
  const double *K = buffer.K.data(), *share = buffer.share.data(), *s = buffer.s.data();
  for (Index a = first; a < last; ++a) {
    double* record = P.at(a);
    Tensor<Dim> Q_a = Tensor<Dim>::load(record);
    Vec<Dim> f_a = load<Vec<Dim>>(record + vector_place<Dim>);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      double* P_b = P.at(other[k]);
      const Vec<Dim> local = load<Vec<Dim>>(local_in), x_ab = load<Vec<Dim>>(x_in);
      const Vec<Dim> c = broadcast(*share, Vec<Dim>{});
      const Vec<Dim> q = local * broadcast(*K, Vec<Dim>{}) + x_ab * c;
      const Vec<Dim> p = q + (local - x_ab * broadcast(*s, Vec<Dim>{})) * c;
      f_a += p;
      store(P_b + vector_place<Dim>, load<Vec<Dim>>(P_b + vector_place<Dim>) - p);
      Q_a.add_outer(q, X);
      scatter_outer<Dim>(P_b, q, X);
      local_in += S, x_in += S, X += S, ++K, ++share, ++s;
    }
    Q_a.store(record);
    store(record + vector_place<Dim>, f_a);
  }
}

/// Contact of rows [first, last), a group at a time: the division and the chains of either half
/// overlap over its bonds.
template <int Dim>
CONCORD_CLONES void contact_rows(const Bonds& bonds, Index first, Index last,
                                 const ContactFactors& factors, const double* X, Window<Dim> H,
                                 Window<Dim> P, ContactBuffer& buffer) {
  for (Index a = first; a < last; a += stress_width) {
    const Index end = std::min<Index>(a + stress_width, last);
    local_displacements<Dim>(bonds, a, end, X, H, buffer);
    contact_scalars(bonds, bonds.begin[a], bonds.begin[end] - bonds.begin[a], factors, buffer);
    contact_forces<Dim>(bonds, a, end, P, buffer);
  }
}

/// P_a (53) of [first, last), and with contact + Q_a/V_a, from sum q (x) X in P; without
/// contact f_a = 0. Returns the first particle with det F <= 0 or NaN, or -1.
template <int Dim, StressLaw Law, bool Contact>
CONCORD_CLONES Index stress_rows(const StressConstants& c, Index first, Index last,
                                 const double* inverse_V, Window<Dim> H, Window<Dim> P) {
  Index bad_particle = -1;
  for (Index a = first; a < last; a += stress_width) {
    const int count = std::min<Index>(stress_width, last - a);
    double h[Dim * Dim][stress_width], p[Dim * Dim][stress_width];
    Tensor<Dim> tensor[stress_width];
    for (int l = 0; l < stress_width; l += 4) {
      const double* record[4];
      for (int i = 0; i < 4; ++i) record[i] = H.at(a + std::min(l + i, count - 1));
      tensors_to_lanes<Dim>(record, l, h);
    }
    const unsigned bad = stress_of_lanes<Dim, Law>(c, a, count, h, p);
    for (int l = 0; l < stress_width; l += 4) lanes_to_tensors<Dim>(p, l, tensor + l);
    for (int l = 0; l < count; ++l) {
      double* record = P.at(a + l);
      Tensor<Dim>& P_a = tensor[l];
      if constexpr (Contact) {
        const Tensor<Dim> twice = Tensor<Dim>::load(record);
        const Vec<Dim> w = broadcast(-0.5 * inverse_V[a + l], Vec<Dim>{});
        for (int k = 0; k < Dim; ++k) P_a.column[k] += twice.column[k] * w;
      } else {
        store(record + vector_place<Dim>, Vec<Dim>{});
      }
      P_a.store(record);
    }
    if (bad != 0 && bad_particle < 0) bad_particle = a + __builtin_ctz(bad);
  }
  return bad_particle;
}

/// Corrections to the force of a boundary particle: -P_b (B_ab + B_ba)/2, at b with P_a, and
/// -P_a B_aa.
template <int Dim>
CONCORD_INLINE void force_correction(const SurfaceBonds& s, std::size_t row,
                                     const Tensor<Dim>& P_a, Vec<Dim>& f_a, Window<Dim> P) {
  f_a -= P_a.times(&s.B_self[row * Dim]);
  for (Index k = s.begin[row]; k < s.begin[row + 1]; ++k) {
    double* P_b = P.at(s.other[k]);
    const double* B = &s.B_symmetric[static_cast<std::size_t>(k) * Dim];
    f_a -= Tensor<Dim>::load(P_b).times(B);
    store(P_b + vector_place<Dim>, load<Vec<Dim>>(P_b + vector_place<Dim>) - P_a.times(B));
  }
}

/// f_a += -sum_b P_b B_ba over b including a (46), with sum_b B_ab = 0; off the surface sum_b
/// P_b B_ab. The rows' own particles are complete after it.
template <int Dim>
CONCORD_CLONES void force_rows(const Bonds& bonds, Index first, Index last, Window<Dim> P) {
  SurfaceCursor surface(bonds.surface, first);
  const Index* begin = bonds.begin.data();
  const Index* other = bonds.other.data();
  const double* B_all = bonds.B.data();
  for (Index a = first; a < last; ++a) {
    double* record = P.at(a);
    const Tensor<Dim> P_a = Tensor<Dim>::load(record);
    Vec<Dim> f_a = load<Vec<Dim>>(record + vector_place<Dim>);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      double* P_b = P.at(other[k]);
      const double* B = B_all + static_cast<std::size_t>(k) * Dim;
      f_a += Tensor<Dim>::load(P_b).times(B);
      store(P_b + vector_place<Dim>, load<Vec<Dim>>(P_b + vector_place<Dim>) - P_a.times(B));
    }
    if (a == surface.bonds.particle[surface.row])
      force_correction<Dim>(surface.bonds, surface.row++, P_a, f_a, P);
    store(record + vector_place<Dim>, f_a);
  }
}

}  // namespace concord::particle::delaunay
