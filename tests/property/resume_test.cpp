// Runs that were stopped and resumed end with the same bits as runs that were not, for every
// registered particle method: results, history, frames.

#include "scene/continued_output.hpp"
#include "tests/property/resumed_run.hpp"
#include "tests/unit/scene/file_size_limit.hpp"

#include <optional>

namespace concord::particle::test {
namespace {

/// In one go, against: stopped at every one of `stops`, and resumed with the other number of
/// threads.
void compare(const Case& what, const Variant& variant, const std::vector<int>& stops) {
  const Scratch scratch;
  const RunInFolder whole{what, variant, scratch / "whole"},
      parts{what, variant, scratch / "parts"};
  scene::Result expected, got;
  ASSERT_TRUE(whole(1, false, -1, expected));
  EXPECT_FALSE(fs::exists(whole.out / "checkpoint.hdf"))
      << "a short run that nothing stops has no checkpoint";
  int threads = 1;
  bool resume = false;
  for (const int stop : stops) {
    scene::Result partial;
    ASSERT_FALSE(parts(threads, resume, stop, partial))
        << "the run ended before it was stopped";
    EXPECT_LT(partial.t_end, expected.t_end);
    EXPECT_LT(partial.steps, expected.steps);
    EXPECT_NE(contents(parts.out / "history.csv"), contents(whole.out / "history.csv"));
    resume = true;
    threads = 3 - threads;
  }
  ASSERT_TRUE(parts(threads, true, -1, got));
  EXPECT_FALSE(got.notes.at("resumed").empty());
  expect_same(expected, got);
  expect_same_files(whole.out, parts.out);
}

class ResumedRun : public testing::TestWithParam<Variant> {
 protected:
  void SetUp() override {
    if (Bench::method_of(GetParam()).info().cannot.count("curved faces") > 0) m_curved = false;
  }
  bool m_curved = true;
};

/// Settings of artificial viscosity in every method's own words.
Settings viscous(const std::string& method) {
  if (method == "tlsph") return {{"alpha", "0.5"}, {"beta", "1"}};
  if (method == "delaunay" || method == "voronoi") return {{"c1", "0.1"}, {"c2", "0.2"}};
  return {};
}

}  // namespace

/// Rows and frames at different times, so that the last state before the stop has one of them
/// that the whole run has not.
TEST_P(ResumedRun, SwingingElasticBody) {
  compare({"swinging_cube",
           4,
           {{"end_time", "60 ms"}, {"output.frames", "4"}, {"output.history_rows", "7"}},
           {},
           GetParam().method == "cbm" ? 0 : 0.25},
          GetParam(), {2, 3});
}

/// Regions at rest, the time step estimated again.
TEST_P(ResumedRun, WaveFromAStruckEnd) {
  compare({"cantilever",
           8,
           {{"end_time", "25 ms"},
            {"initial.velocity", R"set(["0", "0", "(X > 5.7 ? V : 0)"])set"},
            {"output.frames", "3"},
            {"output.history_rows", "40"}}},
          GetParam(), {4, 11});
}

/// Viscosity and mass damping: their work is carried on.
TEST_P(ResumedRun, DampedBody) {
  Settings settings = viscous(GetParam().method);
  settings["damping"] = "100";
  compare({"swinging_cube",
           3,
           {{"end_time", "60 ms"}, {"output.frames", "2"}, {"output.history_rows", "9"}},
           settings},
          GetParam(), {5});
}

/// History of the material, prescribed motion that does work, a static scene by dynamics.
TEST_P(ResumedRun, PulledPlasticBody) {
  Case what{"tensile_bar",
            14,
            {{"output.frames", "2"}, {"output.history_rows", "5"}, {"parameters.tau", "0.8"}},
            {{"solver", "explicit"}, {"duration", "2e-5"}}};
  if (!m_curved) {
    what.scene = "cooks_membrane";
    what.resolution = 8;
    what.settings["duration"] = "2e-2";
    what.set = {{"output.frames", "2"},
                {"output.history_rows", "5"},
                {"boundary.0.kind", "displacement"},
                {"boundary.0.value", "[\"-1e-3*t\", \"0\"]"}};
  }
  compare(what, GetParam(), {3});
}

/// Static by damped motion that settles: no frames, the ramp of the load.
TEST_P(ResumedRun, DampedMotionThatSettles) {
  Case what{"patch_test_c",
            3,
            {{"output.history_rows", "300"}},
            {{"solver", "explicit"}, {"tolerance", "1e-6"}}};
  if (!m_curved) what.scene = "cooks_membrane", what.resolution = 4;  // it holds no points
  compare(what, GetParam(), {4});
}

INSTANTIATE_TEST_SUITE_P(Methods, ResumedRun, testing::ValuesIn(variants()), variant_name);

/// Bonds that have broken stay broken, and break on at the same steps.
class ResumedFracture : public testing::TestWithParam<std::string> {};

TEST_P(ResumedFracture, GrowingCrack) {
  const Variant variant{GetParam(), GetParam(), {}};
  compare({"pmma_plate",
           2,
           {{"parameters.width", "20 mm"},
            {"parameters.crack", "10 mm"},
            {"parameters.strip", "4 mm"},
            {"end_time", "90 us"},
            {"output.frames", "4"},
            {"output.history_rows", "30"}}},
          variant, {18, 8});
}

INSTANTIATE_TEST_SUITE_P(Methods, ResumedFracture, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const scene::Method* method :
                                scene::MethodRegistry::instance().all()) {
                             const auto* particles =
                                 dynamic_cast<const ParticleMethod*>(method);
                             if (particles && particles->breaks())
                               names.push_back(method->info().name);
                           }
                           return names;
                         }()));

/// Neither row nor frame nor checkpoint can be written any more: the last checkpoint stays.
TEST(ResumedRuns, AfterAFullDiskFromTheCheckpointBefore) {
  const Variant variant{"delaunay", "delaunay", {}};
  const Case what{
      "swinging_cube",
      4,
      {{"end_time", "60 ms"}, {"output.frames", "4"}, {"output.history_rows", "12"}}};
  const Scratch scratch;
  const RunInFolder whole{what, variant, scratch / "whole"};
  scene::Result expected, partial, got;
  ASSERT_TRUE(whole(1, false, -1, expected));
  for (const int stop : {2, 6}) {
    RunInFolder parts{what, variant, scratch / "parts"};
    std::optional<concord::test::FileSizeLimit> full;
    parts.interval = 0;
    parts.at_stop = [&] { full.emplace(500); };
    EXPECT_THROW(parts(1, false, stop, partial), scene::OutputError);
    full.reset();
    for (const scene::FrameEntry& frame : scene::read_frame_series(parts.out))
      EXPECT_EQ(scene::read_frame(frame.file).time, frame.time);
    EXPECT_EQ(contents(parts.out / "history.csv").back(), '\n');
    got = {};
    ASSERT_TRUE(parts(2, true, -1, got));
    expect_same(expected, got);
    expect_same_files(whole.out, parts.out);
    fs::remove_all(parts.out);
  }
}

/// Every fact that differs is told, with what it was and what it is.
TEST(ResumedRuns, OfAnotherRunIsBadInput) {
  const Variant variant{"delaunay", "delaunay", {}}, other{"tlsph", "tlsph", {}},
      settings{"delaunay", "delaunay", {{"xi_n", "0.5"}, {"dt_factor", "0.7"}}};
  const Case what{"swinging_cube", 4, {{"end_time", "60 ms"}}, {}, 0.1};
  const Scratch scratch;
  scene::Result result;
  ASSERT_FALSE((RunInFolder{what, variant, scratch / "r"}(1, false, 3, result)));
  const auto expect = [&](const Case& its, const Variant& with, const std::string& found,
                          const std::string& saved) {
    const std::string history = contents(scratch / "r" / "history.csv");
    try {
      RunInFolder{its, with, scratch / "r"}(1, true, -1, result);
      ADD_FAILURE() << "resumed";
    } catch (const InputError& error) {
      EXPECT_NE(error.found().find(found), std::string::npos) << error.what();
      EXPECT_NE(error.allowed().find(saved), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("checkpoint.hdf"), std::string::npos);
    }
    EXPECT_EQ(contents(scratch / "r" / "history.csv"), history) << "untouched";
  };
  expect({"swinging_cube", 5, what.set, {}, 0.1}, variant, "spacing: 0.2 m", "spacing: 0.25 m");
  expect({"swinging_cube", 4, what.set, {}, 0.2}, variant, "perturb: 0.2", "perturb: 0.1");
  expect({"swinging_cube", 5, what.set, {}, 0.1}, variant, "particles: 216", "particles: 125");
  expect({"cantilever", 4, {}, {}, 0.1}, variant, "scene: cantilever", "scene: swinging_cube");
  expect({"swinging_cube", 4, {{"end_time", "3 ms"}}, {}, 0.1}, variant, "3 ms", "60 ms");
  expect(what, settings, "delaunay.dt_factor: 0.7; delaunay.xi_n: 0.5",
         "delaunay.dt_factor: 0.8; delaunay.xi_n: 1");
  expect(what, other, "method: tlsph", "method: delaunay");
  expect({"patch_test_c", 3}, variant, "static solve", "explicit integrator");
  EXPECT_TRUE((RunInFolder{what, variant, scratch / "r"}(1, true, -1, result)));
}

}  // namespace concord::particle::test
