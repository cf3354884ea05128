// Registers `fem` without deal.II: its library, with some sixty others behind it, is loaded
// when the first run asks for it.

#include "fem_reference/entry.hpp"
#include "fem_reference/parameters.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

namespace concord::fem {
namespace {

namespace fs = std::filesystem;

/// Where libconcord_fem.so may lie: beside this program's ../lib, in the build tree, on the
/// loader's own path.
std::vector<std::string> candidates() {
  const std::string name = "libconcord_fem.so";
  std::vector<std::string> paths;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    paths.push_back((program.parent_path().parent_path() / "lib" / name).string());
    paths.push_back((program.parent_path().parent_path() / CONCORD_LIBDIR / name).string());
  }
  paths.push_back(std::string(CONCORD_FEM_BUILD_DIR) + "/" + name);
  paths.push_back(name);
  return paths;
}

decltype(&concord_fem_run) load() {
  std::string tried;
  for (const std::string& path : candidates()) {
    const bool bare = path.find('/') == std::string::npos;
    if (!bare && !fs::exists(path)) {
      tried += "\n  " + path + ": not there";
      continue;
    }
    void* library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) {
      tried += std::string("\n  ") + dlerror();
      continue;
    }
    if (void* symbol = dlsym(library, "concord_fem_run")) {
      return reinterpret_cast<decltype(&concord_fem_run)>(symbol);
    }
    tried += std::string("\n  ") + dlerror();
  }
  throw InputError({}, "method", "fem",
                   "a build with deal.II (cmake -DCONCORD_FEM=ON, package libdeal.ii-dev); its "
                   "library did not load:" +
                       tried);
}

class FiniteElements : public scene::Method {
 public:
  const scene::MethodInfo& info() const override { return method_info(); }
  void run(const scene::Problem& problem, const scene::RunRequest& request,
           scene::Result& result) const override {
    read_options(problem, request);  // wrong settings are told before the library is loaded
    static const auto run_fem = load();
    run_fem(problem, request, result);
  }
};

const scene::RegisterMethod<FiniteElements> registered;

}  // namespace
}  // namespace concord::fem
