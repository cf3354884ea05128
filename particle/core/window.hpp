#pragma once
// Rings of records that a sweep over the particles keeps in cache: a tensor and a vector of
// each particle, as the loops over bonds read and add to them.

#include "particle/core/stress_kernel.hpp"

#include <cstring>

namespace concord::particle {

/// Doubles in a record of a window: a tensor, column by column, and a vector; whole cache
/// lines.
template <int Dim> inline constexpr std::size_t record_size = Dim == 3 ? 16 : 8;
/// Where the vector is.
template <int Dim> inline constexpr std::size_t vector_place = Dim* Lanes<Dim>::stride;

/// Records of consecutive particles in a ring: particle a is at a modulo the ring's size, a
/// power of two.
template <int Dim> struct Window {
  double* records;
  std::size_t mask;  ///< size - 1
  CONCORD_INLINE double* at(Index a) const {
    return records + (static_cast<std::size_t>(a) & mask) * record_size<Dim>;
  }
};

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
  /// this += d (x) B, B in a register
  CONCORD_INLINE void add_outer(Vec<Dim> d, Vec<Dim> B) {
    column[0] += d * lane<0>(B);
    column[1] += d * lane<1>(B);
    if constexpr (Dim == 3) column[2] += d * lane<2>(B);
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

/// Adds d (x) B to the tensor of a record.
template <int Dim>
CONCORD_INLINE void scatter_outer(double* record, Vec<Dim> d, const double* B) {
  Tensor<Dim> t = Tensor<Dim>::load(record);
  t.add_outer(d, B);
  t.store(record);
}

template <int Dim> CONCORD_INLINE void scatter_outer(double* record, Vec<Dim> d, Vec<Dim> B) {
  Tensor<Dim> t = Tensor<Dim>::load(record);
  t.add_outer(d, B);
  t.store(record);
}

/// Records of [first, last) get a zero tensor and the vectors of a column.
template <int Dim>
CONCORD_CLONES void open_records(Window<Dim> window, Index first, Index last,
                                 const double* column) {
  for (Index a = first; a < last; ++a) {
    double* record = window.at(a);
    for (int k = 0; k < Dim; ++k) store(record + k * Lanes<Dim>::stride, Vec<Dim>{});
    store(record + vector_place<Dim>,
          load<Vec<Dim>>(column + static_cast<std::size_t>(a) * Lanes<Dim>::stride));
  }
}

/// Records of [first, last) get a zero tensor and a zero vector.
template <int Dim>
CONCORD_CLONES void open_records(Window<Dim> window, Index first, Index last) {
  for (Index a = first; a < last; ++a) {
    double* record = window.at(a);
    for (int k = 0; k <= Dim; ++k) store(record + k * Lanes<Dim>::stride, Vec<Dim>{});
  }
}

/// Tensor of a record, the rest zero.
template <int Dim> Mat3 tensor_of(const double* record) {
  Mat3 t = Mat3::Zero();
  for (int j = 0; j < Dim; ++j) {
    for (int i = 0; i < Dim; ++i) t(i, j) = record[j * Lanes<Dim>::stride + i];
  }
  return t;
}

/// Tensors of consecutive records into lanes, h[Dim j + i]; lanes are written whole, in one
/// store: two halves would have to be waited for where a register of all lanes is loaded.
template <int Dim>
CONCORD_INLINE void tensors_to_lanes(const double* records,
                                     double (&h)[Dim * Dim][stress_width]) {
  static_assert(stress_width == 8);
  for (int k = 0; k < (Dim == 3 ? 3 : 1); ++k) {  // in the plane a register holds a tensor
    v4d t[8];
    for (int l = 0; l < 8; ++l) t[l] = load<v4d>(records + l * record_size<Dim> + 4 * k);
    transpose(t[0], t[1], t[2], t[3]);
    transpose(t[4], t[5], t[6], t[7]);
    for (int i = 0; i < (Dim == 3 ? 3 : 4); ++i) {
      const v8d lanes = twin(t[i], t[4 + i]);
      std::memcpy(h[(Dim == 3 ? 3 * k : 0) + i], &lanes, sizeof lanes);
    }
  }
}

/// The way back.
template <int Dim>
CONCORD_INLINE void lanes_to_tensors(const double (&p)[Dim * Dim][stress_width],
                                     Tensor<Dim> (&tensor)[stress_width]) {
  for (int k = 0; k < (Dim == 3 ? 3 : 1); ++k) {
    for (int l = 0; l < stress_width; l += 4) {
      v4d t[4] = {};
      for (int i = 0; i < (Dim == 3 ? 3 : 4); ++i)
        std::memcpy(&t[i], &p[(Dim == 3 ? 3 * k : 0) + i][l], sizeof(v4d));
      transpose(t[0], t[1], t[2], t[3]);
      for (int i = 0; i < 4; ++i) {
        if constexpr (Dim == 3)
          tensor[l + i].column[k] = t[i];
        else
          std::memcpy(&tensor[l + i], &t[i], sizeof(v4d));
      }
    }
  }
}

/// The vectors of records [first, last) into a column.
template <int Dim>
CONCORD_CLONES void copy_vectors(Window<Dim> window, Index first, Index last, double* column) {
  for (Index a = first; a < last; ++a) {
    store(column + static_cast<std::size_t>(a) * Lanes<Dim>::stride,
          load<Vec<Dim>>(window.at(a) + vector_place<Dim>));
  }
}

}  // namespace concord::particle
