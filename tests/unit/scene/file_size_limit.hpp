#pragma once
// A full disk as far as a test can have one anywhere: no file may grow beyond a size.

#include <csignal>
#include <cstdint>
#include <sys/resource.h>

namespace concord::test {

/// While it lives, writing beyond `bytes` fails with "File too large".
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::uintmax_t bytes) : m_action(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &m_before);
    rlimit limit = m_before;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &m_before);
    std::signal(SIGXFSZ, m_action);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*m_action)(int);
  rlimit m_before{};
};

}  // namespace concord::test
