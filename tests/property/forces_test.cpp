// Properties of the forces of every registered particle method.

#include "tests/property/bodies.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstring>

namespace concord::particle::test {
namespace {

INSTANTIATE_TEST_SUITE_P(Registered, EveryMethod, testing::ValuesIn(variants()), variant_name);

/// Scale of forces that strains of order one would make.
double force_scale(const Bench& b) {
  return b.problem.material.E * b.body.h * b.body.h * std::sqrt(b.body.n);
}

TEST_P(EveryMethod, RigidMotionGivesNoForce) {
  Bench b(GetParam(), "spinning_block", 5);
  const Mat3 R = Eigen::AngleAxisd(2.0, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  const Column u = b.column([&](Index a) {
    return Vec3((R - Mat3::Identity()) * b.body.position(a) + Vec3(3, -2, 1));
  });
  EXPECT_LT(norm(b.force(u)), 1e-13 * force_scale(b));
}

TEST_P(EveryMethod, AffineFieldHasExactGradients) {
  Bench b(GetParam(), "spinning_block", 5);
  Mat3 H;
  H << 0.3, 0.1, -0.2, 0.05, -0.2, 0.15, 0.1, -0.1, 0.25;
  const Column u = b.column([&](Index a) { return Vec3(H * b.body.position(a)); });
  std::vector<Mat3> computed(b.body.bulk);
  b.model->gradients(u, computed);
  for (const Mat3& Ha : computed) EXPECT_LT((Ha - H).norm(), 2e-13);
}

/// Whether free faces have no say in the force on a particle under constant stress: inside the
/// body; where particles lie inside anyway, two spacings from its faces, which act through
/// the neighbours of the outermost.
bool is_interior(const Body& body, Index a) {
  if (!body.inside()) return !body.triangulation.on_boundary[a];
  return std::all_of(body.surface.begin(), body.surface.end(), [&](const SurfacePiece& piece) {
    return piece.N.dot(piece.C - body.position(a)) > 2 * body.h;
  });
}

/// Interior particles are in equilibrium under constant stress where the gradient vectors
/// satisfy the integration constraint (31). Methods that cannot say so, and must then really
/// fail.
TEST_P(EveryMethod, ConstantStressLeavesInteriorInEquilibrium) {
  Bench b(GetParam(), "spinning_block", 7);
  Mat3 H;
  H << 0.02, 0.01, 0, 0.01, -0.01, 0.02, 0, 0.02, 0.03;
  const Column u = b.column([&](Index a) { return Vec3(H * b.body.position(a)); });
  const Column f = b.force(u);
  double interior = 0;
  int count = 0;
  for (Index a = 0; a < b.body.bulk; ++a) {
    if (!is_interior(b.body, a)) continue;
    interior = std::max(interior, b.at(f, a).norm());
    ++count;
  }
  EXPECT_GE(count, 27);
  const double scale = b.problem.material.E * H.norm() * b.body.h * b.body.h;
  if (declares(GetParam(), "equilibrium patch test"))
    EXPECT_GT(interior, 1e-6 * scale) << "declared failure did not happen";
  else
    EXPECT_LT(interior, 1e-12 * scale);
}

TEST_P(EveryMethod, ForcesHaveNoResultantAndNoMoment) {
  Bench b(GetParam(), "spinning_block", 5);
  const Column u = b.random_displacement();
  const Column f = b.force(u);
  Vec3 resultant = Vec3::Zero(), moment = Vec3::Zero();
  double sum = 0;
  for (Index a = 0; a < b.body.n; ++a) {
    resultant += b.at(f, a);
    moment += (b.body.position(a) + b.at(u, a)).cross(b.at(f, a));
    sum += b.at(f, a).norm();
  }
  EXPECT_LT(resultant.norm(), 1e-14 * sum);
  const double scale = sum * b.problem.reference_length;
  if (declares(GetParam(), "angular momentum"))
    EXPECT_GT(moment.norm(), 1e-6 * scale) << "declared failure did not happen";
  else
    EXPECT_LT(moment.norm(), 1e-14 * scale);
}

TEST_P(EveryMethod, ForceIsMinusTheGradientOfTheEnergy) {
  Bench b(GetParam(), "spinning_block", 4);
  const bool potential = b.model->has_potential();
  EXPECT_TRUE(potential || declares(GetParam(), "potential"));
  const Column u = b.random_displacement();
  const Column f = b.force(u);
  const double largest = norm(f);
  double worst = 0;
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 8; ++trial) {
    const Column d = b.column([&](Index) {
      return Vec3(uniform(generator), uniform(generator), uniform(generator));
    });
    double power = 0;
    for (std::size_t k = 0; k < d.size(); ++k) power -= f[k] * d[k];
    // Fourth-order difference: truncation and round-off both near 1e-10 of the force's scale.
    const auto energy = [&](double s) {
      Column v = u;
      for (std::size_t k = 0; k < v.size(); ++k) v[k] += s * d[k];
      const Energies e = b.model->energies(v, b.executor);
      return e.internal + e.stabilisation;
    };
    const double s = 1e-4 * b.body.h;
    const double slope =
        (8 * (energy(s) - energy(-s)) - (energy(2 * s) - energy(-2 * s))) / (12 * s);
    worst = std::max(worst, std::abs(slope - power) / (largest * norm(d)));
  }
  if (potential)
    EXPECT_LT(worst, 1e-9);
  else  // work that no energy accounts for
    EXPECT_GT(worst, 1e-6) << "declared failure did not happen";
}

TEST_P(EveryMethod, TangentIsTheDerivativeOfTheForce) {
  for (const char* scene : {"spinning_block", "cooks_membrane"}) {
    Bench b(GetParam(), scene, 4);
    const Column u = b.random_displacement(0.02);
    const ForceModel::Stiffness K = b.model->tangent(u);
    ASSERT_EQ(K.rows(), b.body.n * b.body.dim);
    if (b.model->has_potential()) {
      EXPECT_LT(asymmetry(K), 1e-12);
    }
    EXPECT_LT(tangent_error(b, K, u, random_direction(b, 17), 1e-5 * b.body.h), 2e-8) << scene;
  }
}

TEST_P(EveryMethod, ThreadsDoNotChangeABit) {
  Bench b(GetParam(), "spinning_block", 33);  // three blocks
  const Column u = b.random_displacement();
  const Column one = b.force(u, 1);
  for (const int threads : {2, 3}) {
    const Column other = b.force(u, threads);
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(double)), 0)
        << threads << " threads";
  }
}

TEST_P(EveryMethod, PartsHaveTheBitsOfTheWhole) {
  Bench b(GetParam(), "spinning_block", 16);
  if (!b.model->has_parts()) {
    Column f = b.zeros();
    const std::vector<ParticleRange> all{{0, b.body.n}};
    EXPECT_THROW(b.model->forces_of(all, b.zeros(), b.zeros(), f, b.executor),
                 std::logic_error);
    return;
  }
  const Index n = b.body.n;
  const auto S = static_cast<std::size_t>(b.body.stride);
  const Column u = b.random_displacement(), whole = b.force(u);
  const std::vector<ParticleRange> parts{{5, 6}, {200, 1111}, {n - 300, n}};
  for (const int threads : {1, 3}) {
    Column f(whole.size(), 1e300);
    b.model->forces_of(parts, u, b.zeros(), f, Executor(threads));
    for (Index a = 0; a < n; ++a) {
      const bool in = std::any_of(parts.begin(), parts.end(), [&](const ParticleRange& r) {
        return a >= r.first && a < r.last;
      });
      for (std::size_t i = 0; i < S; ++i)
        ASSERT_EQ(f[a * S + i], in ? whole[a * S + i] : 1e300) << a << " of " << n;
    }
  }
  const ParticleRange part{n / 2, n / 2 + 3}, reach = b.model->reach(part);
  if (GetParam().method != "tlsph")  // whose longer bodies are in tests/unit/sph/parts_test.cpp
    EXPECT_LT(reach.last - reach.first, n) << "the body is too small to show anything";
  Column elsewhere = u;
  for (Index a = 0; a < n; ++a) {
    if (a < reach.first || a >= reach.last) elsewhere[a * S] += 0.1 * b.body.h;
  }
  Column f = whole;
  b.model->forces_of({&part, 1}, elsewhere, b.zeros(), f, b.executor);
  EXPECT_EQ(std::memcmp(f.data(), whole.data(), f.size() * sizeof(double)), 0);
}

TEST_P(EveryMethod, NumberingOfTheMeshDoesNotMatter) {
  Bench b(GetParam(), "spinning_block", 5);
  if (b.body.inside()) return;  // particles are no nodes: voronoi_test.cpp renumbers them
  scene::Mesh mesh = b.body.mesh;
  std::vector<Index> place(mesh.nodes.size());
  std::iota(place.begin(), place.end(), 0);
  std::mt19937_64 generator(23);
  std::shuffle(place.begin(), place.end(), generator);
  scene::Mesh shuffled = mesh;
  for (std::size_t a = 0; a < place.size(); ++a) {
    shuffled.nodes[place[a]] = mesh.nodes[a];
    shuffled.node_entity[place[a]] = mesh.node_entity[a];
  }
  for (Index& v : shuffled.cells) v = place[v];
  for (Index& v : shuffled.facets) v = place[v];
  const Column u = b.random_displacement();
  const Column f = b.force(u);
  const double scale = norm(f);
  const Body renumbered = Bench::divided(GetParam(), b.problem, make_body(b.problem, shuffled));
  for (Index a = 0; a < b.body.n; ++a) ASSERT_EQ(renumbered.position(a), b.body.position(a));
  const auto model =
      Bench::method_of(GetParam())
          .make_model(renumbered, b.problem, Bench::settings_of(GetParam()), b.executor);
  Column g = b.zeros();
  model->forces(u, b.zeros(), g, b.executor);
  for (std::size_t k = 0; k < g.size(); ++k) g[k] -= f[k];
  EXPECT_LT(norm(g), 1e-13 * scale);
}

TEST_P(EveryMethod, InvertedParticleIsReported) {
  Bench b(GetParam(), "spinning_block", 4);
  const Column u = b.column(
      [&](Index a) { return Vec3(-2 * b.body.position(a)[0], 0, 0); });  // mirrored: det F = -1
  Column f = b.zeros();
  try {
    b.model->forces(u, b.zeros(), f, b.executor);
    FAIL() << "no BadState";
  } catch (const BadState& bad) {
    EXPECT_EQ(bad.quantity, "det F");
    EXPECT_EQ(bad.particle, 0);
  }
  Column broken = b.zeros();
  broken[static_cast<std::size_t>(7) * b.body.stride] = std::nan("");
  EXPECT_THROW(b.model->forces(broken, b.zeros(), f, b.executor), BadState);
}

}  // namespace
}  // namespace concord::particle::test
