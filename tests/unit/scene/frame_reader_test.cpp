// Frames read back: everything that the writer put in, and errors that name the file.

#include "scene/frame_reader.hpp"
#include "scene/output.hpp"
#include "tests/unit/scene/scratch_scene.hpp"

#include <gtest/gtest.h>

using namespace concord;
using namespace concord::scene;

namespace {

/// The message of what a call throws.
template <class Call> std::string message_of(Call&& call) {
  try {
    call();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "nothing thrown";
}

}  // namespace

TEST(FrameReader, ReadsParticlesAndTheirFields) {
  const test::ScratchScene scratch("");
  constexpr std::size_t n = 2000;  // long enough to be chunked and deflated
  std::vector<Vec3> x(n);
  std::vector<double> u(3 * n), s(n);
  for (std::size_t a = 0; a < n; ++a) {
    x[a] = Vec3(0.1 * static_cast<double>(a), 1, -2);
    u[3 * a + 1] = 0.25;
    s[a] = 1.0 / (1.0 + static_cast<double>(a));
  }
  FrameWriter writer(scratch.folder);
  writer.write(0, x, {{"s", 1, s}});
  writer.write(0.5, x, {{"s", 1, s}, {"displacement", 3, u}});
  const auto series = read_frame_series(scratch.folder);
  ASSERT_EQ(series.size(), 2u);
  EXPECT_EQ(series[1].time, 0.5);
  const Frame frame = read_frame(series[1].file);
  EXPECT_EQ(frame.time, 0.5);
  EXPECT_EQ(frame.points, x);
  EXPECT_EQ(frame.scalar("s"), s);
  EXPECT_EQ(frame.reference_positions()[7], Vec3(x[7][0], 0.75, -2));
  EXPECT_EQ(frame.types, std::vector<unsigned char>(n, 1)) << "vertex cells";
  EXPECT_EQ(frame.cells.size(), n);
  EXPECT_EQ(frame.find("absent"), nullptr);
}

TEST(FrameReader, ReadsCellsOfAFileOfItsOwn) {
  const test::ScratchScene scratch("");
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<double> s{1, 2, 3, 4};
  const std::vector<Index> cells{0, 1, 2, 0, 2, 3}, offsets{0, 3, 6};
  const std::vector<unsigned char> types{5, 5};
  write_frame(scratch.folder / "one.hdf", 2, x, {{"s", 1, s}}, cells, offsets, types);
  const Frame frame = read_frame(scratch.folder / "one.hdf");
  EXPECT_EQ(frame.cells, cells);
  EXPECT_EQ(frame.offsets, offsets);
  EXPECT_EQ(frame.types, types);
  EXPECT_EQ(frame.time, 2);
}

TEST(FrameReader, ErrorsNameTheFileAndWhatThereIs) {
  const test::ScratchScene scratch("");
  const auto file = scratch.folder / "one.hdf";
  EXPECT_NE(message_of([&] { read_frame(file); }).find("one.hdf"), std::string::npos);
  test::write_text(file, "no frame");
  EXPECT_NE(message_of([&] { read_frame(file); }).find("one.hdf"), std::string::npos);
  EXPECT_NE(message_of([&] { read_frame_series(scratch.folder); }).find("fields.hdf.series"),
            std::string::npos);
  test::write_text(scratch.folder / "fields.hdf.series", "{\"files\": []}");
  EXPECT_NE(message_of([&] { read_frame_series(scratch.folder); }).find("no frame"),
            std::string::npos);

  const std::vector<Vec3> x{{0, 0, 0}};
  const std::vector<double> s{1}, v{1, 2, 3};
  write_frame(file, 0, x, {{"pressure", 1, s}, {"velocity", 3, v}});
  const Frame frame = read_frame(file);
  const std::string scalar = message_of([&] { frame.scalar("velocity"); });
  EXPECT_NE(scalar.find("there are pressure"), std::string::npos) << scalar;
  EXPECT_NE(message_of([&] { frame.reference_positions(); }).find("displacement"),
            std::string::npos);
}
