#pragma once

#include <string>

namespace concord::scene {

/// Version of the gmsh library that this process runs.
std::string mesher_version();

}  // namespace concord::scene
