// Ways of pairs through the cells, local supports, whole runs with pairs that break.

#include "fracture_sample.hpp"

#include "scene/method.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace concord::sph {
namespace {

TEST(Springs, TheWayOfAPairLeadsThroughTheCellsOnItsLine) {
  const scene::Problem problem = whole_plate();
  const Body body = body_of(problem);
  const FracturingSph model(body, problem, breakable(), one_thread);
  EXPECT_TRUE(model.springs().hidden_pairs().empty());
  // A pair goes with a spring exactly if its line leads from the cell of one end to that of the
  // other: the nearest particles along it, found by sampling.
  Springs springs(body, model.elastic().neighbours(), SpringLayout::edges);
  Index spring = 0;
  while ((body.position(springs.first(spring)) - Vec3(0.01, 0.01, 0)).norm() > body.h) ++spring;
  const Index i = springs.first(spring), j = springs.second(spring);
  const std::vector<Index> broken = springs.break_up(std::array{spring}, {});
  const std::set<Index> went(broken.begin(), broken.end());
  EXPECT_GT(went.size(), 3u);
  for (const Index a : {i, j}) {
    for (const Index p : springs.pairs_at(a)) {
      const auto& pair = springs.pair(p);
      bool crosses = pair.a == i && pair.b == j;
      Index before = pair.a;
      for (int k = 0; k <= 2000; ++k) {
        const Vec3 X = body.position(pair.a) +
                       k / 2000.0 * (body.position(pair.b) - body.position(pair.a));
        Index nearest = before;
        for (const Index q : springs.springs_at(before)) {
          const Index other = springs.first(q) == before ? springs.second(q) : springs.first(q);
          if ((X - body.position(other)).norm() < (X - body.position(nearest)).norm())
            nearest = other;
        }
        crosses = crosses || (std::min(before, nearest) == i && std::max(before, nearest) == j);
        before = nearest;
      }
      EXPECT_EQ(went.count(p) > 0, crosses) << pair.a << " " << pair.b;
    }
  }
}

// Cutting the springs across a line cuts every pair across it: with them goes all that they
// hid.
TEST(Springs, BrokenEdgesMakeACleanCut) {
  const scene::Problem problem = whole_plate();
  const Body body = body_of(problem);
  const FracturingSph model(body, problem, breakable(), one_thread);
  Springs springs(body, model.elastic().neighbours(), SpringLayout::edges);
  const Vec3 left(-1, 0.00991, 0), right(1, 0.01013, 0);
  const auto broken = springs.break_up(springs.springs_across(left, right), {});
  EXPECT_GT(broken.size(), 100u);
  const std::vector<Index> across = springs.pairs_across(left, right);
  EXPECT_GT(across.size(), 3 * springs.springs_across(left, right).size());
  for (const Index p : across) EXPECT_FALSE(springs.holds(p));
}

TEST(Neighbours, LocalSupportIsTheMeanOfBothEnds) {
  for (const int dim : {2, 3}) {
    const Body body = lattice(dim, dim == 3 ? 7 : 15, 0.25);
    const Kernel kernel(KernelShape::wendland_c2, dim, 0.2);
    std::vector<double> sizes;
    for (Index a = 0; a < body.n; ++a) sizes.push_back(1.2 + 0.2 * random(3, a));
    const Neighbours lists = find_neighbours(body, body.V, kernel, 1, Executor(2), sizes);
    const DirectedRows rows = directed_rows(lists);
    for (Index a = 0; a < body.n; ++a) {
      std::size_t k = rows.begin[a];
      for (Index b = 0; b < body.n; ++b) {
        const double r = (body.position(b) - body.position(a)).norm(),
                     R = 0.1 * (sizes[a] + sizes[b]);
        if (b == a || r >= R) continue;
        ASSERT_EQ(rows.other[k], b);
        const Kernel own(KernelShape::wendland_c2, dim, R);
        const double areas = body.V[a] * body.V[b] / body.thickness;
        EXPECT_NEAR(lists.weight[rows.entry[k]], areas * own.slope(r),
                    1e-13 * areas * own.slope(0));
        EXPECT_NEAR(lists.stiffness[rows.entry[k]], areas * own.value(r) / (r * r),
                    1e-13 * areas * own.value(0) / (r * r));
        ++k;
      }
      EXPECT_EQ(k, rows.begin[a + 1]);
    }
  }
}

scene::Result run_plate(const scene::Problem& problem,
                        const std::map<std::string, std::string>& more = {}) {
  scene::RunRequest request;
  request.h = 0.5e-3;
  request.settings = {{"smoothing", "local"},
                      {"penalty", "potential"},
                      {"support", "2.4"},
                      {"psi", "2"},
                      {"courant", "0.1"}};
  for (const auto& [key, value] : more) request.settings[key] = value;
  scene::Result result;
  scene::MethodRegistry::instance().find("tlsph").run(problem, request, result);
  return result;
}

TEST(SphFractureRun, TheEnergyBalanceClosesWhileItBreaks) {
  for (const char* criterion : {"strain", "energy"}) {
    const scene::Result result = run_plate(plate({{"fracture.criterion", criterion}}));
    EXPECT_GT(result.quantities.at("broken_bonds"), 30) << criterion;
    EXPECT_LT(result.quantities.at("energy_residual"), 5e-4) << criterion;
    EXPECT_GT(result.quantities.at("crack_advance"), 5e-3) << criterion;
  }
}

// A free plate whose halves fly apart: it breaks into pieces that keep both momenta.
TEST(SphFractureRun, FragmentsFlyOn) {
  scene::Problem problem = whole_plate();
  problem.boundaries.clear();
  problem.quantities.clear();
  problem.fracture->arrival.clear();
  problem.end_time = 10e-6;
  problem.initial_velocity.emplace();
  problem.initial_velocity->component[0] = scene::Expression("1e4*(X - 0.01) + 7 - 3*Y", {});
  problem.initial_velocity->component[1] = scene::Expression("3*X", {});
  const scene::Result result = run_plate(problem);
  EXPECT_GT(result.quantities.at("fragments"), 3);
  EXPECT_LT(result.invariants.at("linear_momentum_drift"), 1e-12);
  EXPECT_LT(result.invariants.at("angular_momentum_drift"), 1e-12);
  EXPECT_LT(result.invariants.at("energy_drift"), 5e-4);
}

TEST(SphFractureRun, SettingsThatContradictTheSceneAreInputErrors) {
  const auto key_of = [](const scene::Problem& problem,
                         const std::map<std::string, std::string>& more) {
    try {
      (void)run_plate(problem, more);
    } catch (const InputError& e) {
      return e.key();
    }
    return std::string("no error");
  };
  EXPECT_EQ(key_of(plate(), {{"alpha", "1"}}), "tlsph.alpha");
  EXPECT_EQ(key_of(plate(), {{"beta", "1"}}), "tlsph.beta");
  EXPECT_EQ(key_of(plate(), {{"smoothing", "uniform"}, {"support", "1.5"}}), "tlsph.support");
  scene::Problem elastic = plate();
  elastic.fracture.reset();
  EXPECT_EQ(key_of(elastic, {{"springs", "pairs"}}), "tlsph.springs");
  EXPECT_EQ(key_of(elastic, {{"pair_damping", "0.1"}}), "tlsph.pair_damping");
}

}  // namespace
}  // namespace concord::sph
