#pragma once
// Counting: what runs inside counted() is what callgrind writes out, under a name of its own.

#include <valgrind/callgrind.h>

#include <cstdio>
#include <string>

namespace concord::instructions {

/// Runs `work`; under callgrind (--instr-atstart=no) the instructions of it alone are counted
/// and written with the trigger "Client Request: NAME". Warm it up first: the first call of a
/// library function goes through the loader.
template <class Work> void counted(const std::string& name, const Work& work) {
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
  work();
  CALLGRIND_DUMP_STATS_AT(name.c_str());
  CALLGRIND_STOP_INSTRUMENTATION;
}

/// Prints what counts depend on: the compiler, and the instruction set that the loader picks
/// (under valgrind: no AVX-512).
inline void tell_compiler() {
  const char* isa = __builtin_cpu_supports("x86-64-v4")   ? "AVX-512"
                    : __builtin_cpu_supports("x86-64-v3") ? "AVX2"
                                                          : "baseline";
#ifdef __clang__
  const char* compiler = "Clang " __clang_version__;
#else
  const char* compiler = "GCC " __VERSION__;
#endif
#ifdef NDEBUG
  const char* checks = "";
#else
  const char* checks = ", with assertions";
#endif
  std::printf("compiled %s, %s%s\n", compiler, isa, checks);
}

/// Whether the command line names this case; without names, all are wanted.
inline bool wanted(const std::string& name, int argc, char** argv) {
  bool found = argc < 2;
  for (int i = 1; i < argc; ++i) found = found || name == argv[i];
  return found;
}

}  // namespace concord::instructions
