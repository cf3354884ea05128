// Everything that is an expression of X, Y, Z and t.

#include "scene/reader_parts.hpp"
#include "scene/suggest.hpp"

#include <fmt/format.h>

namespace concord::scene {
namespace {

using Kind = ConfigNode::Kind;

std::string vector_allowed(const Problem& problem, bool free, bool exact) {
  std::string text = fmt::format("an array of {} expressions in double quotes", problem.dim());
  if (free) text += ", \"free\" for a component that is left out";
  if (exact) text += ", \"exact\" for a component of [exact] displacement";
  return text;
}

bool is_word(const ConfigNode& node, const char* word) {
  return node.kind == Kind::text && node.text == word;
}

const VectorExpression& exact_of(const ConfigNode& node, const Problem& problem) {
  if (!problem.exact_displacement)
    throw InputError(node.where, node.key, "\"exact\" in a scene without an exact solution",
                     "an array of expressions, or a table [exact] with displacement");
  return *problem.exact_displacement;
}

std::optional<Expression> read_component(const ConfigNode& node, int index,
                                         const Symbols& symbols, const Problem& problem,
                                         bool free, bool exact) {
  if (free && is_word(node, "free")) return std::nullopt;
  if (exact && is_word(node, "exact"))
    return exact_of(node, problem).component[static_cast<std::size_t>(index)];
  const bool number = node.kind == Kind::integer || node.kind == Kind::real;
  if (node.kind != Kind::text && !number)
    throw bad_value(node, vector_allowed(problem, free, exact));
  Expression expression(node.text, symbols, node.where, node.key);
  if (index >= problem.dim()) {
    if (!expression.is_zero())
      throw bad_value(node, "\"0\" or nothing in the third direction of a plane problem");
    return std::nullopt;
  }
  return expression;
}

const std::map<std::string, BoundaryKind>& boundary_kinds() {
  static const std::map<std::string, BoundaryKind> kinds{
      {"fixed", BoundaryKind::fixed},
      {"symmetric", BoundaryKind::symmetric},
      {"antisymmetric", BoundaryKind::antisymmetric},
      {"displacement", BoundaryKind::displacement},
      {"traction", BoundaryKind::traction}};
  return kinds;
}

void read_value(const Section& section, const Symbols& symbols, const Problem& problem,
                BoundaryCondition& bc) {
  const bool displacement = bc.kind == BoundaryKind::displacement;
  const ConfigNode& node = section.require("value");
  if (is_word(node, "exact")) {
    const VectorExpression& exact = exact_of(node, problem);
    if (!displacement && problem.material.plastic())
      throw bad_value(node, "expressions: the stress of a plastic material does not follow "
                            "from the displacement alone");
    bc.value_from_exact = true;
    if (displacement) bc.value = exact;
    return;
  }
  bc.value = read_vector(node, symbols, problem, displacement, displacement);
  bool any = !displacement;
  for (const auto& component : bc.value.component) any = any || component.has_value();
  if (!any)
    throw bad_value(node, "at least one component that is not \"free\", or no such condition");
}

}  // namespace

VectorExpression read_vector(const ConfigNode& node, const Symbols& symbols,
                             const Problem& problem, bool free, bool exact) {
  const auto dim = static_cast<std::size_t>(problem.dim());
  const std::size_t size = node.elements.size();
  if (node.kind != Kind::array || (size != dim && size != 3))
    throw bad_value(node, vector_allowed(problem, free, exact));
  VectorExpression value;
  for (std::size_t i = 0; i < size; ++i)
    value.component[i] =
        read_component(node.elements[i], static_cast<int>(i), symbols, problem, free, exact);
  return value;
}

Vec3 read_vector_quantity(const ConfigNode& node, const UnitDimension& unit, int dim) {
  const std::size_t size = node.elements.size();
  if (node.kind != Kind::array || (size != static_cast<std::size_t>(dim) && size != 3))
    throw bad_value(node, fmt::format("an array of {} texts with units", dim));
  Vec3 value = Vec3::Zero();
  for (std::size_t i = 0; i < size; ++i)
    value[static_cast<int>(i)] = read_quantity(node.elements[i], unit);
  if (dim == 2 && value[2] != 0)
    throw bad_value(node.elements[2], "0 or nothing in the third direction of a plane problem");
  return value;
}

void read_exact(const Section& scene, const Symbols& symbols, Problem& problem) {
  const ConfigNode* table = scene.table("exact");
  if (table == nullptr) return;
  const Section exact(*table);
  problem.exact_displacement =
      read_vector(exact.require("displacement"), symbols, problem, false, false);
  if (const ConfigNode* velocity = exact.find("velocity"))
    problem.exact_velocity = read_vector(*velocity, symbols, problem, false, false);
}

void read_boundaries(const Section& scene, const Symbols& symbols, Problem& problem) {
  for (const ConfigNode* table : scene.tables("boundary")) {
    const Section section(*table);
    BoundaryCondition bc;
    bc.group = section.text("group");
    bc.where = section.require("group").where;
    bc.kind = boundary_kinds().at(section.word("kind"));
    if (bc.kind == BoundaryKind::displacement || bc.kind == BoundaryKind::traction)
      read_value(section, symbols, problem, bc);
    problem.boundaries.push_back(std::move(bc));
  }
}

void read_loads(const Section& scene, const Symbols& symbols, Problem& problem) {
  if (const ConfigNode* gravity = scene.find("gravity"))
    problem.gravity = read_vector_quantity(*gravity, unit::acceleration, problem.dim());
  if (const ConfigNode* table = scene.table("body_force"))
    problem.body_force =
        read_vector(Section(*table).require("value"), symbols, problem, false, false);
}

void read_initial(const Section& scene, const Symbols& symbols, Problem& problem) {
  const ConfigNode* table = scene.table("initial");
  if (table == nullptr) return;
  if (problem.is_static)
    throw InputError(table->where, table->key, "an initial state beside static = true",
                     "a static scene without [initial], or a dynamic one with end_time");
  const Section initial(*table);
  if (const ConfigNode* u = initial.find("displacement"))
    problem.initial_displacement = read_vector(*u, symbols, problem, false, false);
  if (const ConfigNode* v = initial.find("velocity"))
    problem.initial_velocity = read_vector(*v, symbols, problem, false, false);
}

}  // namespace concord::scene
