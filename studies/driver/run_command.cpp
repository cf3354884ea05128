#include "studies/driver/commands.hpp"

#include "scene/norms.hpp"
#include "scene/output.hpp"
#include "scene/reader.hpp"
#include "studies/driver/cache.hpp"
#include "studies/driver/given.hpp"
#include "studies/driver/memory.hpp"
#include "studies/driver/progress.hpp"
#include "studies/driver/timed_runs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

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

}  // namespace

int run_command(const RunOptions& options) {
  check_numbers(options);
  const scene::Method& method = scene::MethodRegistry::instance().find(options.method);
  const Given given = sort_settings(options);
  const scene::Settings settings(options.method, method.info().parameters, given.of_method);
  const scene::Problem problem = problem_of(options.scene, given, options.seed);
  const fs::path out = options.out.empty()
                           ? build_home() / "runs" / (problem.name + "-" + options.method)
                           : options.out;
  fs::create_directories(out);
  fs::remove(out /
             "summary.json");  // of an earlier run: whoever reads it must not take it for ours
  const scene::RunIdentity id{problem.name,  options.method,     settings.variant(),
                              problem.dim(), options.resolution, options.perturb,
                              options.seed};
  Progress progress(problem.name + ", " + options.method);
  scene::RunRequest request = request_of(options, problem);
  request.settings = given.of_method;
  request.out = out;
  request.progress = [&progress](double done, const std::string& what) {
    progress.update(done, what);
  };
  scene::Result result;
  result.threads = options.threads;
  if (options.repeats > 0) ::unsetenv("CONCORD_CACHE");  // set-up is timed: bodies are made
  const MemoryUse memory;
  double bytes_per_particle = std::nan("");
  Timings timings;  // the run itself is the warm-up where there are repeats
  try {
    method.run(problem, request, result);
    bytes_per_particle = memory.bytes_per_particle(result.particles);
    scene::add_exact_errors(problem, result);
    timings = time_runs(method, problem, request, options.repeats);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // numerics or Ctrl-C: keep what there is
    scene::write_file(out / "summary.json", scene::summary_json(id, result, error.what()));
    throw;
  }
  progress.finish();
  if (options.repeats > 0) {
    result.setup_s = quantile(timings.setup_s, 0.5);
    result.wall_s = quantile(timings.wall_s, 0.5);
  }
  const std::string summary = with_memory(scene::summary_json(id, result), bytes_per_particle);
  scene::write_file(out / "summary.json", with_timings(summary, timings));
  print_summary(id, result, out);
  return 0;
}

}  // namespace concord::studies
