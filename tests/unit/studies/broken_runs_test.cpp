// `concord run --resume` after what may go wrong beside the program: each case ends with the
// same bits, or with a message that says what is wrong and takes nothing away.

#include "resumed_program.hpp"

#include <random>

namespace fs = std::filesystem;

namespace concord::test {
namespace {

class BrokenRuns : public ResumedProgram {
 protected:
  /// In memory, where there is such a folder: a checkpoint a row waits long for a disk.
  void SetUp() override {
    ResumedProgram::SetUp();
    if (::access("/dev/shm", W_OK | X_OK) != 0) return;
    fs::remove_all(m_work);
    m_work = fs::path("/dev/shm") / m_work.filename();
    fs::remove_all(m_work);
    fs::create_directories(m_work);
  }

  /// As someone would who knows no more than what is in the folder.
  pid_t start_or_resume(const std::string& run, const std::string& folder, int threads) {
    const std::string with = " --checkpoint 0 --threads " + std::to_string(threads);
    return fs::exists(m_work / folder / "checkpoint.hdf")
               ? start("run --resume " + folder + with)
               : start(run + "--out " + folder + with);
  }

  void write(const fs::path& file, const std::string& text) {
    std::ofstream(m_work / file, std::ios::binary) << text;
  }
};

}  // namespace

/// Moments from the set-up on, every second one after the first checkpoint, with a checkpoint
/// at every row, so that many fall into the writing of files; one and two threads by turns.
TEST_F(BrokenRuns, KilledAtRandomMomentsTheyEndWithTheSameNumbers) {
  std::string run_it = m_run;
  run_it.replace(run_it.find("history_rows=1500"), 17, "history_rows=25");
  ASSERT_EQ(run(run_it + "--out whole").code, 0);
  int killed = 0, resumed = 0;
  for (const unsigned seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    fs::remove_all(m_work / "parts");
    for (int k = 0; k < 7; ++k) {
      if (fs::exists(m_work / "parts" / "checkpoint.hdf")) ++resumed;
      const pid_t child = start_or_resume(run_it, "parts", 1 + k % 2);
      for (int i = 0;
           k % 2 == 1 && i < 3000 && !fs::exists(m_work / "parts" / "checkpoint.hdf"); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      std::this_thread::sleep_for(std::chrono::milliseconds(20 + random() % 180));
      kill(child, SIGKILL);
      const Ended ended = finish(child);
      if (ended.code == 0) break;
      ASSERT_EQ(ended.code, -SIGKILL) << ended.err;
      ++killed;
      if (!fs::exists(m_work / "parts" / "summary.json")) continue;
      for (const char* left : {"checkpoint.hdf", "run.lock"})
        fs::remove(m_work / "parts" / left);
      break;  // it was complete
    }
    if (!fs::exists(m_work / "parts" / "summary.json")) {
      const Ended ended = finish(start_or_resume(run_it, "parts", 1));
      ASSERT_EQ(ended.code, 0) << ended.err;
    }
    if (summary("parts")["notes"].contains("resumed")) expect_same("whole", "parts");
    EXPECT_EQ(read(m_work / "parts" / "history.csv"), read(m_work / "whole" / "history.csv"));
  }
  EXPECT_GE(killed, 3);
  EXPECT_GE(resumed, 1);
}

TEST_F(BrokenRuns, TwoInOneFolderAreRefused) {
  ASSERT_EQ(run(m_run + "--out whole").code, 0);
  ASSERT_EQ(stopped(m_run, "parts", SIGKILL, 150).code, -SIGKILL);
  EXPECT_TRUE(fs::exists(m_work / "parts" / "run.lock")) << "of a process that is dead";
  ASSERT_EQ(stopped(m_run, "parts", SIGTERM, 150).code, 130);
  EXPECT_FALSE(fs::exists(m_work / "parts" / "run.lock"));
  const pid_t first = start("run --resume parts");
  for (int i = 0; i < 1000 && read(m_work / "parts" / "run.lock").empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(first, SIGSTOP);
  const std::string process = "in use by process " + std::to_string(first) + " on ";
  expect_bad_input("run --resume parts", "parts, " + process);
  expect_bad_input(m_run + "--out parts", "parts, " + process);
  expect_bad_input("run --resume ./parts/", process);
  kill(first, SIGCONT);
  const Ended ended = finish(first);
  ASSERT_EQ(ended.code, 0) << ended.err;
  expect_same("whole", "parts");
}

TEST_F(BrokenRuns, OtherFilesThanThoseOfTheRunAreToldByName) {
  ASSERT_EQ(run(m_run + "--out whole").code, 0);
  ASSERT_EQ(stopped(m_run, "parts", SIGTERM, 400).code, 130);
  const fs::path history = "parts/history.csv", frame = "parts/fields_0001.hdf";
  const std::string rows_before = read(m_work / history), frame_before = read(m_work / frame);
  const auto refused = [&](const fs::path& file, const std::string& text,
                           const std::string& message) {
    const std::string before = read(m_work / file);
    write(file, text);
    expect_bad_input("run --resume parts", message);
    EXPECT_EQ(read(m_work / file), text) << "untouched";
    write(file, before);
  };
  refused(history, rows_before.substr(0, rows_before.size() / 2), "history.csv");
  refused(history, "", "history.csv");
  std::string changed = rows_before;
  changed[changed.find('\n') + 1] = '1';
  refused(history, changed, "other rows");
  refused(frame, frame_before.substr(0, frame_before.size() / 2), "fields_0001.hdf");
  fs::remove(m_work / frame);
  expect_bad_input("run --resume parts", "fields_0001.hdf");
  EXPECT_EQ(read(m_work / history), rows_before) << "looked at before anything is changed";
  write(frame, frame_before);
  std::string checkpoint = read(m_work / "parts" / "checkpoint.hdf");
  checkpoint[checkpoint.size() / 2] ^= 1;
  refused("parts/checkpoint.hdf", checkpoint, "checkpoint.hdf");
  fs::rename(m_work / "parts", m_work / "moved");
  ASSERT_EQ(run("run --resume moved").code, 0);
  expect_same("whole", "moved");
}

/// What cannot be written is told, with what to do; then it goes on from where it was.
TEST_F(BrokenRuns, AFolderThatCannotBeWrittenToIsTold) {
  ASSERT_EQ(run(m_run + "--out whole").code, 0);
  ASSERT_EQ(stopped(m_run, "parts", SIGTERM).code, 130);
  const fs::path in_the_way = m_work / "parts" / "history.csv.part";
  fs::create_directories(in_the_way / "stays");
  const Ended ended = run("run --resume parts");
  EXPECT_EQ(ended.code, 4);
  EXPECT_TRUE(mentions(ended.err, "cannot write parts/history.csv")) << ended.err;
  EXPECT_TRUE(mentions(ended.err, "run --resume parts")) << ended.err;
  fs::remove_all(in_the_way);
  ASSERT_EQ(run("run --resume parts").code, 0);
  expect_same("whole", "parts");
}

/// Killed after it was complete, before it could remove its checkpoint.
TEST_F(BrokenRuns, ACheckpointBesideACompleteRunIsLeftOver) {
  ASSERT_EQ(stopped(m_run, "parts", SIGTERM).code, 130);
  fs::copy(m_work / "parts" / "checkpoint.hdf", m_work / "left.hdf");
  ASSERT_EQ(run("run --resume parts").code, 0);
  const auto leave = [this] {
    fs::copy(m_work / "left.hdf", m_work / "parts" / "checkpoint.hdf",
             fs::copy_options::overwrite_existing);
  };
  leave();
  expect_bad_input("run --resume parts", "a run that is complete");
  EXPECT_FALSE(summary("parts").contains("error")) << "it stays";
  const pid_t again = start(m_run + "--checkpoint 0 --out parts");
  for (int i = 0; i < 3000 && !(fs::exists(m_work / "parts" / "checkpoint.hdf") &&
                                !fs::exists(m_work / "parts" / "summary.json"));
       ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(again, SIGKILL);
  ASSERT_EQ(finish(again).code, -SIGKILL);
  const Ended resumed = run("run --resume parts --checkpoint 30");
  EXPECT_EQ(resumed.code, 0) << "the summary of the complete run is gone: " << resumed.err;
}

/// Another program may go on, and says so: a library that was built from another commit.
TEST_F(BrokenRuns, AnotherProgramGoesOnAndSaysSo) {
  ASSERT_EQ(run(m_run + "--out whole").code, 0);
  ASSERT_EQ(stopped(m_run, "parts", SIGTERM).code, 130);
  const fs::path lib = fs::path(CONCORD_PROGRAM).parent_path().parent_path() / "lib";
  for (const fs::directory_entry& entry : fs::directory_iterator(lib)) {
    const std::string name = entry.path().filename().string();
    if (name.find(".so") != std::string::npos) fs::copy(entry.path(), m_work / name);
  }
  write("concord_commit.txt", "0123456789\n");
  const Ended ended = run("run --resume parts", "LD_LIBRARY_PATH='" + m_work.string() + "'");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(mentions(ended.out, "with another program or processor: last bits may differ"))
      << ended.out;
  expect_same("whole", "parts");
}

}  // namespace concord::test
