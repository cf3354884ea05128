#pragma once
// Runs of the program that are stopped and gone on with.

#include "program.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

namespace concord::test {

class ResumedProgram : public Program {
 protected:
  /// Long enough to be stopped: some thousand steps with a row each.
  const std::string m_run = "run swinging_cube --method delaunay --resolution 6 --perturb 0.25 "
                            "--set 'end_time=0.5 s' --set output.history_rows=1500 "
                            "--set output.frames=6 ";

  long rows(const std::string& folder) const {
    const std::string text = read(m_work / folder / "history.csv");
    return std::count(text.begin(), text.end(), '\n');
  }

  /// Starts a run and sends it a signal when its history has some rows.
  Ended stopped(const std::string& arguments, const std::string& folder, int signal,
                long least = 40) {
    std::filesystem::remove_all(m_work / folder);
    const pid_t child = start(arguments + " --out " + folder);
    for (int i = 0; i < 3000 && rows(folder) < least; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(child, signal);
    return finish(child);
  }

  void expect_same(const std::string& whole, const std::string& parts) {
    nlohmann::json a = summary(whole), b = summary(parts);
    EXPECT_TRUE(b["notes"].contains("resumed"));
    for (const char* key : {"errors", "invariants", "quantities", "steps", "dt", "t_end"})
      EXPECT_EQ(a[key].dump(), b[key].dump()) << key;
    EXPECT_EQ(read(m_work / whole / "history.csv"), read(m_work / parts / "history.csv"));
    EXPECT_EQ(read(m_work / whole / "fields.hdf.series"),
              read(m_work / parts / "fields.hdf.series"));
    const auto names = [this](const std::string& folder) {
      std::vector<std::string> list;
      for (const auto& entry : std::filesystem::directory_iterator(m_work / folder))
        list.push_back(entry.path().filename().string());
      std::sort(list.begin(), list.end());
      return list;
    };
    EXPECT_EQ(names(whole), names(parts)) << "no checkpoint is left";
  }
};

inline bool mentions(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace concord::test
