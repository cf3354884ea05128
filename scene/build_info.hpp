#pragma once
// What built this program: for summary.json and the cache of results.

#include <string>

namespace concord::scene {

struct BuildInfo {
  std::string version, commit, compiler, flags;
};

/// Version of the project, commit of the source tree when the build last ran ("-dirty" if it
/// had changes; "unknown" outside a repository), compiler and its flags.
const BuildInfo& build_info();

}  // namespace concord::scene
