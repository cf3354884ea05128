#pragma once
// New HDF5 files: made in memory, then written in one piece.

#include "scene/hdf5_handle.hpp"

namespace concord::scene {

/// A new file that HDF5 keeps in memory. It must not meet a full disk itself: version 1.10
/// cannot close a file that it could not write, and brings the program down at its end.
Hdf5Handle new_hdf5_file();

/// Writes a new file to the disk by way of a temporary beside `target`, so that a reader never
/// sees half a file, and what was there stays when it fails. `safely`: it has reached the disk
/// itself when this returns. Throws OutputError.
void write_hdf5_file(hid_t file, const std::filesystem::path& target, bool safely = false);

}  // namespace concord::scene
