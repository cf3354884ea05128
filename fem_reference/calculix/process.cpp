#include "fem_reference/calculix/process.hpp"

#include "scene/errors.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

namespace concord::calculix {
namespace {

namespace fs = std::filesystem;

/// Ends the program if it still runs when this goes.
class Child {
 public:
  explicit Child(pid_t pid) : m_pid(pid) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (m_pid <= 0) return;
    kill(m_pid, SIGTERM);
    waitpid(m_pid, nullptr, 0);
  }
  /// True once it has ended; `status` is then that of waitpid.
  bool ended(int& status) {
    const pid_t found = waitpid(m_pid, &status, WNOHANG);
    if (found == 0) return false;
    if (found < 0) status = 0;  // nobody to wait for: its files tell how it went
    m_pid = 0;
    return true;
  }

 private:
  pid_t m_pid;
};

std::vector<std::string> environment_with(int threads) {
  std::vector<std::string> out;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    if (!text.starts_with("OMP_NUM_THREADS=") && !text.starts_with("CCX_NPROC") &&
        !text.starts_with("OPENBLAS_NUM_THREADS="))
      out.push_back(text);
  }
  out.push_back(fmt::format("OMP_NUM_THREADS={}", std::max(1, threads)));
  out.emplace_back(
      "OPENBLAS_NUM_THREADS=1");  // its threads wait for each other in small blocks
  return out;
}

pid_t start(const fs::path& program, const fs::path& folder, int threads) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, "job.log", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  std::vector<std::string> words{program.string(), "job"};
  std::vector<std::string> environment = environment_with(threads);
  std::vector<char*> argv, envp;
  for (std::string& w : words) argv.push_back(w.data());
  for (std::string& e : environment) envp.push_back(e.data());
  argv.push_back(nullptr);
  envp.push_back(nullptr);
  pid_t pid = 0;
  const int error =
      posix_spawn(&pid, program.c_str(), &actions, nullptr, argv.data(), envp.data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw SolveError("the start of CalculiX", 0, 0, -1,
                     fmt::format("{}: {}", program.string(), std::strerror(error)));
  return pid;
}

}  // namespace

fs::path find_program() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder) / "ccx";
    if (!folder.empty() && access(program.c_str(), X_OK) == 0) return fs::absolute(program);
  }
  return {};
}

int run_program(const fs::path& program, const fs::path& folder, int threads,
                const std::function<void()>& watch) {
  Child child(start(program, folder, threads));
  int status = 0;
  auto pause = std::chrono::milliseconds(1);
  while (!child.ended(status)) {
    watch();
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::milliseconds(100));
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

std::string program_version(const fs::path& log) {
  std::ifstream file(log);
  const std::string mark = "CalculiX Version ";
  for (std::string line; std::getline(file, line);) {
    const std::size_t at = line.find(mark);
    if (at == std::string::npos) continue;
    const std::string rest = line.substr(at + mark.size());
    return rest.substr(0, rest.find_first_of(", "));
  }
  return {};
}

std::string log_tail(const fs::path& log) {
  constexpr std::size_t last = 8;
  std::ifstream file(log);
  std::vector<std::string> errors, lines;
  for (std::string line; std::getline(file, line);) {
    if (line.find_first_not_of(" \t\r*_") == std::string::npos) continue;
    if (line.find("*ERROR") != std::string::npos) errors.push_back(line);
    lines.push_back(line);
    if (lines.size() > last) lines.erase(lines.begin());
  }
  if (errors.size() > last) errors.resize(last);
  std::string text;
  for (const std::string& line : errors)
    if (std::find(lines.begin(), lines.end(), line) == lines.end()) text += "\n  " + line;
  for (const std::string& line : lines) text += "\n  " + line;
  return text;
}

}  // namespace concord::calculix
