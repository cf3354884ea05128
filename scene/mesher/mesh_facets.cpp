// The surface of the body: faces of cells that belong to one cell only, each on its entity.
//
// They are found from the cells, not taken from gmsh's surface elements: in transfinite volumes
// of tetrahedra gmsh 4.8 may cut a surface along other diagonals than the volume behind it.

#include "scene/mesh_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <gmsh.h>
#include <map>

namespace concord::scene {
namespace {

using Key = std::array<Index, 4>;  // sorted corners, -1 where there are fewer
using Local = std::vector<std::vector<int>>;

/// Corners of every face in gmsh's order of nodes, seen from outside counter-clockwise (in the
/// plane: the body to the left).
Local face_corners(CellShape shape, int dim) {
  if (shape == CellShape::simplex)
    return dim == 3 ? Local{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}
                    : Local{{0, 1}, {1, 2}, {2, 0}};
  return dim == 3 ? Local{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                          {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}}
                  : Local{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
}

std::vector<Vec3> local_nodes(int gmsh_type) {
  std::string name;
  int dim = 0, order = 0, nodes = 0, primary = 0;
  std::vector<double> local;
  gmsh::model::mesh::getElementProperties(gmsh_type, name, dim, order, nodes, local, primary);
  std::vector<Vec3> points(static_cast<std::size_t>(nodes), Vec3::Zero());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < dim; ++k)
      points[i][k] = local[i * static_cast<std::size_t>(dim) + static_cast<std::size_t>(k)];
  return points;
}

/// Value of corner shape function c of a facet at its reference point xi.
double corner_shape(std::size_t corners, int dim, std::size_t c, const Vec3& xi) {
  if (corners == 2) return (1 + (c == 0 ? -xi[0] : xi[0])) / 2;
  if (corners == 3) return c == 0 ? 1 - xi[0] - xi[1] : xi[static_cast<int>(c) - 1];
  const Vec3 at = hypercube_corner(static_cast<int>(c), dim - 1);
  return (1 + at[0] * xi[0]) * (1 + at[1] * xi[1]) / 4;
}

/// Per face: which nodes of the cell are the nodes of the facet, in gmsh's order.
Local face_nodes(const Mesh& mesh) {
  const std::vector<Vec3> cell = local_nodes(gmsh_element(mesh.shape, mesh.dim, mesh.order));
  const std::vector<Vec3> facet =
      local_nodes(gmsh_element(mesh.shape, mesh.dim - 1, mesh.order));
  Local faces;
  for (const std::vector<int>& corners : face_corners(mesh.shape, mesh.dim)) {
    std::vector<int> nodes;
    for (const Vec3& xi : facet) {
      Vec3 X = Vec3::Zero();
      for (std::size_t c = 0; c < corners.size(); ++c)
        X += corner_shape(corners.size(), mesh.dim, c, xi) *
             cell[static_cast<std::size_t>(corners[c])];
      for (std::size_t i = 0; i < cell.size(); ++i)
        if ((cell[i] - X).norm() < 1e-6) nodes.push_back(static_cast<int>(i));
    }
    faces.push_back(std::move(nodes));
  }
  return faces;
}

template <class Nodes> Key key_of(const Nodes& nodes, std::size_t corners) {
  Key key{-1, -1, -1, -1};
  for (std::size_t c = 0; c < corners; ++c) key[c] = nodes[c];
  std::sort(key.begin(), key.end());
  return key;
}

struct Face {
  Key key;
  std::size_t cell;
  int face;
  Index entity = -1;
};

bool on_surface(const Mesh& mesh, Index node) {
  const auto e = static_cast<std::size_t>(mesh.node_entity[static_cast<std::size_t>(node)]);
  return mesh.entities[e].dim < mesh.dim;
}

/// Faces whose corners all lie on entities below the body's dimension, that one cell only has.
std::vector<Face> single_faces(const Mesh& mesh) {
  const Local corners = face_corners(mesh.shape, mesh.dim);
  std::vector<Face> faces;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    const Index* cell = &mesh.cells[c * static_cast<std::size_t>(mesh.nodes_per_cell)];
    for (std::size_t f = 0; f < corners.size(); ++f) {
      std::array<Index, 4> nodes{};
      bool outer = true;
      for (std::size_t i = 0; i < corners[f].size() && outer; ++i) {
        nodes[i] = cell[corners[f][i]];
        outer = on_surface(mesh, nodes[i]);
      }
      if (outer) faces.push_back({key_of(nodes, corners[f].size()), c, static_cast<int>(f)});
    }
  }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.key < b.key; });
  std::vector<Face> single;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool before = i > 0 && faces[i - 1].key == faces[i].key;
    const bool after = i + 1 < faces.size() && faces[i + 1].key == faces[i].key;
    if (!before && !after) single.push_back(faces[i]);
  }
  return single;
}

/// The entity whose closure holds all corners: for faces that gmsh's own surface lacks.
Index entity_around(const Mesh& mesh, const Key& key) {
  for (std::size_t e = 0; e < mesh.entities.size(); ++e) {
    const Entity& entity = mesh.entities[e];
    if (entity.dim != mesh.dim - 1) continue;
    const bool all = std::all_of(key.begin(), key.end(), [&](Index node) {
      if (node < 0) return true;
      const Index own = mesh.node_entity[static_cast<std::size_t>(node)];
      return own == static_cast<Index>(e) ||
             std::find(entity.closure.begin(), entity.closure.end(), own) !=
                 entity.closure.end();
    });
    if (all) return static_cast<Index>(e);
  }
  return -1;
}

/// A node that gmsh holds to be inside although its facet is on the surface.
void claim_node(Mesh& mesh, Index node, Index entity) {
  const auto a = static_cast<std::size_t>(node);
  if (on_surface(mesh, node)) return;
  mesh.node_entity[a] = entity;
  const Entity& surface = mesh.entities[static_cast<std::size_t>(entity)];
  if (surface.flat) return;
  const Vec3& X = mesh.nodes[a];
  std::vector<double> closest, parameters;
  gmsh::model::getClosestPoint(surface.dim, surface.tag, {X[0], X[1], X[2]}, closest,
                               parameters);
  mesh.nodes[a] = Vec3(closest[0], closest[1], closest[2]);
}

}  // namespace

int gmsh_element(CellShape shape, int dim, int order) {
  if (dim == 1) return order == 1 ? 1 : 8;
  const bool simplex = shape == CellShape::simplex;
  if (dim == 2) return simplex ? (order == 1 ? 2 : 9) : (order == 1 ? 3 : 10);
  return simplex ? (order == 1 ? 4 : 11) : (order == 1 ? 5 : 12);
}

void collect_facets(Mesh& mesh, const Problem& problem, const std::vector<Index>& gmsh_facets,
                    const std::vector<Index>& gmsh_facet_entity) {
  const Local nodes = face_nodes(mesh);
  const auto per_facet = nodes.front().size();
  const std::size_t corners = face_corners(mesh.shape, mesh.dim).front().size();
  mesh.nodes_per_facet = static_cast<int>(per_facet);
  std::map<Key, Index> entity_of;
  for (std::size_t f = 0; f < gmsh_facet_entity.size(); ++f)
    entity_of[key_of(&gmsh_facets[f * per_facet], corners)] = gmsh_facet_entity[f];
  std::vector<Face> faces = single_faces(mesh);
  for (Face& face : faces) {
    const auto found = entity_of.find(face.key);
    face.entity = found != entity_of.end() ? found->second : entity_around(mesh, face.key);
    if (face.entity < 0)
      throw InputError(problem.geometry_where, "geometry",
                       "a face of the body's surface that lies on no surface of the .geo",
                       "a .geo whose volumes are closed by its surfaces");
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& a, const Face& b) { return a.entity < b.entity; });
  for (const Face& face : faces) {
    const Index* cell = &mesh.cells[face.cell * static_cast<std::size_t>(mesh.nodes_per_cell)];
    for (const int local : nodes[static_cast<std::size_t>(face.face)]) {
      claim_node(mesh, cell[local], face.entity);
      mesh.facets.push_back(cell[local]);
    }
    mesh.facet_entity.push_back(face.entity);
  }
}

}  // namespace concord::scene
