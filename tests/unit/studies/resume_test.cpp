// `concord run --resume`: runs stopped by a signal, by force, by a full disk; what is refused.

#include "resumed_program.hpp"

namespace fs = std::filesystem;

namespace concord::test {

TEST_F(ResumedProgram, AfterASignalItEndsWithTheSameNumbers) {
  ASSERT_EQ(run(m_run + "--out whole").code, 0);
  for (const int signal : {SIGTERM, SIGINT}) {
    const Ended ended = stopped(m_run, "parts", signal);
    ASSERT_EQ(ended.code, 130) << ended.err;
    EXPECT_TRUE(mentions(ended.err, "interrupted: everything computed so far is on disk"));
    EXPECT_TRUE(mentions(ended.err, "run --resume parts")) << ended.err;
    EXPECT_TRUE(summary("parts").contains("error"));
    ASSERT_LT(rows("parts"), 1500) << "it was not stopped in the middle";
    const Ended resumed = run("run --resume parts --threads 2");
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_TRUE(mentions(resumed.out, "resumed after step")) << resumed.out;
    EXPECT_EQ(summary("parts")["threads"], 2);
    expect_same("whole", "parts");
  }
  expect_bad_input("run --resume parts", "a run that is complete");
}

TEST_F(ResumedProgram, KilledItGoesOnFromItsLastCheckpoint) {
  ASSERT_EQ(run(m_run + "--out whole").code, 0);
  ASSERT_EQ(stopped(m_run + "--checkpoint 0.05", "parts", SIGKILL, 150).code, -SIGKILL);
  EXPECT_FALSE(fs::exists(m_work / "parts" / "summary.json"));
  ASSERT_TRUE(fs::exists(m_work / "parts" / "checkpoint.hdf"));
  const Ended resumed = run("run --resume parts");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  expect_same("whole", "parts");
}

TEST_F(ResumedProgram, AFullDiskIsToldAndGoneOnWith) {
  ASSERT_EQ(run(m_run + "--out whole").code, 0);
  const auto size = fs::file_size(m_work / "whole" / "history.csv");
  const std::string limited = "bash -c 'ulimit -f " + std::to_string(3 * size / 4096) +
                              R"(; exec "$0" "$@"')";  // three quarters, in blocks of 1024
  const Ended ended = run(m_run + "--out parts", limited);
  ASSERT_EQ(ended.code, 4) << ended.err;
  EXPECT_TRUE(mentions(ended.err, "cannot write parts/history.csv: File too large"));
  EXPECT_TRUE(mentions(ended.err, "run --resume parts")) << ended.err;
  const std::string history = read(m_work / "parts" / "history.csv");
  EXPECT_EQ(history, read(m_work / "whole" / "history.csv").substr(0, history.size()));
  EXPECT_EQ(history.back(), '\n') << "no half row";
  const Ended resumed = run("run --resume parts");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  expect_same("whole", "parts");
}

TEST_F(ResumedProgram, FoldersWithoutAStoppedRunAreBadInput) {
  expect_bad_input("run --resume nowhere", "no folder");
  fs::create_directories(m_work / "empty");
  expect_bad_input("run --resume empty", "a folder without a checkpoint");
  std::ofstream(m_work / "empty" / "summary.json")
      << R"({"scene": "cantilever", "method": "fem", "error": "interrupted"})";
  expect_bad_input("run --resume empty", "a run of fem on cantilever that left no checkpoint");
  expect_bad_input("run --resume empty", "explicit runs of particle methods");
  std::ofstream(m_work / "empty" / "checkpoint.hdf") << "no checkpoint";
  expect_bad_input("run --resume empty", "checkpoint.hdf");
}

TEST_F(ResumedProgram, WhatBelongsToTheStoppedRunIsBadInput) {
  ASSERT_EQ(stopped(m_run, "parts", SIGTERM).code, 130);
  const std::string resume = "run --resume parts ";
  expect_bad_input(resume + "swinging_cube", "SCENE");
  expect_bad_input(resume + "--method tlsph", "--method");
  expect_bad_input(resume + "--resolution 7", "--resolution");
  expect_bad_input(resume + "--seed 3", "--seed");
  expect_bad_input(resume + "--set delaunay.xi_n=0", "--set");
  expect_bad_input(resume + "--out elsewhere", "--out");
  expect_bad_input(resume + "--repeats 3", "--repeats");
  expect_bad_input(resume + "--no-frames", "--frames");
  expect_bad_input(resume + "--checkpoint -1", "--checkpoint");
  expect_bad_input("run --method delaunay", "SCENE");
  expect_bad_input("run swinging_cube", "--method");
  EXPECT_EQ(run(resume).code, 0) << "none of that has harmed it";
}

TEST_F(ResumedProgram, AChangedSceneIsToldByItsLine) {
  const fs::path home = std::getenv("CONCORD_HOME"), library = home / "scene" / "library";
  fs::copy(library / "swinging_cube", m_work / "mine");
  std::string arguments = m_run;
  arguments.replace(arguments.find("swinging_cube"), 13, "mine/scene.toml");
  ASSERT_EQ(stopped(arguments, "parts", SIGTERM).code, 130);
  const fs::path scene = m_work / "mine" / "scene.toml";
  std::string text = read(scene);
  text.replace(text.find("17 MPa"), 6, "18 MPa");
  std::ofstream(scene) << text;
  expect_bad_input("run --resume parts", "text of the scene");
  expect_bad_input("run --resume parts", "18");
  text.replace(text.find("18 MPa"), 6, "17 MPa");
  std::ofstream(scene) << text;
  EXPECT_EQ(run("run --resume parts").code, 0);
}

TEST_F(ResumedProgram, WithoutResumeAStoppedRunBeginsAnew) {
  ASSERT_EQ(stopped(m_run, "parts", SIGTERM).code, 130);
  const Ended anew = run(m_run + "--out parts");
  ASSERT_EQ(anew.code, 0) << anew.err;
  EXPECT_TRUE(mentions(anew.err, "begins anew")) << anew.err;
  EXPECT_FALSE(summary("parts")["notes"].contains("resumed"));
  EXPECT_FALSE(fs::exists(m_work / "parts" / "checkpoint.hdf"));
}

}  // namespace concord::test
