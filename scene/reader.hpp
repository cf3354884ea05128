#pragma once
// From text to a checked Problem.

#include "scene/problem.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace concord::scene {

/// A `--set` of the command line: dotted key and text, e.g. {"material.youngs_modulus", "2
/// MPa"}.
using Override = std::pair<std::string, std::string>;

/// Reads a scene: a name in scene/library, or the path of a scene file. Overrides replace or
/// add keys before checking. Throws InputError (unknown or unread key, wrong unit, value out of
/// range, unreadable file, ...).
Problem read_problem(const std::string& name_or_path,
                     const std::vector<Override>& overrides = {});

/// Names of the scenes in the library, sorted.
std::vector<std::string> library_scenes();

/// Folder that holds `scene/library`, `studies` and `reports`: $CONCORD_HOME if set, else the
/// source tree of the build, else the installed share/concord.
std::filesystem::path data_home();

/// Every key a scene file may hold: {key, unit or type, default, allowed, meaning} for
/// `describe`.
struct KeyInfo {
  std::string key, unit, default_value, range, meaning;
};
const std::vector<KeyInfo>& scene_keys();

}  // namespace concord::scene
