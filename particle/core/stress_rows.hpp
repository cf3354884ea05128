#pragma once
// Stresses of consecutive particles from the gradients in a window.

#include "particle/core/window.hpp"

namespace concord::particle {

/// P_a of the particles of [first, last) from H_a in `H`, `stress_width` at a time: put(a, P_a)
/// for each, ascending, H_a being read before. Returns the first particle with det F <= 0 or
/// NaN, or -1. To be called in a function with CONCORD_CLONES.
template <int Dim, StressLaw Law, class Put>
CONCORD_INLINE Index stress_rows(const StressConstants& c, Index first, Index last,
                                 Window<Dim> H, const Put& put) {
  Index bad_particle = -1;
  for (Index a = first; a < last; a += stress_width) {
    const int count = std::min<Index>(stress_width, last - a);
    double h[Dim * Dim][stress_width], p[Dim * Dim][stress_width];
    Tensor<Dim> tensor[stress_width];
    const double* records = H.at(a);
    alignas(64) double copies[stress_width * record_size<Dim>];
    if (count < stress_width || H.at(a + stress_width - 1) < records) {  // few, or a ring's end
      for (int l = 0; l < stress_width; ++l) {
        std::memcpy(copies + l * record_size<Dim>, H.at(a + std::min(l, count - 1)),
                    record_size<Dim> * sizeof(double));
      }
      records = copies;
    }
    tensors_to_lanes<Dim>(records, h);
    const unsigned bad = stress_of_lanes<Dim, Law>(c, a, count, h, p);
    lanes_to_tensors<Dim>(p, tensor);
    for (int l = 0; l < count; ++l) put(a + l, tensor[l]);
    if (bad != 0 && bad_particle < 0) bad_particle = a + __builtin_ctz(bad);
  }
  return bad_particle;
}

}  // namespace concord::particle
