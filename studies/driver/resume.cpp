#include "studies/driver/resume.hpp"

#include "scene/continued_output.hpp"
#include "scene/errors.hpp"
#include "studies/driver/plan.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

/// What() of another exception of the same kind, with more to it.
template <class Error> class WithAdvice : public Error {
 public:
  WithAdvice(const Error& error, const std::string& advice)
      : Error(error), m_text(fmt::format("{}\n{}", error.what(), advice)) {}
  const char* what() const noexcept override { return m_text.c_str(); }

 private:
  std::string m_text;
};

constexpr const char* what_can_be_resumed =
    "the folder of a run that was stopped before its end: of the explicit runs of particle "
    "methods; finite elements and static solves keep no checkpoints";

nlohmann::json summary_of(const fs::path& folder) {
  std::ifstream stream(folder / "summary.json");
  return nlohmann::json::parse(stream, nullptr, false);
}

/// Throws InputError that says why a folder has no run to go on with.
[[noreturn]] void refuse(const fs::path& folder) {
  std::string found = "a folder without a checkpoint";
  if (!fs::is_directory(folder)) found = "no folder";
  const auto summary = summary_of(folder);
  if (is_complete(folder))
    found = "a run that is complete";
  else if (summary.is_object())
    found = fmt::format("a run of {} on {} that left no checkpoint ({})",
                        summary.value("method", "?"), summary.value("scene", "?"),
                        summary.value("error", "?"));
  throw InputError({"command line"}, "--resume", folder.string() + ": " + found,
                   what_can_be_resumed);
}

/// A library scene by its name, a file of the user's own by its full path.
std::string place_of(const std::string& scene) {
  const fs::path path(scene);
  return fs::exists(path) && (path.has_parent_path() || path.has_extension())
             ? fs::absolute(path).string()
             : scene;
}

}  // namespace

fs::path checkpoint_file(const fs::path& folder) { return folder / "checkpoint.hdf"; }

bool is_complete(const fs::path& folder) {
  const auto summary = summary_of(folder);
  return summary.is_object() && !summary.contains("error");
}

std::string request_text(const RunOptions& options) {
  return nlohmann::ordered_json{{"scene", place_of(options.scene)},
                                {"method", options.method},
                                {"resolution", options.resolution},
                                {"perturb", options.perturb},
                                {"seed", options.seed},
                                {"threads", options.threads},
                                {"set", options.set},
                                {"frames", options.frames},
                                {"checkpoint", options.checkpoint}}
      .dump();
}

RunOptions resumed_options(const RunOptions& options) {
  const auto given = [&](const char* name) {
    return std::find(options.given.begin(), options.given.end(), name) != options.given.end();
  };
  for (const std::string& name : options.given) {
    if (name != "--resume" && name != "--threads" && name != "--checkpoint")
      throw InputError({"command line"}, name, "beside --resume",
                       "--threads and --checkpoint; the rest is that of the run that goes on");
  }
  const fs::path file = checkpoint_file(options.resume);
  if (!fs::exists(file) || is_complete(options.resume)) refuse(options.resume);
  RunOptions run;
  try {
    const auto saved = nlohmann::json::parse(scene::checkpoint_request(file));
    saved.at("scene").get_to(run.scene);
    saved.at("method").get_to(run.method);
    saved.at("resolution").get_to(run.resolution);
    saved.at("perturb").get_to(run.perturb);
    saved.at("seed").get_to(run.seed);
    saved.at("threads").get_to(run.threads);
    saved.at("set").get_to(run.set);
    saved.at("frames").get_to(run.frames);
    saved.at("checkpoint").get_to(run.checkpoint);
  } catch (const nlohmann::json::exception&) {
    throw InputError({file.string()}, "request", "no command line of a run",
                     "a checkpoint that `concord run` wrote");
  }
  if (given("--threads")) run.threads = options.threads;
  if (given("--checkpoint")) run.checkpoint = options.checkpoint;
  run.out = run.resume = options.resume;
  return run;
}

void throw_with_advice(const std::exception& error, const fs::path& folder) {
  const bool can = fs::exists(checkpoint_file(folder));
  const std::string command = shell_line({"run", "--resume", folder.string()});
  if (const auto* stopped = dynamic_cast<const Interrupted*>(&error); stopped && can)
    throw WithAdvice(*stopped, "go on with: " + command);
  if (const auto* full = dynamic_cast<const scene::OutputError*>(&error); full && can)
    throw WithAdvice(*full, "once that is mended, go on with: " + command);
  throw;
}

void remove_checkpoint(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(checkpoint_file(folder).string() + ".part", ignored);
  fs::remove(checkpoint_file(folder), ignored);
}

}  // namespace concord::studies
