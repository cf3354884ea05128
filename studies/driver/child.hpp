#pragma once
// Child processes of the study runner.

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace concord::studies {

/// Starts this program again with arguments, in a process group of its own (so that Ctrl-C
/// reaches it through us alone), its output in files. It is told to end if we die.
pid_t start_child(const std::vector<std::string>& arguments,
                  const std::filesystem::path& output, const std::filesystem::path& errors);

/// How a child ended.
struct ChildExit {
  int code = 0;    ///< exit code
  int signal = 0;  ///< signal that ended it, 0 if none
};

/// Nothing while the child still runs.
std::optional<ChildExit> poll_child(pid_t child);

/// Asks children to stop, waits up to `patience_s`, then ends them.
void stop_children(const std::vector<pid_t>& children, double patience_s);

}  // namespace concord::studies
