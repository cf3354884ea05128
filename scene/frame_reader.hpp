#pragma once
// Reads back the VTKHDF frames that FrameWriter wrote.

#include "scene/types.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace concord::scene {

/// A point field of a frame: values point after point.
struct NodalField {
  std::string name;
  int components = 1;
  std::vector<double> values;
};

/// One frame: an unstructured grid with point fields. Particles are vertex cells.
struct Frame {
  double time = 0;                   ///< [s]; static runs: load parameter
  std::vector<Vec3> points;          ///< current positions [m]
  std::vector<Index> cells;          ///< connectivity in VTK's order
  std::vector<Index> offsets;        ///< size cells + 1
  std::vector<unsigned char> types;  ///< VTK cell types, one a cell
  std::vector<NodalField> fields;

  /// The field of this name, nullptr if there is none.
  const NodalField* find(const std::string& name) const;
  /// The scalar field of this name. Throws std::runtime_error naming the scalar fields there
  /// are.
  const std::vector<double>& scalar(const std::string& name) const;
  /// X = x - u of every point [m]. Throws std::runtime_error when there is no displacement.
  std::vector<Vec3> reference_positions() const;
};

/// Reads one frame. Throws std::runtime_error with the file's name when it cannot be read or is
/// no such frame.
Frame read_frame(const std::filesystem::path& file);

/// A frame's file and its time, in the order of a series.
struct FrameEntry {
  std::filesystem::path file;
  double time = 0;
};

/// What fields.hdf.series of a run's folder lists. Throws std::runtime_error when it is absent,
/// broken or empty.
std::vector<FrameEntry> read_frame_series(const std::filesystem::path& folder);

}  // namespace concord::scene
