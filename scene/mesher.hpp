#pragma once
// gmsh brings some eighty libraries, which cost a program a quarter of a second at its start.
// So the sources that call it (scene/mesher) are a module, libconcord_mesher.so beside the
// scene's library, which the first mesh of a process loads.

#include "scene/geometry.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace concord::scene {

/// Functions of the module.
struct Mesher {
  Mesh (*make_mesh)(const Problem& problem, const MeshRequest& request);
  /// Moves each of the nodes to the nearest point of its entity.
  void (*put_on_entities)(Mesh& mesh, const Problem& problem, const std::vector<Index>& nodes);
  std::string (*version)();  ///< of gmsh
};

/// Loads the module at the first call. Throws InputError (geometry) if it does not load.
const Mesher& mesher();

/// The module's file, whether it is loaded or not.
std::filesystem::path mesher_file();

/// What tells one gmsh from another, without loading it where that can be: its library's file,
/// size and time, else its version.
std::string mesher_version();

}  // namespace concord::scene
