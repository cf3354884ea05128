#pragma once
// Files of a run that can be gone on with, and what happens when one cannot be written.

#include "scene/output.hpp"

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <optional>
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

/// Checksum (crc64.hpp) of the first `bytes` of a file, or of all of it; 0 where they cannot be
/// read.
std::uint64_t digest_of(const std::filesystem::path& file,
                        std::optional<std::uintmax_t> bytes = {});

/// The frames at these times, which have to be there with these digests (0: any). Changes
/// nothing. Throws InputError for one that is not.
FrameList kept_frames(const std::filesystem::path& folder, std::span<const double> times,
                      std::span<const std::uint64_t> digests);

/// These are all the frames: writes `fields.hdf.series`, and removes later ones.
void end_frames(const std::filesystem::path& folder, const FrameList& frames);

/// Goes on with a history of which the first `bytes`, with this digest (0: any), stay. Throws
/// InputError when they are not there, or not rows of these columns as HistoryWriter wrote
/// them.
HistoryWriter continue_history(const std::filesystem::path& file,
                               const std::vector<std::string>& columns, std::uintmax_t bytes,
                               std::uint64_t digest);

/// After a row that could not be written: cuts what came after the first `bytes`.
void cut_back(const std::filesystem::path& file, std::uintmax_t bytes) noexcept;

}  // namespace concord::scene
