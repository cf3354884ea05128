// Checkpoints: bits, damaged files, full disks, what reaches the disk.

#include "scene/checkpoint.hpp"
#include "scene/continued_output.hpp"
#include "tests/unit/scene/disk_calls.hpp"
#include "tests/unit/scene/file_size_limit.hpp"
#include "tests/unit/scene/file_texts.hpp"
#include "tests/unit/scene/scratch_scene.hpp"

#include <cmath>
#include <cstring>
#include <limits>

using namespace concord;
using namespace concord::scene;
using namespace concord::test;
namespace fs = std::filesystem;

namespace {

/// Everything that an item can be.
struct Everything {
  double number = 0;
  long large = 0;
  Index index = 0;
  bool flag = false;
  Vec3 vector = Vec3::Zero();
  std::string text;
  std::vector<double> list, empty;
  std::vector<Index> indices;
  std::vector<char> bytes;

  void keep(Checkpoint& state) {
    state.item("number", number);
    state.item("large", large);
    state.item("index", index);
    state.item("flag", flag);
    state.item("vector", vector);
    state.item("text", text);
    state.item("list", list);
    state.item("empty", empty);
    state.item("indices", indices);
    state.item("bytes", bytes);
  }
};

Everything example() {
  Everything e;
  e.number = 0.1;
  e.large = std::numeric_limits<long>::max() - 1;
  e.index = -7;
  e.flag = true;
  e.vector = Vec3(-0.0, 1e-310, 3);
  e.text = "two\nlines, \"quoted\"";
  e.list = {-0.0, std::numeric_limits<double>::infinity(), std::nan("5"), 5e-324};
  e.indices = {1, -1, 2147483647};
  e.bytes = {'a', 0, 1};
  return e;
}

void save(const fs::path& file, Everything e) {
  Checkpoint state = Checkpoint::to(file);
  e.keep(state);
  state.finish();
}

}  // namespace

TEST(Checkpoint, RestoresBits) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "state.hdf";
  const Everything saved = example();
  save(file, saved);
  EXPECT_FALSE(fs::exists(file.string() + ".part"));
  Everything e;
  e.empty = {1, 2};
  Checkpoint state = Checkpoint::from(file);
  e.keep(state);
  EXPECT_EQ(e.number, saved.number);
  EXPECT_EQ(e.large, saved.large);
  EXPECT_EQ(e.index, saved.index);
  EXPECT_TRUE(e.flag);
  EXPECT_EQ(std::memcmp(e.vector.data(), saved.vector.data(), 3 * sizeof(double)), 0);
  EXPECT_EQ(e.text, saved.text);
  ASSERT_EQ(e.list.size(), saved.list.size());
  EXPECT_EQ(std::memcmp(e.list.data(), saved.list.data(), 4 * sizeof(double)), 0);
  EXPECT_TRUE(e.empty.empty());
  EXPECT_EQ(e.indices, saved.indices);
  EXPECT_EQ(e.bytes, saved.bytes);
}

TEST(Checkpoint, AnUnfinishedOneLeavesTheOneBefore) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "state.hdf";
  save(file, example());
  const std::string before = content(file);
  {
    Checkpoint state = Checkpoint::to(file);
    Everything other;
    other.keep(state);
  }
  EXPECT_EQ(content(file), before);
  EXPECT_FALSE(fs::exists(file.string() + ".part"));
}

TEST(Checkpoint, WhatIsNoCheckpointIsBadInput) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "state.hdf";
  const auto open = [&] { (void)Checkpoint::from(file); };
  expect_words(input_error(open), {"state.hdf", "not there"});
  for (const std::string text : {"", "short", "this is no checkpoint"}) {
    write(file, text);
    expect_words(input_error(open), {"state.hdf", "unreadable", "no checkpoint"});
  }
  fs::create_directory(scratch.folder / "folder");
  expect_words(input_error([&] { (void)Checkpoint::from(scratch.folder / "folder"); }),
               {"folder", "unreadable"});
}

/// Any byte, any length: items of few values, their names and sizes included.
TEST(Checkpoint, DamagedOnesAreBadInput) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "state.hdf", other = scratch.folder / "other.hdf";
  save(file, example());
  const std::string whole = content(file);
  const auto open = [&] { (void)Checkpoint::from(other); };
  write(other, whole);
  ASSERT_NO_THROW(open());
  std::fstream stream(other, std::ios::binary | std::ios::in | std::ios::out);
  const auto put = [&](std::size_t k, char byte) {
    stream.seekp(static_cast<std::streamoff>(k)).put(byte).flush();
  };
  for (std::size_t k = 0; k < whole.size(); ++k) {
    put(k, static_cast<char>(whole[k] ^ (1 << k % 8)));
    expect_words(input_error(open), {"other.hdf", "unreadable"});
    put(k, whole[k]);
  }
  ASSERT_NO_THROW(open());
  stream.close();
  for (std::size_t size = 0; size < whole.size(); size += 101) {
    write(other, whole.substr(0, size));
    expect_words(input_error(open), {"other.hdf", "unreadable"});
  }
}

TEST(Checkpoint, OtherItemsThanThoseSavedAreBadInput) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "state.hdf";
  save(file, example());
  Checkpoint state = Checkpoint::from(file);
  std::vector<double> three(3);
  expect_words(input_error([&] { state.fixed("list", three); }),
               {"state.hdf", "list", "4 values where the run has 3"});
  double number = 0;
  EXPECT_TRUE(state.has("list"));
  EXPECT_FALSE(state.has("other"));
  expect_words(input_error([&] { state.item("other", number); }), {"state.hdf", "other"});
  state.require(true, "list", "is good");
  expect_words(input_error([&] { state.require(false, "list", "it is wrong"); }),
               {"state.hdf", "list", "it is wrong"});
}

/// Itself, then its name.
TEST(Checkpoint, IsOnTheDiskBeforeItTakesItsName) {
  const test::ScratchScene scratch("");
  const DiskCalls calls;
  save(scratch.folder / "state.hdf", example());
  EXPECT_EQ(calls.log(),
            (std::vector<std::string>{"fsync state.hdf.part", "rename state.hdf",
                                      "fsync " + scratch.folder.filename().string()}));
}

TEST(Checkpoint, AFullDiskLeavesTheOneBefore) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "state.hdf";
  save(file, example());
  const std::string before = content(file);
  for (const std::size_t size : {20000, 300000}) {
    Everything large = example();
    large.list.assign(size, 1.5);
    const FileSizeLimit limit(before.size());
    try {
      save(file, large);
      ADD_FAILURE() << "the limit did not bite";
    } catch (const OutputError& error) {
      expect_words(error.what(), {"cannot write " + file.string(), "File too large"});
    }
    EXPECT_FALSE(fs::exists(file.string() + ".part"));
    EXPECT_EQ(content(file), before);
  }
  Everything e;
  Checkpoint state = Checkpoint::from(file);
  e.keep(state);
  EXPECT_EQ(e.text, example().text);
}
