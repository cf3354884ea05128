#pragma once
// A scene file and its geometry in a folder that goes away with the test.

#include "scene/reader.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace concord::test {

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

/// A unit square or cube with groups x0, x1, y0, y1 (z0, z1) and body.
inline const char* const square_geo = R"(
DefineConstant[ h = 0.25, structured = 1, A = 1 ];
n = Round(A/h);
Point(1) = {0, 0, 0, h}; Point(2) = {A, 0, 0, h}; Point(3) = {A, 1, 0, h}; Point(4) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
If (structured)
  Transfinite Curve "*" = n + 1; Transfinite Surface {1};
EndIf
Physical Curve("y0") = {1}; Physical Curve("x1") = {2}; Physical Curve("y1") = {3};
Physical Curve("x0") = {4}; Physical Point("corner") = {1}; Physical Surface("body") = {1};
)";

struct ScratchScene {
  std::filesystem::path folder;
  ScratchScene(const std::string& scene, const std::string& geo = square_geo) {
    std::string name =
        (std::filesystem::temp_directory_path() / "concord-test-XXXXXX").string();
    folder = mkdtemp(name.data());
    write_text(folder / "scene.toml", scene);
    write_text(folder / "body.geo", geo);
  }
  ~ScratchScene() { std::filesystem::remove_all(folder); }
  ScratchScene(const ScratchScene&) = delete;
  scene::Problem read(const std::vector<scene::Override>& overrides = {}) const {
    return scene::read_problem((folder / "scene.toml").string(), overrides);
  }
};

/// The least that a plane dynamic scene needs; `more` goes to the end, `top` before the tables.
inline std::string plane_scene(const std::string& more = "", const std::string& top = "") {
  return R"(dimension = "plane strain"
geometry = "body.geo"
reference_length = "1 m"
end_time = "1 ms"
)" + top +
         R"([material]
model = "neo-hookean"
density = "1000 kg/m^3"
youngs_modulus = "1 MPa"
poissons_ratio = 0.3
)" + more;
}

}  // namespace concord::test
