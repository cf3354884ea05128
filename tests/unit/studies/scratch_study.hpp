#pragma once
// A study file of its own, read as the program reads it.

#include "studies/driver/study_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace concord::studies {

/// A home with one study, s, gone at the end.
class StudyFile : public testing::Test {
 protected:
  void SetUp() override {
    m_home = std::filesystem::path(testing::TempDir()) /
             ("concord-study-" + std::to_string(::getpid()) + "-" +
              testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(m_home / "studies" / "s");
  }
  void TearDown() override { std::filesystem::remove_all(m_home); }

  Study read(const std::string& text, bool full = true) {
    std::ofstream(m_home / "studies" / "s" / "study.toml") << text;
    return read_study("s", full, m_home);
  }
  void expect_error(const std::string& text, int line, const std::string& key) {
    try {
      read(text);
      FAIL() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.where().line, line) << error.what();
      EXPECT_NE(error.key().find(key), std::string::npos) << error.what();
      EXPECT_FALSE(error.allowed().empty());
    }
  }

  std::filesystem::path m_home;
};

inline const std::string head = "title = \"t\"\nquestion = \"q\"\nsource = \"s\"\n";
inline const std::string one_case = head +
                                    "[[case]]\nscene = \"block\"\nmethod = \"delaunay\"\n"
                                    "resolutions = [8, 4]\n";

}  // namespace concord::studies
