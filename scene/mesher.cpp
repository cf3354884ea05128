#include "scene/mesher.hpp"

#include <dlfcn.h>

#include <cmath>
#include <fmt/format.h>

namespace concord::scene {
namespace fs = std::filesystem;
namespace {

const Mesher* load() {
  const std::string file = mesher_file().string();
  void* module = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
  void* entry = module == nullptr ? nullptr : dlsym(module, "concord_mesher");
  if (entry == nullptr)
    throw InputError({}, "geometry", file + ", which does not load: " + dlerror(),
                     "the module of gmsh beside the scene library, as the build leaves it");
  return reinterpret_cast<const Mesher* (*)()>(entry)();
}

}  // namespace

const Mesher& mesher() {
  static const Mesher& functions = *load();
  return functions;
}

fs::path mesher_file() {
  const char* name = "libconcord_mesher.so";
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&mesher_file), &info) == 0 || info.dli_fname == nullptr)
    return name;
  return fs::path(info.dli_fname).parent_path() / name;
}

std::string mesher_version() {
  std::error_code absent;
  const fs::path library = fs::canonical(CONCORD_GMSH_LIBRARY, absent);
  if (absent) return mesher().version();
  return fmt::format("{} {} {}", library.string(), fs::file_size(library),
                     fs::last_write_time(library).time_since_epoch().count());
}

Mesh make_mesh(const Problem& problem, const MeshRequest& request) {
  if (!(request.h > 0 && std::isfinite(request.h)))
    throw InputError({"request", 0, 0}, "resolution",
                     fmt::format("a spacing of {} m", request.h),
                     "a positive number: the spacing is reference_length/resolution");
  return mesher().make_mesh(problem, request);
}

}  // namespace concord::scene
