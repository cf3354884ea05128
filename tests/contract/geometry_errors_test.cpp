// Groups that are missing or unsuitable, geometries that gmsh cannot read or mesh.

#include "scene/geometry.hpp"
#include "tests/contract/expect_input_error.hpp"

using namespace concord;
using namespace concord::test;

namespace {

scene::MeshRequest request(double h = 0.25) {
  return {h, scene::CellShape::simplex, 1, scene::Layout::lattice};
}

void expect_mesh_error(const std::string& text, const Expected& expected,
                       const std::string& geo = square_geo) {
  const ScratchScene scratch(text, geo);
  expect_input_error(text, expected, [&] { (void)make_mesh(scratch.read(), request()); });
}

std::string boundary(const std::string& group, const std::string& rest) {
  return "[[boundary]]\ngroup = \"" + group + "\"\n" + rest;
}

}  // namespace

TEST(Geometry, MissingGroupListsTheGroups) {
  expect_mesh_error(plane_scene(boundary("x9", "kind = \"fixed\"\n")),
                    {"\"x9\"", "group", "\"x9\"", "body | corner | x0 | x1 | y0 | y1"});
  expect_mesh_error(plane_scene("[[quantity]]\nname = \"r\"\nkind = \"reaction\"\n"
                                "group = \"left\"\n"),
                    {"\"left\"", "group", "\"left\"", "x0"});
}

TEST(Geometry, UnsuitableGroups) {
  expect_mesh_error(
      plane_scene(boundary("corner", "kind = \"traction\"\nvalue = [\"1\", \"0\"]\n")),
      {"\"corner\"", "group", "a group of points", "a group of curves"});
  expect_mesh_error(plane_scene(boundary("body", "kind = \"symmetric\"\n")),
                    {"\"body\"", "group", "not normal to one axis", "plane curves"});
}

TEST(Geometry, ConditionsThatDisagreeWhereTheyMeet) {
  const std::string moved =
      boundary("y1", "kind = \"displacement\"\nvalue = [\"0\", \"1e-3*t\"]\n");
  expect_mesh_error(plane_scene(boundary("x0", "kind = \"fixed\"\n") + moved),
                    {"\"y1\"", "group", "u_2", "agree where their groups meet"});
  const ScratchScene agree(plane_scene(boundary("x0", "kind = \"symmetric\"\n") + moved));
  EXPECT_NO_THROW(make_mesh(agree.read(), request()));
}

TEST(Geometry, TractionAgainstASymmetryPlane) {
  const std::string plane = boundary("x0", "kind = \"symmetric\"\n");
  const std::string push = boundary("x0", "kind = \"traction\"\nvalue = [\"1\", \"0\"]\n");
  const std::string slide = boundary("x0", "kind = \"traction\"\nvalue = [\"0\", \"1\"]\n");
  expect_mesh_error(plane_scene(plane + push),
                    {"\"x0\"\nkind = \"traction\"", "group", "direction 1", "one of the two"});
  EXPECT_NO_THROW(make_mesh(ScratchScene(plane_scene(plane + slide)).read(), request()));
}

TEST(Geometry, SyntaxErrorHasTheGeosOwnLine) {
  const ScratchScene scratch(plane_scene(), "Point(1) = {0, 0, 0, h};\nPont(2) = {1, 2;\n");
  try {
    (void)make_mesh(scratch.read(), request());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.where().file.find("body.geo"), std::string::npos) << error.what();
    EXPECT_EQ(error.where().line, 2) << error.what();
  }
}

TEST(Geometry, NothingToMesh) {
  expect_mesh_error(plane_scene(),
                    {"\"body.geo\"", "geometry", "no 2-dimensional body", "surface"},
                    "Point(1) = {0, 0, 0, 1};\n");
  expect_mesh_error(plane_scene(), {"\"body.geo\"", "geometry", "gmsh cannot", ""},
                    "Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h};\nLine(1) = {1, 2};\n"
                    "Curve Loop(1) = {1, 7}; Plane Surface(1) = {1};\n");
}

TEST(Geometry, PlaneBodyOffItsPlane) {
  std::string geo = square_geo;
  for (std::size_t at = 0; (at = geo.find(", 0, h}", at)) != std::string::npos; ++at)
    geo.replace(at, 7, ", 2, h}");
  expect_mesh_error(plane_scene(), {"\"body.geo\"", "geometry", "Z = 2", "Z = 0"}, geo);
}

TEST(Geometry, LatticeOfHypercubesNeedsTransfiniteSurfaces) {
  const std::string text = plane_scene();
  const ScratchScene scratch(text, R"(
DefineConstant[ h = 0.25, structured = 1 ];
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Mesh.RecombinationAlgorithm = 0;
)");
  expect_input_error(text, {"\"body.geo\"", "geometry", "type 2", "transfinite"}, [&] {
    (void)make_mesh(scratch.read(),
                    {0.4, scene::CellShape::hypercube, 1, scene::Layout::lattice});
  });
}

TEST(Geometry, ResolutionMustBePositive) {
  const ScratchScene scratch(plane_scene());
  const scene::Problem problem = scratch.read();
  for (const double h : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    expect_input_error("", {"", "resolution", "spacing", "positive"},
                       [&] { (void)make_mesh(problem, request(h)); });
}
