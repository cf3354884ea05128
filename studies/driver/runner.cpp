#include "studies/driver/runner.hpp"

#include "scene/interrupt.hpp"
#include "scene/method.hpp"
#include "scene/reader.hpp"
#include "studies/driver/child.hpp"
#include "studies/driver/compare.hpp"
#include "studies/driver/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

constexpr double patience_s = 20;  ///< for a child to reach the end of its step after Ctrl-C

constexpr int cannot_start = 127;  ///< exit code where exec or the loader failed

struct Job {
  std::size_t row = 0;  ///< index into the rows
  std::string key;
  fs::path folder;
  std::vector<std::string> arguments;
  double weight = 1;  ///< guess of the cost, for the time left
  std::string what;
};

std::string read_text(const fs::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

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

std::vector<std::string> arguments_of(const Case& entry, const Job& job, const RunKey& run,
                                      bool last_frame_only) {
  std::vector<std::string> arguments{"run",          entry.scene,
                                     "--method",     entry.method,
                                     "--resolution", fmt::format("{}", run.resolution),
                                     "--perturb",    fmt::format("{}", entry.perturb),
                                     "--seed",       fmt::format("{}", run.seed),
                                     "--threads",    "1",
                                     "--out",        job.folder.string()};
  if (!run.frames) arguments.emplace_back("--no-frames");
  for (const auto& [key, value] : entry.scene_set)
    arguments.insert(arguments.end(), {"--set", key + "=" + value});
  if (last_frame_only)
    arguments.insert(arguments.end(),
                     {"--set", fmt::format("{}={}", last_frame_key, last_frame_value)});
  for (const auto& [key, value] : entry.set)
    arguments.insert(arguments.end(), {"--set", entry.method + "." + key + "=" + value});
  return arguments;
}

struct Plan {
  std::vector<Row> rows;
  std::vector<Job> jobs;
};

/// Adds one run of a case to the plan.
class Planner {
 public:
  Planner(const Study& study, const fs::path& out, std::size_t c)
      : m_study(study), m_entry(study.cases[c]), m_case(c), m_out(out),
        m_name(slug(m_entry.scene + "-" + m_entry.method + "-" + m_entry.variant)),
        m_problem(problem_of(m_entry, false)), m_last_frame(problem_of(m_entry, true)) {}

  void add(double resolution, std::uint64_t seed, Plan& plan) const {
    const bool frames = m_entry.frames && resolution == m_entry.resolutions.back() &&
                        seed == m_entry.seeds.front();
    const bool last_only = !frames && needs_last_frame(m_study, m_case, resolution, seed);
    const scene::Problem& problem = last_only ? m_last_frame : m_problem;
    const RunKey run{&m_entry, resolution, seed, frames || last_only, m_study.timing};
    Row row{m_case, resolution, seed, nlohmann::json::object(), "", {}};
    row.run = fs::path("runs") / m_name / fmt::format("{:g}-{}", resolution, seed);
    Job job{plan.rows.size(),
            cache_key(problem, run),
            m_out / row.run,
            {},
            1,
            fmt::format("{}, {:g}", m_entry.title(), resolution)};
    job.arguments = arguments_of(m_entry, job, run, last_only);
    job.weight += std::pow(resolution, problem.dim() + (steps(problem) ? 1 : 0));
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

Plan make_plan(const Study& study, const RunnerOptions& options) {
  Plan plan;
  for (std::size_t c = 0; c < study.cases.size(); ++c) {
    check_method(study.cases[c]);
    const Planner planner(study, options.out, c);
    for (const double resolution : study.cases[c].resolutions)
      for (const std::uint64_t seed : study.cases[c].seeds) planner.add(resolution, seed, plan);
  }
  return plan;
}

/// Reads what a finished run left; `how` says how it ended when it was computed now, `message`
/// what it said.
void read_row(Row& row, const fs::path& folder, const ChildExit& how,
              const std::string& message) {
  if (how.signal != 0) {
    row.error = fmt::format("ended by signal {}", how.signal);
    return;
  }
  if (how.code != 0 && how.code != 3) {
    row.error = fmt::format("ended with exit code {}: {}", how.code, message);
    return;
  }
  try {
    row.summary = nlohmann::json::parse(read_text(folder / "summary.json"));
    row.error = row.summary.value("error", "");
  } catch (const nlohmann::json::exception&) {
    row.error = "no readable summary.json: " + message;
  }
}

/// Children at work, a slot each.
class Crew {
 public:
  Crew(const Study& study, Plan& plan, const Cache& cache, RunnerResult& result)
      : m_study(study), m_plan(plan), m_cache(cache), m_result(result),
        m_done(plan.rows.size()) {}

  void work(std::vector<Job> queue, std::size_t slots) {
    // The longest first: the slots then end at about the same time.
    std::stable_sort(queue.begin(), queue.end(),
                     [](const Job& a, const Job& b) { return a.weight > b.weight; });
    double total = 0, done = 0;
    for (const Job& job : queue) total += job.weight;
    Progress progress(m_study.name);
    std::size_t next = 0, finished = 0;
    while (finished < queue.size()) {
      while (m_running.size() < slots && next < queue.size()) start(queue[next++]);
      if (scene::interrupted()) return stop();
      progress.update(done / total, fmt::format("{}/{} {}", finished, queue.size(),
                                                m_running.front().job.what));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      for (std::size_t i = 0; i < m_running.size();) {
        const auto how = poll_child(m_running[i].pid);
        if (!how) {
          ++i;
          continue;
        }
        const Job job = std::move(m_running[i].job);
        m_running.erase(m_running.begin() + static_cast<long>(i));
        finish(job, *how);
        done += job.weight;
        ++finished;
      }
    }
  }

  void mark_done(std::size_t row) { m_done[row] = true; }
  const std::vector<bool>& done() const { return m_done; }

 private:
  struct Running {
    pid_t pid = 0;
    Job job;
  };

  void start(const Job& job) {
    fs::remove_all(job.folder);
    fs::create_directories(job.folder);
    const fs::path output = job.folder.string() + ".out", errors = job.folder.string() + ".err";
    m_running.push_back({start_child(job.arguments, output, errors), job});
  }

  void finish(const Job& job, const ChildExit& how) {
    const std::string message = read_text(job.folder.string() + ".err");
    fs::remove(job.folder.string() + ".out");
    fs::remove(job.folder.string() + ".err");
    Row& row = m_plan.rows[job.row];
    if (how.code == 2) {
      stop();
      throw InputError(m_study.cases[row.case_index].where, "case", job.what, message);
    }
    if (how.code == cannot_start) {  // no result of any method
      stop();
      throw std::runtime_error(job.what + " could not start: " + message);
    }
    if (scene::interrupted()) return;  // stopped before its end
    read_row(row, job.folder, how, message);
    m_done[job.row] = true;
    ++m_result.computed;
    const bool ended = how.signal == 0 && (how.code == 0 || how.code == 3);
    if (ended && build_unchanged(m_study.cases[row.case_index].method))
      m_cache.store(job.key, job.folder);
  }

  void stop() {
    std::vector<pid_t> children;
    for (const Running& running : m_running) children.push_back(running.pid);
    stop_children(children, patience_s);
    for (const Running& running : m_running) {
      fs::remove(running.job.folder.string() + ".out");
      fs::remove(running.job.folder.string() + ".err");
    }
    m_running.clear();
    m_result.interrupted = scene::interrupted();
  }

  const Study& m_study;
  Plan& m_plan;
  const Cache& m_cache;
  RunnerResult& m_result;
  std::vector<bool> m_done;
  std::vector<Running> m_running;
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

RunnerResult run_cases(const Study& study, const RunnerOptions& options) {
  fs::create_directories(options.out);
  fs::remove_all(options.out / "runs");
  Plan plan = make_plan(study, options);
  const Cache cache(cache_folder());
  RunnerResult result;
  Crew crew(study, plan, cache, result);
  std::vector<Job> missing;
  for (const Job& job : plan.jobs) {
    if (!cache.fetch(job.key, job.folder)) {
      missing.push_back(job);
      continue;
    }
    read_row(plan.rows[job.row], job.folder, {}, "");
    crew.mark_done(job.row);
    ++result.reused;
  }
  if (!missing.empty())
    crew.work(std::move(missing), study.timing ? 1 : static_cast<std::size_t>(options.slots));
  for (std::size_t i = 0; i < plan.rows.size(); ++i)
    if (crew.done()[i]) result.rows.push_back(std::move(plan.rows[i]));
  return result;
}

}  // namespace concord::studies
