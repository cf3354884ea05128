#pragma once
// Who interacts with whom, with which weight, and the correction that makes gradients of affine
// fields exact.

#include "sph_reference/total_lagrangian/kernel.hpp"
#include "sph_reference/total_lagrangian/planes.hpp"

#include <span>
#include <vector>

namespace concord::sph {

/// Directed neighbours in rows: each particle lists all b != a with |X_ab| < R, sorted by
/// number. A pair stands in two rows, so that every particle sums its own forces and threads
/// never write to the same place. Images (Points) are neighbours like others and have no rows;
/// a particle's image at its own place is none.
struct Neighbours {
  std::vector<std::size_t> begin;  ///< row of a: [begin[a], begin[a+1])
  std::vector<Index> other;        ///< b
  Column weight;     ///< w_ab = A_b (-W'(R_ab)/R_ab) [1/m^2], A_b = V_b / thickness (TLS.3)
  Column stiffness;  ///< kappa_ab = psi E A_b W(R_ab) / R_ab^2 [N/m^4] (TLS.9); empty without
                     ///< penalty
  Column inverse_moment;  ///< K_a^-1 [m^2]: K_a = sum_b w_ab X_ab (x) X_ab (TLS.4), dim padded
                          ///< columns

  /// Zeros behind `weight` and `stiffness`, so that a vector may be loaded from the last row's
  /// end.
  static constexpr std::size_t padding = 3;
  std::size_t count() const { return begin.back(); }
};

/// Finds all pairs closer than the kernel's support with a grid of cells, in time linear in n,
/// and weighs them. V: volumes of the particles, with thickness [m^3]; penalty: psi E [Pa]; 0
/// leaves `stiffness` empty. Throws InputError (key tlsph.support) where neighbours do not span
/// the space, so that K_a has no inverse: the support must grow.
Neighbours find_neighbours(const Points& points, std::span<const double> V,
                           const Kernel& kernel, double penalty, const Executor& executor);

}  // namespace concord::sph
