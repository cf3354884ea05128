#include "scene/safe_file.hpp"

#include "scene/continued_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <fstream>

namespace concord::scene {
namespace fs = std::filesystem;
namespace {

void write_all(int descriptor, std::span<const char> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw std::runtime_error("not written");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

/// Does `work` with an open file. Throws std::runtime_error, errno tells why.
template <class Work> void with_open(const fs::path& file, int flags, const Work& work) {
  const int descriptor = ::open(file.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor < 0) throw std::runtime_error("not opened");
  try {
    work(descriptor);
  } catch (...) {
    const int reason = errno;
    ::close(descriptor);
    errno = reason;
    throw;
  }
  if (::close(descriptor) != 0) throw std::runtime_error("not closed");
}

void sync(int descriptor) {
  // EINVAL, EROFS: a file system that cannot do it, for folders (fsync(2))
  if (::fsync(descriptor) != 0 && errno != EINVAL && errno != EROFS)
    throw std::runtime_error("not on the disk");
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

void write_whole(const fs::path& file, std::initializer_list<std::span<const char>> pieces,
                 Reach reach) {
  const fs::path temporary = file.string() + ".part";
  try {
    writing(file, [&] {
      with_open(temporary, O_WRONLY | O_CREAT | O_TRUNC, [&](int descriptor) {
        for (const std::span<const char> piece : pieces) write_all(descriptor, piece);
        if (reach == Reach::disk) sync(descriptor);
      });
      fs::rename(temporary, file);
      if (reach == Reach::disk) bring_to_disk(folder_of(file));
    });
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

void bring_to_disk(const fs::path& file_or_folder) {
  std::error_code absent;
  if (!fs::exists(file_or_folder, absent)) return;
  writing(file_or_folder, [&] { with_open(file_or_folder, O_RDONLY, sync); });
}

void bring_all_to_disk(const fs::path& folder) {
  std::error_code absent;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, absent)) {
    if (entry.is_regular_file(absent)) bring_to_disk(entry.path());
  }
  bring_to_disk(folder);
}

std::vector<char> read_bytes(const fs::path& file, std::uintmax_t bytes) {
  if (fs::file_size(file) < bytes) throw std::runtime_error("shorter than it was");
  std::vector<char> content(bytes);
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(content.data(), static_cast<std::streamsize>(bytes)))
    throw std::runtime_error("unreadable");
  return content;
}

}  // namespace concord::scene
