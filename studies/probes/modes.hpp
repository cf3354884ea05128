#pragma once
// Eigenvalues of K x = lambda M x with a diagonal mass, all of them.

#include "scene/discrete_body.hpp"

#include <span>
#include <vector>

namespace concord::probes {

struct Modes {
  std::vector<double> real;       ///< real parts, ascending [rad^2/s^2]
  std::vector<double> imaginary;  ///< of the same eigenvalues; all 0 for a symmetric K
  double asymmetry = 0;           ///< |K - K^T| / |K|, Frobenius
};

/// Of the free components of a body at u: LAPACK's dsyevd on M^-1/2 K M^-1/2 where K is
/// symmetric to 1e-9, else dgeev; O(n^3). Throws SolveError where LAPACK does not converge.
Modes modes(scene::DiscreteBody& body, std::span<const double> u);

}  // namespace concord::probes
