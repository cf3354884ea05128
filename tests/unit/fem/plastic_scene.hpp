#pragma once
// Blocks of an elastoplastic material for the tests of method `fem`, and what they leave
// behind.

#include "fem_scene.hpp"

#include <sstream>

namespace concord::fem_test {

inline const std::string hardening = R"(yield_stress = "2 kPa"
saturation_stress = "3 kPa"
hardening_modulus = "1 kPa"
saturation_exponent = 20
)";
inline const std::string perfect = "yield_stress = \"2 kPa\"\n";

/// E = 1 MPa, nu = .3 as everywhere in these tests; hardening follows the material's entries.
inline scene::Problem plastic_problem(const Folder& folder, const std::string& dimension,
                                      const std::string& time, const std::string& law,
                                      const std::string& rest) {
  return make_problem(folder, geo_of(dimension),
                      scene_text(dimension, "static = true\n" + time, law + rest, "j2-hencky"));
}

/// Tension of a square block along x, the sides y free, u_x(x = 1) = `motion`.
inline std::string tension(const std::string& motion) {
  return fmt::format(R"toml(
[[boundary]]
group = "x0"
kind = "symmetric"
[[boundary]]
group = "y0"
kind = "symmetric"
[[boundary]]
group = "x1"
kind = "displacement"
value = ["{}", "free"]
[[quantity]]
name = "pull"
kind = "reaction"
group = "x1"
[[quantity]]
name = "eps_p"
kind = "maximum"
field = "plastic_strain"
[[quantity]]
name = "tau_eq"
kind = "maximum"
field = "kirchhoff_mises"
)toml",
                     motion);
}

/// history.csv as columns by name.
inline std::map<std::string, std::vector<double>> history(const fs::path& out) {
  std::ifstream file(out / "history.csv");
  std::string line, cell;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::stringstream cells(line);
    for (std::size_t k = 0; std::getline(cells, cell, ','); ++k) {
      if (names.size() == k)
        names.push_back(cell);
      else
        columns[names[k]].push_back(std::stod(cell));
    }
  }
  return columns;
}

}  // namespace concord::fem_test
