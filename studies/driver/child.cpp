#include "studies/driver/child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>

namespace concord::studies {

pid_t start_child(const std::vector<std::string>& arguments,
                  const std::filesystem::path& output, const std::filesystem::path& errors) {
  std::vector<char*> argv;
  // By way of /proc: this very program, even if a build has replaced its file meanwhile.
  std::string program = "/proc/self/exe";
  argv.push_back(program.data());
  std::vector<std::string> copies = arguments;
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const int err = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const pid_t parent = getpid();
  const pid_t child = out < 0 || err < 0 ? -1 : fork();
  if (child == 0) {
    // Between fork and exec only async-signal-safe calls.
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(127);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  const int failure = errno;
  if (out >= 0) close(out);
  if (err >= 0) close(err);
  if (child < 0)
    throw std::system_error(failure, std::generic_category(), "cannot start " + program);
  return child;
}

std::optional<ChildExit> poll_child(pid_t child) {
  int status = 0;
  const pid_t ended = waitpid(child, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
  if (ended < 0) return ChildExit{127, 0};
  if (WIFSIGNALED(status)) return ChildExit{0, WTERMSIG(status)};
  return ChildExit{WEXITSTATUS(status), 0};
}

void stop_children(const std::vector<pid_t>& children, double patience_s) {
  using Clock = std::chrono::steady_clock;
  for (const pid_t child : children) kill(child, SIGINT);
  const auto deadline = Clock::now() + std::chrono::duration<double>(patience_s);
  for (const pid_t child : children) {
    while (!poll_child(child)) {
      if (Clock::now() > deadline) kill(child, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
}

}  // namespace concord::studies
