#pragma once
// The subcommands of `concord`. Each returns the exit code of a job that ran to its end (0, or
// 1 when a claim failed) and throws InputError, SolveError or Interrupted otherwise.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace concord::studies {

struct RunOptions {
  std::string scene, method;
  double resolution = 8;
  double perturb = 0;
  std::uint64_t seed = 1;
  int threads = 1;
  std::vector<std::string> set;  ///< "key=value"
  std::filesystem::path out;     ///< empty: build/runs/SCENE-METHOD
  bool frames = true;
  int repeats = 0;         ///< timed warm runs after the first; 0: the first one's times count
  double checkpoint = 30;  ///< least wall time between checkpoints [s]
  std::filesystem::path resume;      ///< folder of the run to go on with; empty: a new one
  std::vector<std::string> given{};  ///< options on the command line, by their names
};
int run_command(const RunOptions& options);

/// A test that is no plain run: see studies/probes.
struct ProbeOptions : RunOptions {
  std::string test;
  std::vector<std::string> option;  ///< "key=value" of the test; `out` empty: build/probes/...
};
int probe_command(const ProbeOptions& options);

struct StudyOptions {
  std::vector<std::string> studies;  ///< of a report: empty means all
  bool full = false;
  std::filesystem::path out;  ///< empty: build/studies/NAME, build/report
  int slots = 0;              ///< runs at once; 0: one a core
};
int study_command(const StudyOptions& options);
int report_command(const StudyOptions& options);

int bench_command(const std::string& filter);
int list_command(const std::string& what, bool as_json);
int describe_command(const std::string& name);

}  // namespace concord::studies
