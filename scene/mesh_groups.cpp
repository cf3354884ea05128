// Physical groups: what is in them, and whether they suit what the scene asks of them.

#include "scene/mesh_parts.hpp"
#include "scene/suggest.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace concord::scene {
namespace {

const Mesh::Group& find_group(const Mesh& mesh, const std::string& name,
                              const SourcePosition& where) {
  const auto found = mesh.groups.find(name);
  if (found != mesh.groups.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, group] : mesh.groups) names.push_back(known);
  throw InputError(where, "group", in_quotes(name) + ", which the geometry does not have",
                   names.empty() ? "no group: the .geo defines no Physical groups"
                                 : allowed_words(name, names));
}

const char* dimension_word(int dim) {
  constexpr const char* words[] = {"points", "curves", "surfaces", "volumes"};
  return words[dim];
}

/// Which components a condition prescribes on its group.
std::array<bool, 3> prescribed(const Mesh& mesh, const BoundaryCondition& bc) {
  std::array<bool, 3> components{};
  const int axis = bc.kind == BoundaryKind::symmetric || bc.kind == BoundaryKind::antisymmetric
                       ? mesh.group_axis(bc.group, bc.where)
                       : -1;
  for (int k = 0; k < mesh.dim; ++k) {
    bool& p = components[static_cast<std::size_t>(k)];
    switch (bc.kind) {
      case BoundaryKind::fixed:
        p = true;
        break;
      case BoundaryKind::symmetric:
        p = k == axis;
        break;
      case BoundaryKind::antisymmetric:
        p = k != axis;
        break;
      case BoundaryKind::displacement:
        p = bc.value_from_exact || bc.value.component[static_cast<std::size_t>(k)].has_value();
        break;
      case BoundaryKind::traction:
        p = false;
        break;
    }
  }
  return components;
}

struct Prescription {
  const BoundaryCondition* condition = nullptr;
  double value = 0;
};

/// Two conditions that give one component of one node different values contradict each other.
void check_values(const Mesh& mesh, const Problem& problem, double t) {
  std::vector<std::array<Prescription, 3>> at(mesh.nodes.size());
  const double tolerance = 1e-12 * problem.reference_length;
  for (const BoundaryCondition& bc : problem.boundaries) {
    const auto components = prescribed(mesh, bc);
    if (bc.kind == BoundaryKind::traction) continue;
    for (const Index a : mesh.group_nodes(bc.group, bc.where)) {
      const Vec3& X = mesh.nodes[static_cast<std::size_t>(a)];
      const Vec3 value = problem.boundary_value(bc, X, t, Vec3::Zero());
      for (std::size_t k = 0; k < 3; ++k) {
        if (!components[k]) continue;
        Prescription& p = at[static_cast<std::size_t>(a)][k];
        if (p.condition != nullptr &&
            !(std::abs(p.value - value[static_cast<Index>(k)]) <= tolerance))
          throw InputError(
              bc.where, "group",
              fmt::format(
                  "{} with {} = {:g} m at ({:g}, {:g}, {:g}), where group {} has {:g} m",
                  in_quotes(bc.group), "u_" + std::to_string(k + 1),
                  value[static_cast<Index>(k)], X[0], X[1], X[2], in_quotes(p.condition->group),
                  p.value),
              "conditions that agree where their groups meet; leave a component out with "
              "\"free\"");
        p = {&bc, value[static_cast<Index>(k)]};
      }
    }
  }
}

/// A traction along a direction whose displacement the same group prescribes.
void check_tractions(const Mesh& mesh, const Problem& problem) {
  for (const BoundaryCondition& load : problem.boundaries) {
    if (load.kind != BoundaryKind::traction) continue;
    (void)mesh.group_facets(load.group, load.where);
    for (const BoundaryCondition& bc : problem.boundaries) {
      if (bc.kind == BoundaryKind::traction || bc.group != load.group) continue;
      const auto components = prescribed(mesh, bc);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& value = load.value.component[k];
        if (components[k] && (load.value_from_exact || (value && !value->is_zero())))
          throw InputError(load.where, "group",
                           fmt::format("{} with a traction and a prescribed displacement in "
                                       "direction {}",
                                       in_quotes(load.group), k + 1),
                           "one of the two for each component; a traction component may be "
                           "\"0\", a displacement \"free\"");
      }
    }
  }
}

}  // namespace

std::vector<Index> Mesh::group_nodes(const std::string& name,
                                     const SourcePosition& where) const {
  const Group& group = find_group(*this, name, where);
  std::vector<char> inside(entities.size(), 0);
  for (const Index e : group.entities) {
    inside[static_cast<std::size_t>(e)] = 1;
    for (const Index c : entities[static_cast<std::size_t>(e)].closure)
      inside[static_cast<std::size_t>(c)] = 1;
  }
  std::vector<Index> found;
  for (std::size_t a = 0; a < nodes.size(); ++a)
    if (inside[static_cast<std::size_t>(node_entity[a])])
      found.push_back(static_cast<Index>(a));
  if (found.empty())
    throw InputError(where, "group", in_quotes(name) + ", which holds no node of the body",
                     "a group on the body");
  return found;
}

std::vector<Index> Mesh::group_facets(const std::string& name,
                                      const SourcePosition& where) const {
  const Group& group = find_group(*this, name, where);
  if (group.dim != dim - 1)
    throw InputError(where, "group",
                     in_quotes(name) + ", a group of " + dimension_word(group.dim),
                     std::string("a group of ") + dimension_word(dim - 1));
  std::vector<Index> found;
  for (std::size_t f = 0; f < facet_count(); ++f)
    if (std::find(group.entities.begin(), group.entities.end(), facet_entity[f]) !=
        group.entities.end())
      found.push_back(static_cast<Index>(f));
  if (found.empty())
    throw InputError(where, "group", in_quotes(name) + ", which lies inside the body",
                     "a group on the surface of the body");
  return found;
}

int Mesh::group_axis(const std::string& name, const SourcePosition& where) const {
  const Group& group = find_group(*this, name, where);
  int axis = -2;
  for (const Index e : group.entities) {
    const int next = entities[static_cast<std::size_t>(e)].axis;
    if (axis == -2) axis = next;
    if (next != axis) axis = -1;
  }
  if (axis < 0)
    throw InputError(where, "group", in_quotes(name) + ", which is not normal to one axis",
                     std::string("a group of plane ") + dimension_word(dim - 1) +
                         " normal to one coordinate axis");
  return axis;
}

void check_groups(const Mesh& mesh, const Problem& problem) {
  for (const BoundaryCondition& bc : problem.boundaries) {
    (void)mesh.group_nodes(bc.group, bc.where);
    (void)prescribed(mesh, bc);  // planes of symmetry are planes
  }
  for (const Quantity& quantity : problem.quantities)
    if (!quantity.group.empty()) (void)mesh.group_nodes(quantity.group, quantity.where);
  check_tractions(mesh, problem);
  if (problem.boundaries.size() < 2) return;
  for (const double fraction : {0.5, 1.0})
    check_values(mesh, problem, fraction * problem.end_time);
}

}  // namespace concord::scene
