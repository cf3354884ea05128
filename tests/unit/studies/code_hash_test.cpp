// What the cache knows code by: the contents of what computes, not the commit or the day.

#include "scene/build_info.hpp"
#include "studies/driver/cache.hpp"
#include "studies/driver/code_hash.hpp"

#include <gtest/gtest.h>

#include <dlfcn.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace concord::studies;
namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

class CodeHash : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::path(testing::TempDir()) / ("concord-code-" + std::to_string(::getpid()));
    fs::create_directories(m_folder);
    for (const char* name : {"a", "b"}) std::ofstream(m_folder / name) << name;
  }
  void TearDown() override { fs::remove_all(m_folder); }

  /// The source that the build writes for the files a and b.
  std::string source() {
    const fs::path out = m_folder / "code_hash.cpp";
    const std::string command = "'" CONCORD_CMAKE "' '-DFILES=" + (m_folder / "a").string() +
                                "," + (m_folder / "b").string() + "' '-DOUT=" + out.string() +
                                "' -P studies/code_hash.cmake";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return read(out);
  }
  fs::path m_folder;
};

}  // namespace

TEST_F(CodeHash, FollowsTheContentsOfEveryFile) {
  const std::string base = source();
  EXPECT_NE(base.find("LinkedCode code(\""), std::string::npos) << base;
  const auto written = fs::last_write_time(m_folder / "code_hash.cpp");
  std::ofstream(m_folder / "b") << "b";  // the same again: a newer file, not newer contents
  EXPECT_EQ(source(), base);
  EXPECT_EQ(fs::last_write_time(m_folder / "code_hash.cpp"), written);
  std::ofstream(m_folder / "b") << "c";
  EXPECT_NE(source(), base);
  std::ofstream(m_folder / "b") << "b";
  std::ofstream(m_folder / "a") << "";
  EXPECT_NE(source(), base);
}

TEST(BuildHash, ChangesWithTheLinkedCode) {
  const std::string before = LinkedCode::hash();
  const LinkedCode one("one");
  const std::string hash = build_hash("some method");
  EXPECT_TRUE(build_unchanged("some method"));
  const LinkedCode two("two");
  EXPECT_FALSE(build_unchanged("some method"));
  EXPECT_NE(build_hash("another method"), hash);
  const LinkedCode none("");  // then the program's own file counts
  EXPECT_NE(build_hash("a third method"), hash);
  EXPECT_NE(build_hash("a third method"), build_hash("another method"));
  const LinkedCode restore(before);
}

TEST(BuildHash, TheSceneLibraryDoesNotHoldTheCommit) {
  const std::string commit = concord::scene::build_info().commit;
  if (commit == "unknown") GTEST_SKIP() << "no repository";
  Dl_info info{};
  ASSERT_NE(dladdr(reinterpret_cast<void*>(&concord::scene::build_info), &info), 0);
  const std::string library = read(info.dli_fname);
  ASSERT_GT(library.size(), 100000u);
  EXPECT_EQ(library.find(commit.substr(0, 12)), std::string::npos);
}
