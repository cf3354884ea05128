#include "scene/hdf5_file.hpp"

#include "scene/continued_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <vector>

namespace concord::scene {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t growth = std::size_t{1} << 20;  ///< bytes by which the memory grows

void write_all(int descriptor, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw std::runtime_error("not written");
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
}

/// Creates `file` with these bytes.
void write_bytes(const fs::path& file, const char* bytes, std::size_t size, bool safely) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) throw std::runtime_error("not opened");
  try {
    write_all(descriptor, bytes, size);
    if (safely && ::fsync(descriptor) != 0) throw std::runtime_error("not on the disk");
  } catch (...) {
    const int reason = errno;
    ::close(descriptor);
    errno = reason;
    throw;
  }
  if (::close(descriptor) != 0) throw std::runtime_error("not closed");
}

}  // namespace

Hdf5Handle new_hdf5_file() {
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make properties");
  hdf5_check(H5Pset_fapl_core(access, growth, false), "work in memory");
  static std::atomic<unsigned> count{0};  // HDF5 tells open files in memory by their names
  const std::string name = "in memory " + std::to_string(count++);
  return {H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose,
          "make a file in memory"};
}

void write_hdf5_file(hid_t file, const fs::path& target, bool safely) {
  hdf5_check(H5Fflush(file, H5F_SCOPE_GLOBAL), "end " + target.string());
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  std::vector<char> image(size > 0 ? static_cast<std::size_t>(size) : 0);
  if (size <= 0 || H5Fget_file_image(file, image.data(), image.size()) != size)
    throw std::runtime_error("HDF5 cannot give the contents of " + target.string());
  const fs::path temporary = target.string() + ".part";
  try {
    writing(target, [&] {
      write_bytes(temporary, image.data(), image.size(), safely);
      fs::rename(temporary, target);
    });
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

}  // namespace concord::scene
