#include "scene/build_info.hpp"

#include <dlfcn.h>
#include <filesystem>
#include <fstream>

namespace concord::scene {
namespace {

/// What the build wrote beside this library.
std::string commit() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&build_info), &info) == 0 || !info.dli_fname)
    return "unknown";
  std::ifstream file(std::filesystem::path(info.dli_fname).parent_path() / CONCORD_COMMIT_FILE);
  std::string text;
  return std::getline(file, text) && !text.empty() ? text : "unknown";
}

}  // namespace

const BuildInfo& build_info() {
  static const BuildInfo info{CONCORD_VERSION, commit(), CONCORD_COMPILER, CONCORD_FLAGS};
  return info;
}

}  // namespace concord::scene
