// Pairs that break: forces and gradients of what is left, energy account, saved states.

#include "fracture_sample.hpp"

#include "scene/checkpoint.hpp"
#include "tests/unit/potential.hpp"

#include <gtest/gtest.h>

namespace concord::sph {
namespace {

TEST(FracturingSph, UnbrokenItIsTheElasticModel) {
  for (const PenaltyForm penalty : {PenaltyForm::potential, PenaltyForm::ganzenmueller}) {
    scene::Problem problem = whole_plate();
    problem.fracture->energy_release_rate = 1e9;
    const Body body = body_of(problem);
    FracturingSph model(body, problem, breakable(penalty), one_thread);
    TotalLagrangianSph plain(body, problem, breakable(penalty).sph, one_thread);
    const Column u = random_column(body, 0.02 * body.h, 1), still(body.X.size(), 0.0);
    Column f = still, expected = still;
    model.advance(0, 0, u, still, f, one_thread);
    plain.forces(u, still, expected, one_thread);
    for (std::size_t k = 0; k < f.size(); ++k) ASSERT_EQ(f[k], expected[k]);
    EXPECT_TRUE(model.record().broken.empty());
  }
}

TEST(FracturingSph, NoPairAcrossThePreCrackTransmits) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  for (const SpringLayout layout : {SpringLayout::edges, SpringLayout::pairs}) {
    const FracturingSph model(body, problem, breakable(PenaltyForm::potential, layout),
                              one_thread);
    const scene::PreCrack& crack = problem.fracture->cracks.front();
    const std::vector<Index> across = model.springs().pairs_across(crack.from, crack.to);
    EXPECT_GT(across.size(), 50u);
    for (const Index p : across) {
      for (const std::size_t k : model.springs().pair(p).entry) {
        EXPECT_EQ(model.elastic().neighbours().weight[k], 0);
        EXPECT_EQ(model.elastic().neighbours().stiffness[k], 0);
      }
    }
    EXPECT_GT(model.record().dead.size(), 30u);
    EXPECT_EQ(model.record().released, 0);
  }
}

TEST(FracturingSph, GradientsOfAffineFieldsStayExact) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FracturingSph model(body, problem, breakable(), one_thread);
  damage(model, body, lone);
  Mat3 H = Mat3::Zero();
  H(0, 0) = 0.003, H(0, 1) = -0.002, H(1, 0) = 0.004, H(1, 1) = 0.001;
  std::vector<Mat3> found(body.n);
  model.gradients(affine(body, H), found);
  int alone = 0;
  for (Index a = 0; a < body.n; ++a) {
    if (holding(model, a).empty()) {
      EXPECT_EQ(found[a], Mat3::Zero());
      ++alone;
      continue;
    }
    EXPECT_LT((found[a] - H).topLeftCorner(2, 2).norm(), 1e-13);
  }
  EXPECT_GE(alone, 1);
  EXPECT_LT(alone, 10);
}

TEST(FracturingSph, DamagedForcesAreMinusTheGradientOfTheEnergy) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FracturingSph model(body, problem, breakable(), one_thread);
  damage(model, body, lone);
  ASSERT_GT(model.record().broken.size(), 3u);
  // A polynomial of the fourth degree in u, for which this is exact.
  const auto [slope, power, scale] = particle::test::along(
      model, random_column(body, 0.01 * body.h, 2), random_column(body, 0.01 * body.h, 3), 0.1);
  EXPECT_NEAR(slope, power, 1e-12 * scale);
}

TEST(FracturingSph, WhatIsLeftConservesBothMomentaAndALoneParticleFeelsNothing) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FracturingSph model(body, problem, breakable(), one_thread);
  damage(model, body, lone);
  ASSERT_TRUE(holding(model, lone).empty());
  std::vector<double> share(body.n);
  model.intact_share(share);
  EXPECT_EQ(share[lone], 0);
  const Column u = random_column(body, 0.01 * body.h, 2), v = random_column(body, 1, 4);
  Column f(body.X.size(), 0.0);
  model.forces(u, v, f, one_thread);
  EXPECT_EQ(f[2 * lone], 0);
  EXPECT_EQ(f[2 * lone + 1], 0);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  double scale = 0;
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 f_a = at(body, f, a);
    ASSERT_TRUE(f_a.allFinite());
    sum += f_a, moment += (body.position(a) + at(body, u, a)).cross(f_a);
    scale += f_a.norm();
  }
  EXPECT_LT(sum.norm(), 1e-13 * scale);
  EXPECT_LT(moment.norm(), 1e-13 * 0.03 * scale);
}

TEST(FracturingSph, ASpringBreaksAtItsStrainAndNotBefore) {
  scene::Problem problem = whole_plate();
  const Body body = body_of(problem);
  const double critical =
      std::sqrt(2 * problem.fracture->energy_release_rate / (problem.material.E * body.h));
  for (const SpringLayout layout : {SpringLayout::edges, SpringLayout::pairs}) {
    FracturingSph model(body, problem, breakable(PenaltyForm::potential, layout), one_thread);
    Column f(body.X.size(), 0.0), v = f;
    // The whole body grows: every spring has the same strain.
    for (const double strain : {critical * (1 - 1e-9), critical * (1 + 1e-9)}) {
      const Column u = affine(body, strain * Mat3::Identity());
      model.advance(1e-6, 1e-8, u, v, f, one_thread);
      const bool broken = strain > critical;
      for (Index k = 0; k < model.springs().count(); ++k)
        ASSERT_EQ(model.springs().whole(k), !broken);
    }
    for (const double x : f) EXPECT_EQ(x, 0);
    // All that was stored is released: nothing moves, so that there is no half kick.
    const double stored = model.record().released;
    TotalLagrangianSph plain(body, problem, breakable().sph, one_thread);
    const Column u = affine(body, critical * (1 + 1e-9) * Mat3::Identity());
    EXPECT_NEAR(stored, plain.energies(u, one_thread).internal, 1e-9 * stored);
    EXPECT_EQ(model.record().dead.size(), body.triangulation.size());
  }
}

// (TLS.22): what is stored before less what is stored after, less the half kick's work.
TEST(FracturingSph, DeletionReleasesTheEnergyThatIsGone) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  const Column u = random_column(body, 0.01 * body.h, 2), v = random_column(body, 1, 4),
               still(body.X.size(), 0.0);
  for (const SpringLayout layout : {SpringLayout::edges, SpringLayout::pairs}) {
    FracturingSph model(body, problem, breakable(PenaltyForm::potential, layout, 0),
                        one_thread);
    Column before = still, after = still;
    const auto stored = [&] {
      const particle::Energies e = model.energies(u, one_thread);
      return e.internal + e.stabilisation;
    };
    model.forces(u, still, before, one_thread);
    const double first = stored(), dt = 1e-8;
    model.advance(1e-6, dt, u, v, after, one_thread);
    ASSERT_GT(model.record().broken.size(), 10u);
    double kick = 0;
    for (std::size_t k = 0; k < u.size(); ++k) kick += 0.5 * dt * (after[k] - before[k]) * v[k];
    EXPECT_GT(std::abs(kick), 1e-6 * first);
    EXPECT_NEAR(model.record().released, first - stored() - kick, 1e-10 * first);
  }
}

// (TLS.21) literally, for every pair.
TEST(FracturingSph, DampingOfPairs) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FracturingSph model(body, problem, breakable(), one_thread);
  damage(model, body, lone);
  const Column u = random_column(body, 0.001 * body.h, 2), v = random_column(body, 1, 4);
  Column f(body.X.size(), 0.0);
  model.advance(1e-6, 1e-8, u, v, f, one_thread);
  Column expected(body.X.size(), 0.0);
  const double l = body.h, c_0 = std::sqrt(problem.material.E / problem.material.rho0);
  double power = 0, scale = 0;
  for (Index a = 0; a < body.n; ++a) {
    for (const Index p : model.springs().pairs_at(a)) {
      const auto& pair = model.springs().pair(p);
      const Index b = pair.other(a);
      const Vec3 x = body.position(b) - body.position(a) + at(body, u, b) - at(body, u, a);
      const Vec3 rate = at(body, v, b) - at(body, v, a);
      const double pi = -0.5 * l * problem.material.rho0 * c_0 * rate.dot(x) /
                        (x.squaredNorm() + 0.01 * l * l);
      const double c = model.elastic().neighbours().weight[pair.entry[0]];
      for (int i = 0; i < 2; ++i) expected[2 * a + i] -= 2 * c * pi * x[i];
    }
  }
  for (const double e : expected) scale = std::max(scale, std::abs(e));
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(model.viscous_forces()[k], expected[k], 1e-12 * scale);
    power += model.viscous_forces()[k] * v[k];
  }
  EXPECT_LT(power, 0);
}

TEST(FracturingSph, TheSameBitsForAnyNumberOfThreads) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FracturingSph one(body, problem, breakable(), one_thread),
      two(body, problem, breakable(), Executor(2));
  for (int step = 0; step < 3; ++step) {
    const Column u = random_column(body, 0.012 * body.h, 5 + step),
                 v = random_column(body, 1, 9 + step);
    Column f(body.X.size(), 0.0), g = f;
    one.advance(1e-6, 1e-8, u, v, f, one_thread);
    two.advance(1e-6, 1e-8, u, v, g, Executor(2));
    for (std::size_t k = 0; k < f.size(); ++k) ASSERT_EQ(f[k], g[k]);
  }
  EXPECT_GT(one.record().broken.size(), 10u);
  EXPECT_EQ(one.record().released, two.record().released);
}

TEST(FracturingSph, RestoredItGoesOnWithTheSameBits) {
  const scene::Problem problem = plate();
  const Body body = body_of(problem);
  FracturingSph one(body, problem, breakable(), one_thread),
      two(body, problem, breakable(), one_thread);
  damage(one, body, lone);
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "concord_sph_fracture_checkpoint";
  {
    scene::Checkpoint state = scene::Checkpoint::to(file);
    one.keep(state);
    state.finish();
  }
  scene::Checkpoint state = scene::Checkpoint::from(file);
  two.keep(state);
  std::filesystem::remove(file);
  EXPECT_EQ(one.record().broken.size(), two.record().broken.size());
  EXPECT_EQ(one.record().dead.size(), two.record().dead.size());
  EXPECT_EQ(one.record().released, two.record().released);
  const Neighbours &rows = one.elastic().neighbours(), &again = two.elastic().neighbours();
  EXPECT_EQ(rows.weight, again.weight);
  EXPECT_EQ(rows.inverse_moment, again.inverse_moment);
  for (std::size_t k = 0; k < one.viscous_forces().size(); ++k)
    ASSERT_EQ(one.viscous_forces()[k], two.viscous_forces()[k]);
  const Column u = random_column(body, 0.012 * body.h, 5), v = random_column(body, 1, 9);
  Column f(body.X.size(), 0.0), g = f;
  one.advance(1e-5, 1e-8, u, v, f, one_thread);
  two.advance(1e-5, 1e-8, u, v, g, one_thread);
  for (std::size_t k = 0; k < f.size(); ++k) ASSERT_EQ(f[k], g[k]);
  EXPECT_EQ(one.record().broken.size(), two.record().broken.size());
}

}  // namespace
}  // namespace concord::sph
