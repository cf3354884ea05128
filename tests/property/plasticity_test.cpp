// Plastic materials in every registered particle method: forces and tangent follow from the
// incremental energy, evaluations do not disturb the history, and neither do threads and
// rotations.

#include "particle/core/boundary.hpp"
#include "particle/core/stable_step.hpp"
#include "tests/property/bodies.hpp"

#include <Eigen/Geometry>

#include <cstring>

namespace concord::particle::test {
namespace {

/// Yields at strains of about 2 %.
const std::vector<scene::Override> soft_plastic{{"material.model", "j2-hencky"},
                                                {"material.yield_stress", "20 kPa"},
                                                {"material.saturation_stress", "30 kPa"},
                                                {"material.saturation_exponent", "15"},
                                                {"material.hardening_modulus", "50 kPa"}};

struct Case {
  const char* scene;
  double resolution;
  std::vector<scene::Override> set;
};

/// A block in 3D, and a body in plane strain with the methods that can have it.
std::vector<Case> cases(const Variant& variant) {
  return {{"spinning_block", 4, soft_plastic},
          refuses_curved_faces(variant) ? Case{"cooks_membrane", 6, soft_plastic}
                                        : Case{"tensile_bar", 14, {}}};
}

/// A body of the method with a history: loaded far beyond yield, and taken.
struct Loaded {
  Bench bench;
  Column u;
  explicit Loaded(const Variant& variant, const Case& c)
      : bench(variant, c.scene, c.resolution, c.set), u(bench.random_displacement(0.02)) {
    (void)bench.force(u);
    bench.model->commit();
  }
  /// Another displacement, partly unloading.
  Column further(double share = 0.7) const {
    Column v = bench.random_displacement(0.03, 41);
    for (std::size_t k = 0; k < v.size(); ++k) v[k] = share * u[k] + (1 - share) * v[k];
    return v;
  }
};

TEST_P(EveryMethod, PlasticFlowHappensAndStays) {
  for (const Case& c : cases(GetParam())) {
    Loaded l(GetParam(), c);
    const Energies e = l.bench.model->energies(l.u, l.bench.executor);
    double volume = 0;
    for (const double V : l.bench.body.V) volume += V;
    // Mean plastic strains of several per cent.
    EXPECT_GT(e.plastic, 0.03 * volume * l.bench.problem.material.hardening.yield_stress)
        << c.scene;
    const Energies unloaded = l.bench.model->energies(l.bench.zeros(), l.bench.executor);
    EXPECT_GE(unloaded.plastic, e.plastic * (1 - 1e-12)) << c.scene;  // never comes back
    EXPECT_GT(norm(l.bench.force(l.bench.zeros())), 0) << c.scene;    // residual stress
  }
}

TEST_P(EveryMethod, PlasticForceIsTheGradientOfTheIncrementalEnergy) {
  for (const Case& c : cases(GetParam())) {
    Loaded l(GetParam(), c);
    Bench& b = l.bench;
    if (!b.model->has_potential()) continue;  // declared, see forces_test.cpp
    const Column u = l.further(), f = b.force(u);
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const Column d = random_direction(b, seed);
      double power = 0;
      for (std::size_t k = 0; k < d.size(); ++k) power -= f[k] * d[k];
      const auto energy = [&](double s) {
        const Energies e = b.model->energies(moved(u, d, s), b.executor);
        return e.internal + e.plastic + e.stabilisation;
      };
      const double s = 1e-5 * b.body.h;
      // The energy has a continuous first derivative only, where a particle begins to yield:
      // second order in the step there.
      EXPECT_NEAR((energy(s) - energy(-s)) / (2 * s), power, 1e-7 * norm(f) * norm(d))
          << c.scene;
    }
  }
}

TEST_P(EveryMethod, PlasticTangentIsTheDerivativeOfTheForce) {
  for (const Case& c : cases(GetParam())) {
    Loaded l(GetParam(), c);
    Bench& b = l.bench;
    const Column u = l.further(), d = random_direction(b, 17);
    const ForceModel::Stiffness K = b.model->tangent(u);
    if (b.model->has_potential()) {
      EXPECT_LT(asymmetry(K), 1e-11);
    }
    EXPECT_LT(tangent_error(b, K, u, d, 1e-6 * b.body.h), 1e-6) << c.scene;
  }
}

TEST_P(EveryMethod, EvaluationsLeaveTheHistoryAlone) {
  for (const Case& c : cases(GetParam())) {
    Loaded l(GetParam(), c);
    const Column first = l.bench.force(l.u);
    (void)l.bench.force(l.further(-0.5));
    (void)l.bench.model->energies(l.further(), l.bench.executor);
    (void)l.bench.model->tangent(l.further());
    const Column again = l.bench.force(l.u);
    EXPECT_EQ(std::memcmp(first.data(), again.data(), first.size() * sizeof(double)), 0)
        << c.scene;
  }
}

/// What flows now may unload in the next step: the stable step is that of the elastic response.
TEST_P(EveryMethod, PlasticFlowDoesNotLengthenTheStableStep) {
  using Overrides = std::vector<scene::Override>;
  const Case plane = cases(GetParam())[1];
  const auto omega = [&](const Overrides& set) {
    Overrides all = plane.set;
    all.insert(all.end(), set.begin(), set.end());
    Bench b(GetParam(), plane.scene, plane.resolution, all);
    const Column u =
        b.column([&](Index a) { return Vec3(0, 0.02 * b.body.position(a)[1], 0); });
    (void)b.force(u);
    b.model->commit();
    const Constraints constraints(b.problem, b.body);
    return SpectralRadius(*b.model, constraints, b.executor).omega_max(u);
  };
  // Stresses are below a hundredth of the moduli.
  const double elastic =
      omega({{"material.yield_stress", "1e6 GPa"}, {"material.saturation_stress", "1e6 GPa"}});
  EXPECT_NEAR(omega({}), elastic, 0.03 * elastic);
}

TEST_P(EveryMethod, PlasticityDoesNotSeeThreads) {
  Column f[2];
  for (const int threads : {1, 3}) {
    Bench b(GetParam(), "spinning_block", 33, soft_plastic);  // three blocks
    for (const double share : {1.0, 0.2, 1.3}) {
      const Column u = moved(b.zeros(), b.random_displacement(), share);
      f[threads == 3] = b.force(u, threads);
      b.model->commit();
    }
  }
  EXPECT_EQ(std::memcmp(f[0].data(), f[1].data(), f[0].size() * sizeof(double)), 0);
}

TEST_P(EveryMethod, PlasticHistoryTurnsWithTheBody) {
  Loaded l(GetParam(), cases(GetParam())[0]);
  Bench& b = l.bench;
  const Mat3 R = Eigen::AngleAxisd(2.3, Vec3(0.3, -1, 0.7).normalized()).toRotationMatrix();
  const Column u = l.further();
  const Column turned = b.column([&](Index a) {
    return Vec3(R * (b.body.position(a) + b.at(u, a)) - b.body.position(a));
  });
  const Column f = b.force(u), g = b.force(turned);
  const Column expected = b.column([&](Index a) { return Vec3(R * b.at(f, a)); });
  EXPECT_LT(norm(moved(g, expected, -1)), 1e-12 * norm(f));
}

}  // namespace
}  // namespace concord::particle::test
