#pragma once
// The exact solution where methods are compared with it. It takes longer than many a run, and
// is the same for every method, setting and resolution.

#include "scene/geometry.hpp"

#include <vector>

namespace concord::scene {

struct ExactSamples {
  Quadrature rule;             ///< common_quadrature of the problem
  std::vector<Vec3> u;         ///< [m]
  std::vector<Mat3> gradient;  ///< du/dX
};

/// At time t [s]. With $CONCORD_CACHE kept in its folder `exact`, by the problem's text, t, the
/// scene library and gmsh, 500 MB at most, the newest: what is read from there has the bits of
/// what was computed. The problem needs an exact solution.
ExactSamples exact_samples(const Problem& problem, double t);

}  // namespace concord::scene
