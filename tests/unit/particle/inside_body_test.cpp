// What core makes of particles inside a body: boundary points, constraints, loads, solvers,
// quantities of interest, the field up to the faces.

#include <gtest/gtest.h>

#include "tests/unit/particle/inside_bodies.hpp"

#include "particle/core/interpolant.hpp"
#include "particle/core/statics.hpp"

#include <Eigen/Eigenvalues>

namespace concord::particle {
namespace {

using test::cubes;
using test::Springs;

constexpr double k = 3e3;  // N/m

scene::Problem cube(const std::vector<scene::Override>& set = {}) {
  return scene::read_problem("swinging_cube", set);
}

/// The cube held at x0 and pulled at x1 along X, free else.
scene::Problem pulled(const std::string& u, bool is_static) {
  scene::Problem problem = cube();
  std::erase_if(problem.boundaries, [](const auto& bc) { return bc.group[0] != 'x'; });
  problem.boundaries[0].kind = scene::BoundaryKind::fixed;
  problem.boundaries[1].kind = scene::BoundaryKind::displacement;
  problem.boundaries[1].value.component = {};
  problem.boundaries[1].value.component[0] = scene::Expression(u, {});
  problem.initial_displacement = problem.initial_velocity = {};
  problem.exact_displacement = problem.exact_velocity = {};
  problem.quantities.clear();
  for (const char* group : {"x0", "x1"}) {
    scene::Quantity reaction;
    reaction.name = group;
    reaction.kind = scene::QuantityKind::reaction;
    reaction.group = group;
    problem.quantities.push_back(reaction);
    reaction.name = std::string(group) + "_mean";
    reaction.kind = scene::QuantityKind::average;
    reaction.field = "displacement";
    problem.quantities.push_back(reaction);
  }
  problem.is_static = is_static;
  problem.end_time = 1;
  return problem;
}

TEST(InsideBody, HasMassOnParticlesAndPointsOnFacesWithConditions) {
  const scene::Problem problem = cube();
  const Body body = cubes(problem, 3);
  EXPECT_TRUE(body.inside());
  EXPECT_EQ(body.bulk, 27);
  EXPECT_EQ(body.n, 27 + 6 * 9);
  double mass = 0, point_mass = 0;
  for (Index a = 0; a < body.n; ++a) (a < body.bulk ? mass : point_mass) += body.m[a];
  EXPECT_NEAR(mass, 1100, 1e-9);
  EXPECT_EQ(point_mass, 0);
  const Constraints constraints(problem, body);
  EXPECT_EQ(constraints.unknowns(), 81);
  EXPECT_EQ(constraints.dofs().size(), 3u * 6 * 9);
  EXPECT_FALSE(constraints.moving());
  for (const PrescribedDof& dof : constraints.dofs()) {
    const BoundaryPoint& point = body.boundary[dof.particle - body.bulk];
    const bool normal = std::abs(point.N[dof.component]) == 1;
    const bool symmetric = point.N.sum() < 0;  // x0, y0, z0
    EXPECT_EQ(dof.condition >= 0, normal == symmetric);
    if (dof.condition >= 0) {
      EXPECT_EQ(problem.boundaries[dof.condition].group,
                std::string(1, "xyz"[std::lround(std::abs(point.N.dot(Vec3(0, 1, 2))))]) +
                    (symmetric ? "0" : "1"));
    }
  }
  // Only the cell in the middle has no piece of the surface.
  EXPECT_EQ(std::count(body.triangulation.on_boundary.begin(),
                       body.triangulation.on_boundary.end(), 0),
            1);
  EXPECT_EQ(body.particle_at(5), 5);
  EXPECT_EQ(body.particle_at(body.bulk), body.boundary[0].particle);
}

TEST(InsideBody, RefusesConditionsWhereNoParticleLies) {
  const scene::Problem problem = scene::read_problem("patch_test_c");
  const Body body = cubes(scene::read_problem("patch_test_b"), 3);
  try {
    const Constraints constraints(problem, body);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_GT(e.where().line, 0);
    EXPECT_NE(e.found().find("corner_000"), std::string::npos);
    EXPECT_NE(e.allowed().find("surfaces"), std::string::npos);
  }
  EXPECT_THROW(points_of_group(body, "corner_000", {}), InputError);
}

TEST(InsideBody, ConditionsOnTheWholeBodyPrescribeEveryPoint) {
  const scene::Problem problem = scene::read_problem("patch_test_a");
  const Body body = cubes(problem, 3);
  const Constraints constraints(problem, body);
  EXPECT_EQ(constraints.unknowns(), 0);
  Column u(body.X.size(), 0.0);
  constraints.impose(1, u);
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 exact = (*problem.exact_displacement)(body.position(a), 1);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(u[4 * a + i], exact[i], 1e-18);
  }
}

struct StaticRun {
  scene::Problem problem;
  Body body;
  Springs model;
  Executor executor{1};
  Constraints constraints;
  ExternalLoads loads;
  Recorder recorder;
  Statics statics;
  StaticsOutcome outcome;

  StaticRun(scene::Problem p, int N)
      : problem(std::move(p)), body(cubes(problem, N)), model(body, problem, k),
        constraints(problem, body), loads(problem, model),
        recorder(problem, model, constraints, executor, {}, false),
        statics(problem, model, constraints, loads, executor) {
    StaticsOptions options;
    options.load_steps = 2;
    statics.run(options, recorder, outcome);
  }
  double quantity(const std::string& name) {
    for (const auto& [key, value] : recorder.quantities(statics.state()))
      if (key == name) return value;
    throw std::logic_error("no " + name);
  }
};

/// Springs in series: N - 1 of k and two of 2 k stretch as N of k.
TEST(InsideBody, StaticsStretchesTheSpringsUniformly) {
  const double U = 2e-3;
  StaticRun run(pulled("2e-3*t", true), 4);
  const State s = run.statics.state();
  for (Index a = 0; a < run.body.bulk; ++a)
    EXPECT_NEAR(s.u[4 * a], U * run.body.position(a)[0], 1e-12 * U);
  const double pull = 16 * k / 4 * U;
  EXPECT_NEAR(run.quantity("x1_x"), pull, 1e-9 * pull);
  EXPECT_NEAR(run.quantity("x0_x"), -pull, 1e-9 * pull);
  EXPECT_NEAR(run.quantity("x1_mean_x"), U, 1e-12 * U);
  EXPECT_EQ(run.quantity("x0_mean_x"), 0);
  EXPECT_NEAR(s.external_work, 0.5 * pull * U, 1e-9 * pull * U);  // linear: the rule is exact
}

/// A boundary point's free component holds nothing.
TEST(InsideBody, StaticsSeesRigidMotionsThatFacesLeaveFree) {
  scene::Problem problem = pulled("0", true);
  std::erase_if(problem.boundaries, [](const auto& bc) { return bc.group == "x0"; });
  const Body body = cubes(problem, 3);
  Springs model(body, problem, k);
  const Constraints constraints(problem, body);
  const ExternalLoads loads(problem, model);
  const Executor executor(1);
  EXPECT_THROW(Statics(problem, model, constraints, loads, executor), InputError);
}

TEST(InsideBody, SpreadsTractionsAsTheModelTells) {
  for (const char* traction : {"5", "5*t"}) {
    scene::Problem problem = pulled("0", true);
    problem.boundaries[1].kind = scene::BoundaryKind::traction;
    for (int i = 0; i < 3; ++i)
      problem.boundaries[1].value.component[i] = scene::Expression(i == 0 ? traction : "0", {});
    StaticRun run(std::move(problem), 4);
    EXPECT_EQ(run.loads.depend_on_time(), std::string(traction) == "5*t");
    Column f(run.body.X.size(), 0.0);
    run.loads.add(1, f);
    double sum = 0;
    for (Index a = 0; a < run.body.n; ++a) sum += f[4 * a];
    EXPECT_NEAR(sum, 5, 1e-12);  // on 1 m^2
    EXPECT_NEAR(run.quantity("x0_x"), -5, 1e-9);
    // 5/16 N on each line: N - 1 springs and one of half the length.
    const double U = 5.0 / 16 / k * 3.5;
    for (Index a = 0; a < run.body.bulk; ++a) {
      const double X = run.body.position(a)[0];
      EXPECT_NEAR(run.statics.state().u[4 * a], U * X / 0.875, 1e-10 * U);
    }
  }
}

TEST(InsideBody, StableStepIsThatOfTheParticles) {
  const scene::Problem problem = cube();
  const Body body = cubes(problem, 3);
  Springs model(body, problem, k);
  const Constraints constraints(problem, body);
  const Executor executor(1);
  Eigen::MatrixXd K = model.tangent(Column(body.X.size(), 0.0)).topLeftCorner(81, 81);
  K /= body.m[0];
  const double exact =
      std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().maxCoeff());
  const double omega =
      SpectralRadius(model, constraints, executor).omega_max(Column(body.X.size(), 0.0));
  EXPECT_LE(omega, exact * (1 + 1e-6));
  EXPECT_GT(omega, exact * (1 - 1e-2));
}

/// Pulled by a face that moves: what goes in is what is there, to second order in the step; and
/// the faces' forces on the body are its change of momentum.
TEST(InsideBody, EnergyOfAPulledBodyCloses) {
  const auto run = [](double dt) {
    const scene::Problem problem = pulled("1e-3*(1 - cos(6*t))", false);
    const Body body = cubes(problem, 3);
    Springs model(body, problem, k);
    const Constraints constraints(problem, body);
    EXPECT_TRUE(constraints.moving());
    const ExternalLoads loads(problem, model);
    const Executor executor(1);
    Recorder recorder(problem, model, constraints, executor, {}, false);
    Leapfrog leapfrog(problem, model, constraints, loads, executor);
    LeapfrogOptions options;
    options.end_time = 1;
    options.dt_fixed = dt;
    options.history_rows = 50;
    LeapfrogOutcome outcome;
    leapfrog.run(options, recorder, outcome);
    EXPECT_EQ(outcome.particle_steps, 27.0 * static_cast<double>(outcome.steps));
    const State state = leapfrog.state();
    Vec3 rate = Vec3::Zero(), reaction = Vec3::Zero();
    for (Index a = 0; a < body.bulk; ++a)
      rate += body.m[a] * column_vector(state.acceleration, body, a);
    const auto values = recorder.quantities(state);
    for (const auto& [name, value] : values) {
      if (name == "x0_x" || name == "x1_x") reaction[0] += value;
      if (name == "x1_mean_x") {
        EXPECT_DOUBLE_EQ(value, 1e-3 * (1 - std::cos(6.0)));
      }
    }
    EXPECT_NEAR(rate[0], reaction[0], 1e-12 * std::abs(rate[0]));
    EXPECT_GT(std::abs(rate[0]), 0);
    scene::Result result;
    recorder.add_invariants(result);
    EXPECT_EQ(recorder.samples(state).X.size(), 27u);
    EXPECT_EQ(recorder.samples(state).weight.size(), 27u);
    return result.invariants.at("energy_drift");
  };
  const double coarse = run(0.01), fine = run(0.005);
  EXPECT_LT(coarse, 0.02);
  EXPECT_NEAR(coarse / fine, 4, 0.5);
}

TEST(InsideBody, OrderFollowsTheLayersOfCells) {
  const Body body = cubes(cube(), 6, 0.25);
  for (Index a = 0; a + 1 < body.bulk; ++a) {
    const Vec3 at = (6 * body.position(a)).array().floor(),
               next = (6 * body.position(a + 1)).array().floor();
    EXPECT_TRUE(next[0] > at[0] || (next[0] == at[0] && next[1] >= at[1])) << a;
  }
}

/// Errors of the field made from exact u and H, over points up to the corners of the cube.
struct FieldError {
  double largest = 0, mean_square = 0, gradient = 0;
  double rms() const { return std::sqrt(mean_square); }
};

FieldError field_error(int N, double perturb, const auto& u, const auto& H) {
  Body body = cubes(cube(), N, perturb);
  std::vector<Vec3> X, values;
  std::vector<Mat3> gradients;
  for (Index a = 0; a < body.bulk; ++a) {
    X.push_back(body.position(a));
    values.push_back(u(X.back()));
    gradients.push_back(H(X.back()));
  }
  const ParticleField field(body, X, values, gradients);
  constexpr int M = 21;  // points a side
  std::vector<Vec3> at;
  for (int p = 0; p < M * M * M; ++p)
    at.push_back(Vec3(p % M, p / M % M, p / (M * M)) / (M - 1));
  std::vector<Vec3> found(at.size());
  std::vector<Mat3> slope(at.size());
  field.evaluate(at, found, slope);
  FieldError error;
  for (std::size_t p = 0; p < at.size(); ++p) {
    const double d = (found[p] - u(at[p])).norm();
    error.largest = std::max(error.largest, d);
    error.mean_square += d * d / static_cast<double>(at.size());
    error.gradient = std::max(error.gradient, (slope[p] - H(at[p])).norm());
  }
  return error;
}

TEST(InsideField, IsExactForQuadraticFieldsUpToTheCorners) {
  const auto u = [](const Vec3& X) {
    return Vec3(X[0] * X[1] - 0.3 * X[2], X[2] * X[2] + 0.5, 2 * X[0] + X[1] * X[1]);
  };
  const auto H = [](const Vec3& X) {
    Mat3 h;
    h << X[1], X[0], -0.3, 0, 0, 2 * X[2], 2, 2 * X[1], 0;
    return h;
  };
  for (const double perturb : {0.0, 0.25}) {
    const FieldError error = field_error(4, perturb, u, H);
    EXPECT_LT(error.largest, 1e-13);
    EXPECT_LT(error.gradient, 1e-12);
  }
}

TEST(InsideField, IsOfThirdOrderForSmoothFields) {
  const auto u = [](const Vec3& X) {
    return Vec3(std::sin(X[0] + 2 * X[1]), std::cos(X[2] - X[0]), std::exp(X[1] * X[2]));
  };
  const auto H = [](const Vec3& X) {
    const double c = std::cos(X[0] + 2 * X[1]), s = std::sin(X[2] - X[0]),
                 e = std::exp(X[1] * X[2]);
    Mat3 h;
    h << c, 2 * c, 0, s, 0, -s, 0, X[2] * e, X[1] * e;
    return h;
  };
  for (const double perturb : {0.0, 0.25}) {
    const FieldError coarse = field_error(8, perturb, u, H),
                     fine = field_error(16, perturb, u, H);
    EXPECT_GT(std::log2(coarse.rms() / fine.rms()), 2.6) << perturb;
    EXPECT_GT(std::log2(coarse.gradient / fine.gradient), 1) << perturb;
    EXPECT_LT(fine.rms(), 5e-4);
  }
}

TEST(InsideField, OfOneLayerIsTheExpansionOfTheNearestParticle) {
  Body body;
  body.h = 1;
  const std::vector<Vec3> X{{0, 0, 0}, {1, 0, 0}}, u{{1, 0, 0}, {2, 0, 0}};
  Mat3 H = Mat3::Zero();
  H(0, 2) = 0.5;
  const ParticleField field(body, X, u, {H, H});
  const std::vector<Vec3> at{{0.9, 0.2, 0.4}};
  std::vector<Vec3> found(1);
  std::vector<Mat3> slope(1);
  field.evaluate(at, found, slope);
  EXPECT_DOUBLE_EQ(found[0][0], 2 + 0.5 * 0.4);
  EXPECT_EQ(slope[0], H);
}

TEST(InsideField, OfOneLayerFindsTheNearestOfManyParticles) {
  using scene::uniform_random;
  Body body;
  body.h = 0.1;
  std::vector<Vec3> X, u, at, found(400);
  for (std::uint64_t a = 0; a < 150; ++a) {
    X.emplace_back(uniform_random(7, a, 0), std::pow(uniform_random(7, a, 1), 2), 0.05);
    u.emplace_back(static_cast<double>(a), 0, 0);
  }
  const ParticleField field(body, X, u, std::vector<Mat3>(X.size(), Mat3::Zero()));
  for (std::uint64_t q = 0; q < found.size(); ++q)
    at.emplace_back(2 * uniform_random(8, q, 0) - 0.5, 3 * uniform_random(8, q, 1) - 1, 0.2);
  field.evaluate(at, found, {});
  for (std::size_t q = 0; q < at.size(); ++q) {
    std::size_t nearest = 0;
    for (std::size_t a = 1; a < X.size(); ++a)
      if ((at[q] - X[a]).norm() < (at[q] - X[nearest]).norm()) nearest = a;
    EXPECT_EQ(found[q][0], u[nearest][0]) << q;
  }
}

/// An L of three unit squares, two by two particles each: no simplex joins the legs across the
/// notch, and the rest is the L through the outermost particles.
TEST(InsideBody, TriangulationDoesNotCrossANotch) {
  scene::Mesh mesh;
  mesh.dim = 2;
  mesh.nodes = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  mesh.nodes_per_facet = 2;
  InsideParts parts;
  for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {0, 1}}) {
    for (int c = 0; c < 4; ++c)
      parts.X.emplace_back(x + 0.25 + 0.5 * (c % 2), y + 0.25 + 0.5 * (c / 2), 0);
  }
  parts.V.assign(parts.X.size(), 0.25);
  for (Index e = 0; e < 6; ++e) {
    mesh.entities.push_back({1, e + 1, true, -1, {}});
    mesh.facets.insert(mesh.facets.end(), {e, (e + 1) % 6});
    mesh.facet_entity.push_back(e);
    const Vec3 &from = mesh.nodes[e], &to = mesh.nodes[(e + 1) % 6];
    const Vec3 along = (to - from).normalized(), N(along[1], -along[0], 0);
    for (Index a = 0; a < static_cast<Index>(parts.X.size()); ++a) {
      const double distance = N.dot(from - parts.X[a]), place = along.dot(parts.X[a] - from);
      if (distance < 0 || distance > 0.3 || place < 0 || place > (to - from).norm()) continue;
      SurfacePiece piece;
      piece.particle = a, piece.entity = e, piece.area = 0.5;
      piece.C = parts.X[a] + distance * N, piece.N = N;
      parts.surface.push_back(piece);
    }
  }
  scene::Problem problem;
  problem.dimension = Dimension::plane_strain;
  const Body body = inside_body(problem, mesh, 0.5, parts, Executor(1));
  double area = 0;
  for (std::size_t s = 0; s < body.triangulation.size(); ++s) area += body.simplex_volume(s);
  EXPECT_NEAR(area, 1.5 * 1.5 - 1, 1e-14);
}

}  // namespace
}  // namespace concord::particle
