#include "fem_reference/calculix/options.hpp"

#include "fem_reference/calculix/hardening.hpp"

#include <fmt/format.h>

#include <cmath>

namespace concord::calculix {
namespace {

scene::ParameterInfo number(std::string key, std::string value, double minimum, double maximum,
                            std::string range, std::string meaning) {
  scene::ParameterInfo info{std::move(key), "1", std::move(value), std::move(range),
                            std::move(meaning)};
  info.minimum = minimum;
  info.maximum = maximum;
  return info;
}

scene::ParameterInfo word(std::string key, std::vector<std::string> choices,
                          std::string meaning) {
  scene::ParameterInfo info{std::move(key), "1", choices.front(), "", std::move(meaning)};
  for (const std::string& c : choices) info.range += (info.range.empty() ? "" : " | ") + c;
  info.choices = std::move(choices);
  return info;
}

std::vector<scene::ParameterInfo> parameter_table() {
  return {
      word("element", {"P2"},
           "P2: six-node triangles (CPE6, three points in the plane) or ten-node tetrahedra "
           "(C3D10, four points), on the mesh that method fem has with its element P2"),
      number("steps", "0", 0, 10000, "0 to 10000", "load steps; 0: the scene's"),
      number("hardening_points", "200", 3, max_hardening_points, "3 to 200",
             "points of the table that stands for the hardening curve, Eq. (24) of the "
             "Continuum Bond Method paper"),
      number("tolerance", "1e-8", 1e-12, 1e-2, "1e-12 to 1e-2",
             "CalculiX iterates until residual forces and corrections are below this times the "
             "mean force and the largest increment of displacement (its R_n and C_n)"),
      word("keep_files", {"off", "on"},
           "on: the result files of CalculiX stay in the folder calculix of the run"),
  };
}

/// Statics of the materials and dimensions that there are elements and laws for.
void check_problem(const scene::Problem& problem) {
  const SourcePosition where{problem.file.string()};
  if (!problem.is_static)
    throw InputError(where, "static", "a dynamic scene", "static = true for method calculix");
  if (problem.dimension == Dimension::plane_stress)
    throw InputError(where, "dimension", "plane stress",
                     "plane strain or 3D for method calculix");
  if (problem.material.model != scene::MaterialModel::j2_hencky &&
      problem.material.model != scene::MaterialModel::st_venant_kirchhoff)
    throw InputError(
        where, "material.model", "a neo-Hookean law",
        "st-venant-kirchhoff or j2-hencky for method calculix: its own neo-Hookean "
        "law has another volumetric part");
  if (problem.gravity != Vec3::Zero() || problem.body_force)
    throw InputError(where, "gravity or body_force", "a load on the volume",
                     "no such load for method calculix");
  if (problem.initial_displacement && !problem.initial_displacement->is_zero())
    throw InputError(where, "initial.displacement", "an initial displacement",
                     "none for method calculix");
}

void check_boundaries(const scene::Problem& problem) {
  for (const scene::BoundaryCondition& bc : problem.boundaries) {
    if (bc.kind == scene::BoundaryKind::traction)
      throw InputError(bc.where, "boundary.kind", "traction",
                       "fixed, symmetric, antisymmetric or displacement for method calculix");
  }
}

}  // namespace

const scene::MethodInfo& method_info() {
  static const scene::MethodInfo info{"calculix",
                                      "Finite elements (CalculiX, an outside program)",
                                      "CalculiX CrunchiX (ccx), package calculix-ccx; J2 "
                                      "plasticity with the yield limit on the "
                                      "Cauchy stress; fem_reference/calculix/README.md",
                                      parameter_table()};
  return info;
}

Options read_options(const scene::Problem& problem, const scene::RunRequest& request) {
  const scene::Settings settings("calculix", method_info().parameters, request.settings);
  check_problem(problem);
  check_boundaries(problem);
  if (request.perturb > 0)
    throw InputError({"request"}, "perturb", fmt::format("{:g}", request.perturb),
                     "0 for method calculix, which takes the mesh as gmsh makes it");
  Options o;
  const auto whole = [&](const char* key) {
    const double value = settings.number(key);
    if (value != std::floor(value))
      throw InputError({problem.file.string()}, std::string("calculix.") + key,
                       fmt::format("{:g}", value), "a whole number");
    return static_cast<int>(value);
  };
  const int steps = whole("steps");
  o.steps = steps >= 1 ? steps : problem.load_steps;
  o.hardening_points = whole("hardening_points");
  o.tolerance = settings.number("tolerance");
  o.keep_files = settings.flag("keep_files");
  return o;
}

}  // namespace concord::calculix
