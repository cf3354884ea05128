#pragma once
// The program itself, started by a test in a folder of its own.

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace concord::test {

struct Ended {
  int code = -1;
  std::string out, err;
};

inline std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

class Program : public testing::Test {
 protected:
  void SetUp() override {
    m_work = std::filesystem::path(testing::TempDir()) /
             ("concord-cli-" + std::to_string(::getpid()));
    std::filesystem::remove_all(m_work);
    std::filesystem::create_directories(m_work);
  }
  void TearDown() override { std::filesystem::remove_all(m_work); }

  /// Starts `concord` with shell-quoted arguments; its cache is the test's own.
  pid_t start(const std::string& arguments, const std::string& environment = "") {
    const std::string command = "cd '" + m_work.string() +
                                "' && exec env CONCORD_CACHE=cache " + environment +
                                " '" CONCORD_PROGRAM "' " + arguments + " >out 2>err";
    const pid_t child = fork();
    if (child == 0) {
      execl("/bin/bash", "bash", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    return child;
  }
  Ended finish(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read(m_work / "out"),
            read(m_work / "err")};
  }
  Ended run(const std::string& arguments, const std::string& environment = "") {
    return finish(start(arguments, environment));
  }
  nlohmann::json summary(const std::filesystem::path& folder) {
    return nlohmann::json::parse(read(m_work / folder / "summary.json"));
  }

  /// A home of its own with the library's scenes and one study.
  std::string home_with_study(const std::string& text) {
    const std::filesystem::path home = m_work / "home";
    std::filesystem::create_directories(home / "scene");
    std::filesystem::create_directories(home / "studies" / "s");
    std::error_code there;
    std::filesystem::create_directory_symlink(
        std::filesystem::path(std::getenv("CONCORD_HOME")) / "scene" / "library",
        home / "scene" / "library", there);
    std::ofstream(home / "studies" / "s" / "study.toml") << text;
    return "CONCORD_HOME='" + home.string() + "'";
  }

  void expect_bad_input(const std::string& arguments, const std::string& mentions) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.code, 2) << arguments << "\n" << ended.err;
    EXPECT_NE(ended.err.find(mentions), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("allowed"), std::string::npos) << ended.err;
  }

  std::filesystem::path m_work;
};

}  // namespace concord::test
