// `concord probe`: one test of a method on a scene, whose numbers go to summary.json.

#include "scene/output.hpp"
#include "studies/driver/cache.hpp"
#include "studies/driver/folder_lock.hpp"
#include "studies/driver/given.hpp"
#include "studies/driver/progress.hpp"
#include "studies/probes/probe.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

/// summary.json of a run with the probe's name and options beside its quantities.
std::string probe_summary(const scene::RunIdentity& id, const scene::Result& result,
                          const ProbeOptions& options, const scene::Settings& chosen,
                          const std::string& error = "") {
  auto json = nlohmann::ordered_json::parse(scene::summary_json(id, result, error));
  json["probe"] = options.test;
  json["options"] = chosen.all();
  return json.dump(2) + "\n";
}

scene::Settings probe_options(const ProbeOptions& options, const probes::Probe& probe) {
  std::map<std::string, std::string> given;
  for (const std::string& text : options.option) {
    const auto [key, value] = split_setting("--option", text);
    given[key] = value;
  }
  return {options.test, probe.info().options, given};
}

scene::RunRequest run_request(const ProbeOptions& options, const scene::Problem& problem,
                              const Given& given, const fs::path& out) {
  scene::RunRequest request;
  request.h = problem.reference_length / options.resolution;
  request.perturb = options.perturb;
  request.seed = options.seed;
  request.threads = options.threads;
  request.settings = given.of_method;
  request.out = out;
  request.write_frames = false;
  return request;
}

void print_quantities(const probes::ProbeInfo& info, const scene::Result& result) {
  for (const probes::QuantityInfo& quantity : info.quantities) {
    const auto found = result.quantities.find(quantity.name);
    if (found == result.quantities.end()) continue;
    fmt::print("  {:<26} {:<12.6g} {:<12} {}\n", quantity.name, found->second,
               quantity.unit == "1" ? "" : quantity.unit, quantity.meaning);
  }
  for (const auto& [name, note] : result.notes) fmt::print("  {}: {}\n", name, note);
}

}  // namespace

int probe_command(const ProbeOptions& options) {
  check_numbers(options);
  const probes::Probe& probe = probes::ProbeRegistry::instance().find(options.test);
  const scene::Method& method = scene::MethodRegistry::instance().find(options.method);
  const Given given = sort_settings(options);
  const scene::Settings settings(options.method, method.info().parameters, given.of_method);
  const scene::Settings chosen = probe_options(options, probe);
  const scene::Problem problem = problem_of(options.scene, given, options.seed);
  const fs::path out =
      options.out.empty()
          ? build_home() / "probes" / (options.test + "-" + problem.name + "-" + options.method)
          : options.out;
  fs::create_directories(out);
  const FolderLock lock(out, "--out");
  fs::remove(out / "summary.json");  // of an earlier one: nobody must take it for ours
  const scene::RunIdentity id{problem.name,  options.method,     settings.variant(),
                              problem.dim(), options.resolution, options.perturb,
                              options.seed};
  probes::ProbeRequest request{problem, method, run_request(options, problem, given, out),
                               chosen, cache_folder() / "references" / build_hash("fem", true)};
  Progress progress(options.test + ", " + problem.name + ", " + options.method);
  request.run.progress = [&progress](double done, const std::string& what) {
    progress.update(done, what);
  };
  scene::Result result;
  result.h = request.run.h;
  result.threads = options.threads;
  const auto begin = std::chrono::steady_clock::now();
  try {
    probe.run(request, result);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    scene::write_file(out / "summary.json",
                      probe_summary(id, result, options, chosen, error.what()));
    throw;
  }
  result.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  progress.finish();
  scene::write_file(out / "summary.json", probe_summary(id, result, options, chosen));
  fmt::print("{} of {} with {}{}\n", options.test, id.scene, id.method,
             id.variant.empty() ? "" : " (" + id.variant + ")");
  print_quantities(probe.info(), result);
  fmt::print("  {}\n", (out / "summary.json").string());
  return 0;
}

}  // namespace concord::studies
