// VTKHDF 1.0 frames. Format: VTK file formats, "VTKHDF File Format", UnstructuredGrid.

#include "scene/build_info.hpp"
#include "scene/continued_output.hpp"
#include "scene/hdf5_file.hpp"

#include <algorithm>
#include <cassert>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <numeric>

namespace concord::scene {
namespace {

Hdf5Handle make_group(hid_t parent, const char* name) {
  return {H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
          std::string("make group ") + name};
}

/// A dataset of rows x columns (columns 0: one-dimensional), chunked and deflated when it is
/// long enough for that to pay.
void write_dataset(hid_t parent, const std::string& name, hid_t file_type, hid_t memory_type,
                   hsize_t rows, hsize_t columns, const void* data) {
  constexpr hsize_t chunk_rows = 65536;
  const hsize_t sizes[2] = {rows, columns};
  const int rank = columns == 0 ? 1 : 2;
  const Hdf5Handle space(H5Screate_simple(rank, sizes, nullptr), H5Sclose, "make a data space");
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make properties");
  if (rows >= 1024) {
    const hsize_t chunk[2] = {std::min(rows, chunk_rows), columns};
    hdf5_check(H5Pset_chunk(properties, rank, chunk), "set the chunk of " + name);
    hdf5_check(H5Pset_shuffle(properties), "shuffle " + name);
    hdf5_check(H5Pset_deflate(properties, 4), "deflate " + name);
  }
  const Hdf5Handle set(
      H5Dcreate2(parent, name.c_str(), file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
      H5Dclose, "make dataset " + name);
  if (rows == 0) return;
  hdf5_check(H5Dwrite(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "write " + name);
}

void write_doubles(hid_t parent, const std::string& name, int components,
                   std::span<const double> values) {
  const auto columns = static_cast<hsize_t>(components);
  write_dataset(parent, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.size() / columns,
                components == 1 ? 0 : columns, values.data());
}

void write_integers(hid_t parent, const std::string& name,
                    const std::vector<std::int64_t>& values) {
  write_dataset(parent, name, H5T_STD_I64LE, H5T_NATIVE_INT64, values.size(), 0, values.data());
}

void write_text(hid_t parent, const char* name, const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "copy a type");
  hdf5_check(H5Tset_size(type, std::max<std::size_t>(text.size(), 1)), "size a text");
  hdf5_check(H5Tset_strpad(type, H5T_STR_NULLPAD), "pad a text");
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a data space");
  const Hdf5Handle attribute(H5Acreate2(parent, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose, std::string("make attribute ") + name);
  hdf5_check(H5Awrite(attribute, type, text.c_str()), std::string("write ") + name);
}

void write_version(hid_t group) {
  const hsize_t size = 2;
  const std::int64_t version[2] = {1, 0};
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "make a data space");
  const Hdf5Handle attribute(
      H5Acreate2(group, "Version", H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
      "make attribute Version");
  hdf5_check(H5Awrite(attribute, H5T_NATIVE_INT64, version), "write Version");
}

struct Cells {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<unsigned char> types;
};

/// The cells given, or every point as a vertex cell (VTK type 1).
Cells cells_of(std::size_t points, std::span<const Index> connectivity,
               std::span<const Index> offsets, std::span<const unsigned char> types) {
  Cells cells;
  if (types.empty()) {
    cells.connectivity.resize(points);
    cells.offsets.resize(points + 1);
    std::iota(cells.connectivity.begin(), cells.connectivity.end(), 0);
    std::iota(cells.offsets.begin(), cells.offsets.end(), 0);
    cells.types.assign(points, 1);
    return cells;
  }
  assert(offsets.size() == types.size() + 1);
  cells.connectivity.assign(connectivity.begin(), connectivity.end());
  cells.offsets.assign(offsets.begin(), offsets.end());
  cells.types.assign(types.begin(), types.end());
  return cells;
}

void write_grid(hid_t file, std::span<const Vec3> points,
                const std::vector<FrameField>& point_fields, const Cells& cells) {
  const Hdf5Handle group = make_group(file, "VTKHDF");
  write_version(group);
  write_text(group, "Type", "UnstructuredGrid");
  write_integers(group, "NumberOfPoints", {static_cast<std::int64_t>(points.size())});
  write_integers(group, "NumberOfCells", {static_cast<std::int64_t>(cells.types.size())});
  write_integers(group, "NumberOfConnectivityIds",
                 {static_cast<std::int64_t>(cells.connectivity.size())});
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  write_doubles(group, "Points", 3,
                {points.empty() ? nullptr : points[0].data(), 3 * points.size()});
  write_integers(group, "Connectivity", cells.connectivity);
  write_integers(group, "Offsets", cells.offsets);
  write_dataset(group, "Types", H5T_STD_U8LE, H5T_NATIVE_UCHAR, cells.types.size(), 0,
                cells.types.data());
  const Hdf5Handle data = make_group(group, "PointData");
  for (const FrameField& field : point_fields) {
    assert(field.values.size() == points.size() * static_cast<std::size_t>(field.components));
    write_doubles(data, field.name, field.components, field.values);
  }
}

void write_provenance(hid_t file, double time) {
  const Hdf5Handle group = make_group(file, "provenance");
  write_text(group, "program", "Concord");
  write_text(group, "version", build_info().version);
  write_text(group, "commit", build_info().commit);
  write_doubles(group, "time_s", 1, {&time, 1});
}

}  // namespace

Hdf5Handle new_frame(double time, std::span<const Vec3> points,
                     const std::vector<FrameField>& point_fields,
                     std::span<const Index> connectivity, std::span<const Index> offsets,
                     std::span<const unsigned char> types) {
  const QuietHdf5 quiet;
  Hdf5Handle handle = new_hdf5_file();
  write_grid(handle, points, point_fields,
             cells_of(points.size(), connectivity, offsets, types));
  write_provenance(handle, time);
  return handle;
}

void write_frame(const std::filesystem::path& file, double time, std::span<const Vec3> points,
                 const std::vector<FrameField>& point_fields,
                 std::span<const Index> connectivity, std::span<const Index> offsets,
                 std::span<const unsigned char> types) {
  write_hdf5_file(new_frame(time, points, point_fields, connectivity, offsets, types), file);
}

namespace {

void write_series(const std::filesystem::path& folder, const FrameList& frames) {
  nlohmann::ordered_json series;
  series["file-series-version"] = "1.0";
  series["files"] = nlohmann::json::array();
  for (const auto& [frame, at] : frames)
    series["files"].push_back({{"name", frame}, {"time", at}});
  write_file(folder / "fields.hdf.series", series.dump(2) + "\n");
}

std::string frame_name(std::size_t number) { return fmt::format("fields_{:04d}.hdf", number); }

}  // namespace

void add_frame(const std::filesystem::path& folder, FrameList& frames, double time,
               std::span<const Vec3> points, const std::vector<FrameField>& point_fields,
               std::span<const Index> connectivity, std::span<const Index> offsets,
               std::span<const unsigned char> types) {
  const std::string name = frame_name(frames.size());
  write_frame(folder / name, time, points, point_fields, connectivity, offsets, types);
  frames.emplace_back(name, time);
  try {
    write_series(folder, frames);
  } catch (...) {
    frames.pop_back();
    throw;
  }
}

FrameList kept_frames(const std::filesystem::path& folder, std::span<const double> times,
                      std::span<const std::uint64_t> digests) {
  FrameList frames;
  for (const double time : times) {
    const std::size_t k = frames.size();
    frames.emplace_back(frame_name(k), time);
    const std::filesystem::path file = folder / frames[k].first;
    const bool there = std::filesystem::is_regular_file(file);
    if (!there || k >= digests.size() || (digests[k] != 0 && digest_of(file) != digests[k]))
      throw InputError({file.string()}, "frame", there ? "another one" : "nothing",
                       "the frames that were written before the checkpoint");
  }
  return frames;
}

void end_frames(const std::filesystem::path& folder, const FrameList& frames) {
  write_series(folder, frames);
  for (std::size_t later = frames.size(); std::filesystem::remove(folder / frame_name(later));
       ++later) {
  }
}

FrameWriter::FrameWriter(const std::filesystem::path& folder) : m_folder(folder) {
  std::filesystem::create_directories(folder);
}

void FrameWriter::write(double time, std::span<const Vec3> points,
                        const std::vector<FrameField>& point_fields,
                        std::span<const Index> connectivity, std::span<const Index> offsets,
                        std::span<const unsigned char> types) {
  if (!active()) return;
  add_frame(m_folder, m_series, time, points, point_fields, connectivity, offsets, types);
}

}  // namespace concord::scene
