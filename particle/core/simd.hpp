#pragma once
// Small vectors that the processor handles in one register, and the choice of instruction set
// at run time.

#include "scene/types.hpp"

#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

/// Compiles a function for the baseline, AVX2 and AVX-512; the loader picks one. Everything
/// called inside must be inlined.
#if defined(CONCORD_NO_CLONES) || !defined(__x86_64__) || !defined(__GNUC__) ||                \
    defined(__clang__)
#define CONCORD_CLONES
#else
#define CONCORD_CLONES                                                                         \
  __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#endif
#define CONCORD_INLINE inline __attribute__((always_inline))

namespace concord::particle {

typedef double v8d __attribute__((vector_size(64)));
typedef double v4d __attribute__((vector_size(32)));
typedef double v2d __attribute__((vector_size(16)));

/// A spatial vector in a register: 3 components and a zero lane in 3D, 2 components in the
/// plane.
template <int Dim> struct Lanes;
template <> struct Lanes<3> {
  using type = v4d;
  static constexpr int stride = 4;
};
template <> struct Lanes<2> {
  using type = v2d;
  static constexpr int stride = 2;
};
template <int Dim> using Vec = typename Lanes<Dim>::type;

/// Doubles from one particle to the next in a column of vectors.
constexpr int stride_of(int dim) { return dim == 3 ? 4 : 2; }

/// s in all lanes. As a shuffle: g++ 12 makes {s, s, s, s} of two instructions even where one
/// loads and spreads.
CONCORD_INLINE v4d broadcast(double s, v4d) {
  typedef long long v4i __attribute__((vector_size(32)));
  const v4d first{s, 0, 0, 0};
  return __builtin_shuffle(first, first, v4i{0, 4, 0, 4});
}
CONCORD_INLINE v2d broadcast(double s, v2d) { return v2d{s, s}; }

/// Lane k of a vector in all lanes, without a way through memory.
template <int k> CONCORD_INLINE v4d lane(v4d a) {
  typedef long long v4i __attribute__((vector_size(32)));
  return __builtin_shuffle(a, v4i{k, k, k, k});
}
template <int k> CONCORD_INLINE v2d lane(v2d a) {
  typedef long long v2i __attribute__((vector_size(16)));
  return __builtin_shuffle(a, v2i{k, k});
}

/// Sum over the lanes in a fixed order.
CONCORD_INLINE double lane_sum(v4d a) { return (a[0] + a[2]) + (a[1] + a[3]); }
CONCORD_INLINE double lane_sum(v2d a) { return a[0] + a[1]; }

/// Sums over the lanes of two vectors: {sum a, sum b}.
CONCORD_INLINE v2d lane_sums(v4d a, v4d b) {
  typedef long long v4i __attribute__((vector_size(32)));
  const v4d h =
      __builtin_shuffle(a, b, v4i{0, 4, 2, 6}) + __builtin_shuffle(a, b, v4i{1, 5, 3, 7});
  const v4d sums = h + __builtin_shuffle(h, v4i{2, 3, 0, 1});
  return v2d{sums[0], sums[1]};
}
CONCORD_INLINE v2d lane_sums(v2d a, v2d b) {
  typedef long long v2i __attribute__((vector_size(16)));
  return __builtin_shuffle(a, b, v2i{0, 2}) + __builtin_shuffle(a, b, v2i{1, 3});
}

/// Two vectors side by side.
CONCORD_INLINE v4d twin(v2d a, v2d b) { return __builtin_shufflevector(a, b, 0, 1, 2, 3); }
CONCORD_INLINE v8d twin(v4d a, v4d b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Four vectors as the rows of a matrix become its columns.
CONCORD_INLINE void transpose(v4d& a, v4d& b, v4d& c, v4d& d) {
  typedef long long v4i __attribute__((vector_size(32)));
  const v4d ab_even = __builtin_shuffle(a, b, v4i{0, 4, 2, 6}),
            ab_odd = __builtin_shuffle(a, b, v4i{1, 5, 3, 7}),
            cd_even = __builtin_shuffle(c, d, v4i{0, 4, 2, 6}),
            cd_odd = __builtin_shuffle(c, d, v4i{1, 5, 3, 7});
  a = __builtin_shuffle(ab_even, cd_even, v4i{0, 1, 4, 5});
  b = __builtin_shuffle(ab_odd, cd_odd, v4i{0, 1, 4, 5});
  c = __builtin_shuffle(ab_even, cd_even, v4i{2, 3, 6, 7});
  d = __builtin_shuffle(ab_odd, cd_odd, v4i{2, 3, 6, 7});
}

template <class V> CONCORD_INLINE V load(const double* p) {
  return *reinterpret_cast<const V*>(p);
}
/// Of any address; load() wants that of a whole vector.
CONCORD_INLINE v4d load_anywhere(const double* p) {
  v4d v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
template <class V> CONCORD_INLINE void store(double* p, V v) { *reinterpret_cast<V*>(p) = v; }

/// Allocates on cache lines, so that no vector straddles two.
template <class T> struct CacheAligned {
  using value_type = T;
  CacheAligned() = default;
  template <class U> CacheAligned(const CacheAligned<U>&) noexcept {}
  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64}));
  }
  void deallocate(T* p, std::size_t) noexcept { ::operator delete (p, std::align_val_t{64}); }
  friend bool operator==(const CacheAligned&, const CacheAligned&) { return true; }
};

/// A column of doubles, one vector (stride_of(dim) doubles, unused lane zero) or tensor (dim
/// vectors) a particle.
using Column = std::vector<double, CacheAligned<double>>;

}  // namespace concord::particle
