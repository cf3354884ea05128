// Checkpoints and the files of a run that goes on: bits, damaged files, full disks.

#include "scene/checkpoint.hpp"
#include "scene/continued_output.hpp"
#include "scene/errors.hpp"
#include "scene/frame_reader.hpp"
#include "tests/unit/scene/file_size_limit.hpp"
#include "tests/unit/scene/scratch_scene.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <sstream>

using namespace concord;
using namespace concord::scene;
using concord::test::FileSizeLimit;
namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

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

/// The message of the InputError that `call` throws.
template <class Call> std::string input_error(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << word << " is not in: " << message;
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

TEST(Checkpoint, DamagedOnesAreBadInput) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "state.hdf";
  const auto open = [&] { (void)Checkpoint::from(file); };
  expect_words(input_error(open), {"state.hdf", "not there"});
  write(file, "this is no checkpoint");
  expect_words(input_error(open), {"state.hdf", "unreadable"});
  save(file, example());
  const std::string whole = content(file);
  write(file, whole.substr(0, whole.size() / 2));
  expect_words(input_error(open), {"state.hdf", "unreadable"});
  save(file, example());
  Checkpoint state = Checkpoint::from(file);
  std::vector<double> three(3);
  expect_words(input_error([&] { state.fixed("list", three); }),
               {"state.hdf", "list", "4 values where the run has 3"});
  double number = 0;
  EXPECT_TRUE(state.has("list"));
  EXPECT_FALSE(state.has("other"));
  expect_words(input_error([&] { state.item("other", number); }), {"state.hdf", "other"});
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

namespace {

const std::vector<std::string> columns{"t_s", "x_m"};
const std::string rows = "t_s,x_m\n0,0.1\n1e-05,-nan\n2e-05,5e-324\n";

}  // namespace

TEST(ContinuedHistory, KeepsTheRowsBeforeAndGoesOn) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "history.csv";
  write(file, rows + "3e-05,7\n4e-05,8");
  {
    HistoryWriter writer = continue_history(file, columns, rows.size());
    EXPECT_EQ(content(file), rows);
    const double row[] = {3e-5, 0.3333333333333333};
    writer.append(row);
  }
  EXPECT_EQ(content(file), rows + "3e-05,0.3333333333333333\n");
  EXPECT_FALSE(fs::exists(file.string() + ".part"));
}

TEST(ContinuedHistory, OtherRowsAreBadInput) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "history.csv";
  const auto go_on = [&](std::size_t bytes, const std::vector<std::string>& names = columns) {
    return input_error([&] { (void)continue_history(file, names, bytes); });
  };
  expect_words(go_on(rows.size()), {"history.csv", "nothing"});
  write(file, rows);
  expect_words(go_on(rows.size() + 1), {"history.csv", "less"});
  expect_words(go_on(rows.size(), {"t_s", "y_m"}), {"history.csv:1", "x_m"});
  expect_words(go_on(rows.size() - 1), {"history.csv:4", "2e-05,5e-324"});
  for (const std::string line : {"1,2,3", "1", "1;2", "1,", "one,2", "1,0.50"}) {
    write(file, rows + line + "\n");
    expect_words(go_on(rows.size() + line.size() + 1), {"history.csv:5"});
    EXPECT_EQ(content(file), rows + line + "\n") << "stays as it was";
  }
}

TEST(ContinuedHistory, WhatComesAfterTheLastRowIsCut) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "history.csv";
  write(file, rows + "3e-05,0.33");
  for (int i = 0; i < 2; ++i) {
    cut_back(file, rows.size());
    EXPECT_EQ(content(file), rows);
  }
  cut_back(file, 10 * rows.size());
  EXPECT_EQ(content(file), rows) << "never made longer";
  cut_back(scratch.folder / "none.csv", 0);
}

TEST(ContinuedFrames, KeepsThoseBeforeAndRemovesLaterOnes) {
  const test::ScratchScene scratch("");
  const std::vector<Vec3> points{Vec3(0, 0, 0), Vec3(1, 0, 0)};
  FrameList frames;
  for (const double t : {0.0, 0.5, 1.0, 1.5}) add_frame(scratch.folder, frames, t, points, {});
  const double times[] = {0, 0.5};
  frames = keep_frames(scratch.folder, times);
  EXPECT_TRUE(fs::exists(scratch.folder / "fields_0001.hdf"));
  EXPECT_FALSE(fs::exists(scratch.folder / "fields_0002.hdf"));
  EXPECT_FALSE(fs::exists(scratch.folder / "fields_0003.hdf"));
  add_frame(scratch.folder, frames, 0.75, points, {});
  const std::vector<FrameEntry> series = read_frame_series(scratch.folder);
  ASSERT_EQ(series.size(), 3u);
  EXPECT_EQ(series[2].time, 0.75);
  EXPECT_EQ(read_frame(series[2].file).time, 0.75);
  fs::remove(scratch.folder / "fields_0001.hdf");
  expect_words(input_error([&] { (void)keep_frames(scratch.folder, times); }),
               {"fields_0001.hdf"});
}

TEST(ContinuedFrames, AFullDiskLeavesThoseBefore) {
  const test::ScratchScene scratch("");
  std::vector<Vec3> points(5000);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = Vec3(std::sin(1e5 * static_cast<double>(i)), 0, 0);
  FrameList frames;
  add_frame(scratch.folder, frames, 0, points, {});
  const auto size = fs::file_size(scratch.folder / "fields_0000.hdf");
  for (const std::uintmax_t limit_bytes : {size / 2, size - 100, std::uintmax_t{2000}}) {
    const FileSizeLimit limit(limit_bytes);
    try {
      add_frame(scratch.folder, frames, 1, points, {});
      ADD_FAILURE() << "the limit did not bite";
    } catch (const OutputError& error) {
      expect_words(error.what(), {"cannot write", "fields_0001.hdf", "File too large"});
    }
    EXPECT_EQ(frames.size(), 1u);
    EXPECT_FALSE(fs::exists(scratch.folder / "fields_0001.hdf"));
    EXPECT_FALSE(fs::exists(scratch.folder / "fields_0001.hdf.part"));
  }
  ASSERT_EQ(read_frame_series(scratch.folder).size(), 1u);
  EXPECT_EQ(read_frame(scratch.folder / "fields_0000.hdf").points.size(), points.size());
  add_frame(scratch.folder, frames, 1, points, {});
  EXPECT_EQ(read_frame_series(scratch.folder).size(), 2u);
}

TEST(Output, AFileThatCannotBeWrittenIsNamedWithTheReason) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "text";
  write_file(file, "before");
  {
    const FileSizeLimit limit(100);
    try {
      write_file(file, std::string(1000, 'x'));
      ADD_FAILURE() << "the limit did not bite";
    } catch (const OutputError& error) {
      expect_words(error.what(), {file.string(), "File too large"});
    }
  }
  EXPECT_EQ(content(file), "before");
  EXPECT_FALSE(fs::exists(file.string() + ".part"));
}
