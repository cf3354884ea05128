#include "scene/mesher/gmsh_session.hpp"

#include "scene/suggest.hpp"

#include <fmt/format.h>
#include <fstream>
#include <gmsh.h>
#include <regex>
#include <stdlib.h>  // mkdtemp

namespace concord::scene {
namespace {

std::mutex& gmsh_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Options that a .geo may have changed are set anew for every model.
void set_options() {
  const auto set = [](const char* name, double value) { gmsh::option::setNumber(name, value); };
  set("General.Terminal", 0);
  set("General.Verbosity", 2);     // log warnings and errors only
  set("General.NumThreads", 1);    // the same mesh whatever the machine
  set("General.AbortOnError", 0);  // report, never end the program
  set("Mesh.RandomSeed", 1);
  set("Mesh.RandomFactor", 1e-9);     // gmsh's own defaults, stated because a .geo can change
  set("Mesh.RandomFactor3D", 1e-12);  // them for all that follow
  set("Mesh.Algorithm", 6);
  set("Mesh.Algorithm3D", 1);
  set("Mesh.Optimize", 1);
  set("Mesh.ElementOrder", 1);
  set("Mesh.SecondOrderLinear", 0);
  set("Mesh.SecondOrderIncomplete", 0);
  set("Mesh.RecombineAll", 0);
  set("Mesh.RecombinationAlgorithm", 1);
  set("Mesh.SubdivisionAlgorithm", 0);
  set("Mesh.CharacteristicLengthFactor", 1);
  set("Mesh.CharacteristicLengthMin", 0);
  set("Mesh.CharacteristicLengthMax", 1e22);
  set("Mesh.CharacteristicLengthFromPoints", 1);
  set("Mesh.CharacteristicLengthExtendFromBoundary", 1);
  set("Mesh.CharacteristicLengthFromCurvature", 0);
}

struct Library {
  Library() { gmsh::initialize(0, nullptr, false); }
  ~Library() { gmsh::finalize(); }
};

/// A folder that goes away with its contents.
struct TemporaryFolder {
  std::filesystem::path path;
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "concord-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw std::filesystem::filesystem_error("no temporary folder", name, std::error_code{});
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace

GmshSession::GmshSession() : m_lock(gmsh_mutex()) {
  static Library library;
  set_options();
  gmsh::clear();
  gmsh::logger::start();
}

GmshSession::~GmshSession() {
  try {
    gmsh::logger::stop();
    gmsh::clear();
  } catch (...) {  // a destructor has nobody to tell
  }
}

void GmshSession::open_geometry(const Problem& problem, double h, bool structured) {
  const TemporaryFolder folder;
  const std::filesystem::path wrapper = folder.path / "preset.geo";
  {
    std::ofstream out(wrapper);
    out << fmt::format("h = {:.17g};\nstructured = {};\n", h, structured ? 1 : 0);
    for (const auto& [name, value] : problem.parameters)
      out << fmt::format("{} = {:.17g};\n", name, value);
    out << "Include \"" << problem.geometry.string() << "\";\n";
  }
  gmsh_guard(*this, problem, "cannot read", [&] { gmsh::open(wrapper.string()); });
  if (const std::string report = logged_error(); !report.empty())
    fail(problem, "cannot read", report);
}

std::string GmshSession::logged_error() const {
  std::vector<std::string> log;
  gmsh::logger::get(log);
  for (const std::string& line : log)
    if (line.starts_with("Error")) return line.substr(std::min<std::size_t>(7, line.size()));
  return "";
}

void GmshSession::fail(const Problem& problem, const std::string& stage,
                       const std::string& report) const {
  SourcePosition where = problem.geometry_where;
  std::string text = report;
  std::smatch match;
  if (std::regex_search(report, match, std::regex("'([^']*)', line ([0-9]+): *"))) {
    where = {match[1].str(), std::stoi(match[2].str()), 0};
    text = match.suffix().str();
  }
  throw InputError(where, "geometry",
                   in_quotes(problem.geometry.filename().string()) + ", which gmsh " + stage +
                       ": " + (text.empty() ? "no reason given" : text),
                   "a .geo file that gmsh 4 reads and meshes with the variables h, structured "
                   "and the scene's parameters");
}

}  // namespace concord::scene
