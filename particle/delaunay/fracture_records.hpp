#pragma once
// What the loops of fracture_kernels.hpp work on: rows of a network's bonds, and records of
// gradients, motions and stresses in rings. Elastic and viscous parts, or displacement and
// velocity, go side by side in one register. (CBM.n) are equations of the Continuum Bond Method
// paper.

#include "particle/core/stress_rows.hpp"
#include "particle/delaunay/network.hpp"

#include <algorithm>
#include <cstdint>

namespace concord::particle::delaunay {

/// Two vectors side by side: elastic and viscous, or displacement and velocity.
template <int Dim> struct TwinOf;
template <> struct TwinOf<2> { using type = v4d; };
template <> struct TwinOf<3> { using type = v8d; };
template <int Dim> using Twin = typename TwinOf<Dim>::type;
template <int Dim> inline constexpr std::size_t twin_size = 2 * Lanes<Dim>::stride;

CONCORD_INLINE v2d low(v4d t) { return __builtin_shufflevector(t, t, 0, 1); }
CONCORD_INLINE v2d high(v4d t) { return __builtin_shufflevector(t, t, 2, 3); }
CONCORD_INLINE v4d low(v8d t) { return __builtin_shufflevector(t, t, 0, 1, 2, 3); }
CONCORD_INLINE v4d high(v8d t) { return __builtin_shufflevector(t, t, 4, 5, 6, 7); }

/// Doubles in a record of stresses: {P, J F^-T} column by column, then {f, f_visc}; padded to
/// whole cache lines.
template <int Dim> inline constexpr std::size_t stress_record = Dim == 3 ? 32 : 16;
template <int Dim> inline constexpr std::size_t force_place = Dim* twin_size<Dim>;

/// Where a bond's ends have their records in the rings: in doubles of a ring of stresses, in
/// words of half the size of a ring of gradients, whose records are half as long. One number
/// for both, because the processor scales an index by either.
struct Places {
  std::uint32_t a, b;
};
template <int Dim>
CONCORD_INLINE double* record_at(const Window<Dim>& window, std::uint32_t place) {
  static_assert(2 * record_size<Dim> == stress_record<Dim>);
  char* const records = reinterpret_cast<char*>(window.records);
  return reinterpret_cast<double*>(records + sizeof(double) / 2 * std::size_t{place});
}

/// Records of stresses in a ring, as Window.
template <int Dim> struct StressWindow {
  double* records;
  std::size_t mask;
  CONCORD_INLINE double* at(Index a) const {
    return records + (static_cast<std::size_t>(a) & mask) * stress_record<Dim>;
  }
  std::uint32_t place(Index a) const { return static_cast<std::uint32_t>(at(a) - records); }
};
template <int Dim>
CONCORD_INLINE double* record_at(const StressWindow<Dim>& window, std::uint32_t place) {
  return window.records + place;
}

/// What the loops read of some rows of a network.
template <int Dim> struct SomeBonds {
  const Ends* ends;
  const Places* places;
  const double* z;  ///< dim doubles a bond
  std::size_t count;
  const SkewBond<Dim>*skew, *skew_end;  ///< those of them that are skew
  Index first;                          ///< number of the first

  /// `skew_before`: how many of the skew bonds stand before the rows; moved to behind them.
  SomeBonds(const Network& network, const std::vector<Places>& all_places, Index first_row,
            Index last_row, std::size_t& skew_before) {
    const std::vector<Index>& begin = network.rows().begin;
    first = begin[first_row];
    count = static_cast<std::size_t>(begin[last_row] - first);
    ends = &network.ends(0) + first;
    places = all_places.data() + first;
    z = network.rows().B.data() + static_cast<std::size_t>(first) * Dim;
    const auto& list = network.template skew<Dim>();
    skew = list.data() + skew_before;
    while (skew_before < list.size() && list[skew_before].bond < begin[last_row]) ++skew_before;
    skew_end = list.data() + skew_before;
  }
};

/// How many skew bonds stand before a row.
template <int Dim> std::size_t skew_before_row(const Network& network, Index row) {
  const auto& list = network.template skew<Dim>();
  const auto before = [](const SkewBond<Dim>& one, Index k) { return one.bond < k; };
  return static_cast<std::size_t>(
      std::lower_bound(list.begin(), list.end(), network.rows().begin[row], before) -
      list.begin());
}

/// Records of [first, last) get a zero tensor, u and, in the plane, v behind it.
template <int Dim>
CONCORD_CLONES void open_motion(Window<Dim> window, Index first, Index last, const double* u,
                                const double* v) {
  constexpr std::size_t S = Lanes<Dim>::stride;
  for (Index a = first; a < last; ++a) {
    const auto at = static_cast<std::size_t>(a) * S;
    double* record = window.at(a);
    for (int k = 0; k < (Dim == 3 ? 3 : 1); ++k) store(record + 4 * k, v4d{});
    const Vec<Dim> u_a = load<Vec<Dim>>(u + at);
    if constexpr (Dim == 2)
      store(record + vector_place<2>, twin(u_a, load<v2d>(v + at)));
    else
      store(record + vector_place<3>, u_a);
  }
}

/// Displacement and velocity of a particle whose record is open.
template <int Dim>
CONCORD_INLINE Twin<Dim> motion(const double* record, const double* v, Index a) {
  if constexpr (Dim == 2)
    return load<v4d>(record + vector_place<2>);
  else
    return twin(load<v4d>(record + vector_place<3>),
                load<v4d>(v + static_cast<std::size_t>(a) * 4));
}

/// u (x) z, in as few registers as it fits: one in the plane. u is the first of two vectors.
template <int Dim> struct Outer;
template <> struct Outer<2> {
  v4d all;
  CONCORD_INLINE Outer(v4d motion, const double* z) {
    const v2d vector = load<v2d>(z);
    all = __builtin_shufflevector(motion, motion, 0, 1, 0, 1) *
          __builtin_shufflevector(vector, vector, 0, 0, 1, 1);
  }
  CONCORD_INLINE void add_to(double* tensor) const { store(tensor, load<v4d>(tensor) + all); }
  CONCORD_INLINE void take_from(double* tensor) const {
    store(tensor, load<v4d>(tensor) - all);
  }
};
template <> struct Outer<3> {
  v4d column[3];
  CONCORD_INLINE Outer(v8d motion, const double* z) {
    for (int k = 0; k < 3; ++k) column[k] = low(motion) * broadcast(z[k], v4d{});
  }
  CONCORD_INLINE void add_to(double* tensor) const {
    for (int k = 0; k < 3; ++k) store(tensor + 4 * k, load<v4d>(tensor + 4 * k) + column[k]);
  }
  CONCORD_INLINE void take_from(double* tensor) const {
    for (int k = 0; k < 3; ++k) store(tensor + 4 * k, load<v4d>(tensor + 4 * k) - column[k]);
  }
};

}  // namespace concord::particle::delaunay
