// Probes around whole runs: what they make of ends, of NaN, of seeds.

#include "scene/output.hpp"
#include "studies/probes/whole_run.hpp"
#include "tests/unit/probes/springs.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace concord::probes {
namespace {

namespace fs = std::filesystem;
using test::MadeUp;

class Runs : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::path(testing::TempDir()) / ("concord-probes-" + std::to_string(::getpid()));
    fs::create_directories(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }

  void history(const fs::path& folder, const std::string& text) {
    fs::create_directories(folder);
    std::ofstream(folder / "history.csv") << text;
  }

  /// Probe reach on a method that reaches 0.4, writes `last` and throws.
  std::map<std::string, double> reach(const std::string& last) {
    const MadeUp method({}, [&](const scene::RunRequest& request, scene::Result& result) {
      history(request.out, "t_s,plate_x_N\n0,0\n" + last + "\n");
      result.t_end = 0.4;
      throw SolveError("det F", 7, 0.45, 3);
    });
    scene::RunRequest run;
    run.out = m_folder;
    return test::run_probe("reach", scene::read_problem("cooks_membrane"), method, run,
                           {{"full", "3"}})
        .quantities;
  }

  fs::path m_folder;
};

TEST_F(Runs, ReachIsTheLastEquilibrium) {
  const auto q = reach("0.4,2");
  EXPECT_DOUBLE_EQ(q.at("reached"), 0.4);
  EXPECT_DOUBLE_EQ(q.at("load"), 1.2);
  EXPECT_EQ(q.at("clean"), 1);
}

TEST_F(Runs, ReachSeesNaNOnDisk) {
  EXPECT_EQ(reach("0.4,nan").at("clean"), 0);
  EXPECT_EQ(reach("0.4,inf").at("clean"), 0);
  EXPECT_EQ(reach("0.4").at("clean"), 0);
}

TEST_F(Runs, FramesAreReadForNaN) {
  history(m_folder, "t_s\n0\n");
  const std::vector<Vec3> points{Vec3::Zero(), Vec3::UnitX()};
  std::vector<double> displacement(6, 0.0), pressure{1, 2};
  const auto write = [&] {
    scene::FrameWriter(m_folder).write(
        0, points, {{"displacement", 3, displacement}, {"pressure", 1, pressure}});
  };
  write();
  EXPECT_TRUE(all_finite(m_folder));
  pressure[1] = std::nan("");
  write();
  EXPECT_FALSE(all_finite(m_folder));
}

TEST_F(Runs, EnergyIsPutTogetherFromItsColumns) {
  std::string text = "t_s,kinetic_energy_J,internal_energy_J,external_work_J\n";
  for (int k = 0; k < 100; ++k) {
    const double work = 0.5 * k, internal = 20 + 0.4 * k;  // 0.1 a row is lost
    text += std::to_string(k) + ",10," + std::to_string(internal) + "," + std::to_string(work) +
            "\n";
  }
  history(m_folder, text);
  std::map<std::string, double> q;
  tell_energy(m_folder, q);
  EXPECT_NEAR(q.at("drift"), 9.9 / 30, 1e-6);
  EXPECT_NEAR(q.at("trend"), -9.0 / 29.55, 1e-6);
}

TEST_F(Runs, PlacementIsTheSpreadOverSeeds) {
  const MadeUp method({}, [](const scene::RunRequest& request, scene::Result& result) {
    result.quantities["tip_y"] = 1 + 0.1 * static_cast<double>(request.seed);
  });
  scene::RunRequest run;
  run.seed = 4;
  const scene::Problem problem = scene::read_problem("cooks_membrane");
  const auto q = test::run_probe("placement", problem, method, run,
                                 {{"seeds", "3"}, {"quantity", "quantities.tip_y"}})
                     .quantities;
  EXPECT_NEAR(q.at("mean"), 1.5, 1e-12);
  EXPECT_NEAR(q.at("spread"), 0.2 / 1.5, 1e-12);
  EXPECT_NEAR(q.at("deviation"), 0.1 / 1.5, 1e-12);
  EXPECT_THROW(test::run_probe("placement", problem, method, run, {{"quantity", "errors.x"}}),
               InputError);
}

// An arrangement that a method refuses counts; where it refuses all, the run has failed.
TEST_F(Runs, PlacementCountsWhatIsRefused) {
  const MadeUp method({}, [](const scene::RunRequest& request, scene::Result& result) {
    if (request.seed % 2 == 0)
      throw InputError({"arrangement"}, "perturb", "an inverted cell", "less");
    result.quantities["tip_y"] = static_cast<double>(request.seed);
  });
  scene::RunRequest run;
  const scene::Problem problem = scene::read_problem("cooks_membrane");
  const auto place = [&](std::uint64_t seed, const char* seeds) {
    run.seed = seed;
    return test::run_probe("placement", problem, method, run,
                           {{"seeds", seeds}, {"quantity", "quantities.tip_y"}});
  };
  const scene::Result four = place(1, "4");
  EXPECT_EQ(four.quantities.at("accepted"), 2);
  EXPECT_EQ(four.quantities.at("refused"), 2);
  EXPECT_NEAR(four.quantities.at("mean"), 2, 1e-12);
  EXPECT_TRUE(four.notes.contains("refused"));
  EXPECT_FALSE(place(1, "2").quantities.contains("deviation")) << "of one";
  const MadeUp never({}, [](const scene::RunRequest&, scene::Result&) {
    throw InputError({"arrangement"}, "perturb", "an inverted cell", "less");
  });
  EXPECT_THROW(test::run_probe("placement", problem, never, run, {}), SolveError);
}

TEST_F(Runs, RotationMeasuresTurnsAndShape) {
  const scene::Problem problem = scene::read_problem("spinning_block");
  // A cube of eight points that ends turned by 90 degrees, stretched by 1 % along X.
  class Cube final : public test::Springs {
   public:
    Cube() : Springs(Eigen::MatrixXd::Zero(8, 8), 1, 1) {
      for (int a = 0; a < 8; ++a)
        m_corners.emplace_back(0.5 - (a & 1), 0.5 - ((a >> 1) & 1), 0.5 - ((a >> 2) & 1));
    }
    int dim() const override { return 3; }
    std::span<const Vec3> positions() const override { return m_corners; }

   private:
    std::vector<Vec3> m_corners;
  };
  const MadeUp method([](const scene::RunRequest&) { return std::make_unique<Cube>(); },
                      [](const scene::RunRequest&, scene::Result& result) {
                        const Cube cube;
                        for (const Vec3& X : cube.positions()) {
                          result.samples.X.push_back(X);
                          result.samples.u.push_back(Vec3(-X[1], 1.01 * X[0], X[2]) - X);
                          result.samples.weight.push_back(1);
                        }
                        result.t_end = 1;
                      });
  const auto q = test::run_probe("rotation", problem, method, {}, {{"turns", "10"}}).quantities;
  // (0.3, 0.6, 0.8) 10 rad/s; stretching and bending carry no spin on eight corners but that of
  // 2 X^2 along Z: none, by symmetry.
  const double speed = 10 * std::sqrt(0.09 + 0.36 + 0.64);
  EXPECT_NEAR(q.at("turns_done"), speed / (2 * M_PI), 1e-6);
  EXPECT_EQ(q.at("finished"), 1);
  EXPECT_NEAR(q.at("shape_change"), 0.01 / std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(q.at("nonaffine"), 0, 1e-12);
  // A run that dies has no drifts: nothing that could pass for perfect.
  const MadeUp dies([](const scene::RunRequest&) { return std::make_unique<Cube>(); },
                    [](const scene::RunRequest&, scene::Result& result) {
                      result.invariants["angular_momentum_drift"] = 0;
                      result.t_end = 1;
                      throw SolveError("det F", 7, 1, 3);
                    });
  const scene::Result dead = test::run_probe("rotation", problem, dies, {}, {{"turns", "10"}});
  EXPECT_NEAR(dead.quantities.at("finished"), speed / (2 * M_PI) / 10, 1e-6);
  EXPECT_FALSE(dead.quantities.contains("angular_momentum_drift"));
  EXPECT_FALSE(dead.quantities.contains("nonaffine"));
  EXPECT_TRUE(dead.notes.contains("not_measured"));
}

}  // namespace
}  // namespace concord::probes
