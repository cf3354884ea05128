#pragma once
// Bodies with plane walls for the tests of Voronoi cells, and particles inside them.

#include "particle/voronoi/cells.hpp"
#include "particle/voronoi/placement.hpp"
#include "scene/errors.hpp"
#include "scene/reader.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace concord::particle::voronoi::test {

/// A scene on a geometry of the test's own.
inline scene::Problem problem_on(const std::string& geo, const std::string& dimension,
                                 const std::string& layout = "unstructured") {
  static int count = 0;
  const auto folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("cells_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
       std::to_string(count++));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "body.geo") << geo;
  std::ofstream(folder / "scene.toml")
      << "title = \"t\"\nsource = \"test\"\ndimension = \"" << dimension
      << "\"\ngeometry = \"body.geo\"\nreference_length = \"1 m\"\nend_time = \"1 s\"\nlayout "
         "= \""
      << layout
      << "\"\n[material]\nmodel = \"neo-hookean\"\ndensity = \"1 kg/m^3\"\n"
         "youngs_modulus = \"1 Pa\"\npoissons_ratio = 0.3\n";
  return scene::read_problem((folder / "scene.toml").string());
}

inline scene::Mesh surface_of(const scene::Problem& problem, double h) {
  return scene::make_mesh(problem, {h, scene::CellShape::simplex, 1, problem.layout});
}

/// Outline in the plane, corners counter-clockwise; structured: one transfinite surface if it
/// has four corners.
inline std::string outline(const std::vector<std::array<double, 2>>& corners) {
  std::string geo = "DefineConstant[ h = 0.2, structured = 1 ];\n", loop;
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
    geo += "Point(" + std::to_string(i + 1) + ") = {" + std::to_string(corners[i][0]) + ", " +
           std::to_string(corners[i][1]) + ", 0, h};\n";
  for (std::size_t i = 0; i < n; ++i) {
    geo += "Line(" + std::to_string(i + 1) + ") = {" + std::to_string(i + 1) + ", " +
           std::to_string((i + 1) % n + 1) + "};\n";
    loop += (i ? ", " : "") + std::to_string(i + 1);
  }
  geo += "Curve Loop(1) = {" + loop + "};\nPlane Surface(1) = {1};\n";
  return geo;
}

inline std::string plane(const std::string& geo) {
  return geo + "Physical Surface(\"body\") = {1};\n";
}

inline std::string prism(const std::string& geo, double height) {
  return geo + "out[] = Extrude {0, 0, " + std::to_string(height) +
         "} { Surface{1}; };\nPhysical Volume(\"body\") = {out[1]};\n"
         "Physical Surface(\"bottom\") = {1};\n";
}

/// Three unit blocks around a re-entrant edge at (1, 1), structured; solid: 1 m high.
inline std::string l_block(bool solid) {
  const std::string base = R"(DefineConstant[ h = 0.25, structured = 1 ];
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {2, 0, 0, h};
Point(4) = {0, 1, 0, h}; Point(5) = {1, 1, 0, h}; Point(6) = {2, 1, 0, h};
Point(7) = {0, 2, 0, h}; Point(8) = {1, 2, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {4, 5}; Line(4) = {5, 6}; Line(5) = {7, 8};
Line(6) = {1, 4}; Line(7) = {2, 5}; Line(8) = {3, 6}; Line(9) = {4, 7}; Line(10) = {5, 8};
Curve Loop(1) = {1, 7, -3, -6}; Curve Loop(2) = {2, 8, -4, -7}; Curve Loop(3) = {3, 10, -5, -9};
Plane Surface(1) = {1}; Plane Surface(2) = {2}; Plane Surface(3) = {3};
)";
  const std::string rest = solid ? "out[] = Extrude {0, 0, 1} { Surface{1, 2, 3}; };\n"
                                   "Physical Volume(\"body\") = {out[1], out[7], out[13]};\n"
                                   "Transfinite Volume \"*\";\n"
                                 : "Physical Surface(\"body\") = {1, 2, 3};\n";
  return base + rest +
         "Transfinite Curve \"*\" = Round(1/h) + 1;\nTransfinite Surface \"*\";\n";
}

inline std::string box(double A, double B, double C) {
  return prism(outline({{0, 0}, {A, 0}, {A, B}, {0, B}}), C);
}

/// Uniform random points between two corners.
inline std::vector<Vec3> random_points(int n, int dim, const Vec3& lower, const Vec3& upper,
                                       std::uint64_t seed) {
  std::vector<Vec3> X(static_cast<std::size_t>(n), lower);
  for (std::size_t a = 0; a < X.size(); ++a)
    for (int k = 0; k < dim; ++k)
      X[a][k] += (upper[k] - lower[k]) * scene::uniform_random(seed, a, k);
  return X;
}

/// Outward unit normal, branch vector X_ab and length L_ab of a face seen from a or b.
struct Side {
  Vec3 N, branch;
  double L;
};
inline Side side_of(const Cells& cells, const Face& face, std::span<const Vec3> X,
                    bool from_b = false) {
  Side s;
  if (face.wall >= 0) {
    const Wall& wall = cells.walls[face.wall];
    s.branch = 2 * (wall.offset - wall.N.dot(X[face.a])) * wall.N;
  } else {
    s.branch = from_b ? X[face.a] - X[face.b] : X[face.b] - X[face.a];
  }
  s.L = s.branch.norm();
  s.N = face.wall >= 0 ? cells.walls[face.wall].N : Vec3(s.branch / s.L);
  return s;
}

/// Closure, (8), (12) and (13) for every cell, volumes against the body's, walls against the
/// mesh's entities; bounds relative to the cell's own size.
inline void expect_identities(const scene::Mesh& mesh, const Cells& cells,
                              std::span<const Vec3> X, double bound = 1e-12) {
  const std::size_t n = X.size();
  std::vector<Vec3> closed(n, Vec3::Zero()), out(n, Vec3::Zero()), in(n, Vec3::Zero());
  std::vector<Mat3> dual(n, Mat3::Zero());
  std::vector<double> surface(n, 0);
  std::vector<double> wall_area(mesh.entities.size(), 0), entity_area(mesh.entities.size(), 0);
  const auto add = [&](Index a, const Face& face, bool from_b) {
    const Side s = side_of(cells, face, X, from_b);
    const Vec3 B = face.A / s.L * (face.C - X[a]);                       // B_ab
    const Vec3 B_back = face.A / s.L * (face.C - X[a] - s.branch);       // B_ba
    EXPECT_NEAR((B - B_back - face.A * s.N).norm(), 0, bound * face.A);  // (11)
    closed[a] += face.A * s.N;
    dual[a] += s.branch * B.transpose();
    out[a] += B;
    in[a] += B_back;
    surface[a] += face.A;
  };
  for (const Face& face : cells.faces) {
    EXPECT_GT(face.A, 0);
    add(face.a, face, false);
    if (face.b >= 0) add(face.b, face, true);
    if (face.wall >= 0) wall_area[cells.walls[face.wall].entity] += face.A;
  }
  double volume = 0;
  for (std::size_t a = 0; a < n; ++a) {
    volume += cells.V[a];
    const double size = surface[a] * std::cbrt(cells.V[a]);
    EXPECT_GT(cells.V[a], 0);
    EXPECT_LT(closed[a].norm(), bound * surface[a]) << a;
    EXPECT_LT((out[a] - in[a]).norm(), 2 * bound * surface[a]) << a;
    Mat3 identity = cells.V[a] * Mat3::Identity();
    if (cells.dim == 2) identity(2, 2) = 0;
    EXPECT_LT((dual[a] - identity).norm(), bound * size) << a << "\n" << dual[a] - identity;
  }
  EXPECT_NEAR(volume / (scene::mesh_volume(mesh) * cells.thickness), 1, bound);
  const auto nodes = static_cast<std::size_t>(mesh.nodes_per_facet);
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    const Index* v = &mesh.facets[f * nodes];
    Vec3 area = (mesh.nodes[v[1]] - mesh.nodes[v[0]]) * cells.thickness;
    if (mesh.dim == 3)
      area = 0.5 *
             (mesh.nodes[v[1]] - mesh.nodes[v[0]]).cross(mesh.nodes[v[2]] - mesh.nodes[v[0]]);
    entity_area[mesh.facet_entity[f]] += area.norm();
  }
  for (std::size_t e = 0; e < entity_area.size(); ++e)
    EXPECT_NEAR(wall_area[e], entity_area[e], bound * (1 + entity_area[e])) << "entity " << e;
}

}  // namespace concord::particle::voronoi::test
