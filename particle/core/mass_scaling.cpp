#include "particle/core/mass_scaling.hpp"

#include "scene/errors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace concord::particle {
namespace {

/// 16 vectors of 3 components estimate a sum of squares to sqrt(2/48) = 20 %, its root to 10 %.
constexpr int probes = 16;
/// The search stops with the step between the one asked for and 1 % above; it contracts by the
/// departure from proportionality, some per cent an iteration.
constexpr double margin = 0.01;
constexpr int most_iterations = 12;

}  // namespace

MassScaling scale_masses(Body& body, ForceModel& model, const Constraints& constraints,
                         const Executor& executor, std::span<const double> u, double factor) {
  MassScaling done;
  SpectralRadius unscaled(model, constraints, executor);
  const double omega = unscaled.omega_max(u);
  if (!(omega > 0)) return done;
  const std::vector<double> r = unscaled.row_norms(u, probes);
  const std::vector<double> m = body.m;
  const auto raise = [&](double bound) {
    for (Index a = 0; a < body.n; ++a) body.m[a] = m[a] * std::max(1.0, r[a] / bound);
  };
  double bound = *std::max_element(r.begin(), r.end()) / (factor * factor);
  for (int k = 0; k < most_iterations; ++k) {
    raise(bound);
    const double now = SpectralRadius(model, constraints, executor).omega_max(u);
    done.step_ratio = omega / now;
    const double missing = factor / done.step_ratio;  // wanted within [1/(1 + margin), 1]
    if (missing <= 1 && missing >= 1 / (1 + margin)) break;
    bound /= missing * missing * (1 + margin);
  }
  if (done.step_ratio < factor * (1 - margin)) {
    throw InputError({}, "mass_scaling", fmt::format("{}", factor),
                     fmt::format("a factor that is reached (here {:.3g})", done.step_ratio));
  }
  const double before = std::accumulate(m.begin(), m.end(), 0.0);
  Index raised = 0;
  for (Index a = 0; a < body.n; ++a) {
    done.added_share += (body.m[a] - m[a]) / before;
    done.largest_ratio = std::max(done.largest_ratio, body.m[a] / m[a]);
    raised += body.m[a] > m[a] ? 1 : 0;
  }
  done.particle_share = static_cast<double>(raised) / body.n;
  return done;
}

}  // namespace concord::particle
