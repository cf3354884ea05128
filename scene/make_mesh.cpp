// From the .geo to cells, facets, entities and groups.

#include "scene/geometry.hpp"
#include "scene/gmsh_session.hpp"
#include "scene/mesh_parts.hpp"
#include "scene/suggest.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gmsh.h>

namespace concord::scene {
namespace {

using DimTag = std::pair<int, int>;

/// gmsh's element numbers (gmsh reference manual, "MSH file format").
int element_type(CellShape shape, int dim, int order) {
  if (shape == CellShape::simplex) return dim == 3 ? (order == 1 ? 4 : 11) : (order == 1 ? 2 : 9);
  return dim == 3 ? (order == 1 ? 5 : 12) : (order == 1 ? 3 : 10);
}
int facet_type(CellShape shape, int dim, int order) {
  if (dim == 2) return order == 1 ? 1 : 8;
  return element_type(shape, 2, order);
}

int node_count(int type) {
  switch (type) {
    case 1: return 2;
    case 2:
    case 8: return 3;
    case 3:
    case 4: return 4;
    case 5: return 8;
    case 9: return 6;
    case 10: return 9;
    case 11: return 10;
    default: return 27;
  }
}

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

/// Nodes in the order of gmsh's tags, each on its entity; only those that a cell uses stay.
struct NodeTable {
  std::vector<Index> number;  // by gmsh's tag, -1 where unused
  Index operator[](std::size_t tag) const { return number[tag]; }
};

std::vector<std::size_t> elements_of(int dim, int tag, int type, const Problem& problem) {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, dim, tag);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i] == type) {
      found = nodes[i];
    } else {
      throw InputError(problem.geometry_where, "geometry",
                       fmt::format("cells of gmsh's type {} where type {} was asked for",
                                   types[i], type),
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

void collect_cells(Mesh& mesh, const Problem& problem) {
  const int type = element_type(mesh.shape, mesh.dim, mesh.order);
  const int facet = facet_type(mesh.shape, mesh.dim, mesh.order);
  mesh.nodes_per_cell = node_count(type);
  mesh.nodes_per_facet = node_count(facet);
  std::vector<std::size_t> cells;
  for (const Entity& entity : mesh.entities) {
    if (entity.dim != mesh.dim) continue;
    const auto found = elements_of(entity.dim, entity.tag, type, problem);
    cells.insert(cells.end(), found.begin(), found.end());
  }
  if (cells.empty())
    throw InputError(problem.geometry_where, "geometry",
                     fmt::format("no {}-dimensional body", mesh.dim),
                     mesh.dim == 3 ? "a .geo with at least one volume"
                                   : "a .geo with at least one surface in the plane Z = 0");
  const NodeTable table = collect_nodes(mesh, cells);
  for (const std::size_t tag : cells) mesh.cells.push_back(table[tag]);
  for (std::size_t e = 0; e < mesh.entities.size(); ++e) {
    const Entity& entity = mesh.entities[e];
    if (entity.dim != mesh.dim - 1) continue;
    std::vector<int> upward, downward;
    gmsh::model::getAdjacencies(entity.dim, entity.tag, upward, downward);
    if (upward.size() != 1) continue;  // an interface inside, or no part of the body
    for (const std::size_t tag : elements_of(entity.dim, entity.tag, facet, problem))
      mesh.facets.push_back(table[tag]);
    mesh.facet_entity.resize(mesh.facet_count(), static_cast<Index>(e));
  }
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

Mesh make_mesh(const Problem& problem, const MeshRequest& request) {
  if (!(request.h > 0 && std::isfinite(request.h)))
    throw InputError({"request", 0, 0}, "resolution", fmt::format("a spacing of {} m", request.h),
                     "a positive number: the spacing is reference_length/resolution");
  Mesh mesh;
  mesh.dim = problem.dim();
  mesh.shape = request.shape;
  mesh.order = request.order;
  mesh.h = request.h;
  const bool lattice = request.layout == Layout::lattice;
  GmshSession session;
  // Subdivision into quadrangles or hexahedra halves the spacing.
  const bool halved = !lattice && request.shape == CellShape::hypercube;
  session.open_geometry(problem, halved ? 2 * request.h : request.h, lattice);
  generate(session, problem, request);
  collect_entities(mesh, problem);
  collect_cells(mesh, problem);
  collect_groups(mesh);
  snap_to_planes(mesh, problem);
  orient_cells(mesh, problem);
  check_groups(mesh, problem);
  return mesh;
}

}  // namespace concord::scene
