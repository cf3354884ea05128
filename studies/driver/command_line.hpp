#pragma once
// The command line: subcommands and options as design and README name them.

namespace concord::studies {

/// Parses and runs; returns the exit code. 0 done, 1 a claim failed, 2 bad input, 3 the
/// numerics failed, 4 the program itself failed (no space on the disk, a tool that is missing),
/// 130 interrupted. Messages go to the standard error stream.
int main_program(int argc, char** argv);

}  // namespace concord::studies
