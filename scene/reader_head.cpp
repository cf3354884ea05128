// Title, dimension, geometry, times, material, parameters.

#include "scene/reader_parts.hpp"
#include "scene/suggest.hpp"
#include "scene/unit_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <map>

namespace concord::scene {
namespace {

void read_geometry(const Section& scene, Problem& problem) {
  const std::filesystem::path file(scene.text("geometry"));
  const ConfigNode& node = scene.require("geometry");
  problem.geometry_where = node.where;
  problem.geometry =
      std::filesystem::absolute(file.is_absolute() ? file : problem.file.parent_path() / file)
          .lexically_normal();
  if (!std::filesystem::is_regular_file(problem.geometry))
    throw InputError(node.where, node.key, in_quotes(file.string()) + ", which is no file",
                     "a .geo file beside the scene file");
}

void read_time(const Section& scene, Problem& problem) {
  problem.is_static = scene.boolean("static", false);
  if (problem.is_static) {
    if (const ConfigNode* end = scene.find("end_time"))
      throw InputError(end->where, end->key, end->describe() + " beside static = true",
                       "either static = true with load_steps, or end_time");
    problem.load_steps = scene.integer("load_steps", 1, 1);
    problem.end_time = 1;
    return;
  }
  if (!scene.has("end_time"))
    throw InputError(scene.node().where, "end_time", "nothing",
                     "end_time = \"2 ms\" for a dynamic scene, or static = true");
  problem.end_time = scene.positive("end_time", unit::time);
}

[[noreturn]] void refuse_constants(const Section& material) {
  throw InputError(material.node().where, "material", "no pair of elastic constants",
                   "youngs_modulus with poissons_ratio, shear_modulus with poissons_ratio, or "
                   "shear_modulus with bulk_modulus");
}

double read_poissons_ratio(const Section& material) {
  const double nu = material.number("poissons_ratio");
  if (!(nu > -1 && nu < 0.5))
    throw bad_value(material.require("poissons_ratio"), material.allowed("poissons_ratio"));
  return nu;
}

void read_constants(const Section& section, Material& material) {
  const bool E = section.has("youngs_modulus"), nu = section.has("poissons_ratio"),
             mu = section.has("shear_modulus"), kappa = section.has("bulk_modulus");
  if (E + nu + mu + kappa != 2 || (E && !nu) || (kappa && !mu)) refuse_constants(section);
  if (nu) material.nu = read_poissons_ratio(section);
  if (E) {
    material.E = section.positive("youngs_modulus", unit::pressure);
    material.mu = material.E / (2 * (1 + material.nu));  // Eq. (54)
  } else {
    material.mu = section.positive("shear_modulus", unit::pressure);
    if (kappa) {
      const double K = section.positive("bulk_modulus", unit::pressure);
      material.nu = (3 * K - 2 * material.mu) / (2 * (3 * K + material.mu));
    }
    material.E = 2 * material.mu * (1 + material.nu);
  }
  material.lambda =
      material.nu * material.E / ((1 + material.nu) * (1 - 2 * material.nu));  // Eq. (54)
}

void read_hardening(const Section& section, Problem& problem) {
  if (problem.dimension == Dimension::plane_stress)
    throw bad_value(section.require("model"),
                    "an elastic model in plane stress; j2-hencky in 3D and plane strain");
  Hardening& hardening = problem.material.hardening;
  hardening.yield_stress = section.positive("yield_stress", unit::pressure);
  hardening.saturation_stress = hardening.yield_stress;
  if (section.has("saturation_stress")) {
    hardening.saturation_stress = section.positive("saturation_stress", unit::pressure);
    if (!section.has("saturation_exponent") &&
        hardening.saturation_stress != hardening.yield_stress)
      throw bad_value(section.require("saturation_stress"),
                      "saturation_stress together with saturation_exponent");
  }
  if (section.has("hardening_modulus"))
    hardening.modulus = section.quantity("hardening_modulus", unit::pressure);
  if (section.has("saturation_exponent"))
    hardening.exponent = section.number("saturation_exponent");
  if (hardening.exponent < 0)
    throw bad_value(section.require("saturation_exponent"),
                    section.allowed("saturation_exponent"));
  // The flow stress must not fall faster than the elastic stress at fixed strain, 3 mu (a
  // snap-back of the material point), and must stay positive.
  const double steepest =
      hardening.modulus + std::min(0.0, hardening.exponent * (hardening.saturation_stress -
                                                              hardening.yield_stress));
  if (hardening.modulus < 0)
    throw bad_value(section.require("hardening_modulus"), section.allowed("hardening_modulus"));
  if (!(steepest > -3 * problem.material.mu))
    throw bad_value(section.require("saturation_exponent"),
                    "softening slower than three times the shear modulus: hardening_modulus + "
                    "saturation_exponent (saturation_stress - yield_stress) > -3 mu");
}

Symbols constants(const Problem& problem) {
  const Material& m = problem.material;
  return {{"E", m.E},
          {"nu", m.nu},
          {"rho", m.rho0},
          {"lambda", m.lambda},
          {"mu", m.mu},
          {"c_s", m.shear_wave_speed()},
          {"c_p", m.longitudinal_wave_speed()},
          {"L", problem.reference_length}};
}

void check_name(const std::string& name, const ConfigNode& node, const Symbols& taken) {
  static const std::vector<std::string> reserved{"X", "Y", "Z", "t", "pi", "h", "structured"};
  bool good = std::isalpha(static_cast<unsigned char>(name[0])) != 0;
  for (const char c : name)
    good = good && (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_');
  if (!good)
    throw InputError(node.key_where, node.key, in_quotes(name),
                     "a name of letters, digits and _, beginning with a letter");
  bool used = taken.contains(name);
  for (const std::string& word : reserved) used = used || word == name;
  if (used)
    throw InputError(node.key_where, node.key,
                     in_quotes(name) + ", which has a meaning already",
                     "another name than X, Y, Z, t, pi, h, structured, E, nu, rho, lambda, mu, "
                     "c_s, c_p, L");
}

const char* const parameter_values =
    "a number, a text with a unit (\"0.5 mm\"), or {expr = \"2*U\"}";

/// The expression of {expr = "..."}.
const ConfigNode& expression_of(const ConfigNode& node) {
  const ConfigNode* inner = node.find("expr");
  if (node.members.size() != 1 || inner == nullptr || inner->kind != ConfigNode::Kind::text)
    throw bad_value(node, parameter_values);
  inner->was_read = true;
  return *inner;
}

double plain_parameter(const ConfigNode& node) {
  using Kind = ConfigNode::Kind;
  if ((node.kind == Kind::integer || node.kind == Kind::real) && std::isfinite(node.number))
    return node.number;
  if (node.kind != Kind::text) throw bad_value(node, parameter_values);
  return parse_any_quantity(node.text, node.where, node.key, parameter_values).factor;
}

}  // namespace

void read_head(const Section& scene, Problem& problem) {
  problem.title = scene.text("title", problem.name);
  problem.source = scene.text("source", "");
  const std::string dimension = scene.word("dimension");
  problem.dimension = dimension == "3D"             ? Dimension::three_d
                      : dimension == "plane strain" ? Dimension::plane_strain
                                                    : Dimension::plane_stress;
  read_geometry(scene, problem);
  problem.layout =
      scene.word("layout", "lattice") == "lattice" ? Layout::lattice : Layout::unstructured;
  problem.reference_length = scene.positive("reference_length", unit::length);
  if (problem.dim() == 2 && scene.has("thickness"))
    problem.thickness = scene.positive("thickness", unit::length);
  read_time(scene, problem);
}

void read_material(const Section& scene, Problem& problem) {
  const ConfigNode* table = scene.table("material");
  if (table == nullptr)
    throw InputError(scene.node().where, "material", "nothing",
                     "a table [material] with model, density and elastic constants");
  const Section section(*table);
  const std::string model = section.word("model");
  static const std::map<std::string, MaterialModel> models{
      {"neo-hookean", MaterialModel::neo_hookean},
      {"neo-hookean-isochoric", MaterialModel::neo_hookean_isochoric},
      {"st-venant-kirchhoff", MaterialModel::st_venant_kirchhoff},
      {"j2-hencky", MaterialModel::j2_hencky}};
  problem.material.model = models.at(model);
  problem.material.rho0 = section.positive("density", unit::density);
  read_constants(section, problem.material);
  if (problem.material.plastic()) return read_hardening(section, problem);
  for (const char* key :
       {"yield_stress", "saturation_stress", "hardening_modulus", "saturation_exponent"}) {
    if (const ConfigNode* node = section.find(key))
      throw bad_value(*node, "this key beside model = \"j2-hencky\" only");
  }
}

Symbols read_parameters(const Section& scene, Problem& problem) {
  Symbols symbols = constants(problem);
  const ConfigNode* table = scene.table("parameters");
  if (table == nullptr) return symbols;
  const Symbols taken = symbols;
  struct Pending {
    std::string name;
    const ConfigNode* node;
  };
  std::vector<Pending> pending;
  for (const auto& [name, node] : table->members) {
    node.was_read = true;
    check_name(name, node, taken);
    if (node.kind == ConfigNode::Kind::table) {
      pending.push_back({name, &expression_of(node)});
    } else {
      symbols[name] = problem.parameters[name] = plain_parameter(node);
    }
  }
  // Expressions may use one another in any order: each pass evaluates those that can be; a pass
  // that evaluates none reports the first that cannot.
  while (!pending.empty()) {
    std::vector<Pending> left;
    std::exception_ptr first;
    for (const Pending& p : pending) {
      try {
        const Expression expression(p.node->text, symbols, p.node->where, p.node->key);
        symbols[p.name] = problem.parameters[p.name] = expression(Vec3::Zero(), 0);
      } catch (const InputError&) {
        if (!first) first = std::current_exception();
        left.push_back(p);
      }
    }
    if (left.size() == pending.size()) std::rethrow_exception(first);
    pending = std::move(left);
  }
  return symbols;
}

}  // namespace concord::scene
