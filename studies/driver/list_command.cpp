#include "studies/driver/commands.hpp"

#include "scene/method.hpp"
#include "scene/reader.hpp"
#include "scene/suggest.hpp"
#include "studies/driver/study_file.hpp"
#include "studies/probes/probe.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace concord::studies {
namespace {

using nlohmann::ordered_json;

const char* dimension_text(Dimension dimension) {
  switch (dimension) {
    case Dimension::three_d:
      return "3D";
    case Dimension::plane_strain:
      return "plane strain";
    case Dimension::plane_stress:
      return "plane stress";
  }
  return "";
}

ordered_json scenes() {
  ordered_json list = ordered_json::array();
  for (const std::string& name : scene::library_scenes()) {
    const scene::Problem problem = scene::read_problem(name);
    list.push_back({{"name", name},
                    {"title", problem.title},
                    {"source", problem.source},
                    {"dimension", dimension_text(problem.dimension)}});
  }
  return list;
}

ordered_json methods() {
  ordered_json list = ordered_json::array();
  for (const scene::Method* method : scene::MethodRegistry::instance().all()) {
    const scene::MethodInfo& info = method->info();
    list.push_back({{"name", info.name}, {"title", info.title}, {"source", info.source}});
  }
  return list;
}

ordered_json studies() {
  ordered_json list = ordered_json::array();
  for (const std::string& name : study_names(scene::data_home())) {
    const Study study = read_study(name, true, scene::data_home());
    list.push_back({{"name", name}, {"title", study.title}, {"source", study.source}});
  }
  return list;
}

ordered_json probe_list() {
  ordered_json list = ordered_json::array();
  for (const probes::Probe* probe : probes::ProbeRegistry::instance().all()) {
    const probes::ProbeInfo& info = probe->info();
    list.push_back({{"name", info.name}, {"title", info.title}, {"source", info.source}});
  }
  return list;
}

/// Columns as wide as their widest cell; the last one is not padded.
void print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i)
      line += i + 1 == row.size() ? " " + row[i] : fmt::format(" {:<{}} ", row[i], widths[i]);
    fmt::print("{}\n", line);
  }
}

const char* kind_text(scene::BoundaryKind kind) {
  switch (kind) {
    case scene::BoundaryKind::fixed:
      return "fixed";
    case scene::BoundaryKind::symmetric:
      return "symmetric";
    case scene::BoundaryKind::antisymmetric:
      return "antisymmetric";
    case scene::BoundaryKind::displacement:
      return "displacement";
    case scene::BoundaryKind::traction:
      return "traction";
  }
  return "";
}

void describe_scene(const std::string& name) {
  const scene::Problem problem = scene::read_problem(name);
  fmt::print("scene {}: {}\n  source: {}\n  file: {}\n  {}, {}, reference length {:g} m\n",
             name, problem.title, problem.source, problem.file.string(),
             dimension_text(problem.dimension),
             problem.is_static ? fmt::format("static in {} load steps", problem.load_steps)
                               : fmt::format("dynamic to {:g} s", problem.end_time),
             problem.reference_length);
  fmt::print("  material: rho0 {:g} kg/m^3, E {:g} Pa, nu {:g}\n", problem.material.rho0,
             problem.material.E, problem.material.nu);
  for (const scene::BoundaryCondition& condition : problem.boundaries)
    fmt::print("  boundary {}: {}\n", condition.group, kind_text(condition.kind));
  for (const scene::Quantity& quantity : problem.quantities)
    fmt::print("  quantity {}\n", quantity.name);
  fmt::print("parameters (--set parameters.NAME=...), SI units:\n");
  std::vector<std::vector<std::string>> rows;
  for (const auto& [key, value] : problem.parameters)
    rows.push_back({key, fmt::format("{:g}", value)});
  print_table(rows);
  fmt::print("keys of a scene (--set KEY=...):\n");
  rows = {{"key", "unit", "default", "allowed", "meaning"}};
  for (const scene::KeyInfo& key : scene::scene_keys())
    rows.push_back({key.key, key.unit, key.default_value, key.range, key.meaning});
  print_table(rows);
}

/// Keys of a method or probe, with a heading.
void print_parameters(const std::vector<scene::ParameterInfo>& parameters) {
  std::vector<std::vector<std::string>> rows{{"key", "unit", "default", "range", "meaning"}};
  for (const scene::ParameterInfo& parameter : parameters)
    rows.push_back({parameter.key, parameter.unit, parameter.default_value, parameter.range,
                    parameter.meaning});
  print_table(rows);
}

void describe_method(const scene::MethodInfo& info) {
  fmt::print("method {}: {}\n  source: {}\nsettings (--set {}.KEY=...):\n", info.name,
             info.title, info.source, info.name);
  print_parameters(info.parameters);
}

void describe_probe(const probes::ProbeInfo& info) {
  fmt::print("probe {}: {}\n  source: {}\noptions (--option KEY=...):\n", info.name, info.title,
             info.source);
  print_parameters(info.options);
  fmt::print("quantities:\n");
  std::vector<std::vector<std::string>> rows{{"name", "unit", "meaning"}};
  for (const probes::QuantityInfo& quantity : info.quantities)
    rows.push_back({quantity.name, quantity.unit, quantity.meaning});
  print_table(rows);
}

void describe_study(const std::string& name) {
  const Study study = read_study(name, true, scene::data_home());
  const Study quick = read_study(name, false, scene::data_home());
  fmt::print("study {}: {}\n  {}\n  source: {}\ncases:\n", name, study.title, study.question,
             study.source);
  for (const Case& entry : study.cases) {
    const bool in_quick =
        std::any_of(quick.cases.begin(), quick.cases.end(),
                    [&](const Case& c) { return c.title() == entry.title(); });
    fmt::print("  {}: resolutions {}, {} seeds{}\n", entry.title(),
               fmt::join(entry.resolutions, ", "), entry.seeds.size(),
               in_quick ? "" : ", full report only");
  }
  fmt::print("claims:\n");
  for (const Claim& claim : study.claims) fmt::print("  {}: {}\n", claim.id, claim.statement);
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

int list_command(const std::string& what, bool as_json) {
  ordered_json lists;
  if (what.empty() || what == "scenes") lists["scenes"] = scenes();
  if (what.empty() || what == "methods") lists["methods"] = methods();
  if (what.empty() || what == "studies") lists["studies"] = studies();
  if (what.empty() || what == "probes") lists["probes"] = probe_list();
  if (as_json) {
    fmt::print("{}\n", lists.dump(1));
    return 0;
  }
  for (const auto& [title, list] : lists.items()) {
    fmt::print("{}\n", title);
    std::vector<std::vector<std::string>> rows;
    for (const auto& item : list) rows.push_back({item["name"], item["title"]});
    print_table(rows);
  }
  return 0;
}

int describe_command(const std::string& name) {
  std::vector<std::string> known;
  const auto scene_names = scene::library_scenes();
  const auto study_list = study_names(scene::data_home());
  bool found = false;
  for (const scene::Method* method : scene::MethodRegistry::instance().all()) {
    known.push_back(method->info().name);
    if (method->info().name != name) continue;
    describe_method(method->info());
    found = true;
  }
  if (has(scene_names, name) || (name.ends_with(".toml") && std::filesystem::exists(name))) {
    describe_scene(name);
    found = true;
  }
  if (has(study_list, name)) {
    describe_study(name);
    found = true;
  }
  for (const probes::Probe* probe : probes::ProbeRegistry::instance().all()) {
    known.push_back(probe->info().name);
    if (probe->info().name != name) continue;
    describe_probe(probe->info());
    found = true;
  }
  if (found) return 0;
  known.insert(known.end(), scene_names.begin(), scene_names.end());
  known.insert(known.end(), study_list.begin(), study_list.end());
  throw InputError({"command line"}, "NAME", scene::in_quotes(name),
                   scene::allowed_words(name, known));
}

}  // namespace concord::studies
