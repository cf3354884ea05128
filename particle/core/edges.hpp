#pragma once
// The edges of a body's triangulation, for measures that need nearest neighbours of every
// method, and for bonds and springs that break.

#include "particle/core/body.hpp"

#include <vector>

namespace concord::particle {

/// Edges ab, a < b, in rows of a, sorted by b, with the weight w_ab = V_ab / |X_ab|^2 [m], V_ab
/// the edge's share of the simplices around it (a simplex divides its volume equally among its
/// edges), so that sum w_ab |X_ab|^2 is the body's volume. Edges of flat simplices alone have
/// weight 0. Weights in single precision: they weigh averages.
struct Edges {
  std::vector<std::size_t> begin;  ///< row of a: [begin[a], begin[a+1])
  std::vector<Index> other;        ///< b
  std::vector<float> weight;       ///< w_ab [m] (3D, or thickness included)
};

/// In time and memory linear in the particles.
Edges make_edges(const Body& body);

}  // namespace concord::particle
