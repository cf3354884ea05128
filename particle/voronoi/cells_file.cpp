// Cells as polygons in a VTKHDF file, for pictures like the paper's Fig. 3.

#include "particle/voronoi/cells.hpp"
#include "scene/hdf5_file.hpp"

#include <cassert>

namespace concord::particle::voronoi {
namespace {

using scene::Hdf5Handle;

void write_column(hid_t parent, const char* name, const std::vector<Index>& values) {
  const hsize_t size = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "make a data space");
  const Hdf5Handle set(
      H5Dcreate2(parent, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose, std::string("make dataset ") + name);
  if (size == 0) return;
  scene::hdf5_check(
      H5Dwrite(set, H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
      std::string("write ") + name);
}

}  // namespace

void write_cells(const std::filesystem::path& file, const Cells& cells,
                 std::span<const Index> number) {
  constexpr unsigned char vtk_line = 3, vtk_polygon = 7;
  const FacePolygons& polygons = cells.polygons;
  assert(polygons.begin.size() == polygons.face.size() + 1);
  std::vector<Index> connectivity(polygons.points.size()), offsets, particle, neighbour, wall;
  for (std::size_t i = 0; i < connectivity.size(); ++i) connectivity[i] = static_cast<Index>(i);
  for (const std::size_t begin : polygons.begin) offsets.push_back(static_cast<Index>(begin));
  const auto name = [&](Index a) { return a < 0 || number.empty() ? a : number[a]; };
  for (const Index f : polygons.face) {
    particle.push_back(name(cells.faces[f].a));
    neighbour.push_back(name(cells.faces[f].b));
    wall.push_back(cells.faces[f].wall >= 0 ? 1 : 0);
  }
  const std::vector<unsigned char> types(particle.size(),
                                         cells.dim == 2 ? vtk_line : vtk_polygon);
  const Hdf5Handle frame =
      scene::new_frame(0, polygons.points, {}, connectivity, offsets, types);
  {
    const Hdf5Handle data(
        H5Gcreate2(frame, "/VTKHDF/CellData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
        "make group CellData");
    write_column(data, "particle", particle);
    write_column(data, "neighbour", neighbour);
    write_column(data, "wall", wall);
  }
  scene::write_hdf5_file(frame, file);
}

}  // namespace concord::particle::voronoi
