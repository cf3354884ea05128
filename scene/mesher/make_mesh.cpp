// From the .geo to cells, facets, entities and groups.

#include "scene/mesher/entry.hpp"
#include "scene/mesher/gmsh_session.hpp"
#include "scene/mesh_parts.hpp"
#include "scene/suggest.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gmsh.h>

namespace concord::scene {
namespace {

using DimTag = std::pair<int, int>;

void generate(const GmshSession& session, const Problem& problem, const MeshRequest& request) {
  const int dim = problem.dim();
  const bool hypercube = request.shape == CellShape::hypercube;
  if (hypercube) {
    std::vector<DimTag> surfaces;
    gmsh::model::getEntities(surfaces, 2);
    if (request.layout == Layout::lattice || dim == 2)
      for (const auto& [d, tag] : surfaces) gmsh::model::mesh::setRecombine(d, tag);
    if (request.layout == Layout::unstructured)  // 1: all quadrangles, 2: all hexahedra
      gmsh::option::setNumber("Mesh.SubdivisionAlgorithm", dim == 2 ? 1 : 2);
  }
  gmsh_guard(session, problem, "cannot mesh", [&] {
    gmsh::model::mesh::generate(dim);
    if (request.order == 2) gmsh::model::mesh::setOrder(2);
  });
  if (const std::string report = session.logged_error(); !report.empty())
    session.fail(problem, "cannot mesh", report);
}

/// How much larger the spacing before the subdivision into hypercubes must be. Quadrangles are
/// halved. Each tetrahedron gives four hexahedra, and about 5.8 tetrahedra fill a cube of their
/// edge length (counted on gmsh's meshes of a cube): (4 * 5.8)^(1/3).
double subdivided_spacing(int dim) { return dim == 2 ? 2.0 : 2.85; }

/// Nodes in the order of gmsh's tags, each on its entity; only those that a cell uses stay.
struct NodeTable {
  std::vector<Index> number;  // by gmsh's tag, -1 where unused
  Index operator[](std::size_t tag) const { return tag < number.size() ? number[tag] : -1; }
};

int node_count(int type) {
  std::string name;
  int dim = 0, order = 0, nodes = 0, primary = 0;
  std::vector<double> local;
  gmsh::model::mesh::getElementProperties(type, name, dim, order, nodes, local, primary);
  return nodes;
}

std::vector<std::size_t> elements_of(int dim, int tag, int type, const Problem& problem) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dim, tag);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i] == type) {
      found = std::move(nodes[i]);
    } else {
      throw InputError(
          problem.geometry_where, "geometry",
          fmt::format("cells of gmsh's type {} where type {} was asked for", types[i], type),
          "a geometry whose surfaces and volumes are transfinite when structured "
          "is 1 (lattices), and that gmsh can subdivide when it is 0");
    }
  }
  return found;
}

NodeTable collect_nodes(Mesh& mesh, const std::vector<std::size_t>& cell_tags) {
  const std::size_t highest =
      cell_tags.empty() ? 0 : *std::max_element(cell_tags.begin(), cell_tags.end());
  NodeTable table{std::vector<Index>(highest + 1, -1)};
  for (const std::size_t tag : cell_tags) table.number[tag] = 0;
  Index next = 0;
  for (Index& number : table.number)
    if (number == 0) number = next++;
  mesh.nodes.assign(static_cast<std::size_t>(next), Vec3::Zero());
  mesh.node_entity.assign(static_cast<std::size_t>(next), -1);
  for (std::size_t e = 0; e < mesh.entities.size(); ++e) {
    std::vector<std::size_t> tags;
    std::vector<double> X, unused;
    gmsh::model::mesh::getNodes(tags, X, unused, mesh.entities[e].dim, mesh.entities[e].tag,
                                false, false);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (tags[i] > highest || table.number[tags[i]] < 0) continue;
      const auto a = static_cast<std::size_t>(table.number[tags[i]]);
      mesh.nodes[a] = Vec3(X[3 * i], X[3 * i + 1], X[3 * i + 2]);
      mesh.node_entity[a] = static_cast<Index>(e);
    }
  }
  return table;
}

/// Cells with their nodes, oriented; then the facets.
void collect_cells(Mesh& mesh, const Problem& problem) {
  const int type = gmsh_element(mesh.shape, mesh.dim, mesh.order);
  std::vector<std::size_t> cells;
  for (const Entity& entity : mesh.entities) {
    if (entity.dim != mesh.dim) continue;
    auto found = elements_of(entity.dim, entity.tag, type, problem);
    if (cells.empty())
      cells = std::move(found);
    else
      cells.insert(cells.end(), found.begin(), found.end());
  }
  if (cells.empty())
    throw InputError(problem.geometry_where, "geometry",
                     fmt::format("no {}-dimensional body", mesh.dim),
                     mesh.dim == 3 ? "a .geo with at least one volume"
                                   : "a .geo with at least one surface in the plane Z = 0");
  mesh.nodes_per_cell = node_count(type);
  const NodeTable table = collect_nodes(mesh, cells);
  mesh.cells.reserve(cells.size());
  for (const std::size_t tag : cells) mesh.cells.push_back(table[tag]);
  std::vector<std::size_t>().swap(cells);
  orient_cells(mesh, problem);

  std::vector<Index> facets, facet_entity;
  const int facet = gmsh_element(mesh.shape, mesh.dim - 1, mesh.order);
  for (std::size_t e = 0; e < mesh.entities.size(); ++e) {
    if (mesh.entities[e].dim != mesh.dim - 1) continue;
    for (const std::size_t tag :
         elements_of(mesh.dim - 1, mesh.entities[e].tag, facet, problem))
      facets.push_back(table[tag]);
    facet_entity.resize(facets.size() / static_cast<std::size_t>(node_count(facet)),
                        static_cast<Index>(e));
  }
  collect_facets(mesh, problem, facets, facet_entity);
}

void collect_groups(Mesh& mesh) {
  std::vector<DimTag> groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dim, tag] : groups) {
    std::string name;
    gmsh::model::getPhysicalName(dim, tag, name);
    if (name.empty()) name = std::to_string(tag);
    std::vector<int> members;
    gmsh::model::getEntitiesForPhysicalGroup(dim, tag, members);
    Mesh::Group& group = mesh.groups[name];
    group.dim = std::max(group.dim, dim);
    for (std::size_t e = 0; e < mesh.entities.size(); ++e)
      if (mesh.entities[e].dim == dim &&
          std::find(members.begin(), members.end(), mesh.entities[e].tag) != members.end())
        group.entities.push_back(static_cast<Index>(e));
  }
}

}  // namespace

Mesh mesh_by_gmsh(const Problem& problem, const MeshRequest& request) {
  Mesh mesh;
  mesh.dim = problem.dim();
  mesh.shape = request.shape;
  mesh.order = request.order;
  mesh.h = request.h;
  const bool lattice = request.layout == Layout::lattice;
  GmshSession session;
  const bool subdivided = !lattice && request.shape == CellShape::hypercube;
  const double spacing = subdivided ? subdivided_spacing(mesh.dim) * request.h : request.h;
  session.open_geometry(problem, spacing, lattice);
  generate(session, problem, request);
  collect_entities(mesh, problem);
  collect_cells(mesh, problem);
  collect_groups(mesh);
  snap_to_planes(mesh, problem);
  if (lattice) snap_lattice(mesh);
  check_groups(mesh, problem);
  return mesh;
}

}  // namespace concord::scene
