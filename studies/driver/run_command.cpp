#include "studies/driver/commands.hpp"

#include "scene/continued_output.hpp"
#include "scene/norms.hpp"
#include "scene/reader.hpp"
#include "scene/safe_file.hpp"
#include "studies/driver/cache.hpp"
#include "studies/driver/folder_lock.hpp"
#include "studies/driver/given.hpp"
#include "studies/driver/memory.hpp"
#include "studies/driver/progress.hpp"
#include "studies/driver/resume.hpp"
#include "studies/driver/timed_runs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <optional>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

/// While it lives the cache is out of the environment, if `wanted`.
class WithoutCache {
 public:
  explicit WithoutCache(bool wanted) {
    const char* folder = std::getenv("CONCORD_CACHE");
    if (!wanted || folder == nullptr) return;
    m_folder = folder;
    ::unsetenv("CONCORD_CACHE");
  }
  ~WithoutCache() {
    if (m_folder) ::setenv("CONCORD_CACHE", m_folder->c_str(), 1);
  }
  WithoutCache(const WithoutCache&) = delete;
  WithoutCache& operator=(const WithoutCache&) = delete;

 private:
  std::optional<std::string> m_folder;
};

void print_map(const char* title, const std::map<std::string, double>& values) {
  for (const auto& [name, value] : values) {
    fmt::print("  {:<11} {:<28} {:.6g}\n", title, name, value);
    title = "";
  }
}

void print_summary(const scene::RunIdentity& id, const scene::Result& result,
                   const fs::path& out) {
  fmt::print("{} with {}{}\n", id.scene, id.method,
             id.variant.empty() ? "" : " (" + id.variant + ")");
  fmt::print("  resolution {:g}, h {:.4g} m, {} unknowns, {} particles or nodes\n",
             id.resolution, result.h, result.unknowns, result.particles);
  fmt::print("  {} steps to t = {:.6g}, {:.3g} s (and {:.3g} s to set up)\n", result.steps,
             result.t_end, result.wall_s, result.setup_s);
  print_map("errors", result.errors);
  print_map("invariants", result.invariants);
  print_map("quantities", result.quantities);
  if (result.notes.contains("resumed"))
    fmt::print("  resumed {}\n", result.notes.at("resumed"));
  fmt::print("  {}\n", (out / "summary.json").string());
}

scene::RunRequest request_of(const RunOptions& options, const scene::Problem& problem) {
  if (options.repeats < 0)
    throw InputError({"command line"}, "--repeats", std::to_string(options.repeats),
                     "0 or more timed runs");
  scene::RunRequest request;
  request.h = problem.reference_length / options.resolution;
  request.perturb = options.perturb;
  request.seed = options.seed;
  request.threads = options.threads;
  request.write_frames = options.frames;
  return request;
}

void check(const RunOptions& options) {
  for (const auto& [name, value] :
       {std::pair{"SCENE", &options.scene}, std::pair{"--method", &options.method}})
    if (value->empty())
      throw InputError({"command line"}, name, "nothing",
                       "SCENE and --method of a run, or --resume DIR");
  check_numbers(options);
  if (!(options.checkpoint >= 0))
    throw InputError({"command line"}, "--checkpoint", fmt::format("{:g}", options.checkpoint),
                     "seconds, 0 or more");
}

/// Nobody must take what an earlier run left for ours. What a run that was stopped left (its
/// summary says so) stays until this one has been set up: bad input must not take it.
void clear(const fs::path& out, bool resumes) {
  const bool stopped = fs::exists(checkpoint_file(out)) && !is_complete(out);
  if (!stopped) {
    remove_checkpoint(out);
    fs::remove(out / "summary.json");
  }
  if (!resumes && stopped)
    fmt::print(stderr, "concord: the run that was stopped in {} begins anew, not by --resume\n",
               out.string());
}

/// Runs the method, with checkpoints where it has them.
void run_kept(const scene::Method& method, const scene::Problem& problem,
              const scene::RunRequest& request, const RunOptions& options,
              scene::Result& result) {
  const auto* resumable = dynamic_cast<const scene::Resumable*>(&method);
  if (resumable == nullptr) {
    remove_checkpoint(request.out);
    return method.run(problem, request, result);
  }
  const scene::Keeping keeping{checkpoint_file(request.out), options.checkpoint,
                               !options.resume.empty(), request_text(options)};
  resumable->run_kept(problem, request, keeping, result);
}

/// After numerics that failed, a signal, a full disk: keeps what there is, where there is room
/// for it, and says how to go on.
[[noreturn]] void leave(const scene::RunIdentity& id, const scene::Result& result,
                        const std::exception& error, const fs::path& out) {
  if (dynamic_cast<const SolveError*>(&error)) remove_checkpoint(out);  // to fail again
  try {
    scene::write_file(out / "summary.json", scene::summary_json(id, result, error.what()));
  } catch (const scene::OutputError&) {  // the first one is told
  }
  throw_with_advice(error, out);
}

void write_summary(const scene::RunIdentity& id, scene::Result& result, const Timings& timings,
                   double bytes_per_particle, const fs::path& out) {
  if (!timings.wall_s.empty()) {
    result.setup_s = quantile(timings.setup_s, 0.5);
    result.wall_s = quantile(timings.wall_s, 0.5);
  }
  const std::string summary = with_memory(scene::summary_json(id, result), bytes_per_particle);
  scene::write_file(out / "summary.json", with_timings(summary, timings));
}

}  // namespace

int run_command(const RunOptions& asked) {
  std::optional<FolderLock> lock;
  if (!asked.resume.empty()) lock.emplace(asked.resume, "--resume");
  const RunOptions options = asked.resume.empty() ? asked : resumed_options(asked);
  check(options);
  const scene::Method& method = scene::MethodRegistry::instance().find(options.method);
  const Given given = sort_settings(options);
  const scene::Settings settings(options.method, method.info().parameters, given.of_method);
  const scene::Problem problem = problem_of(options.scene, given, options.seed);
  const fs::path out = options.out.empty()
                           ? build_home() / "runs" / (problem.name + "-" + options.method)
                           : options.out;
  scene::RunRequest request = request_of(options, problem);
  fs::create_directories(out);
  if (!lock) lock.emplace(out, "--out");
  clear(out, !options.resume.empty());
  const scene::RunIdentity id{problem.name,  options.method,     settings.variant(),
                              problem.dim(), options.resolution, options.perturb,
                              options.seed};
  Progress progress(problem.name + ", " + options.method);
  request.settings = given.of_method;
  request.out = out;
  request.progress = [&progress](double done, const std::string& what) {
    progress.update(done, what);
  };
  scene::Result result;
  result.threads = options.threads;
  const bool timed = options.repeats > 0;  // set-up too: bodies are made
  const MemoryUse memory;
  try {
    {
      const WithoutCache no_cache(timed);
      run_kept(method, problem, request, options, result);
    }
    const double bytes_per_particle = memory.bytes_per_particle(result.particles);
    scene::add_exact_errors(problem, result);
    // The run itself was the warm-up where there are repeats.
    const Timings timings = [&] {
      const WithoutCache no_cache(timed);
      return time_runs(method, problem, request, options.repeats);
    }();
    progress.finish();
    write_summary(id, result, timings, bytes_per_particle, out);
    // Until the results are on the disk the checkpoint is worth more than they are.
    if (fs::exists(checkpoint_file(out))) scene::bring_all_to_disk(out);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    leave(id, result, error, out);
  }
  remove_checkpoint(out);
  print_summary(id, result, out);
  return 0;
}

}  // namespace concord::studies
