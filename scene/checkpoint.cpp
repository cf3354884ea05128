// Checkpoints are HDF5 files with one dataset an item, bits as they are in memory.

#include "scene/checkpoint.hpp"

#include "scene/continued_output.hpp"
#include "scene/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace concord::scene {
namespace fs = std::filesystem;
namespace {

constexpr const char* format_name = "format";
constexpr long format_now = 1;  ///< of the items; another one is refused

InputError damaged(const fs::path& file, const std::string& key, const std::string& found) {
  return {{file.string()}, key, found, "a checkpoint that this version of the program wrote"};
}

}  // namespace

Checkpoint::Checkpoint(fs::path file, bool restores)
    : m_file(std::move(file)), m_restores(restores) {}

Checkpoint::Checkpoint(Checkpoint&& other) noexcept
    : m_file(std::move(other.m_file)), m_restores(other.m_restores),
      m_handle(std::exchange(other.m_handle, -1)) {}

Checkpoint::~Checkpoint() {
  if (m_handle >= 0) H5Fclose(m_handle);
}

Checkpoint Checkpoint::to(const fs::path& file) {
  Checkpoint state(file, false);
  state.m_handle = new_hdf5_file().release();
  long number = format_now;
  state.item(format_name, number);
  return state;
}

Checkpoint Checkpoint::from(const fs::path& file) {
  Checkpoint state(file, true);
  const QuietHdf5 quiet;
  state.m_handle = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (state.m_handle < 0)
    throw damaged(file, "checkpoint", fs::exists(file) ? "unreadable" : "not there");
  long number = 0;
  state.item(format_name, number);
  if (number != format_now) throw damaged(file, format_name, std::to_string(number));
  return state;
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

bool Checkpoint::has(const std::string& name) const {
  const QuietHdf5 quiet;
  return H5Lexists(m_handle, name.c_str(), H5P_DEFAULT) > 0;
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
  const hsize_t extent = block.size;
  const Hdf5Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, "make a data space");
  const Hdf5Handle checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make properties");
  if (block.size >= 64) {  // a checksum for every chunk, which reading compares; costs 2 kB
    const hsize_t chunk = std::min<hsize_t>(extent, 65536);
    hdf5_check(H5Pset_chunk(checked, 1, &chunk), "set the chunk of " + name);
    hdf5_check(H5Pset_fletcher32(checked), "check " + name);
  }
  const Hdf5Handle set(
      H5Dcreate2(m_handle, name.c_str(), block.type, space, H5P_DEFAULT, checked, H5P_DEFAULT),
      H5Dclose, "make dataset " + name);
  if (block.size > 0)
    hdf5_check(H5Dwrite(set, block.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, block.values),
               "write " + name);
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

void Checkpoint::finish() {
  if (!m_restores) write_hdf5_file(m_handle, m_file, true);
}

std::string checkpoint_request(const fs::path& file) {
  Checkpoint state = Checkpoint::from(file);
  std::string request;
  state.item("request", request);
  return request;
}

}  // namespace concord::scene
