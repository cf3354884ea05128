#include "studies/driver/folder_lock.hpp"

#include "scene/errors.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <utility>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

/// Process and machine, as text.
std::string this_process() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return fmt::format("process {} on {}", ::getpid(), host.data());
}

std::string holder(const fs::path& file) {
  std::ifstream stream(file);
  std::string text;
  std::getline(stream, text);
  return text.empty() ? "another process" : text;
}

/// Whether a file is still the one of that name: who had it may have removed it in between.
bool still_there(int descriptor, const fs::path& file) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, const char* option, Lock* lock)
    : m_file(folder / file_name) {
  while (true) {
    m_descriptor = ::open(m_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (m_descriptor < 0) return;
    const bool mine = lock(m_descriptor, LOCK_EX | LOCK_NB) == 0;
    const bool taken = !mine && errno == EWOULDBLOCK;
    if (mine && still_there(m_descriptor, m_file)) break;
    ::close(std::exchange(m_descriptor, -1));
    if (taken)
      throw InputError({"command line"}, option,
                       fmt::format("{}, in use by {}", folder.string(), holder(m_file)),
                       "a folder that no other run writes to");
    if (!mine) {  // of no use, and perhaps new
      ::unlink(m_file.c_str());
      return;
    }
  }
  const std::string text = this_process() + "\n";
  // Who it is helps the reader of a message; without room for that the lock holds as well.
  if (::ftruncate(m_descriptor, 0) != 0 || ::write(m_descriptor, text.data(), text.size()) < 0)
    errno = 0;
}

FolderLock::~FolderLock() {
  if (m_descriptor < 0) return;
  ::unlink(m_file.c_str());
  ::close(m_descriptor);
}

}  // namespace concord::studies
