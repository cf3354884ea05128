#include "studies/driver/command_line.hpp"

#include "scene/errors.hpp"
#include "scene/interrupt.hpp"
#include "scene/suggest.hpp"
#include "studies/driver/commands.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <functional>

namespace concord::studies {
namespace {

/// Options of all subcommands, and the job that the chosen one sets.
struct Commands {
  RunOptions run;
  ProbeOptions probe;
  StudyOptions study, report;
  std::string filter, list_what, name, study_name;
  bool as_json = false;
  std::function<int()> job;
};

/// What a run and a probe are asked for alike; a run to be resumed needs no more than its
/// folder.
void add_problem(CLI::App* command, RunOptions& options, const char* out, bool needed) {
  command
      ->add_option("SCENE", options.scene,
                   "a scene of the library, or the path of a scene file")
      ->required(needed);
  command->add_option("--method", options.method, "see: concord list methods")
      ->required(needed);
  command
      ->add_option("--resolution", options.resolution,
                   "N: mean spacing h = L/N with the scene's reference length L")
      ->capture_default_str();
  command
      ->add_option("--perturb", options.perturb,
                   "random displacement of particles, fraction of h")
      ->capture_default_str();
  command
      ->add_option("--seed", options.seed,
                   "of the perturbation, or of what else the scene arranges by it")
      ->capture_default_str();
  command->add_option("--threads", options.threads)->capture_default_str();
  command->add_option("--set", options.set, "key=value of the scene, or METHOD.key=value")
      ->take_all();
  command->add_option("--out", options.out, out);
}

void add_run(CLI::App& app, Commands& commands) {
  CLI::App* run = app.add_subcommand("run", "run one method on one scene");
  add_problem(run, commands.run, "default build/runs/SCENE-METHOD", false);
  run->add_flag("--frames,!--no-frames", commands.run.frames, "write field frames (default)");
  run->add_option("--repeats", commands.run.repeats,
                  "time N more runs, warm and without output: medians and quartiles");
  run->add_option("--checkpoint", commands.run.checkpoint,
                  "seconds of wall time between two checkpoints of an explicit run (0: one at "
                  "every row of the history); one more when it is stopped")
      ->capture_default_str();
  run->add_option("--resume", commands.run.resume,
                  "DIR: go on with the run there that was stopped, to the same bits; takes its "
                  "scene, method and settings from its checkpoint");
  run->callback([run, &commands] {
    for (const CLI::Option* option : run->get_options())
      if (option->count() > 0) commands.run.given.push_back(option->get_name());
    commands.job = [&commands] { return run_command(commands.run); };
  });
}

void add_probe(CLI::App& app, Commands& commands) {
  CLI::App* probe = app.add_subcommand("probe", "a test of one method on one scene");
  probe->add_option("TEST", commands.probe.test, "see: concord list probes")->required();
  add_problem(probe, commands.probe, "default build/probes/TEST-SCENE-METHOD", true);
  probe
      ->add_option("--option", commands.probe.option,
                   "key=value of the test; see: concord describe TEST")
      ->take_all();
  probe->callback(
      [&commands] { commands.job = [&commands] { return probe_command(commands.probe); }; });
}

void add_studies(CLI::App& app, Commands& commands) {
  CLI::App* study = app.add_subcommand("study", "run a study and judge its claims");
  study->add_option("STUDY", commands.study_name, "see: concord list studies")->required();
  CLI::App* report =
      app.add_subcommand("report", "run studies and write the report (all studies by default)");
  report->add_option("STUDY", commands.report.studies);
  for (auto [sub, options, out] :
       {std::tuple{study, &commands.study, "default build/studies/STUDY"},
        std::tuple{report, &commands.report, "default build/report"}}) {
    sub->add_flag("--full", options->full, "the full ladders of resolutions and seeds");
    sub->add_option("--out", options->out, out);
    sub->add_option("--threads", options->slots,
                    "runs at once, one thread each (default: one a core)")
        ->check(CLI::PositiveNumber);
  }
  study->callback([&commands] {
    commands.study.studies = {commands.study_name};
    commands.job = [&commands] { return study_command(commands.study); };
  });
  report->callback(
      [&commands] { commands.job = [&commands] { return report_command(commands.report); }; });
}

void add_information(CLI::App& app, Commands& commands) {
  CLI::App* bench = app.add_subcommand("bench", "kernel benchmarks");
  bench->add_option("FILTER", commands.filter, "regular expression");
  bench->callback(
      [&commands] { commands.job = [&commands] { return bench_command(commands.filter); }; });
  CLI::App* list = app.add_subcommand("list", "scenes, methods, studies and probes");
  list->add_option("WHAT", commands.list_what, "scenes | methods | studies | probes")
      ->check(CLI::IsMember({"scenes", "methods", "studies", "probes"}));
  list->add_flag("--json", commands.as_json);
  list->callback([&commands] {
    commands.job = [&commands] { return list_command(commands.list_what, commands.as_json); };
  });
  CLI::App* describe =
      app.add_subcommand("describe", "parameters of a scene, method, study or probe");
  describe->add_option("NAME", commands.name)->required();
  describe->callback(
      [&commands] { commands.job = [&commands] { return describe_command(commands.name); }; });
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

int run_job(int argc, char** argv) {
  CLI::App app("Verification and comparison of particle methods in solid mechanics", "concord");
  app.require_subcommand(1);
  Commands commands;
  add_run(app, commands);
  add_probe(app, commands);
  add_studies(app, commands);
  add_information(app, commands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    const auto chosen = app.get_subcommands();
    if (chosen.empty() && argc > 1)
      throw InputError({"command line"}, "command", scene::in_quotes(argv[1]),
                       scene::allowed_words(argv[1], command_names(app)));
    const std::string name = chosen.empty() ? "" : " " + chosen.front()->get_name();
    throw InputError({"command line"}, "concord" + name, error.what(),
                     "what `concord" + name + " --help` lists");
  }
  return commands.job();
}

}  // namespace

int main_program(int argc, char** argv) {
  scene::install_interrupt_handlers();
  const auto fail = [](int code, const std::exception& error) {
    fmt::print(stderr, "concord: {}\n", error.what());
    return code;
  };
  try {
    return run_job(argc, argv);
  } catch (const InputError& error) {
    return fail(2, error);
  } catch (const SolveError& error) {
    return fail(3, error);
  } catch (const Interrupted& error) {
    return fail(130, error);
  } catch (const std::exception& error) {
    return fail(4, error);
  }
}

}  // namespace concord::studies
