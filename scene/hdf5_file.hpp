#pragma once
// HDF5 files made and read in memory; on the disk they are written in one piece.

#include "scene/hdf5_handle.hpp"
#include "scene/output.hpp"

#include <vector>

namespace concord::scene {

/// A new file that HDF5 keeps in memory. It must not meet a full disk itself: version 1.10
/// cannot close a file that it could not write, and brings the program down at its end.
Hdf5Handle new_hdf5_file();

/// The bytes of a new file.
std::vector<char> hdf5_image(hid_t file);

/// Opens bytes of a file for reading. HDF5 meets no file system then, so none that lacks the
/// locks it would ask for.
Hdf5Handle open_hdf5_image(std::span<const char> image);

/// Writes a new file to the disk by way of a temporary beside `target`, so that a reader never
/// sees half a file, and what was there stays when it fails. Throws OutputError.
void write_hdf5_file(hid_t file, const std::filesystem::path& target);

/// A VTKHDF frame in memory, to which more can be added. Arguments as FrameWriter::write.
Hdf5Handle new_frame(double time, std::span<const Vec3> points,
                     const std::vector<FrameField>& point_fields,
                     std::span<const Index> connectivity = {},
                     std::span<const Index> offsets = {},
                     std::span<const unsigned char> types = {});

}  // namespace concord::scene
