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

void* load_library() {
  std::string tried;
  for (const std::string& path : candidates()) {
    const bool bare = path.find('/') == std::string::npos;
    if (!bare && !fs::exists(path)) {
      tried += "\n  " + path + ": not there";
      continue;
    }
    void* library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (library != nullptr) return library;
    tried += std::string("\n  ") + dlerror();
  }
  throw InputError({}, "method", "fem",
                   "a build with deal.II (cmake -DCONCORD_FEM=ON, package libdeal.ii-dev); its "
                   "library did not load:" +
                       tried);
}

/// A function of the library, which is loaded at the first call.
template <class Function> Function* entry(const char* name) {
  static void* const library = load_library();
  if (void* symbol = dlsym(library, name)) return reinterpret_cast<Function*>(symbol);
  throw InputError({}, "method", "fem", std::string("a library of this build: ") + dlerror());
}

class FiniteElements : public scene::Method, public scene::Discretises {
 public:
  const scene::MethodInfo& info() const override { return method_info(); }
  void run(const scene::Problem& problem, const scene::RunRequest& request,
           scene::Result& result) const override {
    read_options(problem, request);  // wrong settings are told before the library is loaded
    entry<decltype(concord_fem_run)>("concord_fem_run")(problem, request, result);
  }
  std::unique_ptr<scene::DiscreteBody>
  discretise(const scene::Problem& problem, const scene::RunRequest& request) const override {
    read_options(problem, request);
    return std::unique_ptr<scene::DiscreteBody>(
        entry<decltype(concord_fem_discretise)>("concord_fem_discretise")(problem, request));
  }
};

const scene::RegisterMethod<FiniteElements> registered;

}  // namespace
}  // namespace concord::fem
