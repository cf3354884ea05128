#include "studies/driver/commands.hpp"

#include "scene/errors.hpp"

#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace concord::studies {

int bench_command(const std::string& filter) {
  namespace fs = std::filesystem;
  const fs::path program =
      fs::read_symlink("/proc/self/exe").parent_path() / "concord_benchmarks";
  if (!fs::exists(program))
    throw InputError({"command line"}, "bench", "no benchmark program beside this one",
                     "a build with CONCORD_BENCHMARKS=ON (./concord bench makes one)");
  std::string name = program.string(),
              option = "--benchmark_filter=" + (filter.empty() ? "." : filter);
  char* argv[] = {name.data(), option.data(), nullptr};
  execv(argv[0], argv);
  throw std::system_error(errno, std::generic_category(), "cannot start " + name);
}

}  // namespace concord::studies
