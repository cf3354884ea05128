#include "scene/build_info.hpp"

#include "concord_commit.hpp"

namespace concord::scene {

const BuildInfo& build_info() {
  static const BuildInfo info{CONCORD_VERSION, CONCORD_COMMIT, CONCORD_COMPILER, CONCORD_FLAGS};
  return info;
}

}  // namespace concord::scene
