#pragma once
// Runs the runs of a study: from the cache, or as child processes of this program.

#include "studies/driver/plan.hpp"

#include <filesystem>
#include <vector>

namespace concord::studies {

struct RunnerOptions {
  std::filesystem::path out;  ///< folder of the study
  int slots = 1;              ///< runs at once; a study with timing = true takes one
};

struct RunnerResult {
  std::vector<Row> rows;  ///< in the order of cases, resolutions, seeds
  bool interrupted = false;
  std::size_t computed = 0, reused = 0;
};

/// Expands cases to runs and gets every one. A run that fails in its numerics (or crashes) is a
/// row with its error. After Ctrl-C children are stopped and the rows so far returned. Throws
/// InputError when a scene, method or setting of the study is wrong.
RunnerResult run_cases(const Study& study, const RunnerOptions& options);

}  // namespace concord::studies
