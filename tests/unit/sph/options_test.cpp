// What settings do: threads and instruction sets, psi = 0, viscosity, errors, neighbours,
// registration.

#include "sample.hpp"

#include "scene/method.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace concord::sph {
namespace {

Column forces(TotalLagrangianSph& model, const Column& u, const Column& v,
              const Executor& executor = one_thread) {
  Column f(u.size(), 1e30);
  model.forces(u, v, f, executor);
  return f;
}

TEST(Neighbours, AreAllPairsWithinTheSupport) {
  for (const int dim : {2, 3}) {
    const Body body = lattice(dim, dim == 3 ? 7 : 15, 0.25);
    const Kernel kernel(KernelShape::cubic_spline, dim, 0.23);
    const Neighbours lists = find_neighbours(body, body.V, kernel, 1, Executor(2));
    const DirectedRows rows = directed_rows(lists);
    EXPECT_EQ(lists.directed, rows.other.size());
    for (Index a = 0; a < body.n; ++a) {
      std::vector<Index> expected;
      for (Index b = 0; b < body.n; ++b) {
        if (b != a && (body.position(b) - body.position(a)).norm() < 0.23)
          expected.push_back(b);
      }
      EXPECT_EQ(std::vector<Index>(&rows.other[rows.begin[a]], &rows.other[rows.begin[a + 1]]),
                expected);
    }
  }
}

TEST(Neighbours, TooSmallASupportIsAnInputError) {
  const Body body = lattice(3, 4, 0.1);
  try {
    TotalLagrangianSph(body, rubber(Dimension::three_d), options(0, PenaltyForm::none, 1.01),
                       one_thread);
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_EQ(e.key(), "tlsph.support");
    EXPECT_THAT(e.allowed(), testing::HasSubstr("larger support"));
  }
}

TEST(Threads, GiveTheSameBits) {
  for (const PenaltyForm penalty : {PenaltyForm::ganzenmueller, PenaltyForm::potential}) {
    const Body body = lattice(3, 14, 0.25);
    TlsphOptions o = options(0.3, penalty);
    o.alpha = 0.5, o.beta = 1;
    TotalLagrangianSph model(body, rubber(Dimension::three_d), o, one_thread);
    const Column u = random_column(body, 0.004, 1), v = random_column(body, 10, 2);
    const Column f = forces(model, u, v);
    for (const int threads : {2, 3, 5}) {
      const Executor executor(threads);
      TotalLagrangianSph other(body, rubber(Dimension::three_d), o, executor);
      EXPECT_EQ(forces(other, u, v, executor), f);
    }
  }
}

TEST(Penalty, WithoutFactorIsNoPenaltyAtAll) {
  const Body body = lattice(2, 9, 0.25);
  const Column u = random_column(body, 0.004, 1);
  TotalLagrangianSph none(body, rubber(Dimension::plane_strain), options(0, PenaltyForm::none),
                          one_thread);
  for (const PenaltyForm penalty : {PenaltyForm::ganzenmueller, PenaltyForm::potential}) {
    TotalLagrangianSph zero(body, rubber(Dimension::plane_strain), options(0, penalty),
                            one_thread);
    EXPECT_EQ(forces(zero, u, {}), forces(none, u, {}));
    EXPECT_TRUE(zero.neighbours().stiffness.empty());
    EXPECT_TRUE(zero.has_potential());
    TotalLagrangianSph some(body, rubber(Dimension::plane_strain), options(0.1, penalty),
                            one_thread);
    EXPECT_NE(forces(some, u, {}), forces(none, u, {}));
  }
}

/// (28): two-particle terms summed by hand, with delta_ij = (x_ij - F_i X_ij).n.
TEST(Penalty, IsEquation28) {
  const Body body = lattice(2, 7, 0.25);
  const scene::Problem problem = rubber(Dimension::plane_strain);
  const double psi = 0.3;
  TotalLagrangianSph model(body, problem, options(psi), one_thread);
  TotalLagrangianSph bare(body, problem, options(0), one_thread);
  const Column u = random_column(body, 0.004, 1), f = forces(model, u, {}),
               f_bare = forces(bare, u, {});
  std::vector<Mat3> H(body.n);
  model.gradients(u, H);
  const double R = 2.4 * body.h, scale = largest(f);
  for (Index i = 0; i < body.n; ++i) {
    Vec3 penalty = Vec3::Zero();
    for (Index j = 0; j < body.n; ++j) {
      const Vec3 X = body.position(j) - body.position(i),
                 x = X + at(body, u, j) - at(body, u, i), n = x.normalized();
      if (j == i || X.norm() >= R) continue;
      const double delta_ij = (x - X - H[i] * X).dot(n), delta_ji = (x - X - H[j] * X).dot(n);
      const double w = Kernel(KernelShape::cubic_spline, 2, R).value(X.norm());
      const double areas =
          body.V[i] * body.V[j] / body.thickness;  // force for the whole thickness
      penalty += psi * areas * w / X.squaredNorm() * problem.material.E / 2 *
                 (delta_ij + delta_ji) * n;
    }
    EXPECT_LT((at(body, f, i) - at(body, f_bare, i) - penalty).norm(), 1e-13 * scale);
  }
}

class Viscosity : public testing::TestWithParam<PenaltyForm> {};

TEST_P(Viscosity, Dissipates) {
  for (const int dim : {2, 3}) {
    const Body body = lattice(dim, dim == 3 ? 6 : 10, 0.25);
    const scene::Problem problem =
        rubber(dim == 3 ? Dimension::three_d : Dimension::plane_strain);
    TlsphOptions viscous = options(0.1, GetParam());
    viscous.alpha = 0.7, viscous.beta = 1.3;
    TotalLagrangianSph with(body, problem, viscous, one_thread),
        without(body, problem, options(0.1, GetParam()), one_thread);
    EXPECT_TRUE(with.viscous());
    EXPECT_FALSE(without.viscous());
    EXPECT_EQ(without.viscous_damping_ratio(1e4), 0);
    EXPECT_GT(with.viscous_damping_ratio(1e4), 0);
    const Column u = random_column(body, 0.004, 1), v = random_column(body, 30, 2);
    const Column f = forces(with, u, v), f_bare = forces(without, u, v);
    double power = 0, size = 0;
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (Index a = 0; a < body.n; ++a) {
      const Vec3 drag = at(body, f, a) - at(body, f_bare, a);
      power += at(body, v, a).dot(drag);
      size += at(body, v, a).norm() * drag.norm();
      sum += drag;
      moment += (body.position(a) + at(body, u, a)).cross(drag);
    }
    EXPECT_LT(power, -0.1 * size);
    EXPECT_LT(sum.norm(), 1e-12 * size / 30);
    EXPECT_LT(moment.norm(), 1e-12 * size / 30);
  }
}

TEST_P(Viscosity, IsAbsentInRigidMotionAndBetweenPartingParticles) {
  const Body body = lattice(3, 6, 0.25);
  TlsphOptions viscous = options(0.1, GetParam());
  viscous.alpha = 0.7, viscous.beta = 1.3;
  TotalLagrangianSph with(body, rubber(Dimension::three_d), viscous, one_thread);
  const Column u = affine(body, rotation(3, 0.4));
  const Mat3 F = rotation(3, 0.4) + Mat3::Identity();
  Mat3 spin;
  spin << 0, -30, 10, 30, 0, -5, -10, 5, 0;
  const Column rest(u.size(), 0.0), closing = affine(body, -50 * F),
                                    f_rest = forces(with, u, rest);
  const auto drag = [&](const Column& v) {
    Column d = forces(with, u, v);
    for (std::size_t i = 0; i < d.size(); ++i) d[i] -= f_rest[i];
    return largest(d);
  };
  const double scale = drag(closing);
  EXPECT_GT(scale, 1);
  EXPECT_LT(drag(affine(body, spin * F)), 1e-13 * scale);
  EXPECT_EQ(drag(affine(body, 50 * F)), 0);
}

INSTANTIATE_TEST_SUITE_P(Penalties, Viscosity,
                         testing::Values(PenaltyForm::ganzenmueller, PenaltyForm::potential));

TEST(State, TurnedInsideOutIsReportedWithItsLowestParticle) {
  const Body body = lattice(3, 6, 0.1);
  TotalLagrangianSph model(body, rubber(Dimension::three_d), options(0.1), one_thread);
  Column f(body.X.size());
  try {
    model.forces(affine(body, -1.5 * Mat3::Identity()), {}, f, one_thread);
    FAIL() << "no error";
  } catch (const particle::BadState& bad) {
    EXPECT_EQ(bad.quantity, "det F");
    EXPECT_EQ(bad.particle, 0);
  }
  Column u(body.X.size(), 0.0);
  u[4 * 100] = std::nan("");
  std::vector<Index> touched{100};
  const DirectedRows rows = directed_rows(model.neighbours());
  for (std::size_t k = rows.begin[100]; k < rows.begin[101]; ++k)
    touched.push_back(rows.other[k]);
  try {
    model.forces(u, {}, f, one_thread);
    FAIL() << "no error";
  } catch (const particle::BadState& bad) {
    EXPECT_EQ(bad.particle, *std::min_element(touched.begin(), touched.end()));
  }
}

TEST(InstructionSets, AgreeToRoundOff) {
  const Body body = lattice(3, 6, 0.25);
  const Neighbours rows = find_neighbours(
      body, body.V, Kernel(KernelShape::cubic_spline, 3, 0.24), 1e6, one_thread);
  const Column u = random_column(body, 0.004, 1), v = random_column(body, 10, 2);
  const auto run = [&](Isa isa, PenaltyForm penalty) {
    const Points all(body);
    Column points = all.make_points(), H(3 * u.size()), T(3 * u.size()), f(u.size());
    all.set_displacements(u, 0, body.n, points);
    const State s{points.data(), v.data(), body.V.data(), H.data(), T.data(), f.data()};
    const Loops loops = choose_loops(3, StressLaw::neo_hookean, penalty, true, isa);
    EXPECT_EQ(rows.blocks, (std::vector<Index>{0, body.n}));
    loops.gradients(rows, 0, body.n, s);
    EXPECT_EQ(loops.stresses(rows, 0, body.n, {9e6, 6e6}, s), -1);
    loops.forces(rows, 0, body.n, {1e3, 1, 1e-4}, s);
    return f;
  };
  for (const PenaltyForm penalty :
       {PenaltyForm::none, PenaltyForm::ganzenmueller, PenaltyForm::potential}) {
    const Column expected = run(Isa::baseline, penalty);
    for (int isa = 1; isa <= static_cast<int>(best_isa()); ++isa) {
      const Column found = run(static_cast<Isa>(isa), penalty);
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-13 * largest(expected));
    }
  }
}

TEST(Method, IsRegisteredWithItsSettings) {
  const scene::MethodInfo& info = scene::MethodRegistry::instance().find("tlsph").info();
  std::vector<std::string> keys;
  for (const scene::ParameterInfo& p : info.parameters) keys.push_back(p.key);
  EXPECT_THAT(keys,
              testing::IsSupersetOf({"kernel", "support", "psi", "penalty", "alpha", "beta"}));
  EXPECT_NO_THROW(
      scene::Settings("tlsph", info.parameters, {{"kernel", "wendland-c2"}, {"psi", "0"}}));
  EXPECT_THROW(scene::Settings("tlsph", info.parameters, {{"kernel", "gaussian"}}), InputError);
  EXPECT_THROW(scene::Settings("tlsph", info.parameters, {{"psi", "-1"}}), InputError);
}

}  // namespace
}  // namespace concord::sph
