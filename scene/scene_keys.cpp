// Every key of a scene file: what `describe` prints and what the reader checks against.

#include "scene/keys.hpp"

namespace concord::scene {

const std::vector<KeyInfo>& scene_keys() {
  static const std::vector<KeyInfo> keys{
      {"title", "text", "", "", "Name of the problem in reports"},
      {"source", "text", "", "", "Where the problem comes from: paper, section"},
      {"dimension", "text", "", "3D | plane strain | plane stress",
       "What the third direction does; plane bodies lie in Z = 0"},
      {"geometry", "text", "", "a file beside the scene file", "The gmsh .geo file"},
      {"layout", "text", "lattice", "lattice | unstructured",
       "How particles and cells lie: the .geo sees structured = 1 or 0"},
      {"reference_length", "m", "", "> 0", "L: resolution N means the spacing h = L/N"},
      {"thickness", "m", "1 m", "> 0", "Out-of-plane thickness of plane problems"},
      {"static", "true | false", "false", "true | false", "Quasi-static: t runs from 0 to 1"},
      {"load_steps", "1", "1", ">= 1", "Static: number of load steps in t from 0 to 1"},
      {"end_time", "s", "", "> 0", "Dynamic: the run goes from 0 to this time"},
      {"gravity", "m/s^2", "[0, 0, 0]", "one acceleration a direction",
       "Body force per mass in the whole body"},

      {"parameters.*", "any", "", "a number, a text with a unit, or {expr = \"...\"}",
       "Parameter of the .geo and of expressions, by its own name, in SI units"},

      {"material.model", "text", "",
       "neo-hookean | neo-hookean-isochoric | st-venant-kirchhoff | j2-hencky",
       "Stress law: W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2; W = mu/2 (J^(-2/3) tr C "
       "- 3) + kappa/4 (J^2 - 1 - 2 ln J), kappa = lambda + 2 mu/3; W = lambda/2 (tr E)^2 + "
       "mu E:E; or finite-strain J2 plasticity with logarithmic strains, not in plane stress"},
      {"material.density", "kg/m^3", "", "> 0", "Mass per reference volume"},
      {"material.youngs_modulus", "Pa", "", "> 0", "E, together with poissons_ratio"},
      {"material.poissons_ratio", "1", "", "-1 < nu < 0.5",
       "nu, together with youngs_modulus or shear_modulus"},
      {"material.shear_modulus", "Pa", "", "> 0",
       "mu, together with bulk_modulus or poissons_ratio"},
      {"material.bulk_modulus", "Pa", "", "> 0", "kappa, together with shear_modulus"},
      {"material.yield_stress", "Pa", "", "> 0",
       "j2-hencky: initial flow (Kirchhoff) stress tau_y0 of tau_y = tau_y0 + h_0 eps_p + "
       "(tau_y,inf - tau_y0)(1 - exp(-alpha eps_p))"},
      {"material.saturation_stress", "Pa", "yield_stress", "> 0", "j2-hencky: tau_y,inf"},
      {"material.hardening_modulus", "Pa", "0 Pa", ">= 0", "j2-hencky: h_0"},
      {"material.saturation_exponent", "1", "0", ">= 0", "j2-hencky: alpha"},

      {"boundary[].group", "text", "", "a physical group of the .geo",
       "Where the condition holds"},
      {"boundary[].kind", "text", "",
       "fixed | symmetric | antisymmetric | displacement | traction", "What is prescribed"},
      {"boundary[].value", "m or Pa", "", "an expression a direction, or \"exact\"",
       "Displacement (a component may be \"free\" or \"exact\") or nominal traction"},

      {"initial.displacement", "m", "zero", "an expression a direction",
       "Displacement at t = 0"},
      {"initial.velocity", "m/s", "zero", "an expression a direction", "Velocity at t = 0"},
      {"body_force.value", "N/m^3", "zero", "an expression a direction",
       "Force per reference volume"},
      {"exact.displacement", "m", "", "an expression a direction", "The exact displacement"},
      {"exact.velocity", "m/s", "", "an expression a direction", "The exact velocity"},

      {"fracture.energy_release_rate", "J/m^2", "", "> 0",
       "G_f: energy that a unit of crack area takes"},
      {"fracture.criterion", "text", "strain", "strain | energy",
       "A bond breaks when its strain reaches sqrt(2 G_f/(E l_c)), or when the work of the "
       "stress along it reaches G_f/l_c per volume, the same in uniaxial tension"},
      {"fracture.length", "m", "the spacing h", "> 0", "l_c of the criterion"},
      {"fracture.arrival", "text", "", "a physical group of the .geo",
       "Where the crack's arrival is timed"},
      {"fracture.crack[].from", "m", "", "an expression of the parameters a direction",
       "Pre-crack: its mouth; bonds that cross it are removed, in 3D those that cross the plane "
       "through it along Z"},
      {"fracture.crack[].to", "m", "", "an expression of the parameters a direction",
       "Pre-crack: its tip"},

      {"quantity[].name", "text", "", "letters, digits and _",
       "Name in history.csv and summary.json"},
      {"quantity[].kind", "text", "", "point | average | reaction | maximum",
       "Displacement at a point, mean over a group, reaction of a group, maximum of a field"},
      {"quantity[].at", "m", "", "one length a direction", "Point: reference position"},
      {"quantity[].group", "text", "", "a physical group of the .geo",
       "Average, reaction: where; maximum: restriction"},
      {"quantity[].field", "text", "displacement",
       "displacement | velocity | displacement_error | von_mises | pressure | "
       "plastic_strain | kirchhoff_mises | unbalanced_force",
       "Average, maximum: of which field"},
      {"quantity[].where", "text", "everywhere", "everywhere | interior",
       "Maximum: interior leaves the surface of the body out"},

      {"output.frames", "1", "20", ">= 0", "Field frames besides the initial one"},
      {"output.history_rows", "1", "200", ">= 0", "Rows of history.csv over the run"},
  };
  return keys;
}

}  // namespace concord::scene
