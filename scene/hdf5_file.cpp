#include "scene/hdf5_file.hpp"

#include "scene/safe_file.hpp"

#include <atomic>

namespace concord::scene {
namespace {

constexpr std::size_t growth = std::size_t{1} << 20;  ///< bytes by which the memory grows

Hdf5Handle in_memory() {
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make properties");
  hdf5_check(H5Pset_fapl_core(access, growth, false), "work in memory");
  return access;
}

/// HDF5 tells open files in memory by their names.
std::string next_name() {
  static std::atomic<unsigned> count{0};
  return "in memory " + std::to_string(count++);
}

}  // namespace

Hdf5Handle new_hdf5_file() {
  return {H5Fcreate(next_name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, in_memory()), H5Fclose,
          "make a file in memory"};
}

std::vector<char> hdf5_image(hid_t file) {
  hdf5_check(H5Fflush(file, H5F_SCOPE_GLOBAL), "end a file in memory");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  std::vector<char> image(size > 0 ? static_cast<std::size_t>(size) : 0);
  if (size <= 0 || H5Fget_file_image(file, image.data(), image.size()) != size)
    throw std::runtime_error("HDF5 cannot give the contents of a file in memory");
  return image;
}

Hdf5Handle open_hdf5_image(std::span<const char> image) {
  const Hdf5Handle access = in_memory();
  hdf5_check(H5Pset_file_image(access, const_cast<char*>(image.data()), image.size()),
             "take the contents of a file");  // it copies them
  return {H5Fopen(next_name().c_str(), H5F_ACC_RDONLY, access), H5Fclose, "open a file"};
}

void write_hdf5_file(hid_t file, const std::filesystem::path& target) {
  write_whole(target, {hdf5_image(file)}, Reach::system);
}

}  // namespace concord::scene
