#include "studies/driver/given.hpp"

#include "scene/method.hpp"
#include "studies/driver/study_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace concord::studies {

std::pair<std::string, std::string> split_setting(const std::string& option,
                                                  const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw InputError({"command line"}, option, '"' + text + '"', "key=value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

Given sort_settings(const RunOptions& options) {
  Given given;
  for (const std::string& text : options.set) {
    const auto [key, value] = split_setting("--set", text);
    const std::string prefix = key.substr(0, key.find('.'));
    bool of_method = false;
    for (const scene::Method* method : scene::MethodRegistry::instance().all())
      of_method = of_method || method->info().name == prefix;
    if (!of_method) {
      given.of_scene.emplace_back(key, value);
    } else if (prefix == options.method && key.size() > prefix.size() + 1) {
      given.of_method[key.substr(prefix.size() + 1)] = value;
    } else {
      throw InputError({"command line"}, "--set " + key, "a setting of method " + prefix,
                       "settings of the method that runs (" + options.method +
                           ") and keys of the scene");
    }
  }
  return given;
}

scene::Problem problem_of(const std::string& scene, const Given& given, std::uint64_t seed) {
  scene::Problem problem = scene::read_problem(scene, given.of_scene);
  const std::string key = "parameters.seed";
  const bool told = std::any_of(given.of_scene.begin(), given.of_scene.end(),
                                [&](const scene::Override& set) { return set.first == key; });
  if (told || !problem.parameters.contains("seed")) return problem;
  std::vector<scene::Override> overrides = given.of_scene;
  overrides.emplace_back(key, std::to_string(seed));
  return scene::read_problem(scene, overrides);
}

void check_numbers(const RunOptions& options) {
  const auto reject = [](const char* key, double found, const char* allowed) {
    throw InputError({"command line"}, key, fmt::format("{:g}", found), allowed);
  };
  if (!(options.resolution > 0) || !std::isfinite(options.resolution))
    reject("--resolution", options.resolution,
           "a number above 0: spacings along the scene's reference length");
  if (!(options.perturb >= 0 && options.perturb <= max_perturb))
    reject("--perturb", options.perturb, "a fraction of the spacing from 0 to 0.45");
  if (options.threads < 1) reject("--threads", options.threads, "1 or more");
}

}  // namespace concord::studies
