// Bonds that break in 3D: the network of tetrahedra against one made of those that are left,
// forces, energy account, a bar that is torn.

#include "particle/core/leapfrog.hpp"
#include "particle/delaunay/delaunay.hpp"
#include "particle/delaunay/fracture.hpp"
#include "scene/reader.hpp"
#include "tests/unit/particle/fragments.hpp"
#include "tests/unit/potential.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace concord::particle::delaunay {
namespace {

/// The beam of `free_beam`, 6 m along Z, of a material that breaks; neo-Hookean or St
/// Venant-Kirchhoff.
scene::Problem beam(const std::string& model = "neo-hookean") {
  scene::Problem problem = scene::read_problem("free_beam", {{"material.model", model}});
  problem.initial_velocity.reset();
  problem.quantities.clear();
  problem.fracture.emplace();
  problem.fracture->energy_release_rate = 0.5 * 0.1 * 0.1 * problem.material.E * 0.25;
  problem.fracture->length = 0.25;  // with E = 1 MPa a bond breaks at a strain of .1
  return problem;
}
constexpr double critical = 0.1;

Body body_of(const scene::Problem& problem, double perturb = 0.2) {
  return make_body(problem, 0.25, perturb, 3);
}

using test::along, test::random_column;

/// u_i = H_ij X_j.
Column affine(const Body& body, const Mat3& H) {
  Column u(body.X.size(), 0.0);
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 u_a = H * body.position(a);
    for (int i = 0; i < 3; ++i) u[4 * static_cast<std::size_t>(a) + i] = u_a[i];
  }
  return u;
}

Mat3 some_gradient() {
  Mat3 H;
  H << 0.02, 0.01, -0.03, 0.015, -0.01, 0.02, 0.005, -0.02, 0.03;
  return H;
}

/// A particle off the surface, about the middle.
Index inner(const Body& body) {
  Index best = -1;
  const auto distance = [&](Index a) { return (body.position(a) - Vec3(0, 0, 3)).norm(); };
  for (Index a = 0; a < body.n; ++a) {
    if (body.triangulation.on_boundary[a] != 0) continue;
    if (best < 0 || distance(a) < distance(best)) best = a;
  }
  return best;
}

/// The tetrahedra around one particle, and single ones.
std::vector<Index> some_tetrahedra(const Body& body, Index lone) {
  std::vector<Index> list;
  for (Index t = 0; t < static_cast<Index>(body.triangulation.size()); ++t) {
    const Index* v = &body.triangulation.simplices[4 * static_cast<std::size_t>(t)];
    if (std::find(v, v + 4, lone) != v + 4 || t % 53 == 3) list.push_back(t);
  }
  return list;
}

/// Moves one particle so far to all sides that each of its bonds breaks.
void damage(FractureModel& model, const Body& body, Index lone) {
  const std::size_t at = 4 * static_cast<std::size_t>(lone);
  for (int side = 0; side < 6; ++side) {
    Column u(body.X.size(), 0.0), v = u, f = u;
    u[at + side % 3] = (side < 3 ? 0.35 : -0.35) * body.h;
    model.advance(1e-6 * side, 1e-8, u, v, f, Executor(1));
  }
}

const FractureParameters with_contact{0.5, 0.3, 0.2};

}  // namespace

TEST(FractureNetworkSolid, WhatIsLeftIsTheNetworkOfTheTetrahedraLeft) {
  const scene::Problem problem = beam();
  const Body body = body_of(problem);
  const Index lone = inner(body);
  Network network(body, true);
  std::vector<Index> dead = some_tetrahedra(body, lone);
  std::mt19937_64 generator(1);
  std::shuffle(dead.begin(), dead.end(), generator);
  for (std::size_t k = 0; k < dead.size(); k += 7)  // in an order of their own
    network.remove({dead.data() + k, std::min<std::size_t>(7, dead.size() - k)});
  Body left = body;
  left.triangulation.simplices.clear();
  for (Index t = 0; t < static_cast<Index>(body.triangulation.size()); ++t) {
    const Index* v = &body.triangulation.simplices[4 * static_cast<std::size_t>(t)];
    if (network.alive(t))
      left.triangulation.simplices.insert(left.triangulation.simplices.end(), v, v + 4);
  }
  const Network expected(left, true);
  std::map<std::pair<Index, Index>, Index> known;
  for (Index k = 0; k < static_cast<Index>(expected.bonds()); ++k)
    known[{expected.ends(k).a, expected.ends(k).b}] = k;
  std::size_t found = 0;
  for (Index k = 0; k < static_cast<Index>(network.bonds()); ++k) {
    const auto [a, b] = network.ends(k);
    const auto bond = known.find({a, b});
    ASSERT_EQ(network.connected(k), bond != known.end());
    for (const Index end : {a, b}) {
      const Vec3 zeta =
          bond == known.end() ? Vec3(Vec3::Zero()) : expected.zeta(bond->second, end);
      ASSERT_TRUE(network.zeta(k, end) == zeta);
    }
    ASSERT_EQ(network.rows().area_over_length[k],
              bond == known.end() ? 0.0 : expected.rows().area_over_length[bond->second]);
    found += bond != known.end();
  }
  EXPECT_EQ(found, expected.bonds());
  EXPECT_LT(found, network.bonds());
  EXPECT_EQ(network.skew<3>().size(), expected.skew<3>().size());
  EXPECT_EQ(network.omega(), expected.omega());
  EXPECT_EQ(network.inverse_omega()[lone], 0);
}

TEST(FractureSolid, UnbrokenItIsTheMethodWithoutFracture) {
  scene::Problem problem = beam();
  problem.fracture->energy_release_rate = 1e12;
  const Body body = body_of(problem);
  FractureModel model(body, problem, with_contact);
  Parameters parameters;
  parameters.xi_n = with_contact.xi_n, parameters.xi_t = with_contact.xi_t;
  DelaunayModel plain(body, problem, parameters);
  const Column u = random_column(body, 0.03 * body.h, 1), still(body.X.size(), 0.0);
  Column f = still, expected = still;
  model.advance(0, 0, u, still, f, Executor(1));
  plain.forces(u, still, expected, Executor(1));
  double scale = 0;
  for (const double x : expected) scale = std::max(scale, std::abs(x));
  for (std::size_t k = 0; k < f.size(); ++k) ASSERT_NEAR(f[k], expected[k], 1e-12 * scale);
  const Energies e = model.energies(u, Executor(1)), e0 = plain.energies(u, Executor(1));
  EXPECT_NEAR(e.internal, e0.internal, 1e-12 * e0.internal);
  EXPECT_NEAR(e.stabilisation, e0.stabilisation, 1e-12 * e0.stabilisation);
  EXPECT_GT(e0.stabilisation, 0);
}

TEST(FractureSolid, AffineFieldsAreExactOnWhatIsLeft) {
  const scene::Problem problem = beam();
  const Body body = body_of(problem);
  FractureModel model(body, problem, with_contact);
  const Index lone = inner(body);
  damage(model, body, lone);
  const Mat3 H = some_gradient();
  std::vector<Mat3> gradients(body.n);
  model.gradients(affine(body, H), gradients);
  std::vector<double> share(body.n);
  model.intact_share(share);
  Index cut = 0;
  for (Index a = 0; a < body.n; ++a) {
    cut += share[a] < 0.999;
    EXPECT_LT((gradients[a] - (share[a] > 0 ? H : Mat3(Mat3::Zero()))).norm(), 1e-11) << a;
  }
  EXPECT_EQ(share[lone], 0);
  EXPECT_GT(cut, 8);
}

TEST(FractureSolid, DamagedForcesAreMinusTheGradientOfTheEnergy) {
  for (const char* law : {"neo-hookean", "st-venant-kirchhoff"}) {
    const scene::Problem problem = beam(law);
    const Body body = body_of(problem);
    FractureModel model(body, problem, with_contact);
    damage(model, body, inner(body));
    ASSERT_GT(model.record().broken.size(), 8u);
    // Differences of fourth order: 1e-10 at these strains.
    const auto [slope, power, scale] = along(model, random_column(body, 0.01 * body.h, 2),
                                             random_column(body, 0.01 * body.h, 3), 0.02);
    EXPECT_NEAR(slope, power, 1e-9 * scale) << law;
  }
}

// What the deletion takes from the energy is the record's, with dt = 0 to the last digits.
TEST(FractureSolid, ReleasedIsWhatTheEnergyLoses) {
  const scene::Problem problem = beam();
  const Body body = body_of(problem);
  FractureModel model(body, problem, with_contact);
  const Column still(body.X.size(), 0.0);
  Column u = random_column(body, 0.01 * body.h, 5), f = still;
  u[4 * static_cast<std::size_t>(inner(body))] += 0.3 * body.h;
  const auto total = [&] {
    const Energies e = model.energies(u, Executor(1));
    return e.internal + e.stabilisation;
  };
  const double before = total();
  model.advance(1, 0, u, still, f, Executor(1));
  ASSERT_GT(model.record().broken.size(), 1u);
  EXPECT_NEAR(model.record().released, before - total(), 1e-12 * before);
}

// Forces near what broke are computed once more, all others once: the same bits as computing
// everything on what is left.
TEST(FractureSolid, ForcesAfterABreakAreThoseOfWhatIsLeft) {
  for (const FractureParameters& parameters : {FractureParameters{}, with_contact}) {
    const scene::Problem problem = beam();
    const Body body = body_of(problem);
    FractureModel model(body, problem, parameters);
    Column u = random_column(body, 0.01 * body.h, 5);
    const Column v = random_column(body, 1, 6);
    u[4 * static_cast<std::size_t>(inner(body))] += 0.3 * body.h;
    Column f(body.X.size(), 0.0), again = f;
    model.advance(1, 1e-8, u, v, f, Executor(1));
    ASSERT_GT(model.record().broken.size(), 1u);
    const std::vector<double> viscous(model.viscous_forces().begin(),
                                      model.viscous_forces().end());
    model.advance(2, 1e-8, u, v, again, Executor(1));
    EXPECT_EQ(f, again);
    EXPECT_TRUE(std::equal(viscous.begin(), viscous.end(), model.viscous_forces().begin()));
  }
}

TEST(FractureSolid, AParticleLeftAloneCarriesNoStress) {
  const scene::Problem problem = beam();
  const Body body = body_of(problem);
  FractureModel model(body, problem, with_contact);
  const Index lone = inner(body);
  damage(model, body, lone);
  const Column u = random_column(body, 0.01 * body.h, 2), v = random_column(body, 1, 4);
  Column f(body.X.size(), 0.0);
  model.forces(u, v, f, Executor(1));
  Vec3 sum = Vec3::Zero();
  double scale = 0;
  for (Index a = 0; a < body.n; ++a) {
    const std::size_t at = 4 * static_cast<std::size_t>(a);
    const Vec3 f_a(f[at], f[at + 1], f[at + 2]);
    ASSERT_TRUE(f_a.allFinite());
    EXPECT_TRUE(a != lone || f_a.isZero(0));
    sum += f_a;
    scale += f_a.norm();
  }
  EXPECT_LT(sum.norm(), 1e-12 * scale);  // viscous ones included
}

// A lattice stretched along Z: bonds along Z are stretched by the strain, all others by less.
TEST(FractureSolid, ABarBreaksAtTheCriterionsStrain) {
  const scene::Problem problem = beam();
  const Body body = body_of(problem, 0);
  FractureModel model(body, problem, {});
  Mat3 H = Mat3::Zero();
  Column f(body.X.size(), 0.0);
  const Column still = f;
  H(2, 2) = critical * (1 - 1e-9);
  model.advance(0, 0, affine(body, H), still, f, Executor(1));
  EXPECT_TRUE(model.record().broken.empty());
  H(2, 2) = critical * (1 + 1e-9);
  model.advance(1, 0, affine(body, H), still, f, Executor(1));
  ASSERT_FALSE(model.record().broken.empty());
  for (const BrokenBond& bond : model.record().broken) {
    const Vec3 X = body.position(bond.b) - body.position(bond.a);
    EXPECT_LT(std::hypot(X[0], X[1]), 1e-12);
  }
}

// What an unbroken slab tells of its cracks.
TEST(FractureSolid, AnUnbrokenSlabIsOnePiece) {
  scene::Problem problem = scene::read_problem("pmma_plate_3d", {{"end_time", "0.5 us"}});
  problem.fracture->cracks.clear();
  for (const char* method : {"delaunay", "cbm"}) {
    scene::RunRequest request;
    request.h = 1e-3;
    scene::Result result;
    scene::MethodRegistry::instance().find(method).run(problem, request, result);
    EXPECT_EQ(result.quantities.at("fragments"), 1) << method;
    EXPECT_EQ(result.quantities.at("isolated_particles"), 0) << method;
    EXPECT_EQ(result.quantities.at("dead_area"), 0) << method;
  }
}

namespace {

scene::Result run(const scene::Problem& problem,
                  const std::map<std::string, std::string>& settings) {
  scene::RunRequest request;
  request.h = 0.25;
  request.settings = settings;
  scene::Result result;
  scene::MethodRegistry::instance().find("delaunay").run(problem, request, result);
  return result;
}

}  // namespace

TEST(FractureSolid, ATornBeamFliesApartAndKeepsItsMomenta) {
  const scene::Result result = run(
      fragments::torn(), {{"beta", "0"}, {"xi_n", "0.1"}, {"xi_t", "0.1"}, {"courant", "0.1"}});
  EXPECT_GT(result.quantities.at("broken_bonds"), 20);
  EXPECT_GE(result.quantities.at("fragments"), 2);
  EXPECT_LT(result.invariants.at("linear_momentum_drift"), 1e-12);
  EXPECT_LT(result.invariants.at("angular_momentum_drift"), 1e-12);
}

TEST(FractureSolid, TheEnergyBalanceClosesWhileItBreaks) {
  for (const char* beta : {"0", "0.5"}) {
    const scene::Result coarse =
        run(fragments::torn(),
            {{"beta", beta}, {"xi_n", "0.1"}, {"xi_t", "0.1"}, {"courant", "0.1"}});
    EXPECT_GT(coarse.quantities.at("broken_bonds"), 20);
    EXPECT_LT(coarse.invariants.at("energy_drift"), 5e-4) << beta;
  }
}

}  // namespace concord::particle::delaunay
