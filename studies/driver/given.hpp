#pragma once
// What --set and the numbers of a command line ask for, checked.

#include "scene/reader.hpp"
#include "studies/driver/commands.hpp"

#include <cstdint>
#include <map>

namespace concord::studies {

/// What --set gave, sorted by whom it concerns.
struct Given {
  std::vector<scene::Override> of_scene;
  std::map<std::string, std::string> of_method;
};

/// "key=value" in two. Throws InputError naming `option` ("--set").
std::pair<std::string, std::string> split_setting(const std::string& option,
                                                  const std::string& text);

/// A key whose first part is a method's name is a setting of that method, any other one of the
/// scene. Throws InputError for settings of another method.
Given sort_settings(const RunOptions& options);

/// The scene as asked for. One with a parameter `seed` has the run's seed in it, unless --set
/// says otherwise: its .geo may arrange the particles by it.
scene::Problem problem_of(const std::string& scene, const Given& given, std::uint64_t seed);

/// Throws InputError for a resolution, perturbation or number of threads out of range.
void check_numbers(const RunOptions& options);

}  // namespace concord::studies
