// The machine that a run ran on.

#include "scene/output.hpp"

#include <fstream>
#include <sys/resource.h>

namespace concord::scene {

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 / 1e6;  // Linux counts in KiB
}

std::string simd_name() {
  // The sets of target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4"); g++ 12 cannot ask
  // for a level by name, so its newest features stand for it.
#if defined(__x86_64__)
#if !defined(CONCORD_NO_CLONES)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return "AVX-512";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi2"))
    return "AVX2";
#endif
  return "SSE2";
#else
  return "scalar";
#endif
}

std::string cpu_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(':');
    if (line.starts_with("model name") && colon + 2 < line.size())
      return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace concord::scene
