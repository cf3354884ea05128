// Checkpoints are HDF5 files with one dataset an item, bits as they are in memory, and behind
// that a tag and the checksum of all that is before it. HDF5 does not mind what stands there.

#include "scene/checkpoint.hpp"

#include "scene/continued_output.hpp"
#include "scene/crc64.hpp"
#include "scene/hdf5_file.hpp"
#include "scene/safe_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>

namespace concord::scene {
namespace fs = std::filesystem;
namespace {

constexpr const char* format_name = "format";
constexpr long format_now = 2;  ///< of the items; another one is refused
constexpr std::array<char, 8> tag{'c', 'r', 'c', '6', '4', '/', 'x', 'z'};
using Trailer = std::array<char, tag.size() + sizeof(std::uint64_t)>;

InputError damaged(const fs::path& file, const std::string& key, const std::string& found) {
  return {{file.string()}, key, found, "a checkpoint that this version of the program wrote"};
}

Trailer trailer_of(std::span<const char> content) {
  const std::uint64_t sum = crc64(content);
  Trailer trailer{};
  std::memcpy(trailer.data(), tag.data(), tag.size());
  std::memcpy(trailer.data() + tag.size(), &sum, sizeof sum);
  return trailer;
}

/// What is before the trailer of a file. HDF5 gets to see nothing else: it was not made for
/// files that are damaged.
std::vector<char> checked_content(const fs::path& file) {
  std::vector<char> bytes;
  try {
    bytes = read_bytes(file, fs::file_size(file));
  } catch (const std::runtime_error&) {
    throw damaged(file, "checkpoint", fs::exists(file) ? "unreadable" : "not there");
  }
  Trailer trailer{};
  if (bytes.size() >= trailer.size())
    std::memcpy(trailer.data(), bytes.data() + bytes.size() - trailer.size(), trailer.size());
  if (!std::equal(tag.begin(), tag.end(), trailer.begin()))
    throw damaged(file, "checkpoint",
                  "unreadable: no checkpoint, cut off, or of an earlier version");
  bytes.resize(bytes.size() - trailer.size());
  if (trailer_of(bytes) != trailer)
    throw damaged(file, "checkpoint", "unreadable: damaged, its checksum is another one");
  return bytes;
}

}  // namespace

Checkpoint::Checkpoint(fs::path file, bool restores)
    : m_file(std::move(file)), m_restores(restores) {}

Checkpoint::Checkpoint(Checkpoint&& other) noexcept
    : m_file(std::move(other.m_file)), m_restores(other.m_restores),
      m_handle(std::exchange(other.m_handle, -1)), m_bytes(other.m_bytes) {}

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
  const std::vector<char> content = checked_content(file);
  state.m_bytes = content.size();
  const QuietHdf5 quiet;
  try {
    state.m_handle = open_hdf5_image(content).release();
  } catch (const std::runtime_error&) {
    throw damaged(file, "checkpoint", "unreadable: no HDF5 file");
  }
  long number = 0;
  state.item(format_name, number);
  state.require(number == format_now, format_name, std::to_string(number));
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

void Checkpoint::require(bool good, const std::string& name, const std::string& found) const {
  if (m_restores && !good) throw damaged(m_file, name, found);
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
    const auto values = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
    require(values <= m_bytes, name, "more values than the file has bytes");
    return values;
  } catch (const InputError&) {
    throw;
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
  const Hdf5Handle set(H5Dcreate2(m_handle, name.c_str(), block.type, space, H5P_DEFAULT,
                                  H5P_DEFAULT, H5P_DEFAULT),
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
void Checkpoint::fixed(const std::string& name, std::span<std::uint64_t> values) {
  transfer(name, {H5T_NATIVE_UINT64, values.size(), values.data()});
}
void Checkpoint::fixed(const std::string& name, std::span<char> values) {
  transfer(name, {H5T_NATIVE_CHAR, values.size(), values.data()});
}

void Checkpoint::finish() {
  if (m_restores) return;
  const std::vector<char> content = hdf5_image(m_handle);
  write_whole(m_file, {content, trailer_of(content)}, Reach::disk);
}

std::string checkpoint_request(const fs::path& file) {
  Checkpoint state = Checkpoint::from(file);
  std::string request;
  state.item("request", request);
  return request;
}

}  // namespace concord::scene
