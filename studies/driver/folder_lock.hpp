#pragma once
// Two programs must not write to one folder.

#include <sys/file.h>

#include <filesystem>

namespace concord::studies {

/// While it lives, no other run can have the same folder. The lock goes with the process that
/// has it, however that ends; only then the file may stay, and does not matter. File systems
/// that cannot lock, and folders that cannot be written to, go without.
class FolderLock {
 public:
  static constexpr const char* file_name = "run.lock";
  using Lock = int(int descriptor, int operation);  ///< flock(2)

  /// Throws InputError of `option`, with the folder and the process that has it. Nothing for a
  /// folder that is not there.
  FolderLock(const std::filesystem::path& folder, const char* option, Lock* lock = ::flock);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool held() const { return m_descriptor >= 0; }

 private:
  std::filesystem::path m_file;
  int m_descriptor = -1;  ///< -1: goes without
};

}  // namespace concord::studies
