// The discretised bodies of all methods: what must hold for each of them.

#include "particle/core/body.hpp"
#include "scene/material.hpp"
#include "studies/probes/modes.hpp"
#include "studies/probes/states.hpp"
#include "studies/probes/stepping.hpp"
#include "tests/unit/probes/springs.hpp"

#include <Eigen/Geometry>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace concord::probes {
namespace {

struct Variant {
  std::string name, method;
  std::map<std::string, std::string> settings;
  bool potential;
};
void PrintTo(const Variant& variant, std::ostream* out) { *out << variant.name; }

std::vector<Variant> variants() {
  std::vector<Variant> list;
  for (const scene::Method* method : scene::MethodRegistry::instance().all()) {
    if (dynamic_cast<const scene::Discretises*>(method) != nullptr)
      list.push_back(
          {method->info().name, method->info().name, {}, method->info().name != "tlsph"});
  }
  list.push_back({"delaunay_xi0", "delaunay", {{"xi_n", "0"}, {"xi_t", "0"}}, true});
  list.push_back({"tlsph_psi0", "tlsph", {{"psi", "0"}}, true});
  const auto fem = [](const Variant& v) { return v.method == "fem"; };
  if (std::any_of(list.begin(), list.end(), fem))
    list.push_back({"fem_Q1", "fem", {{"element", "Q1"}}, true});
  return list;
}

class Body : public testing::TestWithParam<Variant> {
 protected:
  std::unique_ptr<scene::DiscreteBody> make(double resolution = 3, double perturb = 0.2) {
    scene::RunRequest request;
    request.h = m_problem.reference_length / resolution;
    request.perturb = perturb;
    request.seed = 3;
    request.settings = GetParam().settings;
    const auto& method = dynamic_cast<const scene::Discretises&>(
        scene::MethodRegistry::instance().find(GetParam().method));
    return method.discretise(m_problem, request);
  }
  /// u = A X at every point.
  static std::vector<double> affine(const scene::DiscreteBody& body, const Mat3& A) {
    std::vector<double> u;
    for (const Vec3& X : body.positions())
      for (int i = 0; i < body.dim(); ++i) u.push_back(A.row(i).dot(X));
    return u;
  }
  /// A smooth finite deformation.
  static std::vector<double> smooth(const scene::DiscreteBody& body) {
    std::vector<double> u;
    for (const Vec3& X : body.positions()) {
      u.push_back(0.1 * X[0] + 0.05 * X[1] * X[1]);
      u.push_back(-0.08 * X[0] * X[2] + 0.05 * X[1]);
      u.push_back(0.1 * X[0] - 0.05 * X[2]);
    }
    return u;
  }
  static double norm(const std::vector<double>& v) {
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()))
        .norm();
  }

  scene::Problem m_problem = scene::read_problem("spinning_block");
};

TEST_P(Body, HasTheMassOfTheBody) {
  const auto body = make(3, 0);  // Gauss-Lobatto rules are exact on boxes
  double mass = 0;
  for (const double m : body->masses()) {
    EXPECT_GT(m, 0);
    mass += m;
  }
  EXPECT_NEAR(mass / m_problem.material.rho0, 1, 1e-12);  // 1 m^3
}

TEST_P(Body, HasSixZeroModesOnAFreeBlock) {
  const auto body = make();
  const std::vector<double> rest(3 * body->positions().size(), 0.0);
  const Modes found = modes(*body, rest);
  const double zero = 1e-9 * found.real.back();
  for (int k = 0; k < 6; ++k) EXPECT_LT(std::abs(found.real[k]), zero) << k;
  EXPECT_GT(found.real[6], 1e3 * zero);
}

TEST_P(Body, FeelsNoForceInARotation) {
  const auto body = make();
  const Mat3 R = Eigen::AngleAxisd(2.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<double> f(3 * body->positions().size()), scale = f;
  body->force(affine(*body, R - Mat3::Identity()), f);
  body->force(affine(*body, 0.1 * Mat3::Identity()), scale);
  EXPECT_LT(norm(f), 1e-12 * norm(scale));
}

TEST_P(Body, StiffnessIsTheSlopeOfTheForce) {
  const auto body = make();
  const std::vector<double> u = smooth(*body);
  const Eigen::SparseMatrix<double> K = body->stiffness(u);
  Eigen::VectorXd d = Eigen::VectorXd::Random(K.cols());
  std::vector<double> at = u, plus(u.size()), minus(u.size());
  const double step = 1e-6;
  for (std::size_t k = 0; k < u.size(); ++k) at[k] = u[k] + step * d[static_cast<int>(k)];
  body->force(at, plus);
  for (std::size_t k = 0; k < u.size(); ++k) at[k] = u[k] - step * d[static_cast<int>(k)];
  body->force(at, minus);
  const Eigen::VectorXd product = K * d;
  double error = 0;
  for (std::size_t k = 0; k < u.size(); ++k)
    error += std::pow(product[static_cast<int>(k)] + (plus[k] - minus[k]) / (2 * step), 2);
  EXPECT_LT(std::sqrt(error), 1e-7 * product.norm());
  const double asymmetry =
      Eigen::SparseMatrix<double>(K - Eigen::SparseMatrix<double>(K.transpose())).norm() /
      K.norm();
  if (GetParam().potential)
    EXPECT_LT(asymmetry, 1e-12);
  else
    EXPECT_GT(asymmetry, 1e-6);
}

TEST_P(Body, ForceIsTheSlopeOfTheEnergyWhereThereIsAPotential) {
  const auto body = make();
  const std::vector<double> u = smooth(*body);
  std::vector<double> at = u, f(u.size());
  body->force(u, f);
  const Eigen::VectorXd d = Eigen::VectorXd::Random(static_cast<Eigen::Index>(u.size()));
  const double step = 1e-5;
  double work = 0, scale = 0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    at[k] = u[k] + step * d[static_cast<int>(k)];
    work += f[k] * d[static_cast<int>(k)];
    scale += std::abs(f[k] * d[static_cast<int>(k)]);
  }
  const double plus = body->energy(at);
  for (std::size_t k = 0; k < u.size(); ++k) at[k] = u[k] - step * d[static_cast<int>(k)];
  const double slope = (plus - body->energy(at)) / (2 * step);
  if (GetParam().potential)
    EXPECT_NEAR(slope, -work, 1e-7 * scale);
  else  // a penalty that is no gradient: its work is not in the energy
    EXPECT_GT(std::abs(slope + work), 1e-6 * scale);
}

TEST_P(Body, PressureIsThatOfTheLaw) {
  const auto body = make();
  Mat3 H = Mat3::Zero();
  H << -0.1, 0.05, 0, 0.02, -0.07, 0.01, 0, 0.03, -0.05;
  const scene::ElasticLaw law(m_problem.material, m_problem.dimension);
  const Mat3 F = Mat3::Identity() + H;
  const double exact = -(law.stress(H) * F.transpose()).trace() / (3 * F.determinant());
  std::vector<double> p(body->positions().size());
  body->pressure(affine(*body, H), p);
  EXPECT_GT(exact, 0);
  for (const double value : p) EXPECT_NEAR(value, exact, 1e-9 * exact);
}

TEST_P(Body, StepsAreStableUpToTwoOverTheHighestFrequency) {
  const auto body = make(2, 0.3);
  const std::vector<double> rest(3 * body->positions().size(), 0.0);
  const double exact = 2 / std::sqrt(modes(*body, rest).real.back());
  EXPECT_NEAR(stable_step(*body, rest, exact) / exact, 1, 1e-3);
  // The methods' own estimates come from below omega_max, hence from above the step; where they
  // stop early the factor 0.8 of the runs covers it.
  const double estimate = body->critical_step(rest);
  EXPECT_GT(estimate, 0.999 * exact);
  EXPECT_LT(estimate, 1.04 * exact);
}

/// The run itself, at fixed steps on both sides of the limit.
TEST_P(Body, RunsBlowUpBeyondThatStepAndNotBelow) {
  scene::Problem problem = scene::read_problem(
      "spinning_block", {{"initial.velocity", "[\"1e-3*X*Y\", \"1e-3*Z\", \"1e-3*X*X\"]"}});
  const auto body = make(2, 0.3);
  const std::vector<double> rest(3 * body->positions().size(), 0.0);
  const double critical = 2 / std::sqrt(modes(*body, rest).real.back());
  problem.frames = 0;
  problem.history_rows = 50;
  const auto drift = [&](double dt) {
    problem.end_time = 600 * dt;
    scene::RunRequest request;
    request.h = problem.reference_length / 2;
    request.perturb = 0.3;
    request.seed = 3;
    request.settings = GetParam().settings;
    request.settings["dt"] = fmt::format("{:.17g}", dt);
    scene::Result result;
    try {
      scene::MethodRegistry::instance().find(GetParam().method).run(problem, request, result);
    } catch (const SolveError&) {
      return 1e300;
    }
    return result.invariants.at("energy_drift");
  };
  EXPECT_LT(drift(0.98 * critical), 0.5);
  EXPECT_GT(drift(1.02 * critical), 0.9);
}

INSTANTIATE_TEST_SUITE_P(EveryMethod, Body, testing::ValuesIn(variants()),
                         [](const auto& info) { return info.param.name; });

TEST(Arrangements, TinyMovesOfALatticeMakeSlivers) {
  // Four points of a cube's face lie on a circle: moved a little they span a flat tetrahedron.
  const double h = 0.25;
  const particle::Body body =
      particle::make_body(scene::read_problem("spinning_block"), h, 1e-3, 1);
  long flat = 0;
  for (std::size_t s = 0; s < body.triangulation.size(); ++s)
    flat += body.simplex_volume(s) < 1e-3 * h * h * h;
  EXPECT_GT(flat, 20);
}

}  // namespace
}  // namespace concord::probes
