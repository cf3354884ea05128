// Fracture: criterion and pre-cracks.

#include "scene/reader_parts.hpp"

namespace concord::scene {
namespace {

/// A point given by expressions of the parameters alone.
Vec3 read_point(const ConfigNode& node, const Symbols& symbols, const Problem& problem) {
  const VectorExpression value = read_vector(node, symbols, problem, false, false);
  const Vec3 point = value(Vec3::Zero(), 0);
  // Elsewhere and later it is the same, or the expression holds more than parameters.
  if (!point.allFinite() || value.depends_on_time() || value(Vec3(1.1, 2.3, 3.7), 0) != point)
    throw bad_value(node, "expressions of the parameters alone, without X, Y, Z and t [m]");
  return point;
}

PreCrack read_crack(const ConfigNode& table, const Symbols& symbols, const Problem& problem) {
  const Section section(table);
  PreCrack crack;
  crack.from = read_point(section.require("from"), symbols, problem);
  crack.to = read_point(section.require("to"), symbols, problem);
  if (crack.from == crack.to) throw bad_value(section.require("to"), "another point than from");
  return crack;
}

/// What fracture does not go with.
void check_scene(const Section& scene, const Section& fracture, const Problem& problem) {
  const auto refuse = [&](const std::string& found, const std::string& allowed) {
    throw InputError(fracture.node().where, fracture.node().key, found, allowed);
  };
  if (problem.is_static)
    refuse("fracture beside static = true", "a dynamic scene, with end_time");
  if (problem.material.plastic())
    throw bad_value(Section(scene.require("material")).require("model"),
                    "an elastic model beside [fracture]");
}

}  // namespace

void read_fracture(const Section& scene, const Symbols& symbols, Problem& problem) {
  const ConfigNode* table = scene.table("fracture");
  if (table == nullptr) return;
  const Section section(*table);
  check_scene(scene, section, problem);
  Fracture fracture;
  fracture.where = table->where;
  fracture.criterion = section.word("criterion", "strain") == "strain"
                           ? FractureCriterion::strain
                           : FractureCriterion::energy;
  fracture.energy_release_rate = section.positive("energy_release_rate", unit::energy_per_area);
  if (section.has("length")) fracture.length = section.positive("length", unit::length);
  fracture.arrival = section.text("arrival", "");
  for (const ConfigNode* crack : section.tables("crack"))
    fracture.cracks.push_back(read_crack(*crack, symbols, problem));
  problem.fracture = fracture;
}

}  // namespace concord::scene
