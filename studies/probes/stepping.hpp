#pragma once
// The largest stable step of central differences, by stepping.

#include "scene/discrete_body.hpp"

#include <span>

namespace concord::probes {

struct SteppingOptions {
  long steps = 300;         ///< of a trial
  double growth = 1e4;      ///< of the motion's norm that tells an unstable step
  double amplitude = 1e-7;  ///< of the random start, in shortest distances
  double tolerance = 5e-4;  ///< relative, of the result
  double widest = 8;        ///< the result lies within this factor of the guess, or is told so
};

/// Largest dt for which w of  m w'' = f(u + w) - f(u)  stays bounded under central
/// differences from a random start at rest, by bisection from `guess` [s]. A mode beyond its
/// limit by a factor 1 + e alternates and grows by exp(sqrt(8 e)) a step: 300 steps and growth
/// 1e4 find the limit to 2e-4. Growth without alternation (buckling at u, complex eigenvalues)
/// is not the step's: it is taken out of w every 16 steps, and hides nothing.
/// Returns guess/widest or guess*widest where even these are unstable or stable.
double stable_step(scene::DiscreteBody& body, std::span<const double> u, double guess,
                   const SteppingOptions& options = {});

/// Whether what alternates of that motion grows by less than options.growth in all steps at dt.
bool stays_bounded(scene::DiscreteBody& body, std::span<const double> u, double dt,
                   const SteppingOptions& options);

}  // namespace concord::probes
