#include "studies/driver/plan.hpp"

#include "scene/method.hpp"
#include "scene/reader.hpp"
#include "studies/driver/cache.hpp"
#include "studies/driver/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

/// Overrides of the scene that make a run leave its last state as its only frame.
constexpr const char* last_frame_key = "output.frames";
constexpr const char* last_frame_value = "0";

scene::Problem problem_of(const Case& entry, bool last_frame_only) {
  std::vector<scene::Override> overrides(entry.scene_set.begin(), entry.scene_set.end());
  if (last_frame_only) overrides.emplace_back(last_frame_key, last_frame_value);
  return scene::read_problem(entry.scene, overrides);
}

/// Throws InputError at the case when its method or settings are wrong.
void check_method(const Case& entry) {
  const auto& method = scene::MethodRegistry::instance().find(entry.method);
  try {
    scene::Settings(entry.method, method.info().parameters, entry.set);
  } catch (const InputError& error) {
    throw InputError(entry.where, error.key(), error.found(), error.allowed());
  }
}

/// What the program is called with, but for the folder of the results.
std::vector<std::string> arguments_of(const Case& entry, const RunKey& run,
                                      bool last_frame_only) {
  std::vector<std::string> arguments{"run"};
  if (!entry.probe.empty()) arguments = {"probe", entry.probe};
  arguments.insert(arguments.end(), {entry.scene, "--method", entry.method, "--resolution",
                                     fmt::format("{}", run.resolution), "--perturb",
                                     fmt::format("{}", entry.perturb), "--seed",
                                     fmt::format("{}", run.seed), "--threads", "1"});
  if (!run.frames && entry.probe.empty()) arguments.emplace_back("--no-frames");
  if (entry.repeats > 0)
    arguments.insert(arguments.end(), {"--repeats", std::to_string(entry.repeats)});
  for (const auto& [key, value] : entry.scene_set)
    arguments.insert(arguments.end(), {"--set", key + "=" + value});
  if (last_frame_only)
    arguments.insert(arguments.end(),
                     {"--set", fmt::format("{}={}", last_frame_key, last_frame_value)});
  for (const auto& [key, value] : entry.set)
    arguments.insert(arguments.end(), {"--set", entry.method + "." + key + "=" + value});
  for (const auto& [key, value] : entry.options)
    arguments.insert(arguments.end(), {"--option", key + "=" + value});
  return arguments;
}

/// Adds one run of a case to the plan.
class Planner {
 public:
  Planner(const Study& study, const fs::path& out, std::size_t c)
      : m_study(study), m_entry(study.cases[c]), m_case(c), m_out(out),
        m_name(slug(m_entry.scene + "-" + m_entry.method + "-" + m_entry.variant + "-" +
                    m_entry.probe)),
        m_problem(problem_of(m_entry, false)), m_last_frame(problem_of(m_entry, true)) {}

  void add(double resolution, std::uint64_t seed, Plan& plan) const {
    const auto& at = m_entry.frames_at;
    const bool asked = (m_entry.frames && resolution == m_entry.resolutions.back()) ||
                       std::find(at.begin(), at.end(), resolution) != at.end();
    const bool frames = asked && seed == m_entry.seeds.front();
    const bool last_only = !frames && needs_last_frame(m_study, m_case, resolution, seed);
    const scene::Problem& problem = last_only ? m_last_frame : m_problem;
    const RunKey run{&m_entry, resolution, seed, frames || last_only, m_study.timing};
    Row row{m_case, resolution, seed, nlohmann::json::object(), "", {}, ""};
    row.run = fs::path("runs") / m_name / fmt::format("{:g}-{}", resolution, seed);
    Job job{plan.rows.size(),
            cache_key(problem, run),
            m_out / row.run,
            {},
            1,
            fmt::format("{}, {:g}", m_entry.title(), resolution)};
    job.arguments = arguments_of(m_entry, run, last_only);
    row.command = shell_line(job.arguments);
    job.arguments.insert(job.arguments.end(), {"--out", job.folder.string()});
    job.weight += std::pow(resolution, problem.dim() + (steps(problem) ? 1 : 0));
    job.weight *= 1 + m_entry.repeats;
    plan.rows.push_back(std::move(row));
    plan.jobs.push_back(std::move(job));
  }

 private:
  /// Whether the number of steps grows with the resolution.
  bool steps(const scene::Problem& problem) const {
    const auto solver = m_entry.set.find("solver");
    return !problem.is_static || (solver != m_entry.set.end() && solver->second == "explicit");
  }

  const Study& m_study;
  const Case& m_entry;
  std::size_t m_case;
  const fs::path& m_out;
  std::string m_name;
  scene::Problem m_problem, m_last_frame;
};

}  // namespace

std::string slug(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool keep = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_';
    if (keep)
      result += c;
    else if (!result.empty() && result.back() != '-')
      result += '-';
  }
  while (!result.empty() && result.back() == '-') result.pop_back();
  return result;
}

std::string shell_line(const std::vector<std::string>& arguments) {
  std::string line = "./concord";
  for (std::string argument : arguments) {
    const bool plain = argument.find_first_not_of("abcdefghijklmnopqrstuvwxyz"
                                                  "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                  "0123456789_-+=./:,") == std::string::npos;
    for (std::size_t at = 0; (at = argument.find('\'', at)) != std::string::npos; at += 4)
      argument.replace(at, 1, "'\\''");
    line += plain && !argument.empty() ? ' ' + argument : " '" + argument + '\'';
  }
  return line;
}

Plan make_plan(const Study& study, const fs::path& out) {
  Plan plan;
  for (std::size_t c = 0; c < study.cases.size(); ++c) {
    check_method(study.cases[c]);
    const Planner planner(study, out, c);
    for (const double resolution : study.cases[c].resolutions)
      for (const std::uint64_t seed : study.cases[c].seeds) planner.add(resolution, seed, plan);
  }
  return plan;
}

}  // namespace concord::studies
