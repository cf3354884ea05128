// Checkpoints are HDF5 files with one dataset an item, bits as they are in memory.

#include "scene/checkpoint.hpp"

#include "scene/continued_output.hpp"
#include "scene/hdf5_handle.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

namespace concord::scene {
namespace fs = std::filesystem;
namespace {

constexpr const char* format_name = "format";
constexpr long format_now = 1;  ///< of the items; another one is refused

InputError damaged(const fs::path& file, const std::string& key, const std::string& found) {
  return {{file.string()}, key, found, "a checkpoint that this version of the program wrote"};
}

/// Until it is on the disk itself: a rename must not overtake it.
bool reach_disk(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool done = ::fsync(descriptor) == 0;
  return ::close(descriptor) == 0 && done;
}

}  // namespace

Checkpoint::Checkpoint(fs::path file, bool restores)
    : m_file(std::move(file)), m_temporary(m_file.string() + ".part"), m_restores(restores) {}

Checkpoint::Checkpoint(Checkpoint&& other) noexcept
    : m_file(std::move(other.m_file)), m_temporary(std::move(other.m_temporary)),
      m_restores(other.m_restores), m_handle(std::exchange(other.m_handle, -1)) {}

Checkpoint::~Checkpoint() { drop(); }

void Checkpoint::drop() noexcept {
  if (m_handle < 0) return;
  const QuietHdf5 quiet;
  H5Fclose(std::exchange(m_handle, -1));
  std::error_code ignored;
  if (!m_restores) fs::remove(m_temporary, ignored);
}

Checkpoint Checkpoint::to(const fs::path& file) {
  Checkpoint state(file, false);
  writing(file, [&] { state.open(); });
  long number = format_now;
  state.item(format_name, number);
  return state;
}

Checkpoint Checkpoint::from(const fs::path& file) {
  Checkpoint state(file, true);
  state.open();
  long number = 0;
  state.item(format_name, number);
  if (number != format_now) throw damaged(file, format_name, std::to_string(number));
  return state;
}

void Checkpoint::open() {
  const QuietHdf5 quiet;
  if (m_restores) {
    m_handle = H5Fopen(m_file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (m_handle < 0)
      throw damaged(m_file, "checkpoint", fs::exists(m_file) ? "unreadable" : "not there");
    return;
  }
  m_handle = H5Fcreate(m_temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  hdf5_check(m_handle < 0 ? -1 : 0, "create it");
}

void Checkpoint::item(const std::string& name, bool& value) {
  char byte = value ? 1 : 0;
  fixed(name, {&byte, 1});
  value = byte != 0;
}

void Checkpoint::item(const std::string& name, std::string& value) {
  std::vector<char> letters(value.begin(), value.end());
  item(name, letters);
  value.assign(letters.begin(), letters.end());
}

std::size_t Checkpoint::size(const std::string& name) const {
  const QuietHdf5 quiet;
  try {
    const Hdf5Handle set(H5Dopen2(m_handle, name.c_str(), H5P_DEFAULT), H5Dclose, "open");
    const Hdf5Handle space(H5Dget_space(set), H5Sclose, "get the extent");
    return static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  } catch (const std::exception&) {
    throw damaged(m_file, name, "nothing of that name");
  }
}

void Checkpoint::read(const std::string& name, const Block& block) const {
  if (const std::size_t saved = size(name); saved != block.size)
    throw damaged(m_file, name,
                  fmt::format("{} values where the run has {}", saved, block.size));
  if (block.size == 0) return;
  const QuietHdf5 quiet;
  try {
    const Hdf5Handle set(H5Dopen2(m_handle, name.c_str(), H5P_DEFAULT), H5Dclose, "open");
    hdf5_check(H5Dread(set, block.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, block.values), "read");
  } catch (const std::exception&) {
    throw damaged(m_file, name, "unreadable values");
  }
}

void Checkpoint::write(const std::string& name, const Block& block) {
  const QuietHdf5 quiet;
  writing(m_file, [&] {
    const hsize_t extent = block.size;
    const Hdf5Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose,
                           "make a data space");
    const Hdf5Handle set(H5Dcreate2(m_handle, name.c_str(), block.type, space, H5P_DEFAULT,
                                    H5P_DEFAULT, H5P_DEFAULT),
                         H5Dclose, "make a dataset");
    if (block.size > 0)
      hdf5_check(H5Dwrite(set, block.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, block.values),
                 "write");
  });
}

void Checkpoint::transfer(const std::string& name, const Block& block) {
  if (m_restores)
    read(name, block);
  else
    write(name, block);
}

void Checkpoint::fixed(const std::string& name, std::span<double> values) {
  transfer(name, {H5T_NATIVE_DOUBLE, values.size(), values.data()});
}
void Checkpoint::fixed(const std::string& name, std::span<long> values) {
  transfer(name, {H5T_NATIVE_LONG, values.size(), values.data()});
}
void Checkpoint::fixed(const std::string& name, std::span<Index> values) {
  transfer(name, {H5T_NATIVE_INT32, values.size(), values.data()});
}
void Checkpoint::fixed(const std::string& name, std::span<char> values) {
  transfer(name, {H5T_NATIVE_CHAR, values.size(), values.data()});
}

/// What HDF5 still keeps to itself is written by the flush; only when the disk has all of it
/// does the file get its name.
void Checkpoint::finish() {
  if (m_restores) return;
  writing(m_file, [&] {
    const QuietHdf5 quiet;
    hdf5_check(H5Fflush(m_handle, H5F_SCOPE_GLOBAL), "write what it holds");
    hdf5_check(H5Fclose(std::exchange(m_handle, -1)), "close it");
    if (!reach_disk(m_temporary)) throw std::runtime_error("not on the disk");
    fs::rename(m_temporary, m_file);
  });
}

std::string checkpoint_request(const fs::path& file) {
  Checkpoint state = Checkpoint::from(file);
  std::string request;
  state.item("request", request);
  return request;
}

}  // namespace concord::scene
