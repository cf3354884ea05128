#include "scene/hdf5_handle.hpp"
#include "scene/output.hpp"
#include "tests/unit/scene/scratch_scene.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace concord;
using namespace concord::scene;

namespace {

std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

template <class T> std::vector<T> dataset(hid_t file, const char* path, hid_t type) {
  const Hdf5Handle set(H5Dopen2(file, path, H5P_DEFAULT), H5Dclose, path);
  const Hdf5Handle space(H5Dget_space(set), H5Sclose, path);
  std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  hdf5_check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
  return values;
}

}  // namespace

TEST(History, HeaderRowsAndEveryRowOnDisk) {
  const test::ScratchScene folder("");
  HistoryWriter writer(folder.folder / "deep" / "history.csv", {"t_s", "tip_z_m"});
  const double row[] = {0.1, -1.0 / 3};
  writer.append(row);
  EXPECT_EQ(content(folder.folder / "deep" / "history.csv"),
            "t_s,tip_z_m\n0.1,-0.3333333333333333\n");
  EXPECT_FALSE(HistoryWriter().active());
  HistoryWriter().append(row);
}

TEST(Frames, VtkHdfThatReadsBack) {
  const test::ScratchScene folder("");
  FrameWriter writer(folder.folder);
  constexpr std::size_t n = 3000;  // long enough to be chunked and deflated
  std::vector<Vec3> points(n);
  std::vector<double> scalar(n), vector(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    points[i] = Vec3(static_cast<double>(i), 0.5, -1);
    scalar[i] = std::sin(static_cast<double>(i));
    vector[3 * i + 1] = scalar[i];
  }
  writer.write(0, points, {{"s", 1, scalar}, {"displacement", 3, vector}});
  writer.write(0.25, points, {{"s", 1, scalar}});
  const Hdf5Handle file(
      H5Fopen((folder.folder / "fields_0000.hdf").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
      H5Fclose, "open");
  EXPECT_EQ(dataset<double>(file, "/VTKHDF/PointData/s", H5T_NATIVE_DOUBLE), scalar);
  EXPECT_EQ(dataset<double>(file, "/VTKHDF/PointData/displacement", H5T_NATIVE_DOUBLE), vector);
  EXPECT_EQ(dataset<double>(file, "/VTKHDF/Points", H5T_NATIVE_DOUBLE)[3 * 7], 7);
  EXPECT_EQ(dataset<std::int64_t>(file, "/VTKHDF/Offsets", H5T_NATIVE_INT64).size(), n + 1);
  EXPECT_EQ(dataset<unsigned char>(file, "/VTKHDF/Types", H5T_NATIVE_UCHAR)[0], 1);
  EXPECT_GE(H5Gopen2(file, "/provenance", H5P_DEFAULT), 0);
  const auto series = nlohmann::json::parse(content(folder.folder / "fields.hdf.series"));
  EXPECT_EQ(series["files"].size(), 2u);
  EXPECT_EQ(series["files"][1]["name"], "fields_0001.hdf");
  EXPECT_EQ(series["files"][1]["time"], 0.25);
}

TEST(Summary, HasTheContractsNamesAndLeavesUndefinedOut) {
  Result result;
  result.h = 0.125;
  result.particles = 1000;
  result.steps = 10;
  result.dt = 1e-3;
  result.wall_s = 0.5;
  result.errors["displacement_l2"] = 0.01;
  result.errors["velocity_l2"] = std::nan("");
  const auto s =
      nlohmann::json::parse(summary_json({"cube", "m", "xi 1", 3, 8, 0.25, 7}, result));
  for (const char* key : {"scene",       "method",
                          "dim",         "resolution",
                          "h",           "unknowns",
                          "particles",   "seed",
                          "steps",       "dt",
                          "t_end",       "setup_s",
                          "wall_s",      "ns_per_particle_step",
                          "peak_rss_mb", "threads",
                          "errors",      "invariants",
                          "quantities",  "machine",
                          "build"})
    EXPECT_TRUE(s.contains(key)) << key;
  EXPECT_DOUBLE_EQ(s["ns_per_particle_step"], 5e4);
  EXPECT_FALSE(s["errors"].contains("velocity_l2"));
  EXPECT_FALSE(s.contains("error"));
  for (const char* key : {"cpu", "simd", "threads"}) EXPECT_TRUE(s["machine"].contains(key));
  for (const char* key : {"version", "commit", "compiler", "flags"})
    EXPECT_FALSE(s["build"][key].get<std::string>().empty()) << key;
  result.dt = 0;
  const auto still = nlohmann::json::parse(summary_json({}, result, "stopped"));
  EXPECT_FALSE(still.contains("ns_per_particle_step"));
  EXPECT_EQ(still["error"], "stopped");
}

TEST(WriteFile, ReplacesWhole) {
  const test::ScratchScene folder("");
  write_file(folder.folder / "a" / "f.txt", "one");
  write_file(folder.folder / "a" / "f.txt", "two");
  EXPECT_EQ(content(folder.folder / "a" / "f.txt"), "two");
  EXPECT_FALSE(std::filesystem::exists(folder.folder / "a" / "f.txt.part"));
}
