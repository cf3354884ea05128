// Regions at rest are left out without changing a bit, for every registered particle method.

#include "particle/core/leapfrog.hpp"
#include "tests/property/bodies.hpp"

#include <cstring>

namespace concord::particle::test {
namespace {

struct Outcome {
  Column u, v, f;
  Energies energies;
  double particle_steps = 0;
};

Outcome run(Bench& b, bool rest_regions, int threads, int steps, double ramp_time) {
  const Executor executor(threads);
  const Constraints constraints(b.problem, b.body);
  const ExternalLoads loads(b.problem, *b.model);
  Recorder recorder(b.problem, *b.model, constraints, executor, {}, false);
  Leapfrog leapfrog(b.problem, *b.model, constraints, loads, executor, ramp_time);
  LeapfrogOptions options;
  options.dt_fixed = 0.3 * b.body.h_min / b.problem.material.longitudinal_wave_speed();
  options.end_time = steps * options.dt_fixed;
  options.rest_regions = rest_regions;
  LeapfrogOutcome outcome;
  leapfrog.run(options, recorder, outcome);
  EXPECT_EQ(outcome.steps, steps);
  const State state = leapfrog.state();
  const auto column = [](std::span<const double> s) { return Column(s.begin(), s.end()); };
  return {column(state.u), column(state.v), column(state.unbalanced),
          b.model->energies(state.u, executor), outcome.particle_steps};
}

bool same_bits(const Column& a, const Column& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

void compare(const std::string& scene, double resolution,
             const std::vector<scene::Override>& set, double ramp_time,
             const Variant& variant) {
  constexpr int steps = 12;
  Bench whole(variant, scene, resolution, set);
  const Outcome expected = run(whole, false, 1, steps, ramp_time);
  EXPECT_EQ(expected.particle_steps, static_cast<double>(steps) * whole.body.bulk);
  EXPECT_GT(norm(expected.u), 0);
  for (const int threads : {1, 3}) {
    Bench b(variant, scene, resolution, set);
    const Outcome got = run(b, true, threads, steps, ramp_time);
    EXPECT_TRUE(same_bits(got.u, expected.u)) << threads << " threads";
    EXPECT_TRUE(same_bits(got.v, expected.v)) << threads << " threads";
    EXPECT_TRUE(same_bits(got.f, expected.f)) << threads << " threads";
    EXPECT_EQ(got.energies.internal, expected.energies.internal);
    EXPECT_EQ(got.energies.plastic, expected.energies.plastic);
    // tlsph: the front of exact rest moves by two supports a step, in whole blocks
    const double most = variant.method == "tlsph" ? 1 : 0.8;
    if (b.model->has_parts())
      EXPECT_LE(got.particle_steps, most * expected.particle_steps);
    else
      EXPECT_EQ(got.particle_steps, expected.particle_steps);
  }
}

TEST_P(EveryMethod, WaveFromAStruckEndFindsTheRestAsIfItHadBeenComputed) {
  compare("cantilever", 8, {{"initial.velocity", R"set(["0", "0", "(X > 5.7 ? V : 0)"])set"}},
          0, GetParam());
}

/// Prescribed motion, history of the material, plane strain.
TEST_P(EveryMethod, WaveFromAPulledEndFindsTheRestAsIfItHadBeenComputed) {
  if (refuses_curved_faces(GetParam())) {
    EXPECT_THROW(Bench(GetParam(), "tensile_bar", 14), InputError);
    compare("cooks_membrane", 20,
            {{"boundary.0.kind", "displacement"}, {"boundary.0.value", "[\"-1e-3*t\", \"0\"]"}},
            1e-2, GetParam());
    return;
  }
  compare("tensile_bar", 80, {}, 1e-4, GetParam());
}

TEST(RestRegions, MinusZeroIsNoRest) {
  Bench b({"delaunay", "delaunay", {}}, "cantilever", 8);
  const Constraints constraints(b.problem, b.body);
  const ExternalLoads loads(b.problem, *b.model);
  const Column zero = b.zeros();
  RestRegions still(*b.model, constraints, loads, zero, zero);
  EXPECT_TRUE(still.awake().empty());
  Column v = zero;
  v[static_cast<std::size_t>(b.body.n / 2) * b.body.stride] = -0.0;
  still.look(zero, v);
  ASSERT_EQ(still.awake().size(), 0u) << "nothing was worked on, so nothing can have moved";
  const RestRegions moved(*b.model, constraints, loads, zero, v);
  ASSERT_EQ(moved.awake().size(), 1u);
  EXPECT_LE(moved.awake()[0].first, b.body.n / 2);
  EXPECT_GT(moved.awake()[0].last, b.body.n / 2);
  EXPECT_FALSE(moved.all_awake());
}

}  // namespace
}  // namespace concord::particle::test
