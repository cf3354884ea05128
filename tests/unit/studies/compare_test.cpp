// Comparison of frames: which runs are compared, interpolation on quadratic triangles, points
// left out, and reasons where nothing can be compared.

#include "scene/frame_reader.hpp"
#include "scene/output.hpp"
#include "studies/driver/claims.hpp"
#include "studies/driver/compare.hpp"

#include <gtest/gtest.h>

#include <fstream>

using namespace concord;
using namespace concord::studies;
namespace fs = std::filesystem;

namespace {

/// A quadratic field, which quadratic triangles carry exactly.
double field(const Vec3& X) { return 1 + 2 * X[0] - X[1] + 3 * X[0] * X[0] + X[0] * X[1]; }

Vec3 displaced(const Vec3& X) { return X + Vec3(0.1 * X[1], 0.2, 0); }

std::vector<double> displacement_of(const std::vector<Vec3>& X) {
  std::vector<double> u;
  for (const Vec3& one : X)
    for (int k = 0; k < 3; ++k) u.push_back((displaced(one) - one)[k]);
  return u;
}

/// Writes the last frame of a run with field `s` and its series.
void write_run(const fs::path& folder, const std::vector<Vec3>& X, const std::vector<double>& s,
               const std::vector<Index>& cells = {}, const std::vector<Index>& offsets = {},
               const std::vector<unsigned char>& types = {}) {
  std::vector<Vec3> x;
  for (const Vec3& one : X) x.push_back(displaced(one));
  const std::vector<double> u = displacement_of(X);
  scene::FrameWriter writer(folder);
  writer.write(0, X, {});
  writer.write(1, x, {{"displacement", 3, u}, {"s", 1, s}}, cells, offsets, types);
}

/// The unit square as two quadratic triangles.
void write_square(const fs::path& folder) {
  const std::vector<Vec3> X{{0, 0, 0},   {1, 0, 0},   {1, 1, 0},   {0, 1, 0},    {0.5, 0, 0},
                            {1, 0.5, 0}, {0.5, 1, 0}, {0, 0.5, 0}, {0.5, 0.5, 0}};
  std::vector<double> s;
  for (const Vec3& one : X) s.push_back(field(one));
  write_run(folder, X, s, {0, 1, 2, 4, 5, 8, 0, 2, 3, 8, 6, 7}, {0, 6, 12}, {22, 22});
}

Case case_of(const std::string& method, const std::string& variant,
             std::vector<double> resolutions) {
  Case entry;
  entry.scene = "bar";
  entry.method = method;
  entry.variant = variant;
  entry.resolutions = std::move(resolutions);
  return entry;
}

/// fem at 2 and 4, of which 4 is the reference, and two particle runs.
class Compared : public testing::Test {
 protected:
  void SetUp() override {
    m_out = fs::path(testing::TempDir()) /
            ("concord-compare-" + std::to_string(::getpid()) + "-" +
             testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(m_out);
    m_study.cases = {case_of("fem", "T6", {2, 4}), case_of("cbm", "xi 0", {4}),
                     case_of("cbm", "xi 1", {4})};
    Comparison comparison;
    comparison.fields = {"s"};
    comparison.reference = {std::nullopt, "fem", std::nullopt};
    m_study.comparisons = {comparison};
    for (std::size_t c = 0; c < 3; ++c)
      for (const double n : m_study.cases[c].resolutions) {
        Row row;
        row.case_index = c;
        row.resolution = n;
        row.run = "run-" + std::to_string(m_rows.size());
        row.summary = {{"h", 0.1}};
        m_rows.push_back(row);
      }
    write_square(m_out / "run-0");
    write_square(m_out / "run-1");
    for (const char* run : {"run-2", "run-3"}) write_run(m_out / run, m_X, values(0.5));
  }
  void TearDown() override { fs::remove_all(m_out); }

  /// The field at the particles, the last one too large by `excess`.
  std::vector<double> values(double excess) const {
    std::vector<double> s;
    for (const Vec3& one : m_X) s.push_back(field(one));
    s.back() += excess;
    return s;
  }

  const std::vector<Vec3> m_X{{0.3, 0.05, 0}, {0.9, 0.35, 0}, {0.2, 0.7, 0}, {0.6, 0.95, 0}};
  fs::path m_out;
  Study m_study;
  std::vector<Row> m_rows;
};

}  // namespace

TEST_F(Compared, InterpolatesQuadraticallyAndMeasuresByEquation29) {
  compare_runs(m_study, m_rows, m_out);
  double scale = 0;
  for (const Vec3& X : m_X) scale += field(X) * field(X);
  EXPECT_NEAR(*value_of(m_rows[2], "errors.s_difference"), 0.5 / std::sqrt(scale), 1e-12);
  EXPECT_EQ(m_rows[2].summary["comparisons"]["difference"]["points"], 4);
  EXPECT_NE(m_rows[2].summary["comparisons"]["difference"]["reference"].get<std::string>().find(
                "fem"),
            std::string::npos);
  EXPECT_NEAR(*value_of(m_rows[0], "errors.s_difference"), 0, 1e-13) << "coarser fem, too";
  EXPECT_FALSE(m_rows[1].summary.contains("comparisons")) << "the reference itself is not";
}

TEST_F(Compared, LeavesTheDifferenceAsAFrame) {
  compare_runs(m_study, m_rows, m_out);
  const scene::Frame frame = scene::read_frame(m_out / "run-2" / "difference.hdf");
  EXPECT_NEAR(frame.scalar("s_reference")[1], field(m_X[1]), 1e-12);
  EXPECT_NEAR(frame.scalar("s_difference")[1], 0, 1e-12);
  EXPECT_NEAR(frame.scalar("s_difference")[3], 0.5, 1e-12);
  EXPECT_NEAR((frame.reference_positions()[3] - m_X[3]).norm(), 0, 1e-15);
  const scene::Frame cells = scene::read_frame(m_out / "run-0" / "difference.hdf");
  EXPECT_EQ(cells.types, (std::vector<unsigned char>{22, 22}));
}

TEST_F(Compared, PointsNearTheEndsDoNotCount) {
  m_study.comparisons[0].leave_out = LeaveOut{1, 0, 1, 2};  // closer than 2 h = 0.2 to y = 0, 1
  compare_runs(m_study, m_rows, m_out);
  EXPECT_EQ(m_rows[2].summary["comparisons"]["difference"]["points"], 2);
  EXPECT_EQ(m_rows[2].summary["comparisons"]["difference"]["left_out"], 2);
  EXPECT_NEAR(*value_of(m_rows[2], "errors.s_difference"), 0, 1e-12) << "the last one is out";
}

TEST_F(Compared, WithoutAReferenceThereIsAReason) {
  m_rows[1].error = "no equilibrium";
  compare_runs(m_study, m_rows, m_out);
  EXPECT_FALSE(value_of(m_rows[2], "errors.s_difference"));
  EXPECT_NE(why_absent(m_rows[2], "errors.s_difference").find("no equilibrium"),
            std::string::npos);
}

TEST_F(Compared, AFieldThatARunLacksIsAReason) {
  m_study.comparisons[0].fields = {"s", "plastic_strain"};
  compare_runs(m_study, m_rows, m_out);
  EXPECT_NE(m_rows[2].summary["comparisons"]["difference"]["reason"].get<std::string>().find(
                "there are s"),
            std::string::npos);
  EXPECT_FALSE(m_rows[2].summary.contains("errors"));
}

TEST_F(Compared, TheFirstComparisonOfANameThatSelectsACaseCounts) {
  Comparison own = m_study.comparisons[0];
  own.selector = {std::nullopt, "cbm", "* 1"};
  own.reference_resolution = 2;
  m_study.comparisons.insert(m_study.comparisons.begin(), own);
  using List = std::vector<const Comparison*>;
  const auto& entries = m_study.comparisons;
  EXPECT_EQ(comparisons_of(m_study, 2, 4, 1), List{&entries[0]});
  EXPECT_EQ(comparisons_of(m_study, 1, 4, 1), List{&entries[1]});
  EXPECT_EQ(comparisons_of(m_study, 0, 2, 1), List{}) << "a reference of either";
  EXPECT_TRUE(needs_last_frame(m_study, 0, 2, 1));
  EXPECT_TRUE(needs_last_frame(m_study, 2, 4, 1));
  m_study.comparisons[0].name = "other";
  EXPECT_EQ(comparisons_of(m_study, 2, 4, 1), (List{&entries[1], &entries[0]}));
  EXPECT_EQ(comparisons_of(m_study, 0, 2, 1), List{&entries[1]});
  m_study.comparisons.clear();
  EXPECT_FALSE(needs_last_frame(m_study, 2, 4, 1));
}

TEST_F(Compared, ParticlesAreComparedOneByOne) {
  Comparison direct = m_study.comparisons[0];
  direct.name = "from_first";
  direct.reference = {std::nullopt, "cbm", "xi 0"};
  m_study.comparisons.push_back(direct);
  write_run(m_out / "run-3", m_X, values(0.75));
  compare_runs(m_study, m_rows, m_out);
  double scale = 0;
  for (const double s : values(0.5)) scale += s * s;
  EXPECT_NEAR(*value_of(m_rows[3], "errors.s_from_first"), 0.25 / std::sqrt(scale), 1e-12);
  EXPECT_TRUE(value_of(m_rows[3], "errors.s_difference")) << "and with the mesh, too";
  EXPECT_TRUE(fs::exists(m_out / "run-3" / "from_first.hdf"));
  EXPECT_NE(why_absent(m_rows[0], "errors.s_from_first").find("other ones"), std::string::npos)
      << "nodes elsewhere";
}
