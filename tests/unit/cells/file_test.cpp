// Cells written as polygons.

#include "scene/continued_output.hpp"
#include "scene/hdf5_handle.hpp"
#include "tests/unit/cells/bodies.hpp"
#include "tests/unit/scene/file_size_limit.hpp"

#include <fstream>

namespace concord::particle::voronoi {
namespace {

using namespace test;
using scene::Hdf5Handle;

template <class T> std::vector<T> dataset(hid_t file, const char* path, hid_t type) {
  const Hdf5Handle set(H5Dopen2(file, path, H5P_DEFAULT), H5Dclose, path);
  const Hdf5Handle space(H5Dget_space(set), H5Sclose, path);
  std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  scene::hdf5_check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
  return values;
}

TEST(VoronoiFile, PolygonsWithTheirParticles) {
  const scene::Mesh mesh = surface_of(problem_on(box(1, 1, 1), "3D"), .5);
  const auto X = random_points(20, 3, {.05, .05, .05}, {.95, .95, .95}, 3);
  const Cells cells = make_cells(mesh, 3, 1, X, Executor(1), {true});
  ASSERT_EQ(cells.polygons.face.size(), cells.faces.size());  // a convex body: one each
  std::vector<Index> number(X.size());
  for (std::size_t a = 0; a < X.size(); ++a) number[a] = static_cast<Index>(100 + a);
  const auto path = std::filesystem::path(testing::TempDir()) / "cells.vtkhdf";
  write_cells(path, cells, number);

  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "open");
  const auto points = dataset<double>(file, "/VTKHDF/Points", H5T_NATIVE_DOUBLE);
  const auto offsets = dataset<std::int64_t>(file, "/VTKHDF/Offsets", H5T_NATIVE_INT64);
  const auto corners = dataset<std::int64_t>(file, "/VTKHDF/Connectivity", H5T_NATIVE_INT64);
  const auto types = dataset<unsigned char>(file, "/VTKHDF/Types", H5T_NATIVE_UCHAR);
  const auto particle = dataset<Index>(file, "/VTKHDF/CellData/particle", H5T_NATIVE_INT32);
  const auto neighbour = dataset<Index>(file, "/VTKHDF/CellData/neighbour", H5T_NATIVE_INT32);
  const auto wall = dataset<Index>(file, "/VTKHDF/CellData/wall", H5T_NATIVE_INT32);
  ASSERT_EQ(offsets.size(), cells.faces.size() + 1);
  ASSERT_EQ(types.size(), cells.faces.size());
  for (std::size_t f = 0; f < cells.faces.size(); ++f) {
    EXPECT_EQ(types[f], 7);
    EXPECT_EQ(particle[f], 100 + cells.faces[f].a);
    EXPECT_EQ(neighbour[f], f < cells.interior ? 100 + cells.faces[f].b : -1);
    EXPECT_EQ(wall[f], f < cells.interior ? 0 : 1);
    Vec3 area = Vec3::Zero();  // of the polygon as it is in the file
    const auto at = [&](std::int64_t i) -> Vec3 {
      return Eigen::Map<const Vec3>(&points[3 * static_cast<std::size_t>(corners[i])]);
    };
    for (std::int64_t i = offsets[f] + 1; i + 1 < offsets[f + 1]; ++i)
      area += .5 * (at(i) - at(offsets[f])).cross(at(i + 1) - at(offsets[f]));
    EXPECT_NEAR(area.norm(), cells.faces[f].A, 1e-13);
  }
}

TEST(VoronoiFile, SegmentsInThePlane) {
  const scene::Mesh mesh = surface_of(
      problem_on(plane(outline({{0, 0}, {1, 0}, {1, 1}, {0, 1}})), "plane strain"), .5);
  const auto X = random_points(20, 2, {.05, .05, 0}, {.95, .95, 0}, 3);
  const Cells cells = make_cells(mesh, 2, 1, X, Executor(1), {true});
  ASSERT_EQ(cells.polygons.face.size(), cells.faces.size());
  for (std::size_t p = 0; p < cells.polygons.face.size(); ++p) {
    const std::size_t first = cells.polygons.begin[p];
    ASSERT_EQ(cells.polygons.begin[p + 1], first + 2);
    const Vec3 along = cells.polygons.points[first + 1] - cells.polygons.points[first];
    EXPECT_NEAR(along.norm(), cells.faces[cells.polygons.face[p]].A, 1e-14);
    EXPECT_EQ(along[2], 0);
  }
}

/// At whichever part of the file there is no room any more.
TEST(VoronoiFile, AFullDiskLeavesTheOneBefore) {
  const scene::Mesh mesh = surface_of(problem_on(box(1, 1, 1), "3D"), .5);
  const auto X = random_points(200, 3, {.05, .05, .05}, {.95, .95, .95}, 3);
  const Cells cells = make_cells(mesh, 3, 1, X, Executor(1), {true});
  const auto path = std::filesystem::path(testing::TempDir()) / "cells-full.hdf";
  write_cells(path, cells);
  const auto size = std::filesystem::file_size(path);
  std::filesystem::remove(path);
  std::ofstream(path) << "before";
  for (const std::uintmax_t room : {size - 1, size - size / 20, size / 2, size / 100}) {
    const concord::test::FileSizeLimit limit(room);
    try {
      write_cells(path, cells);
      ADD_FAILURE() << "the limit did not bite";
    } catch (const scene::OutputError& error) {
      EXPECT_NE(std::string(error.what()).find("cannot write " + path.string()),
                std::string::npos)
          << error.what();
    }
    EXPECT_EQ(std::filesystem::file_size(path), 6u);
    EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
  }
  write_cells(path, cells);
  EXPECT_EQ(std::filesystem::file_size(path), size);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace concord::particle::voronoi
