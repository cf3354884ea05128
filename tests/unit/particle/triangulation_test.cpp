// Triangulations of convex and non-convex bodies: volumes add up, the boundary is reproduced,
// else a clear error.

#include "particle/core/body.hpp"
#include "scene/errors.hpp"
#include "scene/reader.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace concord::particle {
namespace {

/// A scene on a geometry of the test's own.
scene::Problem problem_on(const std::string& geo, const std::string& dimension) {
  const auto folder = std::filesystem::path(testing::TempDir()) /
                      testing::UnitTest::GetInstance()->current_test_info()->name();
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "body.geo") << geo;
  std::ofstream(folder / "scene.toml")
      << "title = \"t\"\nsource = \"test\"\ndimension = \"" << dimension
      << "\"\ngeometry = \"body.geo\"\nreference_length = \"1 m\"\nend_time = \"1 s\"\n"
         "layout = \"unstructured\"\n"
         "[material]\nmodel = \"neo-hookean\"\ndensity = \"1 kg/m^3\"\n"
         "youngs_modulus = \"1 Pa\"\npoissons_ratio = 0.3\n";
  return scene::read_problem((folder / "scene.toml").string());
}

const char* l_shape = R"(DefineConstant[ h = 0.2 ];
Point(1) = {0, 0, 0, h}; Point(2) = {2, 0, 0, h}; Point(3) = {2, 1, 0, h};
Point(4) = {1, 1, 0, h}; Point(5) = {1, 2, 0, h}; Point(6) = {0, 2, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};
)";

double volume(const Body& body) {
  double v = 0;
  for (std::size_t s = 0; s < body.triangulation.size(); ++s) v += body.simplex_volume(s);
  return v;
}

TEST(Triangulation, FillsANonConvexPlaneBody) {
  const scene::Problem problem =
      problem_on(std::string(l_shape) + "Physical Surface(\"body\") = {1};", "plane strain");
  const Body body = make_body(problem, 0.2, 0.2, 4);
  EXPECT_NEAR(volume(body), 3.0, 1e-12);
  double V = 0;
  for (const double v : body.V) V += v;
  EXPECT_NEAR(V, 3.0, 1e-12);
}

TEST(Triangulation, FillsANonConvexSolidAndKeepsItsFaces) {
  const std::string geo =
      std::string(l_shape) +
      "out[] = Extrude {0, 0, 0.6} { Surface{1}; };\n"
      "Physical Volume(\"body\") = {out[1]};\nPhysical Surface(\"bottom\") = {1};\n";
  const scene::Problem problem = problem_on(geo, "3D");
  const Body body = make_body(problem, 0.2, 0.1, 4);
  EXPECT_NEAR(volume(body), 1.8, 1e-11);
  // Every particle of the surface mesh is on the triangulation's boundary and the other way
  // round.
  std::vector<char> on(body.n, 0);
  for (const Index node : body.mesh.facets) on[body.particle[node]] = 1;
  for (Index a = 0; a < body.n; ++a) EXPECT_EQ(on[a], body.triangulation.on_boundary[a]);
  // Boundary facets are filed under the face they lie on.
  const Triangulation& t = body.triangulation;
  double bottom = 0;
  for (std::size_t f = 0; f < t.boundary_entity.size(); ++f) {
    const Vec3 a = body.position(t.boundary[3 * f]), b = body.position(t.boundary[3 * f + 1]),
               c = body.position(t.boundary[3 * f + 2]);
    const auto& group = body.mesh.groups.at("bottom").entities;
    if (std::find(group.begin(), group.end(), t.boundary_entity[f]) == group.end()) continue;
    EXPECT_EQ(a[2] + b[2] + c[2], 0);
    bottom += 0.5 * (b - a).cross(c - a).norm();
  }
  EXPECT_NEAR(bottom, 3.0, 1e-12);
}

TEST(Triangulation, FillsASolidWithAGrooveAHoleAndCurvedFaces) {
  // A U with a round hole through its web: outside are the groove, at whose mouth cells of
  // surface particles meet no others, and the hole.
  const std::string geo = R"(DefineConstant[ h = 0.2 ];
Point(1) = {0, 0, 0, h}; Point(2) = {3, 0, 0, h}; Point(3) = {3, 3, 0, h}; Point(4) = {2, 3, 0, h};
Point(5) = {2, 1.5, 0, h}; Point(6) = {1, 1.5, 0, h}; Point(7) = {1, 3, 0, h}; Point(8) = {0, 3, 0, h};
For k In {1:8}
  Line(k) = {k, k % 8 + 1};
EndFor
Point(20) = {1.5, 0.75, 0}; Point(21) = {1.9, 0.75, 0, h}; Point(22) = {1.5, 1.15, 0, h};
Point(23) = {1.1, 0.75, 0, h}; Point(24) = {1.5, 0.35, 0, h};
Circle(21) = {21, 20, 22}; Circle(22) = {22, 20, 23}; Circle(23) = {23, 20, 24}; Circle(24) = {24, 20, 21};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8}; Curve Loop(2) = {21, 22, 23, 24};
Plane Surface(1) = {1, 2};
out[] = Extrude {0, 0, 0.6} { Surface{1}; };
Physical Volume("body") = {out[1]};
)";
  const scene::Problem problem = problem_on(geo, "3D");
  const Body body = make_body(problem, 0.2, 0.05, 4);
  const double expected = (9 - 1.5 - M_PI * 0.16) * 0.6;  // less what the chords cut off: 2 %
  EXPECT_NEAR(volume(body), expected, 0.02 * expected);
  const Body threaded = make_body(problem, 0.2, 0.05, 4, CellSource::delaunay, Executor(3));
  EXPECT_EQ(threaded.triangulation.simplices, body.triangulation.simplices);
  EXPECT_EQ(threaded.triangulation.boundary, body.triangulation.boundary);
  EXPECT_EQ(threaded.V, body.V);
}

TEST(Triangulation, RefusesABodyThatItsParticlesDoNotResolve) {
  // A slot much narrower than the spacing along its sides: the Delaunay triangulation crosses
  // it.
  const std::string geo = R"(DefineConstant[ h = 0.5 ];
Point(1) = {0, 0, 0, h}; Point(2) = {2, 0, 0, h}; Point(3) = {2, 1, 0, h}; Point(4) = {0.1, 1, 0, h};
Point(5) = {0.1, 1.02, 0, h}; Point(6) = {2, 1.02, 0, h}; Point(7) = {2, 2, 0, h}; Point(8) = {0, 2, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8};
Line(8) = {8, 1}; Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8}; Plane Surface(1) = {1};
Transfinite Curve {3} = 4; Transfinite Curve {5} = 6;
Physical Surface("body") = {1};
)";
  const scene::Problem problem = problem_on(geo, "plane strain");
  try {
    (void)make_body(problem, 0.5, 0, 1);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.key(), "geometry");
    EXPECT_NE(e.allowed().find("more particles"), std::string::npos);
  }
}

TEST(SweepOrder, GoesPlaneByPlaneAlongTheLongestAxis) {
  const scene::Problem problem =
      scene::read_problem("spinning_block", {{"parameters.B", "3 m"}});
  const Body body = make_body(problem, 0.25, 0.2, 4);
  for (Index a = 1; a < body.n; ++a) {
    EXPECT_GE(body.position(a)[1], body.position(a - 1)[1] - 0.6 * body.h);
  }
}

}  // namespace
}  // namespace concord::particle
