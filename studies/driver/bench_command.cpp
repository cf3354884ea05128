#include "studies/driver/commands.hpp"

#include "scene/errors.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <regex>
#include <system_error>

namespace concord::studies {
namespace {

/// What a program prints, started with one argument by the shell.
std::string printed_by(const std::string& program, const std::string& argument) {
  std::string command;
  for (const std::string& word : {program, argument})
    command.append("'").append(std::regex_replace(word, std::regex("'"), "'\\''")).append("' ");
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) throw std::system_error(errno, std::generic_category(), "cannot start " + program);
  std::string text;
  std::array<char, 4096> piece{};
  while (std::fgets(piece.data(), piece.size(), pipe.get())) text += piece.data();
  return text;
}

/// The filter as google-benchmark takes it: "-REGEX" is all but what matches. The triad runs
/// beside whatever is asked for: times that memory bounds scale with it.
std::string with_triad(const std::string& program, const std::string& filter) {
  if (filter.empty()) return ".";
  if (filter.front() == '-') return filter;
  const std::string names = printed_by(program, "--benchmark_list_tests=true");
  bool found = false;
  try {
    const std::regex wanted(filter, std::regex::extended);
    for (std::size_t begin = 0, end = 0; begin < names.size() && !found; begin = end + 1) {
      end = std::min(names.find('\n', begin), names.size());
      found = std::regex_search(names.substr(begin, end - begin), wanted);
    }
  } catch (const std::regex_error&) {
  }
  if (!found)
    throw InputError({"command line"}, "FILTER", filter,
                     "a regular expression that one of these names matches:\n" + names);
  return std::string("^triad$|").append(filter);
}

}  // namespace

int bench_command(const std::string& filter) {
  namespace fs = std::filesystem;
  const fs::path program =
      fs::read_symlink("/proc/self/exe").parent_path() / "concord_benchmarks";
  if (!fs::exists(program))
    throw InputError({"command line"}, "bench", "no benchmark program beside this one",
                     "a build with CONCORD_BENCHMARKS=ON (./concord bench makes one)");
  std::string name = program.string(),
              option = "--benchmark_filter=" + with_triad(name, filter);
  char* argv[] = {name.data(), option.data(), nullptr};
  execv(argv[0], argv);
  throw std::system_error(errno, std::generic_category(), "cannot start " + name);
}

}  // namespace concord::studies
