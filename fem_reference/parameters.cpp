#include "fem_reference/parameters.hpp"

namespace concord::fem {
namespace {

scene::ParameterInfo word(std::string key, std::string value, std::vector<std::string> choices,
                          std::string meaning) {
  std::string range;
  for (const std::string& c : choices) range += (range.empty() ? "" : " | ") + c;
  scene::ParameterInfo info;
  info.key = std::move(key);
  info.unit = std::string(1, '1');
  info.default_value = std::move(value);
  info.range = std::move(range);
  info.meaning = std::move(meaning);
  info.choices = std::move(choices);
  return info;
}

scene::ParameterInfo number(std::string key, std::string unit, std::string value,
                            double minimum, double maximum, std::string range,
                            std::string meaning) {
  scene::ParameterInfo info;
  info.key = std::move(key);
  info.unit = std::move(unit);
  info.default_value = std::move(value);
  info.range = std::move(range);
  info.meaning = std::move(meaning);
  info.minimum = minimum;
  info.maximum = maximum;
  return info;
}

std::vector<scene::ParameterInfo> parameter_table() {
  return {
      word(
          "element", "Q2", {"P1", "P2", "Q1", "Q2"},
          "Lagrange element: P on triangles and tetrahedra, Q on quadrilaterals and hexahedra; "
          "the digit is the polynomial degree p"),
      word(
          "solver", "auto", {"auto", "explicit", "newmark", "static"},
          "auto: static for static scenes, else explicit for Q1 and Q2, newmark for P1 and P2"),
      word("linear_solver", "auto", {"auto", "direct", "cg"},
           "Newton's linear systems: direct is UMFPACK, cg is conjugate gradients with SSOR; "
           "auto: "
           "cg for Newmark and for static 3D problems above 20000 unknowns, else direct"),
      word("law", "scene", {"scene", "split-neo-hookean"},
           "scene: the scene's law; split-neo-hookean: W = mu/2 (J^-2/3 tr C - 3) + kappa/4 "
           "(J^2 - 1 "
           "- 2 ln J), with the scene's constants, for figures published with it (3D, plane "
           "strain)"),
      word("quadrature", "auto", {"auto", "3"},
           "points of the internal force: 3 is the 3-point rule of P2 in the plane (T6 of the "
           "Continuum Bond Method paper); auto: 3 there with plastic materials, else p+1 Gauss "
           "points a direction (Q) or the rule exact to degree 2p-1 (P)"),
      word("yield_measure", "kirchhoff", {"kirchhoff", "cauchy"},
           "plastic materials: stress whose equivalent reaches tau_y of Eq. (24) of the "
           "Continuum Bond Method paper; cauchy is CalculiX's choice, and its tangent is not "
           "symmetric"),
      number("dt", "s", "0", 0, 1e300, ">= 0",
             "time step; 0: from dt_factor (explicit) or courant (newmark)"),
      number(
          "dt_factor", "1", "0.8", 1e-6, 1, "1e-6 to 1",
          "explicit: dt = dt_factor 2/omega_max, omega_max^2 the largest eigenvalue of M^-1 K "
          "by power iteration"),
      number(
          "courant", "1", "0.5", 1e-6, 1000, "1e-6 to 1000",
          "newmark: dt = courant h/(p c_p), c_p the longitudinal wave speed, Eq. (55) of the "
          "Delaunay paper"),
      number("newmark_beta", "1", "0.25", 1e-6, 1, "1e-6 to 1",
             "u_1 = u_0 + dt v_0 + dt^2 ((1/2 - beta) a_0 + beta a_1)"),
      number("newmark_gamma", "1", "0.5", 0.5, 1, "0.5 to 1",
             "v_1 = v_0 + dt ((1 - gamma) a_0 + gamma a_1); above 1/2 dissipates"),
      number(
          "tolerance", "1", "0", 0, 1e-2, "0 to 1e-2",
          "Newton stops when |f_ext - f_int - M a| <= tolerance times the norm of all element "
          "forces before they cancel; 0: 1e-12 in statics, 1e-9 for newmark"),
      number("max_iterations", "1", "25", 1, 1000, "1 to 1000",
             "Newton iterations allowed in a load or time step"),
      number("max_halvings", "1", "12", 0, 40, "0 to 40",
             "how often a static load step that fails is halved before the run is given up"),
  };
}

/// The 3-point rule, asked for or by default.
bool pick_three_points(const scene::Problem& problem, const Options& options,
                       const std::string& asked) {
  const bool fits = problem.dim() == 2 && options.element == "P2";
  if (asked != "auto" && !fits) {
    throw InputError({problem.file.string()}, "fem.quadrature", asked,
                     "auto, or element P2 in a plane problem");
  }
  return fits && (asked != "auto" || problem.material.plastic());
}

Solver pick_solver(const scene::Problem& problem, const Options& options,
                   const std::string& asked) {
  const bool simplex = options.shape == scene::CellShape::simplex;
  const auto reject = [&](const std::string& allowed) -> Solver {
    throw InputError({problem.file.string()}, "fem.solver", asked, allowed);
  };
  if (problem.material.plastic() &&
      (!problem.is_static || asked == "explicit" || asked == "newmark")) {
    return reject("static, in a static scene: fem solves plastic scenes quasi-statically");
  }
  if (asked == "auto") {
    if (problem.is_static) return Solver::statics;
    return simplex ? Solver::newmark : Solver::explicit_leapfrog;
  }
  if (asked == "static") {
    return problem.is_static ? Solver::statics
                             : reject("explicit or newmark for a dynamic scene");
  }
  if (problem.is_static) return reject("auto or static for a static scene");
  if (asked == "newmark") return Solver::newmark;
  if (simplex) return reject("newmark for P1 and P2: explicit needs Q1 or Q2");
  return Solver::explicit_leapfrog;
}

}  // namespace

const scene::MethodInfo& method_info() {
  static const scene::MethodInfo info{"fem", "Finite elements (reference, deal.II)",
                                      "total-Lagrangian displacement elements; laws Eqs. "
                                      "(51)-(53) of the Delaunay paper, St "
                                      "Venant-Kirchhoff, J2 plasticity (Algorithm 2 of the "
                                      "Continuum Bond Method paper, quasi-static); "
                                      "fem_reference/README.md",
                                      parameter_table()};
  return info;
}

Options read_options(const scene::Problem& problem, const scene::RunRequest& request) {
  scene::refuse_fracture(problem, "fem");
  const scene::Settings settings("fem", method_info().parameters, request.settings);
  Options o;
  o.element = settings.word("element");
  o.shape = o.element[0] == 'P' ? scene::CellShape::simplex : scene::CellShape::hypercube;
  o.degree = o.element[1] - '0';
  o.solver = pick_solver(problem, o, settings.word("solver"));
  const std::string& linear = settings.word("linear_solver");
  o.linear_solver = linear == "direct" ? LinearChoice::direct
                    : linear == "cg"   ? LinearChoice::conjugate_gradients
                                       : LinearChoice::automatic;
  o.split_law = settings.word("law") != "scene";
  if (o.split_law && problem.material.plastic()) {
    throw InputError({problem.file.string()}, "fem.law", settings.word("law"),
                     "scene, for a plastic material");
  }
  o.three_points = pick_three_points(problem, o, settings.word("quadrature"));
  o.yield_measure = settings.word("yield_measure") == "cauchy" ? YieldMeasure::cauchy
                                                               : YieldMeasure::kirchhoff;
  o.dt = settings.number("dt");
  o.dt_factor = settings.number("dt_factor");
  o.courant = settings.number("courant");
  o.beta = settings.number("newmark_beta");
  o.gamma = settings.number("newmark_gamma");
  o.tolerance = settings.number("tolerance");
  o.max_iterations = static_cast<int>(settings.number("max_iterations"));
  o.max_halvings = static_cast<int>(settings.number("max_halvings"));
  return o;
}

}  // namespace concord::fem
