#pragma once
// What the module hands out: see scene/mesher.hpp.

#include "scene/mesher.hpp"

namespace concord::scene {

/// make_mesh of a spacing that is known to be one.
Mesh mesh_by_gmsh(const Problem& problem, const MeshRequest& request);

}  // namespace concord::scene

extern "C" const concord::scene::Mesher* concord_mesher();
