// The program as a user meets it: exit codes, messages, files, cache and Ctrl-C.

#include "program.hpp"

#include <chrono>
#include <csignal>
#include <thread>

namespace fs = std::filesystem;
using concord::test::Ended;
using concord::test::Program;
using concord::test::read;
using nlohmann::json;

namespace {

const std::string head = "title = \"t\"\nquestion = \"q\"\nsource = \"s\"\n";
const std::string cube = head + "[[case]]\nscene = \"swinging_cube\"\nmethod = \"delaunay\"\n";

std::string claim(const std::string& bound) {
  return "[[claim]]\nid = \"c\"\nstatement = \"s\"\nsource = \"s\"\nkind = \"value\"\n"
         "quantity = \"errors.displacement_l2\"\n" +
         bound + "\n";
}

}  // namespace

TEST_F(Program, RunWritesTheContractsSummary) {
  const Ended ended =
      run("run swinging_cube --method delaunay --resolution 4 --perturb 0.25 --seed 7 --out r");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const json s = summary("r");
  for (const char* key : {"scene",       "method",
                          "dim",         "resolution",
                          "h",           "unknowns",
                          "particles",   "seed",
                          "steps",       "dt",
                          "t_end",       "setup_s",
                          "wall_s",      "ns_per_particle_step",
                          "peak_rss_mb", "threads",
                          "errors",      "invariants",
                          "quantities",  "machine",
                          "build"})
    EXPECT_TRUE(s.contains(key)) << key;
  EXPECT_EQ(s["particles"], 125);
  EXPECT_EQ(s["seed"], 7);
  EXPECT_DOUBLE_EQ(s["h"].get<double>(), 0.25);
  EXPECT_TRUE(s["errors"].contains("displacement_l2"));
  EXPECT_TRUE(s["errors"].contains("displacement_l2_common"));
  EXPECT_TRUE(fs::exists(m_work / "r" / "history.csv"));
  EXPECT_TRUE(fs::exists(m_work / "r" / "fields.hdf.series"));
  EXPECT_TRUE(ended.err.empty()) << "quiet when not on a terminal: " << ended.err;
}

TEST_F(Program, SettingsReachMethodAndScene) {
  const Ended ended =
      run("run swinging_cube --method delaunay --resolution 2 --no-frames --out r "
          "--set delaunay.xi_n=0 --set delaunay.xi_t=0 --set 'parameters.U=1 mm'");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(summary("r").dump().find("xi_n=0"), std::string::npos);
  EXPECT_FALSE(fs::exists(m_work / "r" / "fields.hdf.series"));
}

TEST_F(Program, BadInputIsExitTwoWithOneMessage) {
  const std::string base = "run swinging_cube --method delaunay --out r ";
  expect_bad_input(base + "--resolution 0", "--resolution");
  expect_bad_input(base + "--resolution -3", "--resolution");
  expect_bad_input(base + "--resolution four", "--resolution");
  expect_bad_input(base + "--perturb 0.5", "--perturb");
  expect_bad_input(base + "--perturb -0.1", "--perturb");
  expect_bad_input(base + "--threads 0", "--threads");
  expect_bad_input(base + "--set xi", "--set");
  expect_bad_input(base + "--set delaunay.xi=1", "xi");
  expect_bad_input(base + "--set delaunay.xi_n=much", "xi_n");
  expect_bad_input(base + "--set tlsph.psi=1", "tlsph");
  expect_bad_input(base + "--set material.yungs_modulus=1", "yungs_modulus");
  expect_bad_input("run swinging_cube --method delauney", "delauney");
  expect_bad_input("run swinging_cub --method delaunay", "swinging_cub");
  expect_bad_input("run swinging_cube", "--method");
  expect_bad_input("describe nothing_of_the_kind", "nothing_of_the_kind");
  expect_bad_input("study nothing_of_the_kind", "nothing_of_the_kind");
  expect_bad_input("list colours", "colours");
  expect_bad_input("walk", "walk");
}

TEST_F(Program, ANumericalFailureIsExitThreeWithASummary) {
  // About twice the stable step: it blows up after a few steps.
  const Ended ended = run("run swinging_cube --method delaunay --resolution 4 --out r "
                          "--set delaunay.dt=0.003 --set 'end_time=1 s'");
  EXPECT_EQ(ended.code, 3) << ended.err;
  EXPECT_NE(ended.err.find("step"), std::string::npos) << ended.err;
  EXPECT_TRUE(summary("r").contains("error"));
  EXPECT_TRUE(fs::exists(m_work / "r" / "history.csv"));
}

TEST_F(Program, ListsAsJson) {
  const json lists = json::parse(run("list --json").out);
  for (const char* list : {"scenes", "methods", "studies"})
    EXPECT_FALSE(lists[list].empty()) << list;
  std::string methods;
  for (const auto& method : lists["methods"])
    methods += method["name"].get<std::string>() + " ";
  EXPECT_NE(methods.find("delaunay"), std::string::npos);
  EXPECT_FALSE(json::parse(run("list methods --json").out).contains("scenes"));
}

TEST_F(Program, DescribesEverythingItLists) {
  const json lists = json::parse(run("list --json").out);
  for (const auto& [kind, list] : lists.items())
    for (const auto& item : list) {
      const Ended ended = run("describe " + item["name"].get<std::string>());
      EXPECT_EQ(ended.code, 0) << ended.err;
      EXPECT_GT(ended.out.size(), 100u);
    }
  EXPECT_NE(run("describe delaunay").out.find("xi_n"), std::string::npos);
}

TEST_F(Program, AStudyIsJudgedAndCached) {
  const std::string environment =
      home_with_study(cube + "resolutions = [2, 3]\n" + claim("max = 1"));
  const Ended first = run("study s --out o", environment);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("2 runs computed, 0 from the cache"), std::string::npos)
      << first.out;
  const json study = json::parse(read(m_work / "o" / "study.json"));
  EXPECT_EQ(study["verdict"], "pass");
  EXPECT_EQ(study["rows"].size(), 2u);
  EXPECT_TRUE(fs::exists(m_work / "o" / "tables" / "runs.csv"));
  EXPECT_TRUE(
      fs::exists(m_work / "o" / study["rows"][0]["run"].get<std::string>() / "history.csv"));
  const Ended second = run("study s --out o", environment);
  EXPECT_NE(second.out.find("0 runs computed, 2 from the cache"), std::string::npos)
      << second.out;
  EXPECT_EQ(json::parse(read(m_work / "o" / "study.json")), study)
      << "the same, wall times included";

  home_with_study(cube + "resolutions = [2, 3]\n" + claim("max = 1e-9"));
  const Ended failed = run("study s --out o", environment);
  EXPECT_EQ(failed.code, 1);
  EXPECT_NE(failed.out.find("0 runs computed"), std::string::npos)
      << "a claim's bound is no run's";
}

TEST_F(Program, ARunThatFailsIsARow) {
  const std::string environment = home_with_study(
      cube +
      "variant = \"wild\"\nresolutions = [4]\nscene_set = { \"parameters.U\" = \"400 mm\", "
      "end_time = \"1 s\" }\n" +
      "[[case]]\nscene = \"swinging_cube\"\nmethod = \"delaunay\"\nresolutions = [2]\n" +
      claim("max = 1"));
  EXPECT_EQ(run("study s --out o", environment).code, 1);
  const json study = json::parse(read(m_work / "o" / "study.json"));
  ASSERT_EQ(study["rows"].size(), 2u);
  EXPECT_FALSE(study["rows"][0]["error"].get<std::string>().empty());
  EXPECT_FALSE(study["rows"][1].contains("error"));
  EXPECT_EQ(study["claims"][0]["verdict"], "fail");
  EXPECT_TRUE(study["claims"][0]["measured"].is_null());
}

TEST_F(Program, AStudysMistakesAreBadInput) {
  const auto code = [this](const std::string& text) {
    const Ended ended = run("study s --out o", home_with_study(text));
    EXPECT_NE(ended.err.find("study.toml:"), std::string::npos) << ended.err;
    return ended.code;
  };
  EXPECT_EQ(code(cube + "resolutions = [2]\nset = { xi = 1 }\n" + claim("max = 1")), 2);
  EXPECT_EQ(code(cube + "resolutions = [2]\ncolour = 1\n" + claim("max = 1")), 2);
  EXPECT_EQ(code(cube + "resolutions = [2\n"), 2);
}

TEST_F(Program, CtrlCLeavesReadableResults) {
  const pid_t child = start("run swinging_cube --method delaunay --resolution 12 --out r "
                            "--set 'end_time=1000 s' --set 'output.frames=0'");
  const fs::path history = m_work / "r" / "history.csv";
  for (int i = 0; i < 600 && !fs::exists(history); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(child, SIGINT);
  const Ended ended = finish(child);
  EXPECT_EQ(ended.code, 130) << ended.err;
  EXPECT_TRUE(summary("r").contains("error"));
  EXPECT_TRUE(fs::exists(history));
}

TEST_F(Program, CtrlCInAStudyStopsItsRunsAndKeepsTheFinished) {
  const std::string environment = home_with_study(
      cube + "variant = \"long\"\nresolutions = [12]\nscene_set = { end_time = \"1000 s\" }\n" +
      "[[case]]\nscene = \"swinging_cube\"\nmethod = \"delaunay\"\nresolutions = [2]\n" +
      claim("max = 1"));
  const pid_t child = start("study s --out o --threads 2", environment);
  const auto stored = [&] {  // the short run
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(m_work / "cache", none)) {
      if (fs::exists(entry.path() / "entry.json")) return true;
    }
    return false;
  };
  for (int i = 0; i < 600 && !stored(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  kill(child, SIGINT);
  const Ended ended = finish(child);
  EXPECT_EQ(ended.code, 130) << ended.err;
  const json study = json::parse(read(m_work / "o" / "study.json"));
  EXPECT_EQ(study["verdict"], "fail");
  EXPECT_TRUE(study["interrupted"].get<bool>());
  EXPECT_EQ(study["rows"].size(), 1u);
}

TEST_F(Program, RepeatedRunsAreTimedByTheirMedian) {
  const Ended ended = run("run swinging_cube --method delaunay --resolution 4 --repeats 3 "
                          "--no-frames --out r");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const json s = summary("r");
  EXPECT_EQ(s["repeats"], 3);
  for (const std::string name : {"setup_s", "wall_s"}) {
    const json& quartiles = s[name + "_quartiles"];
    EXPECT_LE(quartiles.at(0), s[name]) << name;
    EXPECT_LE(s[name], quartiles.at(1)) << name;
    EXPECT_GT(quartiles.at(0).get<double>(), 0) << name;
  }
  EXPECT_TRUE(s["errors"].contains("displacement_l2")) << "of the run with output";
  EXPECT_TRUE(fs::exists(m_work / "r" / "history.csv"));
  expect_bad_input("run swinging_cube --method delaunay --repeats -1", "--repeats");
}

TEST_F(Program, AProbeIsACaseLikeARun) {
  const std::string environment = home_with_study(
      head +
      "[[case]]\nscene = \"spinning_block\"\nmethod = \"delaunay\"\nresolutions = [2]\n" +
      "probe = \"spectrum\"\noptions = { reference = 0, low = 5 }\n" +
      "[[claim]]\nid = \"c\"\nstatement = \"s\"\nsource = \"s\"\nkind = \"value\"\n" +
      "quantity = \"quantities.zero_modes\"\nmin = 6\nmax = 6\n" +
      "[[heatmap]]\ncolumns = [{ label = \"D\", method = \"delaunay\" }]\n" +
      "rows = [{ label = \"z\", probe = \"spectrum\", quantity = \"quantities.zero_modes\", " +
      "good = 6, bad = 7 }]\n");
  const Ended first = run("study s --out o", environment);
  ASSERT_EQ(first.code, 0) << first.out << first.err;
  EXPECT_NE(first.out.find("1 runs computed"), std::string::npos) << first.out;
  const json study = json::parse(read(m_work / "o" / "study.json"));
  const json& row = study["rows"].at(0);
  EXPECT_EQ(row["probe"], "spectrum");
  EXPECT_EQ(row["options"]["low"], "5");
  const json& cell = study["heatmap"].at(0)["rows"].at(0)["cells"].at(0);
  EXPECT_EQ(cell["score"], 1);
  EXPECT_TRUE(fs::exists(m_work / "o" / cell["run"].get<std::string>() / "summary.json"));
  // The command of the cell gives the number again.
  const std::string command = cell["command"].get<std::string>();
  ASSERT_TRUE(command.starts_with("./concord probe spectrum spinning_block")) << command;
  ASSERT_EQ(run(command.substr(std::string("./concord ").size()) + " --out p").code, 0);
  EXPECT_EQ(summary("p")["quantities"]["zero_modes"], 6);
  const Ended second = run("study s --out o", environment);
  EXPECT_NE(second.out.find("0 runs computed, 1 from the cache"), std::string::npos);
}
