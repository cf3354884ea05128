#pragma once
// How much memory a run needs.

#include <string>

namespace concord::studies {

/// Resident memory from its making on, without the pages of programs and libraries, which come
/// as they are first used and do not grow with the body. Where the kernel lets it, the peak
/// counts from then too (Linux, /proc/self/clear_refs); else it is that of the whole process.
class MemoryUse {
 public:
  MemoryUse();
  /// (peak - memory at the start) / particles [bytes]: everything that the run held at
  /// once, set-up included. NaN without particles or without /proc.
  double bytes_per_particle(long particles) const;

 private:
  double m_start;
};

/// summary.json with the entry "bytes_per_particle" after "peak_rss_mb"; unchanged for NaN.
std::string with_memory(const std::string& summary, double bytes_per_particle);

}  // namespace concord::studies
