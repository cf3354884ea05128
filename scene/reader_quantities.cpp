// Quantities of interest, output, and statements that do not go together.

#include "scene/reader_parts.hpp"
#include "scene/suggest.hpp"

#include <cctype>
#include <fmt/format.h>

namespace concord::scene {
namespace {

std::string read_name(const Section& section, const Problem& problem) {
  const std::string name = section.text("name");
  const ConfigNode& node = section.require("name");
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_')
      throw bad_value(node, section.allowed("name"));
  for (const Quantity& other : problem.quantities)
    if (other.name == name) throw bad_value(node, "a name that no other quantity has");
  return name;
}

void read_field(const Section& section, const Problem& problem, Quantity& quantity) {
  quantity.field = section.word("field", "displacement");
  if (quantity.field == "displacement_error" && !problem.exact_displacement)
    throw bad_value(section.require("field"),
                    "displacement_error in scenes with [exact] displacement only");
  if (quantity.field == "plastic_strain" && !problem.material.plastic())
    throw bad_value(section.require("field"),
                    "plastic_strain in scenes with a plastic material only");
  if (quantity.field == "velocity" && problem.is_static)
    throw bad_value(section.require("field"), "velocity in dynamic scenes only");
}

Quantity read_quantity_of_interest(const ConfigNode& table, const Problem& problem) {
  const Section section(table);
  Quantity quantity;
  quantity.name = read_name(section, problem);
  quantity.where = section.require("name").where;
  const std::string kind = section.word("kind");
  if (kind == "point") {
    quantity.kind = QuantityKind::point;
    quantity.at = read_vector_quantity(section.require("at"), unit::length, problem.dim());
    return quantity;
  }
  quantity.kind = kind == "average"    ? QuantityKind::average
                  : kind == "reaction" ? QuantityKind::reaction
                                       : QuantityKind::maximum;
  if (quantity.kind != QuantityKind::maximum || section.has("group")) {
    quantity.group = section.text("group");
    quantity.where = section.require("group").where;
  }
  if (quantity.kind == QuantityKind::reaction) return quantity;
  read_field(section, problem, quantity);
  if (quantity.kind == QuantityKind::maximum)
    quantity.interior_only = section.word("where", "everywhere") == "interior";
  return quantity;
}

/// Whether a condition prescribes displacement component k whatever the group's direction.
bool prescribes(const BoundaryCondition& bc, std::size_t k) {
  if (bc.kind == BoundaryKind::fixed) return true;
  return bc.kind == BoundaryKind::displacement && bc.value.component[k].has_value();
}

bool loads(const BoundaryCondition& bc, std::size_t k) {
  if (bc.kind != BoundaryKind::traction) return false;
  const auto& component = bc.value.component[k];
  return bc.value_from_exact || (component && !component->is_zero());
}

void check_pair(const BoundaryCondition& first, const BoundaryCondition& second, int dim) {
  if (first.group != second.group) return;
  const bool both_loads = first.kind == BoundaryKind::traction && second.kind == first.kind;
  if (both_loads)
    throw InputError(second.where, "group", in_quotes(second.group) + " with a second traction",
                     "one traction a group");
  for (std::size_t k = 0; k < static_cast<std::size_t>(dim); ++k)
    if ((prescribes(first, k) && loads(second, k)) ||
        (loads(first, k) && prescribes(second, k)))
      throw InputError(second.where, "group",
                       fmt::format("{} with a traction and a prescribed displacement in "
                                   "direction {}",
                                   in_quotes(second.group), k + 1),
                       "one of the two for each component; a traction component may be \"0\", "
                       "a displacement \"free\"");
}

}  // namespace

void read_quantities(const Section& scene, Problem& problem) {
  for (const ConfigNode* table : scene.tables("quantity"))
    problem.quantities.push_back(read_quantity_of_interest(*table, problem));
}

void read_output(const Section& scene, Problem& problem) {
  const ConfigNode* table = scene.table("output");
  if (table == nullptr) return;
  const Section output(*table);
  problem.frames = output.integer("frames", problem.frames, 0);
  problem.history_rows = output.integer("history_rows", problem.history_rows, 0);
}

void check_statements(const Section& scene, const Problem& problem) {
  const auto& conditions = problem.boundaries;
  for (std::size_t i = 0; i < conditions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) check_pair(conditions[j], conditions[i], problem.dim());
  if (!problem.is_static) return;
  for (const BoundaryCondition& bc : conditions)
    if (bc.kind != BoundaryKind::traction) return;
  throw InputError(scene.require("static").where, "boundary",
                   "no condition that holds the body",
                   "at least one [[boundary]] of kind fixed | symmetric | antisymmetric | "
                   "displacement, which a static scene needs");
}

}  // namespace concord::scene
