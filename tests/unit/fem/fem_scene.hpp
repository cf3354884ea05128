#pragma once
// Scenes made on the spot for the tests of method `fem`: a block with named sides.

#include "scene/method.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace concord::fem_test {

namespace fs = std::filesystem;

/// A folder of this process that goes when the test ends.
class Folder {
 public:
  Folder() {
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    for (char& c : name) {
      if (c == '/') c = '_';  // parametrised tests
    }
    m_path = fs::temp_directory_path() / fmt::format("concord-fem-{}-{}", name, getpid());
    fs::create_directories(m_path);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(m_path); }
  fs::path operator/(const std::string& name) const { return m_path / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(m_path / name) << text;
  }

 private:
  fs::path m_path;
};

/// Unit square or cube, sides x0 x1 y0 y1 (z0 z1), body.
inline std::string square_geo() {
  return R"(DefineConstant[ h = 0.25, structured = 1 ];
n = Round(1/h);
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {1, 1, 0, h}; Point(4) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
If (structured)
  Transfinite Curve "*" = n + 1; Transfinite Surface "*";
EndIf
Physical Curve("y0") = {1}; Physical Curve("x1") = {2}; Physical Curve("y1") = {3};
Physical Curve("x0") = {4}; Physical Surface("body") = {1}; Physical Point("origin") = {1};
Physical Curve("sides") = {1, 2, 3, 4};
)";
}

inline std::string cube_geo() {
  return R"(DefineConstant[ h = 0.25, structured = 1 ];
n = Round(1/h);
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {1, 1, 0, h}; Point(4) = {0, 1, 0, h};
Point(5) = {0, 0, 1, h}; Point(6) = {1, 0, 1, h}; Point(7) = {1, 1, 1, h}; Point(8) = {0, 1, 1, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 5};
Line(9) = {1, 5}; Line(10) = {2, 6}; Line(11) = {3, 7}; Line(12) = {4, 8};
Curve Loop(1) = {-4, -3, -2, -1}; Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(2) = {2};
Curve Loop(3) = {1, 10, -5, -9}; Plane Surface(3) = {3};
Curve Loop(4) = {3, 12, -7, -11}; Plane Surface(4) = {4};
Curve Loop(5) = {4, 9, -8, -12}; Plane Surface(5) = {5};
Curve Loop(6) = {2, 11, -6, -10}; Plane Surface(6) = {6};
Surface Loop(1) = {1, 2, 3, 4, 5, 6}; Volume(1) = {1};
If (structured)
  Transfinite Curve "*" = n + 1; Transfinite Surface "*"; Transfinite Volume "*";
EndIf
Physical Surface("z0") = {1}; Physical Surface("z1") = {2}; Physical Surface("y0") = {3};
Physical Surface("y1") = {4}; Physical Surface("x0") = {5}; Physical Surface("x1") = {6};
Physical Volume("body") = {1}; Physical Surface("sides") = {1, 2, 3, 4, 5, 6};
)";
}

inline std::string geo_of(const std::string& dimension) {
  return dimension == "3D" ? cube_geo() : square_geo();
}

/// scene.toml with the parts common to the tests; `rest` holds boundaries, loads, solutions.
inline std::string scene_text(const std::string& dimension, const std::string& time,
                              const std::string& rest,
                              const std::string& model = "neo-hookean") {
  return fmt::format(R"(title = "test"
source = "made for a test"
dimension = "{}"
geometry = "body.geo"
reference_length = "1 m"
{}
[material]
model = "{}"
density = "1000 kg/m^3"
youngs_modulus = "1 MPa"
poissons_ratio = 0.3
{})",
                     dimension, time, model, rest);
}

inline scene::Problem make_problem(const Folder& folder, const std::string& geo,
                                   const std::string& text) {
  folder.write("body.geo", geo);
  folder.write("scene.toml", text);
  return scene::read_problem((folder / "scene.toml").string());
}

inline scene::Result run(const scene::Problem& problem, double h,
                         const std::map<std::string, std::string>& settings, double perturb = 0,
                         const fs::path& out = {}, int threads = 1) {
  scene::RunRequest request;
  request.h = h;
  request.perturb = perturb;
  request.seed = 7;
  request.settings = settings;
  request.out = out;
  request.threads = threads;
  scene::Result result;
  scene::MethodRegistry::instance().find("fem").run(problem, request, result);
  return result;
}

}  // namespace concord::fem_test
