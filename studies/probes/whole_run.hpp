#pragma once
// Runs of a method inside a probe, whose end by SolveError may be the result.

#include "studies/probes/probe.hpp"

namespace concord::probes {

struct Attempt {
  scene::Result result;
  bool failed = false;
  std::string error;     ///< message of the SolveError
  std::string quantity;  ///< what failed: "det F", ...
};

/// Runs the request's method on `problem` with history (and frames, where asked) in `folder`
/// (may be empty). SolveError is caught; InputError is not.
Attempt attempt(const ProbeRequest& request, const scene::Problem& problem,
                const std::filesystem::path& folder, bool frames = false);

/// Whether every number is finite in history.csv and in the point fields of all frames of a
/// folder; a file that cannot be read is not.
bool all_finite(const std::filesystem::path& folder);

/// Columns of a CSV file with one header line. Throws std::runtime_error for a broken file.
std::map<std::string, std::vector<double>> read_columns(const std::filesystem::path& csv);

/// Energy over a run from its history.csv: `drift`, the largest change of kinetic + stored
/// energy
/// (+ dissipation - external work) over its largest value, and `trend`, the mean of the last
/// tenth of the rows less that of the first, over the latter.
void tell_energy(const std::filesystem::path& folder,
                 std::map<std::string, double>& quantities);
/// linear_ and angular_momentum_drift, where the run has them.
void tell_momenta(const Attempt& attempt, std::map<std::string, double>& quantities);

/// Size of a run and its evidence into the probe's result.
void tell_run(const Attempt& attempt, scene::Result& result);

}  // namespace concord::probes
