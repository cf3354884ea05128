#pragma once
// Files of a run that can be gone on with, and what happens when one cannot be written.

#include "scene/output.hpp"

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace concord::scene {

/// A file of the results could not be written: full disk, no permission.
class OutputError : public std::runtime_error {
 public:
  /// `reason`: empty for that of errno, if there is one.
  explicit OutputError(const std::filesystem::path& file, const std::string& reason = "");
};

/// Does `write`, which writes to `file`; what it throws becomes an OutputError that names it.
template <class Write> void writing(const std::filesystem::path& file, const Write& write) {
  errno = 0;
  try {
    write();
  } catch (const OutputError&) {
    throw;
  } catch (const std::exception&) {
    throw OutputError(file);
  }
}

/// Frames of a folder: file names and times.
using FrameList = std::vector<std::pair<std::string, double>>;

/// Writes the next frame of a list as FrameWriter does, adds it to the list and writes
/// `fields.hdf.series`. The list is as before when that fails.
void add_frame(const std::filesystem::path& folder, FrameList& frames, double time,
               std::span<const Vec3> points, const std::vector<FrameField>& point_fields,
               std::span<const Index> connectivity = {}, std::span<const Index> offsets = {},
               std::span<const unsigned char> types = {});

/// The frames at these times are those that stay: writes `fields.hdf.series` of them, and
/// removes later ones. Throws InputError for one that is not there.
FrameList keep_frames(const std::filesystem::path& folder, std::span<const double> times);

/// Goes on with a history of which the first `bytes` stay. Throws InputError when they are not
/// there, or not rows of these columns as HistoryWriter wrote them.
HistoryWriter continue_history(const std::filesystem::path& file,
                               const std::vector<std::string>& columns, std::uintmax_t bytes);

/// After a row that could not be written: cuts what came after the first `bytes`.
void cut_back(const std::filesystem::path& file, std::uintmax_t bytes) noexcept;

}  // namespace concord::scene
