#include "scene/reader.hpp"

#include "scene/reader_parts.hpp"
#include "scene/suggest.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace concord::scene {
namespace fs = std::filesystem;
namespace {

fs::path scene_file(const std::string& name_or_path) {
  const fs::path path(name_or_path);
  if (fs::is_regular_file(path)) return path;
  if (fs::is_regular_file(path / "scene.toml")) return path / "scene.toml";
  const fs::path in_library = data_home() / "scene" / "library" / path / "scene.toml";
  if (!name_or_path.empty() && fs::is_regular_file(in_library)) return in_library;
  throw InputError({"command line", 0, 0}, "scene", in_quotes(name_or_path),
                   "the path of a scene file or one of " +
                       allowed_words(name_or_path, library_scenes()));
}

std::string file_bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The .geo and whatever it includes or merges, each once.
void append_geometry(const fs::path& file, std::set<fs::path>& seen, std::string& out) {
  if (!seen.insert(file).second) return;
  const std::string bytes = file_bytes(file);
  out += fmt::format("{}:{}\n{}\n", file.filename().string(), bytes.size(), bytes);
  const std::regex include("(?:Include|Merge)\\s*\"([^\"]+)\"");
  for (auto it = std::sregex_iterator(bytes.begin(), bytes.end(), include);
       it != std::sregex_iterator(); ++it) {
    const fs::path other = fs::absolute(file.parent_path() / (*it)[1].str());
    if (fs::is_regular_file(other)) append_geometry(other, seen, out);
  }
}

}  // namespace

fs::path data_home() {
  if (const char* home = std::getenv("CONCORD_HOME"); home != nullptr && *home != '\0')
    return home;
  if (fs::is_directory(fs::path(CONCORD_SOURCE_HOME) / "scene" / "library"))
    return CONCORD_SOURCE_HOME;
  return CONCORD_INSTALLED_HOME;
}

std::vector<std::string> library_scenes() {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(data_home() / "scene" / "library", none))
    if (fs::is_regular_file(entry.path() / "scene.toml"))
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

Problem read_problem(const std::string& name_or_path, const std::vector<Override>& overrides) {
  Problem problem;
  problem.file = scene_file(name_or_path);
  const fs::path absolute = fs::absolute(problem.file).lexically_normal();
  problem.name = absolute.filename() == "scene.toml"
                     ? absolute.parent_path().filename().string()
                     : absolute.stem().string();
  ConfigNode root = read_toml(problem.file);
  for (const auto& [key, text] : overrides) set_value(root, key, text);
  check_keys_known(root);

  const Section scene(root);
  read_head(scene, problem);
  read_material(scene, problem);
  const Symbols symbols = read_parameters(scene, problem);
  read_exact(scene, symbols, problem);
  read_boundaries(scene, symbols, problem);
  read_loads(scene, symbols, problem);
  read_initial(scene, symbols, problem);
  read_fracture(scene, symbols, problem);
  read_quantities(scene, problem);
  read_output(scene, problem);
  check_keys_read(root);
  check_statements(scene, problem);

  std::set<fs::path> seen;
  problem.normalised_text = root.canonical() + "\n";
  append_geometry(problem.geometry, seen, problem.normalised_text);
  return problem;
}

}  // namespace concord::scene
