#pragma once
// Who interacts with whom, with which weight, and the correction that makes gradients of affine
// fields exact.

#include "sph_reference/total_lagrangian/kernel.hpp"
#include "sph_reference/total_lagrangian/planes.hpp"

#include <span>
#include <vector>

namespace concord::sph {

/// Every pair of particles with |X_ab| < R, once: particles are cut into blocks, and a pair
/// within a block stands in the row of its lower particle, for both of them. A pair of two
/// blocks stands in both rows, for the particle of the row alone, and so does a particle with
/// an image (Points): a block's loops write to its own particles only. Rows are sorted by
/// number, pairs for both first. A particle's image at its own place is no neighbour.
struct Neighbours {
  std::vector<Index> blocks;       ///< block k: particles [blocks[k], blocks[k+1])
  std::vector<std::size_t> begin;  ///< row of a: [begin[a], begin[a+1])
  std::vector<std::size_t> cut;    ///< entries [begin[a], cut[a]) count for b as well
  std::vector<Index> other;        ///< b
  Column weight;                   ///< c_ab = V_a w_ab [m], symmetric in a and b (TLS.3)
  Column stiffness;                ///< k_ab [N/m], symmetric (TLS.9); empty without penalty
  Column inverse_moment;           ///< (V_a K_a)^-1 [1/m^3] (TLS.4), dim padded columns
  std::size_t directed = 0;        ///< sum over the particles of their neighbours
  std::vector<Index> lowest;       ///< lowest and highest particle that a block's rows read
  std::vector<Index> highest;

  /// Zeros behind `weight` and `stiffness`, so that a vector may be loaded from the last row's
  /// end.
  static constexpr std::size_t padding = 3;
};

/// The same as rows of all neighbours of each particle, sorted by number; for what is done
/// rarely.
struct DirectedRows {
  std::vector<std::size_t> begin;  ///< row of a: [begin[a], begin[a+1])
  std::vector<Index> other;
  std::vector<std::size_t> entry;  ///< where the pair stands in Neighbours
};
DirectedRows directed_rows(const Neighbours& rows);

/// Finds all pairs closer than the kernel's support with a grid of cells, in time linear in n,
/// and weighs them; blocks as blocks_of() cuts them. V: volumes of the particles, with
/// thickness [m^3]; penalty: psi E [Pa]; 0 leaves `stiffness` empty. sizes: R_a over the
/// kernel's radius, of every particle; a pair has the mean of both, R_ab = (R_a + R_b)/2, in
/// place of R; empty: R everywhere. Throws InputError (key tlsph.support) where neighbours do
/// not span the space, so that K_a has no inverse: the support must grow.
Neighbours find_neighbours(const Points& points, std::span<const double> V,
                           const Kernel& kernel, double penalty, const Executor& executor,
                           std::span<const double> sizes = {});

/// For arrangements whose spacing varies: the mean length of the triangulation's edges at each
/// particle over the body's mean spacing h, but not below 1.
std::vector<double> local_sizes(const Body& body);

/// (V_a K_a)^-1 of V_a K_a into padded columns; false where its eigenvalues differ by more than
/// the factor 1/least, in which case nothing is written.
bool invert_moment(const Body& body, Mat3 K, double least, double* inverse);

/// Contiguous ranges of particles, the same for every number of threads: as many as are at
/// least 512 particles and 2 R thick along the body's longest axis, beyond four at least 3 R,
/// so that particles in sweep order (Body) have few pairs between blocks; an even number; at
/// most max_blocks.
inline constexpr Index max_blocks = 64;
std::vector<Index> blocks_of(const Body& body, double R);

}  // namespace concord::sph
