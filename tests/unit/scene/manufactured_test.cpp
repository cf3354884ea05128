// The library's manufactured solutions: velocity, boundary values and body force belong to the
// exact displacement and to the project's stress law, by differences.

#include "scene/material.hpp"
#include "scene/reader.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

using namespace concord;
using namespace concord::scene;

namespace {

/// f'(0) of a vector function by fourth-order central differences, error h^4 f^(5)/30.
template <class F> Vec3 derivative(const F& f, double h) {
  return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

struct Manufactured {
  Problem problem;
  ElasticLaw law;
  double step;  ///< of differences in space [m]
  double tick;  ///< of differences in time [s]

  Manufactured(const char* name, const std::vector<Override>& overrides, double step)
      : problem(read_problem(name, overrides)), law(problem.material, problem.dimension),
        step(step), tick(1e-3 * problem.end_time) {}

  Mat3 gradient(const Vec3& X, double t) const {
    return problem.exact_displacement->gradient(X, t, step);
  }
  Vec3 divergence(const Vec3& X, double t) const {
    Vec3 sum = Vec3::Zero();
    for (int j = 0; j < problem.dim(); ++j)
      sum += derivative(
          [&](double s) -> Vec3 {
            return law.stress(gradient(X + s * Vec3::Unit(j), t)).col(j);
          },
          step);
    return sum;
  }
  Vec3 acceleration(const Vec3& X, double t) const {
    return derivative([&](double s) { return (*problem.exact_velocity)(X, t + s); }, tick);
  }
  /// rho a - Div P - b [N/m^3].
  Vec3 residual(const Vec3& X, double t) const {
    return problem.material.rho0 * acceleration(X, t) - divergence(X, t) -
           (*problem.body_force)(X, t);
  }
};

struct Scene {
  const char* name;
  std::vector<Override> overrides;
  double step;
  Vec3 low, high;  ///< box in which points are drawn
};

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all{
      {"axis_aligned_mms", {}, 1e-3, {0.01, 0.01, 0.01}, {0.99, 0.99, 0.99}},
      {"axis_aligned_mms",
       {{"parameters.G", "0.1"}},
       1e-3,
       {0.01, 0.01, 0.01},
       {0.99, 0.99, 0.99}},
      {"vortex", {}, 2.5e-4, {-1.3, -1.3, 0}, {1.3, 1.3, 0}},
      {"vortex_ring", {{"parameters.G", "0.2"}}, 2.5e-4, {-1.3, -1.3, 0}, {1.3, 1.3, 0}}};
  return all;
}

/// Points of the box and times of the run; of vortices none within four steps of the edges of
/// the ring, where second derivatives jump.
std::vector<std::pair<Vec3, double>> samples(const Scene& scene, const Problem& problem) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::pair<Vec3, double>> points;
  while (points.size() < 200) {
    Vec3 X;
    for (int i = 0; i < 3; ++i)
      X[i] = scene.low[i] + unit(random) * (scene.high[i] - scene.low[i]);
    const double t = problem.end_time * (0.01 + 0.98 * unit(random));
    const double from_edge = std::abs(std::abs(X.head<2>().norm() - 1) - 0.25);
    if (problem.dim() == 2 && from_edge < 8 * scene.step) continue;
    points.emplace_back(X, t);
  }
  return points;
}

}  // namespace

TEST(Manufactured, BodyForceHoldsTheExactMotion) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const Manufactured motion(scene.name, scene.overrides, scene.step);
    const auto points = samples(scene, motion.problem);
    double scale = 0, worst = 0, stress = 0;
    for (const auto& [X, t] : points) {
      scale = std::max(scale, (*motion.problem.body_force)(X, t).norm());
      stress = std::max(stress, motion.divergence(X, t).norm());
      worst = std::max(worst, motion.residual(X, t).norm());
    }
    EXPECT_GT(stress, 0.1 * scale) << "the stress takes part";
    EXPECT_LT(worst, 1e-6 * scale);
  }
}

TEST(Manufactured, VelocitiesAreTheTimeDerivatives) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const Manufactured motion(scene.name, scene.overrides, scene.step);
    const Problem& problem = motion.problem;
    double scale = 0, worst = 0, start = 0;
    for (const auto& [X, t] : samples(scene, problem)) {
      const Vec3 v = (*problem.exact_velocity)(X, t);
      const Vec3 by_differences = derivative(
          [&](double s) { return (*problem.exact_displacement)(X, t + s); }, motion.tick);
      scale = std::max(scale, v.norm());
      worst = std::max(worst, (v - by_differences).norm());
      start = std::max(
          start, ((*problem.initial_velocity)(X, 0) - (*problem.exact_velocity)(X, 0)).norm());
      EXPECT_EQ((*problem.exact_displacement)(X, 0).norm(), 0);
    }
    EXPECT_LT(worst, 1e-8 * scale);
    EXPECT_LT(start, 1e-14 * scale);
  }
}

TEST(Manufactured, FacesOfTheCubeArePlanesOfSymmetry) {
  const Manufactured motion("axis_aligned_mms", {{"parameters.G", "0.1"}}, 1e-3);
  const double t = 0.7 * motion.problem.end_time;
  for (int i = 0; i < 3; ++i)
    for (const double face : {0.0, 1.0}) {
      Vec3 X(0.3, 0.6, 0.8);
      X[i] = face;
      const Mat3 P = motion.law.stress(motion.gradient(X, t));
      EXPECT_NEAR((*motion.problem.exact_displacement)(X, t)[i], 0, 1e-16);
      for (int j = 0; j < 3; ++j)
        if (j != i) EXPECT_NEAR(P(j, i), 0, 1e-6 * motion.problem.material.E * 1e-3);
    }
}

TEST(Manufactured, EdgesOfTheVortexRest) {
  const Manufactured motion("vortex_ring", {}, 1e-5);
  for (const double R : {0.75, 1.25})
    for (const double angle : {0.3, 2.0, 4.4}) {
      const Vec3 X(R * std::cos(angle), R * std::sin(angle), 0);
      EXPECT_LT((*motion.problem.exact_displacement)(X, 0.2).norm(), 1e-14);
      EXPECT_LT(motion.gradient(X, 0.2).norm(), 0.02) << "alpha' vanishes there as well";
    }
}
