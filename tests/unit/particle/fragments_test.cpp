// Fragments of irregular arrangements: what is too flat to be held goes, and the step follows
// what a break has left.

#include "tests/unit/particle/fragments.hpp"
#include "tests/unit/potential.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace concord::particle::delaunay::fragments {

// Lone slivers carried such runs off: turned inside out within the average that hid them, by
// stretches that no bond tells of, or by frequencies above the step's.
TEST(Fragments, AnIrregularBeamIsTornToTheEnd) {
  for (const double perturb : {0.1, 0.2}) {
    for (const int seed : {1, 2, 3}) {
      SCOPED_TRACE(testing::Message() << perturb << " seed " << seed);
      const scene::Result result = run_torn(perturb, seed, {{"beta", "0"}, {"courant", "0.1"}});
      EXPECT_EQ(result.t_end, 0.2);
      EXPECT_GT(result.quantities.at("flat_simplices"), 0);
      EXPECT_GE(result.quantities.at("fragments"), 2);
      EXPECT_GT(result.quantities.at("isolated_particles"), 20);
      EXPECT_LT(result.invariants.at("linear_momentum_drift"), 1e-12);
      EXPECT_LT(result.invariants.at("angular_momentum_drift"), 1e-12);
      EXPECT_LT(result.invariants.at("energy_drift"), 5e-4);
      for (const Vec3& u : result.samples.u) ASSERT_TRUE(u.allFinite());
    }
  }
}

// What is left in the balance is the leapfrog's own error, of second order in the step, so that
// no deletion leaves anything out.
TEST(Fragments, TheBalanceClosesWithTheSquareOfTheStep) {
  for (const char* beta : {"0", "0.5"}) {
    const auto drift = [&](const char* courant) {
      return run_torn(0.2, 2, {{"beta", beta}, {"courant", courant}})
          .invariants.at("energy_drift");
    };
    const double coarse = drift("0.1"), fine = drift("0.025");
    EXPECT_LT(fine, 2e-5) << beta;
    EXPECT_GT(std::log2(coarse / fine) / 2, 1.6) << beta;
  }
}

TEST(Fragments, TheLongestStepTearsTheBeamToo) {
  for (const char* beta : {"0", "0.5"}) {
    const scene::Result result = run_torn(0.2, 2, {{"beta", beta}, {"dt_factor", "0.95"}});
    EXPECT_EQ(result.t_end, 0.2);
    EXPECT_LT(result.invariants.at("energy_drift"), 0.01) << beta;
  }
}

// A lattice's tetrahedra are thicker than that, alone and in any company, so that they all
// stay.
TEST(Fragments, OfALatticeNoneIsFlat) {
  const scene::Problem problem = torn();
  const Body body = torn_body(problem, 1, 0);
  Network network(body, false);
  double least = 1, alone = 1;
  for (Index t = 0; t < static_cast<Index>(body.triangulation.size()); ++t)
    if (t % 7 != 3) network.remove({&t, 1});
  for (Index a = 0; a < body.n; ++a) {
    if (network.omega()[a] == 0) continue;
    least = std::min(least, thickness(body, network, a));
    if (network.simplices_at(a).size() == 1)
      alone = std::min(alone, thickness(body, network, a));
  }
  EXPECT_GT(least, 0.3);
  EXPECT_NEAR(alone, 1.0 / 3, 1e-9);
}

// Above the true frequency, and not far above.
TEST(Fragments, TheBoundIsAboveTheTrueFrequency) {
  const scene::Problem problem = torn();
  for (const FractureParameters& parameters :
       {FractureParameters{0, 0, 0}, FractureParameters{0, 0.3, 0.6}}) {
    const Body body = torn_body(problem, 2);
    FractureModel model(body, problem, parameters);
    const Column u = test::random_column(body, 0.01 * body.h, 4);
    std::vector<Index> all;
    for (Index a = 0; a < body.n; ++a) all.push_back(a);
    const ContactFactors contact{parameters.xi_n * problem.material.E,
                                 parameters.xi_t * problem.material.mu};
    for (int round = 0; round < 3; ++round) {
      const double omega = omega_of(model, problem, body, u);
      Stiffening now(body, model.network(), model.constitution(), contact);
      const double bound = now.near(all, u).omega;
      EXPECT_GT(bound, omega);
      EXPECT_LT(bound, 2.2 * omega);
      break_some(model, body, round);
    }
  }
}

// Followed from break to break it is, to the bit, what it is made anew.
TEST(Fragments, TheBoundIsFollowed) {
  const scene::Problem problem = torn();
  const Body body = torn_body(problem, 2);
  FractureModel model(body, problem, {0, 0.1, 0.1});
  const Column still(body.X.size(), 0.0);
  const ContactFactors contact{0.1 * problem.material.E, 0.1 * problem.material.mu};
  EXPECT_EQ(model.stiffened(still).omega, 0);
  Stiffening followed(body, model.network(), model.constitution(), contact);
  std::size_t known = 0;
  for (int round = 0; round < 5; ++round) {
    break_some(model, body, round, 301);
    std::vector<Index> touched;
    for (; known < model.record().dead.size(); ++known) {
      const Index* v = &body.triangulation.simplices[4 * model.record().dead[known].simplex];
      touched.insert(touched.end(), v, v + 4);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    ASSERT_FALSE(touched.empty());
    const double bound = followed.near(touched, still).omega;
    Stiffening anew(body, model.network(), model.constitution(), contact);
    EXPECT_EQ(bound, anew.near(touched, still).omega);
    EXPECT_EQ(bound, model.stiffened(still).omega);
  }
}

// Against the eigenvalues of the assembled matrix, in the plane and in 3D.
TEST(Fragments, TheRateOfDamping) {
  scene::Problem plate = scene::read_problem("pmma_plate", {{"parameters.width", "5 mm"},
                                                            {"parameters.height", "5 mm"},
                                                            {"parameters.strip", "2 mm"},
                                                            {"parameters.crack", "2 mm"}});
  scene::Problem cube = torn();
  for (const bool solid : {false, true}) {
    const scene::Problem& problem = solid ? cube : plate;
    const Body body = make_body(problem, solid ? 0.5 : 1e-3, 0.1, 1);
    FractureModel model(body, problem, {1, 0, 0});
    const Constraints constraints(problem, body);
    const Executor one(1);
    const Column still(body.X.size(), 0.0);
    const auto n = static_cast<Eigen::Index>(body.X.size());
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, n);
    Column v = still, f = still, free(still.size(), 1.0);
    constraints.clear(free);
    for (Eigen::Index k = 0; k < n; ++k) {
      if (k % body.stride >= body.dim) continue;
      v = still;
      v[k] = free[k];
      model.forces(still, v, f, one);
      for (Eigen::Index j = 0; j < n; ++j) C(j, k) = -f[j] * free[j] / body.m[j / body.stride];
    }
    const double expected = C.eigenvalues().real().maxCoeff();
    const double found = SpectralRadius(model, constraints, one).damping_max(still, 1e-6, 400);
    EXPECT_NEAR(found, expected, 0.02 * expected) << solid;
  }
}

// Each break decides what follows, so that arrivals scatter by some per cent; damping that
// grows broke the plate's end at a fifth of the time.
TEST(Fragments, TheLongestStepGivesThePlatesCrack) {
  for (const char* perturb : {"0", "0.2"}) {
    const auto run = [&](const char* dt_factor) {
      const scene::Problem problem = scene::read_problem("pmma_plate", {});
      scene::RunRequest request;
      request.h = 0.5e-3;
      request.perturb = std::stod(perturb);
      request.settings = {
          {"dt_factor", dt_factor}, {"beta", "1"}, {"xi_n", "0"}, {"xi_t", "0"}};
      scene::Result result;
      scene::MethodRegistry::instance().find("delaunay").run(problem, request, result);
      return result;
    };
    const scene::Result longest = run("0.95"), half = run("0.5");
    EXPECT_NEAR(longest.quantities.at("crack_arrival"), half.quantities.at("crack_arrival"),
                0.1 * half.quantities.at("crack_arrival"))
        << perturb;
    EXPECT_LT(longest.quantities.at("energy_residual"), 5e-4) << perturb;
  }
}

}  // namespace concord::particle::delaunay::fragments
