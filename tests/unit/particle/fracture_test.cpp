// Bonds that break: the network against a rebuilt one, forces, energy account, whole runs.

#include "particle/core/leapfrog.hpp"
#include "particle/core/particle_method.hpp"
#include "particle/delaunay/delaunay.hpp"
#include "particle/delaunay/fracture.hpp"
#include "scene/reader.hpp"
#include "tests/unit/potential.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace concord::particle::delaunay {
namespace {

scene::Problem plate(const std::vector<scene::Override>& more = {}) {
  std::vector<scene::Override> set{{"parameters.width", "20 mm"},
                                   {"parameters.crack", "10 mm"},
                                   {"parameters.strip", "4 mm"}};
  set.insert(set.end(), more.begin(), more.end());
  return scene::read_problem("pmma_plate", set);
}
Body body_of(const scene::Problem& problem) {
  return make_body(problem, 0.5e-3, 0, 1, CellSource::mesh);
}

using test::along, test::random_column;

/// Some triangles in a heap around a particle, so that it is left alone, and single ones.
std::vector<Index> some_triangles(const Body& body, Index lone) {
  std::vector<Index> list;
  for (Index t = 0; t < static_cast<Index>(body.triangulation.size()); ++t) {
    const Index* v = &body.triangulation.simplices[3 * static_cast<std::size_t>(t)];
    if (v[0] == lone || v[1] == lone || v[2] == lone || t % 97 == 3) list.push_back(t);
  }
  return list;
}

constexpr Index lone = 300;

/// Moves one particle so far to all sides that each of its bonds breaks.
void damage(FractureModel& model, const Body& body) {
  for (int side = 0; side < 4; ++side) {
    Column u(body.X.size(), 0.0), v = u, f = u;
    u[2 * lone + side % 2] = (side < 2 ? 0.1 : -0.1) * body.h;
    model.advance(1e-6 * side, 1e-8, u, v, f, Executor(1));
  }
}

}  // namespace

TEST(FractureNetwork, BondVectorsAndVolumesAreThoseOfTheTrianglesLeft) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  Network network(body, false);
  const std::vector<Index> dead = some_triangles(body, lone);
  const std::vector<Index> loose = network.remove(dead);
  Body left = body;
  left.triangulation.simplices.clear();
  std::vector<double> omega(body.n, 0.0);
  for (Index t = 0; t < static_cast<Index>(body.triangulation.size()); ++t) {
    if (!network.alive(t)) continue;
    for (int i = 0; i < 3; ++i) {
      const Index a = body.triangulation.simplices[3 * static_cast<std::size_t>(t) + i];
      left.triangulation.simplices.push_back(a);
      omega[a] += body.thickness / 3 * body.simplex_volume(t);
    }
  }
  left.triangulation.on_boundary.assign(body.n, 1);  // no antisymmetry is assumed
  std::map<std::pair<Index, Index>, Bond> expected;
  for (const Bond& bond : gradient_vectors(left)) expected[{bond.a, bond.b}] = bond;
  std::size_t found = 0;
  for (Index k = 0; k < static_cast<Index>(network.bonds()); ++k) {
    const auto [a, b] = network.ends(k);
    const auto bond = expected.find({a, b});
    EXPECT_EQ(network.connected(k), bond != expected.end());
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(network.zeta(k, a)[i], bond == expected.end() ? 0 : bond->second.B_ab[i],
                  1e-13 * body.h);
      EXPECT_NEAR(network.zeta(k, b)[i], bond == expected.end() ? 0 : bond->second.B_ba[i],
                  1e-13 * body.h);
    }
    found += bond != expected.end();
  }
  EXPECT_EQ(found, expected.size());
  EXPECT_FALSE(loose.empty());
  for (Index a = 0; a < body.n; ++a) {
    EXPECT_NEAR(network.omega()[a], omega[a], 1e-14 * body.V[a]);
  }
  EXPECT_EQ(network.inverse_omega()[lone], 0);
}

TEST(FractureModel, UnbrokenItIsTheMethodWithoutFracture) {
  scene::Problem problem = plate();
  problem.fracture->cracks.clear();
  problem.fracture->energy_release_rate = 1e9;
  const Body body = body_of(problem);
  FractureModel model(body, problem, {});
  Parameters parameters;
  parameters.xi_n = parameters.xi_t = 0;
  DelaunayModel plain(body, problem, parameters);
  const Column u = random_column(body, 0.02 * body.h, 1), still(body.X.size(), 0.0);
  Column f = still, expected = still;
  model.advance(0, 0, u, still, f, Executor(1));
  plain.forces(u, still, expected, Executor(1));
  double scale = 0;
  for (const double x : expected) scale = std::max(scale, std::abs(x));
  for (std::size_t k = 0; k < f.size(); ++k) EXPECT_NEAR(f[k], expected[k], 1e-12 * scale);
  EXPECT_NEAR(model.energies(u, Executor(1)).internal, plain.energies(u, Executor(1)).internal,
              1e-12 * plain.energies(u, Executor(1)).internal);
  EXPECT_TRUE(model.record().broken.empty());
}

TEST(FractureModel, DamagedForcesAreMinusTheGradientOfTheEnergy) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FractureModel model(body, problem, {});
  damage(model, body);
  ASSERT_GT(model.record().broken.size(), 3u);
  // The energy of the law is a polynomial of the fourth degree in u, and this exact for it.
  const auto [slope, power, scale] = along(model, random_column(body, 0.01 * body.h, 2),
                                           random_column(body, 0.01 * body.h, 3), 0.1);
  EXPECT_NEAR(slope, power, 1e-12 * scale);
}

TEST(FractureModel, AParticleLeftAloneCarriesNoStress) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FractureModel model(body, problem, {});
  damage(model, body);
  std::vector<double> share(body.n);
  model.intact_share(share);
  ASSERT_EQ(share[lone], 0);
  EXPECT_GT(body.m[lone], 0);
  const Column u = random_column(body, 0.01 * body.h, 2), v = random_column(body, 1, 4);
  Column f(body.X.size(), 0.0);
  model.forces(u, v, f, Executor(1));
  std::vector<Mat3> H(body.n);
  model.gradients(u, H);
  EXPECT_EQ(f[2 * lone], 0);
  EXPECT_EQ(f[2 * lone + 1], 0);
  EXPECT_EQ(H[lone], Mat3::Zero());
  Vec3 sum = Vec3::Zero();
  double scale = 0;
  for (Index a = 0; a < body.n; ++a) {
    ASSERT_TRUE(std::isfinite(f[2 * a]) && std::isfinite(f[2 * a + 1]));
    sum += Vec3(f[2 * a], f[2 * a + 1], 0);
    scale += std::abs(f[2 * a]);
  }
  EXPECT_LT(sum.norm(), 1e-12 * scale);  // viscous ones included
}

TEST(FractureModel, DampingTakesEnergyWhetherTheBodyGrowsOrShrinks) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FractureModel model(body, problem, {});
  for (const double rate : {1e3, -1e3}) {
    Column v = body.X, f(body.X.size(), 0.0);
    for (double& x : v) x *= rate;
    const Column u(body.X.size(), 0.0);
    model.advance(0, 0, u, v, f, Executor(1));
    double power = 0;
    for (std::size_t k = 0; k < v.size(); ++k) power += model.viscous_forces()[k] * v[k];
    EXPECT_LT(power, 0) << rate;
    EXPECT_EQ(power, power);
  }
}

// pi = -beta l rho c_0 v.x/(x^2 + .01 l^2) (21) and f = -(23) with P - pi J F^-T, for one bond.
TEST(FractureModel, DampingOfAStretchedBond) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FractureModel one(body, problem, {0.5}), two(body, problem, {1.0});
  const Column u = random_column(body, 0.01 * body.h, 2), v = random_column(body, 1, 4);
  Column f(body.X.size(), 0.0);
  one.advance(0, 0, u, v, f, Executor(1));
  two.advance(0, 0, u, v, f, Executor(1));
  const Network& network = one.network();
  std::vector<Mat3> H(body.n);
  one.gradients(u, H);
  Column expected(body.X.size(), 0.0);
  const double l = body.h, c0 = std::sqrt(problem.material.E / problem.material.rho0);
  for (Index k = 0; k < static_cast<Index>(network.bonds()); ++k) {
    const auto [i, p] = network.ends(k);
    const auto difference = [&, i = i, p = p](const Column& c) {
      return Vec3(c[2 * p] - c[2 * i], c[2 * p + 1] - c[2 * i + 1], 0);
    };
    const Vec3 x = body.position(p) - body.position(i) + difference(u);
    const double pi = -0.5 * l * problem.material.rho0 * c0 * difference(v).dot(x) /
                      (x.squaredNorm() + 0.01 * l * l);
    const auto cofactor = [&](Index a, const Vec3& z) {
      return Vec3((1 + H[a](1, 1)) * z[0] - H[a](1, 0) * z[1],
                  -H[a](0, 1) * z[0] + (1 + H[a](0, 0)) * z[1], 0);
    };
    const Vec3 force =
        -pi * (cofactor(i, network.zeta(k, i)) - cofactor(p, network.zeta(k, p)));
    for (int j = 0; j < 2; ++j)
      expected[2 * i + j] += force[j], expected[2 * p + j] -= force[j];
  }
  double scale = 0;
  for (const double e : expected) scale = std::max(scale, std::abs(e));
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(one.viscous_forces()[k], expected[k], 1e-12 * scale);
    EXPECT_NEAR(two.viscous_forces()[k], 2 * expected[k], 2e-12 * scale);
  }
}

namespace {

scene::Result run_plate(const std::vector<scene::Override>& more, double beta = 0.5) {
  const scene::Problem problem = plate(more);
  scene::RunRequest request;
  request.h = 0.5e-3;
  request.settings = {{"courant", "0.1"}, {"beta", std::to_string(beta)}};
  scene::Result result;
  scene::MethodRegistry::instance().find("cbm").run(problem, request, result);
  return result;
}

}  // namespace

TEST(FractureRun, TheEnergyBalanceClosesWhileItBreaks) {
  for (const char* criterion : {"strain", "energy"}) {
    const scene::Result result = run_plate({{"fracture.criterion", criterion}});
    EXPECT_GT(result.quantities.at("broken_bonds"), 30) << criterion;
    EXPECT_LT(result.quantities.at("energy_residual"), 5e-4) << criterion;
    EXPECT_GT(result.quantities.at("crack_advance"), 5e-3) << criterion;
  }
}

TEST(FractureRun, ATougherPlateBreaksLaterAndLess) {
  const scene::Result weak = run_plate({}),
                      tough = run_plate({{"fracture.energy_release_rate", "500 J/m^2"}});
  ASSERT_TRUE(weak.quantities.contains("crack_arrival"));
  ASSERT_TRUE(tough.quantities.contains("crack_arrival"));
  EXPECT_LT(weak.quantities.at("crack_arrival"), tough.quantities.at("crack_arrival"));
  EXPECT_LT(tough.quantities.at("dead_area"), weak.quantities.at("dead_area"));
}

// The step follows from forces at no velocity, also where there is no damping.
TEST(FractureRun, UndampedWithTheStepAskedFor) {
  const scene::Problem problem = plate({{"end_time", "5 us"}});
  for (const char* method : {"cbm", "delaunay"}) {
    scene::RunRequest request;
    request.h = 1e-3;
    request.settings = {{"beta", "0"}};
    scene::Result result;
    scene::MethodRegistry::instance().find(method).run(problem, request, result);
    EXPECT_NEAR(result.t_end, 5e-6, 1e-18) << method;
    EXPECT_GT(result.dt, 0) << method;
  }
}

TEST(FractureRun, ACutThroughNothingIsRefused) {
  const auto run = [](const std::string& from, const std::string& to) {
    scene::Problem problem = plate();
    scene::Fracture& fracture = *problem.fracture;
    fracture.cracks.front().from = Vec3(std::stod(from), 0.01, 0);
    fracture.cracks.front().to = Vec3(std::stod(to), 0.01, 0);
    scene::RunRequest request;
    request.h = 1e-3;
    scene::Result result;
    scene::MethodRegistry::instance().find("cbm").run(problem, request, result);
  };
  EXPECT_THROW(run("0.010", "0.01000001"), InputError);  // between two bonds
  EXPECT_THROW(run("0.015", "0.021"), InputError);       // nothing ahead
}

TEST(FractureRun, OtherMethodsRefuse) {
  const scene::Problem problem = plate();
  for (const scene::Method* method : scene::MethodRegistry::instance().all()) {
    const auto* particles = dynamic_cast<const ParticleMethod*>(method);
    if (particles != nullptr && particles->breaks()) continue;
    scene::RunRequest request;
    request.h = 2e-3;
    scene::Result result;
    EXPECT_THROW(method->run(problem, request, result), InputError) << method->info().name;
  }
}

}  // namespace concord::particle::delaunay
