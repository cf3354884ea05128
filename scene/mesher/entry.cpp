#include "scene/mesher/entry.hpp"

#include "scene/mesher/gmsh_session.hpp"

#include <gmsh.h>

namespace concord::scene {
namespace {

void put_on_entities(Mesh& mesh, const Problem& problem, const std::vector<Index>& nodes) {
  GmshSession session;
  session.open_geometry(problem, mesh.h, problem.layout == Layout::lattice);
  gmsh_guard(session, problem, "cannot project on", [&] {
    for (const Index node : nodes) {
      const auto a = static_cast<std::size_t>(node);
      const Entity& e = mesh.entities[static_cast<std::size_t>(mesh.node_entity[a])];
      const Vec3& X = mesh.nodes[a];
      std::vector<double> closest, parameters;
      gmsh::model::getClosestPoint(e.dim, e.tag, {X[0], X[1], X[2]}, closest, parameters);
      mesh.nodes[a] = Vec3(closest[0], closest[1], closest[2]);
    }
  });
}

std::string gmsh_version() {
  const GmshSession session;
  std::string version;
  gmsh::option::getString("General.Version", version);
  return version;
}

}  // namespace
}  // namespace concord::scene

const concord::scene::Mesher* concord_mesher() {
  using namespace concord::scene;
  static const Mesher functions{mesh_by_gmsh, put_on_entities, gmsh_version};
  return &functions;
}
