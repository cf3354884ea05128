#include "scene/mesher_version.hpp"

#include "scene/gmsh_session.hpp"

#include <gmsh.h>

namespace concord::scene {

std::string mesher_version() {
  const GmshSession session;
  std::string version;
  gmsh::option::getString("General.Version", version);
  return version;
}

}  // namespace concord::scene
