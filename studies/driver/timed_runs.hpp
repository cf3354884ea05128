#pragma once
// Warm runs of one process, timed: medians and quartiles.

#include "scene/method.hpp"

#include <string>
#include <vector>

namespace concord::studies {

/// What each timed run took [s].
struct Timings {
  std::vector<double> setup_s, wall_s;
};

/// Runs `repeats` times without output. `request` as of the run before, which warmed caches up;
/// its output folder and progress are not used. Throws what the method throws.
Timings time_runs(const scene::Method& method, const scene::Problem& problem,
                  const scene::RunRequest& request, int repeats);

/// The q-quantile, 0 <= q <= 1, of at least one value: linear between the ordered values, the
/// least at 0 and the greatest at 1 (type 7 of Hyndman and Fan, American Statistician 50 (1996)
/// 361).
double quantile(std::vector<double> values, double q);

/// summary.json with "repeats", "setup_s_quartiles" and "wall_s_quartiles" [first, third] at
/// its end; unchanged without timings.
std::string with_timings(const std::string& summary, const Timings& timings);

}  // namespace concord::studies
