// Runs of the Voronoi method on bodies with moving walls, tractions and layers of one particle:
// the energy balance closes, the step follows the deformation, what is not defined is left out.

#include "particle/core/leapfrog.hpp"
#include "tests/property/bodies.hpp"

#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace concord::particle::test {
namespace {

using Settings = std::map<std::string, std::string>;

/// A slab lx x ly x lz of hexahedra, and a strip lx x ly in the plane; faces x0 to z1.
constexpr const char* slab = R"(
DefineConstant[ h = 0.25, structured = 1, lx = 1, ly = 1, lz = 0.5 ];
Point(1) = {0, 0, 0, h}; Point(2) = {lx, 0, 0, h}; Point(3) = {lx, ly, 0, h}; Point(4) = {0, ly, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = Max(1, Round(lx/h)) + 1; Transfinite Curve {2, 4} = Max(1, Round(ly/h)) + 1;
Transfinite Surface {1}; Recombine Surface {1};
o[] = Extrude {0, 0, lz} { Surface{1}; Layers{Max(1, Round(lz/h))}; Recombine; };
Physical Surface("z0") = {1}; Physical Surface("z1") = {o[0]}; Physical Surface("y0") = {o[2]};
Physical Surface("x1") = {o[3]}; Physical Surface("y1") = {o[4]}; Physical Surface("x0") = {o[5]};
Physical Volume("body") = {o[1]};
)";
constexpr const char* strip = R"(
DefineConstant[ h = 0.25, structured = 1, lx = 1, ly = 1 ];
Point(1) = {0, 0, 0, h}; Point(2) = {lx, 0, 0, h}; Point(3) = {lx, ly, 0, h}; Point(4) = {0, ly, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = Max(1, Round(lx/h)) + 1; Transfinite Curve {2, 4} = Max(1, Round(ly/h)) + 1;
Transfinite Surface {1};
Physical Curve("y0") = {1}; Physical Curve("x1") = {2}; Physical Curve("y1") = {3}; Physical Curve("x0") = {4};
Physical Surface("body") = {1};
)";

/// A scene on one of them: keys of the top, [[boundary]] entries.
struct Files {
  std::filesystem::path folder;

  Files(const std::string& geometry, const std::string& dimension, const std::string& keys,
        const std::string& boundaries)
      : folder(std::filesystem::temp_directory_path() /
               ("concord_voronoi_runs_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "body.geo") << geometry;
    std::ofstream(folder / "scene.toml")
        << "title = \"Body\"\nsource = \"test\"\ngeometry = \"body.geo\"\n"
        << "reference_length = \"1 m\"\ndimension = \"" << dimension << "\"\n"
        << keys
        << "\n[material]\nmodel = \"neo-hookean\"\ndensity = \"1000 kg/m^3\"\n"
           "youngs_modulus = \"1 MPa\"\npoissons_ratio = 0.3\n"
        << boundaries << "[output]\nframes = 0\nhistory_rows = 50\n";
  }
  ~Files() { std::filesystem::remove_all(folder); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  scene::Problem problem(const std::vector<scene::Override>& set = {}) const {
    return scene::read_problem((folder / "scene.toml").string(), set);
  }
  scene::Result run(const Settings& settings, double resolution, double perturb = 0.25,
                    const std::vector<scene::Override>& set = {}) const {
    const scene::Problem p = problem(set);
    scene::RunRequest request;
    request.h = p.reference_length / resolution;
    request.perturb = perturb;
    request.seed = 3;
    request.settings = settings;
    request.out = folder;
    request.write_frames = false;
    scene::Result result;
    scene::MethodRegistry::instance().find("voronoi").run(p, request, result);
    return result;
  }
};

std::string boundary(const std::string& group, const std::string& kind,
                     const std::string& value = "") {
  return "[[boundary]]\ngroup = \"" + group + "\"\nkind = \"" + kind + "\"\n" +
         (value.empty() ? "" : "value = " + value + "\n");
}

/// Largest |energy balance| at steps dt, dt/2, dt/4, relative.
std::array<double, 3> drifts(const Files& files, double dt, Settings settings) {
  std::array<double, 3> drift{};
  for (double& d : drift) {
    settings["dt"] = std::to_string(dt);
    d = files.run(settings, 4).invariants.at("energy_drift");
    dt /= 2;
  }
  return drift;
}

/// The work of walls that move and of tractions on cells' faces is what the body gets.
TEST(VoronoiRuns, BalanceWithMovingWallsAndTractionsClosesToSecondOrder) {
  const Files files(
      slab, "3D", "end_time = \"0.05 s\"",
      boundary("x0", "displacement", R"v(["-0.05*sin(60*t)", "0.1*t*Y", "0.5*t"])v") +
          boundary("x1", "traction", R"v(["1e4*sin(100*t)", "0", "4e4*t"])v"));
  const auto drift = drifts(files, 1e-3, {});
  EXPECT_LT(drift[0], 2e-2);
  EXPECT_NEAR(drift[0] / drift[1], 4, 1);
  EXPECT_NEAR(drift[1] / drift[2], 4, 1);
}

TEST(VoronoiRuns, BalanceInThePlaneWithBodyForcesAndViscosityClosesToSecondOrder) {
  const Files files(
      strip, "plane strain",
      "end_time = \"0.05 s\"\ngravity = [\"3 m/s^2\", \"-9.81 m/s^2\", \"0 m/s^2\"]",
      boundary("x0", "displacement", R"v(["0.03*sin(60*t)", "0.4*t*Y"])v") +
          boundary("y1", "traction", R"v(["2e4*sin(100*t)", "1e4"])v") +
          "[body_force]\nvalue = [\"2e4*Y\", \"1e4*sin(80*t)\", \"0\"]\n");
  for (const Settings& losses : {Settings{}, Settings{{"c1", "0.3"}, {"damping", "5"}}}) {
    const auto drift = drifts(files, 1e-3, losses);
    EXPECT_LT(drift[0], 2e-2);
    EXPECT_NEAR(drift[0] / drift[1], 4, 1);
    EXPECT_NEAR(drift[1] / drift[2], 4, 1);
  }
}

/// One layer between planes of symmetry, pressed together by a wall: no simplex tells that the
/// cells become small.
Files pressed_layer() {
  return {slab, "3D", "end_time = \"0.5 s\"\n[parameters]\nlz = \"0.125 m\"",
          boundary("x0", "displacement", R"v(["1.4*t", "0", "0"])v") + boundary("x1", "fixed") +
              boundary("z0", "symmetric") + boundary("z1", "symmetric")};
}

TEST(VoronoiRuns, StepFollowsTheDeformationOfALayer) {
  const Files files = pressed_layer();
  const Variant variant{"voronoi", "voronoi", {}};
  const scene::Problem problem = files.problem();
  const Body body = Bench::particles(variant, problem, 8, 0, 1);
  ASSERT_TRUE(body.triangulation.simplices.empty());
  const Executor executor(1);
  const auto model = Bench::method_of(variant).make_model(
      body, problem, Bench::settings_of(variant), executor);
  const Constraints constraints(problem, body);
  const ExternalLoads loads(problem, *model);
  Recorder recorder(problem, *model, constraints, executor, {}, false);
  Leapfrog leapfrog(problem, *model, constraints, loads, executor);
  LeapfrogOptions options;
  options.end_time = problem.end_time;
  LeapfrogOutcome outcome;
  leapfrog.run(options, recorder, outcome);
  const State state = leapfrog.state();
  SpectralRadius spectrum(*model, constraints, executor);
  const double first = 2 / spectrum.omega_max(Column(body.X.size(), 0.0)),
               last = 2 / spectrum.omega_max(state.u);
  EXPECT_LT(last, 0.8 * first);
  EXPECT_LT(outcome.dt, last);
}

TEST(VoronoiRuns, HourglassNumbersOfALayerAreLeftOut) {
  const Files files = pressed_layer();
  const auto q = files.run({{"dt_factor", "0.3"}}, 8, 0).quantities;
  for (const auto& [name, value] : q) {
    EXPECT_EQ(name.find("checkerboard"), std::string::npos) << name;
    EXPECT_EQ(name.find("nonaffine"), std::string::npos) << name;
  }
  std::string columns;
  std::ifstream history(files.folder / "history.csv");
  std::getline(history, columns);
  EXPECT_NE(columns.find("energy_balance_J"), std::string::npos);
  EXPECT_EQ(columns.find("checkerboard"), std::string::npos);
  EXPECT_EQ(columns.find("nonaffine"), std::string::npos);
}

/// gmsh divides this geometry into hexahedra alone, so that simplices cannot stand in.
TEST(VoronoiRuns, ContradictionsAreToldAsSuch) {
  const Files files(slab, "3D", "end_time = \"0.05 s\"",
                    boundary("body", "displacement", R"v(["free", "free", "0.1*Z + 0.1"])v") +
                        boundary("x0", "fixed"));
  try {
    files.run({}, 4);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.key(), "group");
    EXPECT_NE(e.found().find("u_3"), std::string::npos) << e.what();
    EXPECT_NE(e.found().find("x0"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace concord::particle::test
