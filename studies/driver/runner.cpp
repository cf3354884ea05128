#include "studies/driver/runner.hpp"

#include "scene/interrupt.hpp"
#include "studies/driver/cache.hpp"
#include "studies/driver/child.hpp"
#include "studies/driver/plan.hpp"
#include "studies/driver/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

constexpr double patience_s = 20;  ///< for a child to reach the end of its step after Ctrl-C

constexpr int cannot_start = 127;  ///< exit code where exec or the loader failed

std::string read_text(const fs::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
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
    const Case& entry = m_study.cases[row.case_index];
    if (ended && build_unchanged(entry.method, !entry.probe.empty()))
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

RunnerResult run_cases(const Study& study, const RunnerOptions& options) {
  fs::create_directories(options.out);
  fs::remove_all(options.out / "runs");
  Plan plan = make_plan(study, options.out);
  const Cache cache(cache_folder());
  ::setenv("CONCORD_CACHE", fs::absolute(cache_folder()).c_str(), 1);  // runs keep bodies there
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
