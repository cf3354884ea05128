#pragma once
// Runs the program ccx.

#include <filesystem>
#include <functional>
#include <string>

namespace concord::calculix {

/// The program ccx on PATH; empty if there is none.
std::filesystem::path find_program();

/// Runs `program` on job.inp in `folder` with its messages in job.log; `watch` is called some
/// times a second meanwhile. Returns the exit status, 128 + n after signal n. When `watch`
/// throws, the program is ended first. Throws SolveError if it cannot be started.
int run_program(const std::filesystem::path& program, const std::filesystem::path& folder,
                int threads, const std::function<void()>& watch);

/// "2.20", from the messages; empty if they do not say.
std::string program_version(const std::filesystem::path& log);
/// Errors and the last lines of the messages, for people.
std::string log_tail(const std::filesystem::path& log);

}  // namespace concord::calculix
