// The Continuum Bond Method literally from its paper against the kernels it runs on, and gmsh's
// cells as triangulation.

#include "particle/core/particle_method.hpp"
#include "particle/delaunay/bonds.hpp"
#include "scene/reader.hpp"

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <numeric>

#include <map>
#include <random>

namespace concord::particle {
namespace {

using Mat2 = Eigen::Matrix2d;
using Vec2 = Eigen::Vector2d;

/// Bond vectors zeta_ip by (5), (7), (9) and volumes (1), per thickness.
struct BondVectors {
  std::map<std::pair<Index, Index>, Vec2> zeta;
  std::vector<double> Omega;

  explicit BondVectors(const Body& body) : Omega(body.n, 0.0) {
    const Triangulation& t = body.triangulation;
    for (std::size_t s = 0; s < t.size(); ++s) {
      for (int k = 0; k < 3; ++k) {
        const Index i = t.simplices[3 * s + k], alpha = t.simplices[3 * s + (k + 1) % 3],
                    beta = t.simplices[3 * s + (k + 2) % 3];
        Omega[i] += body.simplex_volume(s) / 3;  // (1)
        const Vec2 X_a = (body.position(alpha) - body.position(i)).head<2>(),
                   X_b = (body.position(beta) - body.position(i)).head<2>();
        const Mat2 X = X_a * X_a.transpose() + X_b * X_b.transpose();  // (5)
        for (const auto& [p, X_ip] : {std::pair{alpha, X_a}, std::pair{beta, X_b}}) {
          Vec2& sum = zeta.try_emplace({i, p}, Vec2::Zero()).first->second;
          sum += body.simplex_volume(s) / 3 * (X.inverse() * X_ip);  // (7), (9)
        }
      }
    }
  }
};

scene::Problem bar() { return scene::read_problem("tensile_bar"); }

TEST(ContinuumBondMethod, BondVectorsAreTheGradientVectors) {
  const scene::Problem problem = bar();
  const Body body = make_body(problem, 2e-3, 0, 1, CellSource::mesh);
  const BondVectors bonds(body);
  const double scale = 2e-3;
  std::size_t directed = 0;
  for (const delaunay::Bond& bond : delaunay::gradient_vectors(body)) {
    const Vec2 ab = bond.B_ab.head<2>() / body.thickness,
               ba = bond.B_ba.head<2>() / body.thickness;
    EXPECT_LT((bonds.zeta.at({bond.a, bond.b}) - ab).norm(), 1e-13 * scale);
    EXPECT_LT((bonds.zeta.at({bond.b, bond.a}) - ba).norm(), 1e-13 * scale);
    directed += 2;
  }
  EXPECT_EQ(directed, bonds.zeta.size());
  for (Index a = 0; a < body.n; ++a)
    EXPECT_NEAR(bonds.Omega[a] * body.thickness, body.V[a], 1e-13 * body.V[a]);
}

TEST(ContinuumBondMethod, ForcesAreThoseOfThePaper) {
  const scene::Problem problem = bar();
  const auto& method =
      dynamic_cast<const ParticleMethod&>(scene::MethodRegistry::instance().find("cbm"));
  const scene::Settings settings("cbm", method.info().parameters);
  ASSERT_EQ(method.cells(settings), CellSource::mesh);
  const Body body = make_body(problem, 2e-3, 0, 1, method.cells(settings));
  const Executor executor(1);
  const auto model = method.make_model(body, problem, settings, executor);
  Column u(body.X.size(), 0.0), f = u;
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < 2; ++i) {
      const std::size_t k = static_cast<std::size_t>(a) * body.stride + i;
      u[k] = 0.05 * body.X[k] + 0.03 * 2e-3 * uniform(generator);
    }
  }
  model->forces(u, {}, f, executor);

  const BondVectors bonds(body);
  const auto x = [&](Index a) {
    return Vec2(body.position(a).head<2>() + Eigen::Map<const Vec2>(&u[a * body.stride]));
  };
  std::vector<Mat2> F(body.n, Mat2::Zero());
  for (const auto& [pair, zeta] : bonds.zeta)  // (8)
    F[pair.first] +=
        (x(pair.second) - x(pair.first)) * zeta.transpose() / bonds.Omega[pair.first];
  std::vector<Mat3> P;
  const J2Hencky law(problem.material);
  for (Index a = 0; a < body.n; ++a) {
    Mat3 H = Mat3::Zero();
    H.topLeftCorner<2, 2>() = F[a] - Mat2::Identity();
    P.push_back(law.update(H, {}).P);
  }
  std::vector<Vec2> expected(body.n, Vec2::Zero());
  for (const auto& [pair, zeta] : bonds.zeta) {  // -(18), (19)
    const auto [i, p] = pair;
    const Vec2 from_i = P[i].topLeftCorner<2, 2>() * zeta;
    const Vec2 from_p = P[p].topLeftCorner<2, 2>() * bonds.zeta.at({p, i});
    expected[i] += from_i - from_p;
  }
  double error = 0, scale = 0;
  for (Index a = 0; a < body.n; ++a) {
    const Vec2 f_a = Eigen::Map<const Vec2>(&f[a * body.stride]) / body.thickness;
    error = std::max(error, (f_a - expected[a]).norm());
    scale = std::max(scale, expected[a].norm());
  }
  EXPECT_LT(error, 1e-11 * scale);
}

TEST(MeshTriangulation, IsTheMeshAndFillsTheBody) {
  const scene::Problem problem =
      scene::read_problem("tensile_bar", {{"parameters.neck_mesh", "2"}});
  const Body mesh = make_body(problem, 1e-3, 0, 1, CellSource::mesh),
             delaunay = make_body(problem, 1e-3, 0, 1);
  EXPECT_EQ(mesh.triangulation.size(), mesh.mesh.cell_count());
  double V[2] = {0, 0};
  for (Index a = 0; a < mesh.n; ++a) V[0] += mesh.V[a], V[1] += delaunay.V[a];
  EXPECT_NEAR(V[0], scene::mesh_volume(mesh.mesh) * problem.thickness, 1e-12 * V[0]);
  EXPECT_NEAR(V[0], V[1], 1e-12 * V[0]);
  EXPECT_EQ(mesh.triangulation.on_boundary, delaunay.triangulation.on_boundary);
  // The same area vectors on the boundary, in sum zero.
  Vec3 closed = Vec3::Zero();
  for (std::size_t k = 0; k + 1 < mesh.triangulation.boundary.size(); k += 2)
    closed += mesh.position(mesh.triangulation.boundary[k + 1]) -
              mesh.position(mesh.triangulation.boundary[k]);
  EXPECT_LT(closed.norm(), 1e-15);
}

TEST(MeshTriangulation, RefusesInvertedCells) {
  const scene::Problem problem = bar();
  scene::MeshRequest request;
  request.h = 2e-3;
  request.layout = problem.layout;
  scene::Mesh mesh = scene::make_mesh(problem, request);
  std::swap(mesh.cells[0], mesh.cells[1]);
  std::vector<Index> number(mesh.nodes.size());
  std::iota(number.begin(), number.end(), 0);
  EXPECT_THROW((void)mesh_triangulation(mesh, problem, number), InputError);
}

}  // namespace
}  // namespace concord::particle
