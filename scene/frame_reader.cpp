#include "scene/frame_reader.hpp"

#include "scene/hdf5_handle.hpp"

#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace concord::scene {
namespace {

/// Values of a dataset and its second extent (1 where it has one dimension).
template <class T> struct Dataset {
  std::vector<T> values;
  std::size_t columns = 1;
};

template <class T> Dataset<T> read_dataset(hid_t parent, const std::string& path, hid_t type) {
  const Hdf5Handle set(H5Dopen2(parent, path.c_str(), H5P_DEFAULT), H5Dclose, "open " + path);
  const Hdf5Handle space(H5Dget_space(set), H5Sclose, "get the extent of " + path);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank != 1 && rank != 2) throw std::runtime_error(path + " has neither rows nor columns");
  hsize_t sizes[2] = {0, 1};
  if (H5Sget_simple_extent_dims(space, sizes, nullptr) < 0)
    throw std::runtime_error("HDF5 cannot get the extent of " + path);
  Dataset<T> data;
  data.columns = sizes[1];
  data.values.resize(sizes[0] * sizes[1]);
  if (!data.values.empty())
    hdf5_check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.values.data()),
               "read " + path);
  return data;
}

std::vector<Index> read_indices(hid_t parent, const std::string& path) {
  const auto data = read_dataset<std::int64_t>(parent, path, H5T_NATIVE_INT64);
  std::vector<Index> indices;
  indices.reserve(data.values.size());
  for (const std::int64_t value : data.values) indices.push_back(static_cast<Index>(value));
  return indices;
}

std::vector<std::string> names_in(hid_t group) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  hdf5_check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names),
             "list the point fields");
  return names;
}

void read_fields(hid_t grid, Frame& frame) {
  const Hdf5Handle data(H5Gopen2(grid, "PointData", H5P_DEFAULT), H5Gclose, "open PointData");
  for (const std::string& name : names_in(data)) {
    auto values = read_dataset<double>(data, name, H5T_NATIVE_DOUBLE);
    if (values.values.size() != frame.points.size() * values.columns)
      throw std::runtime_error(fmt::format("{} has {} values for {} points", name,
                                           values.values.size(), frame.points.size()));
    frame.fields.push_back({name, static_cast<int>(values.columns), std::move(values.values)});
  }
}

void check_cells(const Frame& frame) {
  const auto size = static_cast<Index>(frame.cells.size());
  bool good = frame.offsets.size() == frame.types.size() + 1 && frame.offsets.front() == 0 &&
              frame.offsets.back() == size;
  for (std::size_t c = 1; good && c < frame.offsets.size(); ++c)
    good = frame.offsets[c] >= frame.offsets[c - 1];
  for (const Index point : frame.cells)
    good = good && point >= 0 && point < static_cast<Index>(frame.points.size());
  if (!good) throw std::runtime_error("its cells do not fit its points");
}

Frame read_grid(hid_t file) {
  const Hdf5Handle grid(H5Gopen2(file, "VTKHDF", H5P_DEFAULT), H5Gclose, "open VTKHDF");
  Frame frame;
  const auto points = read_dataset<double>(grid, "Points", H5T_NATIVE_DOUBLE);
  if (points.columns != 3) throw std::runtime_error("its points have not three coordinates");
  for (std::size_t i = 0; i < points.values.size(); i += 3)
    frame.points.emplace_back(points.values[i], points.values[i + 1], points.values[i + 2]);
  frame.cells = read_indices(grid, "Connectivity");
  frame.offsets = read_indices(grid, "Offsets");
  frame.types = read_dataset<unsigned char>(grid, "Types", H5T_NATIVE_UCHAR).values;
  check_cells(frame);
  read_fields(grid, frame);
  const auto time = read_dataset<double>(file, "provenance/time_s", H5T_NATIVE_DOUBLE);
  if (time.values.size() == 1) frame.time = time.values[0];
  return frame;
}

}  // namespace

const NodalField* Frame::find(const std::string& name) const {
  for (const NodalField& field : fields)
    if (field.name == name) return &field;
  return nullptr;
}

const std::vector<double>& Frame::scalar(const std::string& name) const {
  const NodalField* field = find(name);
  if (field != nullptr && field->components == 1) return field->values;
  std::vector<std::string> there;
  for (const NodalField& other : fields)
    if (other.components == 1) there.push_back(other.name);
  throw std::runtime_error(
      fmt::format("no scalar field {}; there are {}", name, fmt::join(there, ", ")));
}

std::vector<Vec3> Frame::reference_positions() const {
  const NodalField* u = find("displacement");
  if (u == nullptr || u->components != 3)
    throw std::runtime_error("no displacement, so that reference positions are unknown");
  std::vector<Vec3> X = points;
  for (std::size_t a = 0; a < X.size(); ++a)
    X[a] -= Vec3(u->values[3 * a], u->values[3 * a + 1], u->values[3 * a + 2]);
  return X;
}

Frame read_frame(const std::filesystem::path& file) {
  const QuietHdf5 quiet;
  try {
    const Hdf5Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                            "open it");
    return read_grid(handle);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(
        fmt::format("cannot read the frame {}: {}", file.string(), error.what()));
  }
}

std::vector<FrameEntry> read_frame_series(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "fields.hdf.series";
  std::vector<FrameEntry> entries;
  try {
    std::ifstream stream(file);
    const nlohmann::json series = nlohmann::json::parse(stream);
    for (const auto& entry : series.at("files"))
      entries.push_back(
          {folder / entry.at("name").get<std::string>(), entry.at("time").get<double>()});
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(
        fmt::format("cannot read the frame series {}: {}", file.string(), error.what()));
  }
  if (entries.empty())
    throw std::runtime_error(fmt::format("the series {} lists no frame", file.string()));
  return entries;
}

}  // namespace concord::scene
