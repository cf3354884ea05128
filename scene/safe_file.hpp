#pragma once
// Files that are there as a whole or not at all, also after the power has failed.

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <vector>

namespace concord::scene {

/// How far written bytes have got when a function returns.
enum class Reach {
  system,  ///< other programs see them; they are lost when the machine stops
  disk     ///< they survive that
};

/// Writes pieces, one after the other, to a temporary beside `file` and renames it, so that a
/// reader never sees half a file, and what was there stays when it fails. Throws OutputError.
void write_whole(const std::filesystem::path& file,
                 std::initializer_list<std::span<const char>> pieces, Reach reach);

/// What a file holds, or which files a folder holds, has reached the disk when this returns.
/// Nothing for what is not there. Throws OutputError.
void bring_to_disk(const std::filesystem::path& file_or_folder);

/// The same of a folder and all files in it.
void bring_all_to_disk(const std::filesystem::path& folder);

/// The first `bytes` of a file. Throws std::runtime_error where it has fewer.
std::vector<char> read_bytes(const std::filesystem::path& file, std::uintmax_t bytes);

}  // namespace concord::scene
