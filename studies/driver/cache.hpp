#pragma once
// Results kept by content: a run is stored under the hash of everything that decides it.

#include "scene/problem.hpp"
#include "studies/driver/study_file.hpp"

#include <filesystem>
#include <string>

namespace concord::studies {

/// SHA-256 as 64 hexadecimal digits, fed piece by piece. Every piece enters with its length, so
/// that "ab","c" differs from "a","bc".
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;
  ContentHash& add(const std::string& piece);
  /// The bytes of a file; one that cannot be read throws InputError.
  ContentHash& add_file(const std::filesystem::path& file);
  std::string digits();

 private:
  void* m_context;
};

/// What one run of a case is asked for.
struct RunKey {
  const Case* entry = nullptr;
  double resolution = 0;
  std::uint64_t seed = 1;
  bool frames = false;
  bool timed = false;  ///< ran alone: its wall time means something
};

/// Hash of the code that computes a method: the scene library, and what the program is linked
/// from that makes and times runs (code_hash.hpp); for `fem`, whose code lives in a module of
/// its own, and for probes of any method, which may run it to compare with, the module as well.
/// The commit is in none of them.
std::string build_hash(const std::string& method, bool probe = false);

/// False when the binaries have been replaced since build_hash was first asked: what runs now
/// is not what the key says.
bool build_unchanged(const std::string& method, bool probe = false);

/// Key of a run or a probe: canonical scene text, bytes of the geometry, what is asked for, the
/// binaries.
std::string cache_key(const scene::Problem& problem, const RunKey& run);

/// Finished runs below one folder, each in a folder named by its key. An entry is complete when
/// `entry.json` lists its files with their sizes; anything else is removed and computed again.
class Cache {
 public:
  explicit Cache(std::filesystem::path folder) : m_folder(std::move(folder)) {}
  /// Copies an entry into `target` (replaced). False when there is no sound entry.
  bool fetch(const std::string& key, const std::filesystem::path& target) const;
  /// Stores the files of a run; several processes may store the same key at once.
  void store(const std::string& key, const std::filesystem::path& source) const;

 private:
  std::filesystem::path m_folder;
};

/// $CONCORD_CACHE, else build/cache below build_home().
std::filesystem::path cache_folder();

/// Where results go by default: $CONCORD_HOME/build when started by the launcher, else ./build.
std::filesystem::path build_home();

}  // namespace concord::studies
