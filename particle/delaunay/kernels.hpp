#pragma once
// The loops of one force evaluation of the Delaunay method, over a few rows of bonds at a time.
// Each reads like the paper; numbers in parentheses are its equations. Each bond is visited
// once, in the row of its lower-numbered particle a, and adds to both ends; what is added to
// one particle comes in ascending order of its neighbours, whoever works on which rows.

#include "particle/core/contact.hpp"
#include "particle/core/stress_rows.hpp"
#include "particle/delaunay/bonds.hpp"

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

/// First half of the contact law for rows [first, last): u_loc (7) and what goes with it.
template <int Dim>
CONCORD_INLINE void local_displacements(const Bonds& bonds, Index first, Index last,
                                        const double* X, Window<Dim> H, ContactBuffer& buffer) {
  constexpr std::size_t S = Lanes<Dim>::stride;
  const Index* begin = bonds.begin.data();
  const Index* other = bonds.other.data();
  ContactInput<Dim> input(buffer);
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
      input.add(X_ab, u_ab, sum);
    }
  }
}

/// Nothing in a row but its bonds.
template <int Dim> struct BondsAlone {
  CONCORD_INLINE void operator()(Index, const Tensor<Dim>&) const {}
};

/// Contact of rows [first, last), a group at a time: p of (57), and sums of q (x) X_ab, with q
/// of (58); Q_a takes the place of the second-neighbour sum in (50).
template <int Dim>
CONCORD_CLONES void contact_rows(const Bonds& bonds, Index first, Index last,
                                 const ContactFactors& factors, const double* X, Window<Dim> H,
                                 Window<Dim> P, ContactBuffer& buffer) {
  const Index* begin = bonds.begin.data();
  for (Index a = first; a < last; a += stress_width) {
    const Index end = std::min<Index>(a + stress_width, last);
    local_displacements<Dim>(bonds, a, end, X, H, buffer);
    contact_scalars(begin[end] - begin[a], bonds.area_over_length.data() + begin[a], factors,
                    buffer);
    contact_forces<Dim>(begin, bonds.other.data(), a, end, P, buffer, BondsAlone<Dim>{});
  }
}

/// Puts P_a into a window: with contact P_a + Q_a/V_a, Q_a from sum q (x) X that is there;
/// without, f_a = 0.
template <int Dim, bool Contact> struct PutStress {
  const double* inverse_V;
  Window<Dim> P;
  CONCORD_INLINE void operator()(Index a, Tensor<Dim>& P_a) const {
    double* record = P.at(a);
    if constexpr (Contact) {
      const Tensor<Dim> twice = Tensor<Dim>::load(record);
      const Vec<Dim> w = broadcast(-0.5 * inverse_V[a], Vec<Dim>{});
      for (int k = 0; k < Dim; ++k) P_a.column[k] += twice.column[k] * w;
    } else {
      store(record + vector_place<Dim>, Vec<Dim>{});
    }
    P_a.store(record);
  }
};

/// P_a (53) of [first, last), and with contact + Q_a/V_a. Returns the first particle with det F
/// <= 0 or NaN, or -1.
template <int Dim, StressLaw Law, bool Contact>
CONCORD_CLONES Index stresses(const StressConstants& c, Index first, Index last,
                              const double* inverse_V, Window<Dim> H, Window<Dim> P) {
  return stress_rows<Dim, Law>(c, first, last, H, PutStress<Dim, Contact>{inverse_V, P});
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
