#pragma once
// Going on with a run that was stopped: what its folder says of it.

#include "scene/checkpoint.hpp"
#include "studies/driver/commands.hpp"

namespace concord::studies {

/// The checkpoint of a run in a folder.
std::filesystem::path checkpoint_file(const std::filesystem::path& folder);

/// Whether a folder holds a run that came to its end. (A checkpoint beside it is left over: the
/// program was killed before it could remove it.)
bool is_complete(const std::filesystem::path& folder);

/// What a checkpoint keeps of the command line, as text.
std::string request_text(const RunOptions& options);

/// The command line that a run in options.resume was begun with, its folder as `out`; threads
/// and interval are those of `options` where given. Throws InputError for options that belong
/// to the run that was stopped, and for folders without a run that can go on, saying why.
RunOptions resumed_options(const RunOptions& options);

/// The exception with a line on how to go on with the run in `folder`, where it has a
/// checkpoint; else as it is. Of Interrupted and OutputError alone.
[[noreturn]] void throw_with_advice(const std::exception& error,
                                    const std::filesystem::path& folder);

/// Removes the checkpoint of a run that is complete, or begins anew, where that is possible.
void remove_checkpoint(const std::filesystem::path& folder);

}  // namespace concord::studies
