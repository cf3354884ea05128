#pragma once
// Bodies that took long to make, kept on disk by content.

#include "particle/core/body.hpp"

#include <filesystem>
#include <optional>

namespace concord::particle {

/// What is asked of make_body.
struct Arrangement {
  double h = 0;
  double perturb = 0;
  std::uint64_t seed = 1;
  CellSource cells = CellSource::delaunay;
};

/// A mesh and its triangulation, one file each, named by a hash of everything that decides
/// them: bytes of the .geo, parameters, dimension, layout, the arrangement, gmsh's version, and
/// the program and scene library that would make them. Any number of processes may share the
/// folder: files appear whole, by renaming, and one that is cut off or damaged (it carries a
/// checksum) is made again. When the files exceed the limit, those not used for longest go.
class BodyCache {
 public:
  explicit BodyCache(std::filesystem::path folder, std::uintmax_t limit = default_limit)
      : m_folder(std::move(folder)), m_limit(limit) {}
  /// The folder `bodies` below $CONCORD_CACHE; none if that is not set.
  static std::optional<BodyCache> from_environment();

  /// Name of the file; empty where the .geo reads other files or asks the environment, whose
  /// contents are not known here, and where a file cannot be read.
  std::string key(const scene::Problem& problem, const Arrangement& wanted) const;
  /// Node order, triangulation, mesh and the time they took to make; false if they are not
  /// there.
  bool fetch(const std::string& key, Body& body, double& made_s) const;
  void store(const std::string& key, const Body& body, double made_s) const;

  /// Bodies made faster are not kept: reading takes 0.2 s a million particles, and most bodies
  /// are made once.
  static constexpr double worthwhile_s = 0.5;
  static constexpr std::uintmax_t default_limit = 2'000'000'000;  ///< bytes, ten bodies of 1M

 private:
  void make_room() const;

  std::filesystem::path m_folder;
  std::uintmax_t m_limit;
};

}  // namespace concord::particle
