// One run a folder: who has it, who is dead, file systems without locks.

#include "scene/errors.hpp"
#include "studies/driver/folder_lock.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <optional>

namespace concord::studies {
namespace {

class FolderLocks : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = std::filesystem::path(testing::TempDir()) /
               ("concord-lock-" + std::to_string(::getpid()));
    std::filesystem::create_directories(m_folder);
  }
  void TearDown() override { std::filesystem::remove_all(m_folder); }
  bool there() const { return std::filesystem::exists(m_folder / FolderLock::file_name); }

  std::filesystem::path m_folder;
};

int not_supported(int, int) {
  errno = EOPNOTSUPP;
  return -1;
}

}  // namespace

TEST_F(FolderLocks, TheSecondIsToldWhoHasIt) {
  std::optional<FolderLock> first(std::in_place, m_folder, "--out");
  EXPECT_TRUE(first->held());
  for (int i = 0; i < 2; ++i) {
    try {
      const FolderLock second(m_folder, "--resume");
      ADD_FAILURE() << "had it too";
    } catch (const InputError& error) {
      EXPECT_EQ(error.key(), "--resume");
      const std::string found =
          m_folder.string() + ", in use by process " + std::to_string(::getpid()) + " on ";
      EXPECT_EQ(error.found().rfind(found, 0), 0u) << error.found();
    }
  }
  first.reset();
  EXPECT_FALSE(there());
  EXPECT_TRUE(FolderLock(m_folder, "--out").held());
}

TEST_F(FolderLocks, TheFileOfADeadProcessDoesNotBlock) {
  std::ofstream(m_folder / FolderLock::file_name) << "process 1 on a machine far away\n";
  {
    const FolderLock lock(m_folder, "--out");
    EXPECT_TRUE(lock.held());
    std::ifstream stream(m_folder / FolderLock::file_name);
    std::string text;
    std::getline(stream, text);
    EXPECT_EQ(text.rfind("process " + std::to_string(::getpid()) + " on ", 0), 0u) << text;
  }
  EXPECT_FALSE(there());
}

TEST_F(FolderLocks, WithoutLocksOfTheFileSystemItGoesWithout) {
  const FolderLock one(m_folder, "--out", not_supported), two(m_folder, "--out", not_supported);
  EXPECT_FALSE(one.held());
  EXPECT_FALSE(two.held());
  EXPECT_FALSE(there()) << "nothing is left";
}

TEST_F(FolderLocks, OfNoFolderThereIsNone) {
  const FolderLock lock(m_folder / "none", "--resume");
  EXPECT_FALSE(lock.held());
  EXPECT_FALSE(std::filesystem::exists(m_folder / "none"));
}

}  // namespace concord::studies
