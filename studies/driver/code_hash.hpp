#pragma once
// Which code computes runs in this program, told by the build: a change to the study runner, or
// a commit, is then no reason to compute anything again.

#include <string>

namespace concord::studies {

/// Made once, by a source that the build writes (studies/code_hash.cmake): the hash of the
/// libraries of methods and probes linked into the program and of the sources that make runs of
/// them.
class LinkedCode {
 public:
  explicit LinkedCode(const std::string& hash);
  /// Empty in programs that were not told; their whole file stands for their code then.
  static const std::string& hash();
};

}  // namespace concord::studies
