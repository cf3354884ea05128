#pragma once
// What a program asks of the disk, in order. To be included by one source of a test program:
// its fsync and rename stand in for those of the system everywhere in it.

#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <vector>

namespace concord::test {

/// While it lives: "fsync NAME" and "rename NAME" of every file or folder that was synced, and
/// every new name, without the folder.
class DiskCalls {
 public:
  DiskCalls() { s_log = &m_log; }
  ~DiskCalls() { s_log = nullptr; }
  DiskCalls(const DiskCalls&) = delete;
  DiskCalls& operator=(const DiskCalls&) = delete;

  const std::vector<std::string>& log() const { return m_log; }
  static void note(const char* call, const std::filesystem::path& file) {
    if (s_log != nullptr) s_log->push_back(call + (" " + file.filename().string()));
  }

 private:
  static inline std::vector<std::string>* s_log = nullptr;
  std::vector<std::string> m_log;
};

}  // namespace concord::test

extern "C" int fsync(int descriptor) {
  std::array<char, 4096> name{};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  if (::readlink(link.c_str(), name.data(), name.size() - 1) > 0)
    concord::test::DiskCalls::note("fsync", name.data());
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  concord::test::DiskCalls::note("rename", to);
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}
