#include "studies/driver/commands.hpp"

#include "scene/reader.hpp"
#include "scene/suggest.hpp"
#include "studies/driver/cache.hpp"
#include "studies/driver/compare.hpp"
#include "studies/driver/derive.hpp"
#include "studies/driver/progress.hpp"
#include "studies/driver/runner.hpp"
#include "studies/driver/study_output.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>

namespace concord::studies {
namespace fs = std::filesystem;
namespace {

int slots_of(const StudyOptions& options) {
  return options.slots > 0
             ? options.slots
             : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void print_claims(const StudyResult& result) {
  for (const ClaimResult& claim : result.claims) {
    const std::string unit =
        claim.claim->unit == "1" || !claim.measured ? "" : " " + claim.claim->unit;
    const std::string value =
        claim.measured ? fmt::format("{:.4g}{}", *claim.measured, unit) : "-";
    fmt::print("  {:<4}  {:<32} {:>14}  {}{}\n",
               claim.verdict == Verdict::full_report_only ? "full" : to_text(claim.verdict),
               claim.claim->id, value, bound_text(*claim.claim),
               claim.verdict == Verdict::fail && !claim.reason.empty()
                   ? "  (" + claim.reason + ")"
                   : "");
  }
}

/// Runs and judges one study into `folder`; true when it passed. Throws Interrupted after
/// writing.
bool do_study(const std::string& name, const StudyOptions& options, const fs::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  const Study study = read_study(name, options.full, scene::data_home());
  RunnerResult run = run_cases(study, {fs::absolute(folder), slots_of(options)});
  StudyResult result;
  result.study = &study;
  result.interrupted = run.interrupted;
  result.rows = std::move(run.rows);
  add_signals(study, result.rows, fs::absolute(folder));
  compare_runs(study, result.rows, fs::absolute(folder));
  add_errors(study, result.rows, fs::absolute(folder));
  result.fits = fit_all(study, result.rows);
  result.references = references_of(study, result.rows);
  result.claims = judge(study, result.rows, result.fits, result.references);
  write_study(result, folder);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  fmt::print("{}: {} ({} runs computed, {} from the cache, {})\n", name,
             result.interrupted ? "interrupted" : (result.passed() ? "pass" : "FAIL"),
             run.computed, run.reused, duration_text(elapsed.count()));
  print_claims(result);
  std::fflush(stdout);
  if (result.interrupted) throw Interrupted();
  return result.passed();
}

/// Runs a program and waits for it; throws when it cannot run or fails.
void call(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (child < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(fmt::format("{} failed", fmt::join(arguments, " ")));
}

void draw_report(const fs::path& out) {
  const fs::path script = scene::data_home() / "reports" / "make_report.py";
  // Debian's own Python: another one may come first on PATH and lack the packages.
  call({"/usr/bin/python3", script.string(), "--studies", (out / "studies").string(), "--out",
        out.string()});
}

/// The studies asked for, or all; throws for a name that is none.
std::vector<std::string> chosen(const StudyOptions& options) {
  const auto all = study_names(scene::data_home());
  for (const std::string& name : options.studies)
    if (std::find(all.begin(), all.end(), name) == all.end())
      throw InputError({}, "study", scene::in_quotes(name), scene::allowed_words(name, all));
  return options.studies.empty() ? all : options.studies;
}

}  // namespace

int study_command(const StudyOptions& options) {
  const std::string name = chosen(options).front();
  const fs::path folder = options.out.empty() ? build_home() / "studies" / name : options.out;
  const bool passed = do_study(name, options, folder);
  fmt::print("{}\n", (folder / "study.json").string());
  return passed ? 0 : 1;
}

int report_command(const StudyOptions& options) {
  const auto names = chosen(options);
  const fs::path out =
      fs::absolute(options.out.empty() ? build_home() / "report" : options.out);
  for (const std::string& name : names) read_study(name, options.full, scene::data_home());
  fs::create_directories(out / "studies");
  for (const auto& old : fs::directory_iterator(out / "studies"))
    if (std::find(names.begin(), names.end(), old.path().filename()) == names.end())
      fs::remove_all(old.path());  // of an earlier report
  bool passed = true;
  try {
    for (const std::string& name : names)
      passed = do_study(name, options, out / "studies" / name) && passed;
  } catch (const Interrupted&) {
    draw_report(out);  // of what there is
    throw;
  }
  draw_report(out);
  fmt::print("{}\n", (out / "index.html").string());
  return passed ? 0 : 1;
}

}  // namespace concord::studies
