// The files of a run that goes on: histories, frames, full disks.

#include "scene/continued_output.hpp"
#include "scene/frame_reader.hpp"
#include "tests/unit/scene/file_size_limit.hpp"
#include "tests/unit/scene/file_texts.hpp"
#include "tests/unit/scene/scratch_scene.hpp"

#include <cmath>

using namespace concord;
using namespace concord::scene;
using namespace concord::test;
namespace fs = std::filesystem;

namespace {

const std::vector<std::string> columns{"t_s", "x_m"};
const std::string rows = "t_s,x_m\n0,0.1\n1e-05,-nan\n2e-05,5e-324\n";

}  // namespace

TEST(ContinuedHistory, KeepsTheRowsBeforeAndGoesOn) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "history.csv";
  write(file, rows + "3e-05,7\n4e-05,8");
  {
    HistoryWriter writer =
        continue_history(file, columns, rows.size(), digest_of(file, rows.size()));
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
    return input_error(
        [&] { (void)continue_history(file, names, bytes, digest_of(file, bytes)); });
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

/// Rows that could have been, but were not.
TEST(ContinuedHistory, ChangedRowsAreBadInput) {
  const test::ScratchScene scratch("");
  const fs::path file = scratch.folder / "history.csv";
  write(file, rows);
  const std::uint64_t digest = digest_of(file);
  std::string changed = rows;
  changed[rows.find("0.1") + 2] = '2';
  write(file, changed + "3e-05,7\n");
  expect_words(input_error([&] { (void)continue_history(file, columns, rows.size(), digest); }),
               {"history.csv", "other rows"});
  EXPECT_EQ(content(file), changed + "3e-05,7\n");
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
  const std::uint64_t digests[] = {digest_of(scratch.folder / "fields_0000.hdf"), 0};
  frames = kept_frames(scratch.folder, times, digests);
  EXPECT_TRUE(fs::exists(scratch.folder / "fields_0003.hdf")) << "only looked at";
  end_frames(scratch.folder, frames);
  EXPECT_TRUE(fs::exists(scratch.folder / "fields_0001.hdf"));
  EXPECT_FALSE(fs::exists(scratch.folder / "fields_0002.hdf"));
  EXPECT_FALSE(fs::exists(scratch.folder / "fields_0003.hdf"));
  add_frame(scratch.folder, frames, 0.75, points, {});
  const std::vector<FrameEntry> series = read_frame_series(scratch.folder);
  ASSERT_EQ(series.size(), 3u);
  EXPECT_EQ(series[2].time, 0.75);
  EXPECT_EQ(read_frame(series[2].file).time, 0.75);
  const auto keep = [&] { (void)kept_frames(scratch.folder, times, digests); };
  const std::string first = content(scratch.folder / "fields_0000.hdf");
  write(scratch.folder / "fields_0000.hdf", first.substr(0, first.size() - 1));
  expect_words(input_error(keep), {"fields_0000.hdf", "another one"});
  write(scratch.folder / "fields_0000.hdf", first);
  fs::remove(scratch.folder / "fields_0001.hdf");
  expect_words(input_error(keep), {"fields_0001.hdf", "nothing"});
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
