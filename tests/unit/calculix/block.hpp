#pragma once
// A unit square or cube whose sides x0, y0 (z0) are planes of symmetry and whose top moves by
// U in y; the other sides are free or held.

#include "tests/unit/scene/scratch_scene.hpp"

#include <fmt/format.h>

namespace concord::calculix_test {

inline const char* const cube_geo = R"(
DefineConstant[ h = 1, structured = 1 ];
n = Round(1/h);
Point(1) = {0, 0, 0, h};
line[] = Extrude {1, 0, 0} { Point{1}; Layers{n}; };
area[] = Extrude {0, 1, 0} { Line{line[1]}; Layers{n}; };
body[] = Extrude {0, 0, 1} { Surface{area[1]}; Layers{n}; };
eps = 1e-6;
Physical Surface("x0") = Surface In BoundingBox {-eps, -eps, -eps, eps, 1 + eps, 1 + eps};
Physical Surface("x1") = Surface In BoundingBox {1 - eps, -eps, -eps, 1 + eps, 1 + eps, 1 + eps};
Physical Surface("y0") = Surface In BoundingBox {-eps, -eps, -eps, 1 + eps, eps, 1 + eps};
Physical Surface("y1") = Surface In BoundingBox {-eps, 1 - eps, -eps, 1 + eps, 1 + eps, 1 + eps};
Physical Surface("z0") = Surface In BoundingBox {-eps, -eps, -eps, 1 + eps, 1 + eps, eps};
Physical Volume("body") = {body[1]};
)";

struct Block {
  std::string dimension = "plane strain";
  std::string material{};                               ///< keys of [material]
  std::string motion{};                                 ///< of the top, expression in t
  std::string top = "static = true\nload_steps = 4\n";  ///< keys before the tables
  std::string more{};                                   ///< tables at the end
  bool held = false;                                    ///< x1 cannot move in x

  std::string text() const {
    std::string out =
        fmt::format(R"(dimension = "{}"
geometry = "body.geo"
reference_length = "1 m"
{}[material]
{}
[[boundary]]
group = "x0"
kind = "symmetric"
[[boundary]]
group = "y0"
kind = "symmetric"
[[boundary]]
group = "y1"
kind = "displacement"
value = ["free", "{}"{}]
[[quantity]]
name = "bottom"
kind = "reaction"
group = "y0"
[[quantity]]
name = "top"
kind = "reaction"
group = "y1"
[[quantity]]
name = "side"
kind = "average"
field = "displacement"
group = "x1"
)",
                    dimension, top, material, motion, dimension == "3D" ? ", \"free\"" : "");
    if (dimension == "3D") out += "[[boundary]]\ngroup = \"z0\"\nkind = \"symmetric\"\n";
    if (held) out += "[[boundary]]\ngroup = \"x1\"\nkind = \"symmetric\"\n";
    return out + more;
  }
  test::ScratchScene scene() const {
    return test::ScratchScene(text(), dimension == "3D" ? cube_geo : test::square_geo);
  }
};

/// The metal of the Continuum Bond Method paper (Table 1), or another hardening.
inline std::string metal(const std::string& yield = "450 MPa",
                         const std::string& saturation = "715 MPa",
                         const std::string& modulus = "129 MPa") {
  return fmt::format(R"(model = "j2-hencky"
density = "1000 kg/m^3"
shear_modulus = "80.19 GPa"
bulk_modulus = "164.21 GPa"
yield_stress = "{}"
saturation_stress = "{}"
hardening_modulus = "{}"
saturation_exponent = 16.93
)",
                     yield, saturation, modulus);
}

inline std::string elastic() {
  return R"(model = "st-venant-kirchhoff"
density = "1000 kg/m^3"
youngs_modulus = "1 MPa"
poissons_ratio = 0.3
)";
}

}  // namespace concord::calculix_test
