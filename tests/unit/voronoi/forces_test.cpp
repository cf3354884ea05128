// Forces of the Voronoi model: gradients of its potential, momenta, tangent, and the failures
// of the paper's forms.

#include "particle/voronoi/operators.hpp"
#include "tests/unit/voronoi/bodies.hpp"

#include <Eigen/Geometry>

#include <cstring>

namespace concord::particle::voronoi::test {
namespace {

/// |slope of the energy along d + f.d| over |f||d|, by a fourth-order difference.
double potential_error(const Block& block, VoronoiModel& model, const Column& u,
                       const Column& d, double s) {
  const Column f = block.force(model, u);
  double power = 0;
  for (std::size_t k = 0; k < d.size(); ++k) power -= f[k] * d[k];
  const auto energy = [&](double step) {
    Column moved = u;
    for (std::size_t k = 0; k < u.size(); ++k) moved[k] += step * d[k];
    const Energies e = model.energies(moved, Executor(1));
    return e.internal + e.stabilisation;
  };
  const double slope =
      (8 * (energy(s) - energy(-s)) - (energy(2 * s) - energy(-2 * s))) / (12 * s);
  return std::abs(slope - power) / (norm(f) * norm(d));
}

Column random_direction(const Block& block, unsigned seed) {
  return block.random_displacement(1.0, seed);
}

TEST(VoronoiForces, AreMinusTheGradientOfThePotential) {
  for (const double xi : {0.0, 1.0}) {
    const Block block = cube(3, mixed());
    const auto model = block.model({xi, 0.7 * xi});
    const Column u = block.random_displacement();
    for (unsigned seed = 1; seed <= 6; ++seed) {
      EXPECT_LT(
          potential_error(block, *model, u, random_direction(block, seed), 1e-3 * block.body.h),
          1e-9)
          << "xi " << xi << ", direction " << seed;
    }
  }
}

/// Resultant and moment of the forces on a free body at random displacements, over sum |f|.
std::pair<double, double> resultant_and_moment(Form form) {
  const Block block = cube(4, {});
  const auto model = block.model({1, 1, 0, 0, form});
  const Column u = block.random_displacement(), f = block.force(*model, u);
  Vec3 resultant = Vec3::Zero(), moment = Vec3::Zero();
  double sum = 0;
  for (Index a = 0; a < block.body.n; ++a) {
    resultant += block.at(f, a);
    moment += (block.body.position(a) + block.at(u, a)).cross(block.at(f, a));
    sum += block.at(f, a).norm();
  }
  return {resultant.norm() / sum, moment.norm() / sum};
}

TEST(VoronoiForces, OfFreeBodiesHaveNoResultantAndNoMoment) {
  for (const Form form : {Form::face_compatible, Form::conserving}) {
    const auto [resultant, moment] = resultant_and_moment(form);
    EXPECT_LT(resultant, 1e-14);
    EXPECT_LT(moment, 1e-14);
  }
}

TEST(VoronoiForces, OfTheStaticFormHaveAMoment) {
  const auto [resultant, moment] = resultant_and_moment(Form::quasi_static);
  EXPECT_LT(resultant, 1e-14);
  EXPECT_GT(moment, 1e-4);
}

TEST(VoronoiForces, VanishUnderRigidMotionOfBodyAndWalls) {
  const Mat3 R = Eigen::AngleAxisd(2.0, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  for (const Form form : {Form::face_compatible, Form::conserving, Form::quasi_static}) {
    const Block block = cube(4, mixed());
    const auto model = block.model({1, 1, 0, 0, form});
    const Column u = block.affine(R - Mat3::Identity(), Vec3(3, -2, 1));
    const double scale = block.problem.material.E * block.body.h * block.body.h;
    EXPECT_LT(norm(block.force(*model, u)), 1e-12 * scale * std::sqrt(block.body.n));
  }
}

TEST(VoronoiForces, GradientsOfAffineFieldsAreExact) {
  Mat3 H;
  H << 0.3, 0.1, -0.2, 0.05, -0.2, 0.15, 0.1, -0.1, 0.25;
  for (const Form form : {Form::face_compatible, Form::conserving}) {
    const Block block = cube(4, mixed());
    const auto model = block.model({1, 1, 0, 0, form});
    std::vector<Mat3> computed(block.body.n);
    model->gradients(block.affine(H), computed);
    for (const Mat3& Ha : computed) EXPECT_LT((Ha - H).norm(), 1e-12);
  }
}

TEST(VoronoiForces, TangentIsTheirDerivative) {
  for (const Form form : {Form::face_compatible, Form::conserving, Form::quasi_static}) {
    const Block block = cube(3, mixed());
    const auto model = block.model({1, 0.6, 0, 0, form});
    const Column u = block.random_displacement(0.02), d = random_direction(block, 5);
    const ForceModel::Stiffness K = model->tangent(u);
    const double s = 1e-5 * block.body.h;
    Column plus = u, minus = u;
    for (std::size_t k = 0; k < u.size(); ++k) plus[k] += s * d[k], minus[k] -= s * d[k];
    const Column f_plus = block.force(*model, plus), f_minus = block.force(*model, minus);
    Eigen::VectorXd direction(K.cols()), difference(K.rows());
    for (Index p = 0; p < block.body.n; ++p)
      for (int i = 0; i < 3; ++i) {
        direction[p * 3 + i] = block.at(d, p)[i];
        difference[p * 3 + i] = (block.at(f_minus, p)[i] - block.at(f_plus, p)[i]) / (2 * s);
      }
    const Eigen::VectorXd product = K * direction;
    EXPECT_LT((product - difference).norm(), 2e-8 * product.norm());
    const double asymmetry =
        ForceModel::Stiffness(K - ForceModel::Stiffness(K.transpose())).norm() / K.norm();
    if (model->has_potential())
      EXPECT_LT(asymmetry, 1e-12);
    else
      EXPECT_GT(asymmetry, 1e-4);
  }
}

/// The kernels against the maps written out point by point.
void expect_same_forces(const Block& block, const Parameters& p) {
  const auto model = block.model(p);
  const Stars stars(block.body, block.cells, block.boundary);
  const GhostSystems ghosts = solve_all_ghosts(stars, {}, Executor(1));
  const scene::Material& m = block.problem.material;
  const Operators operators(stars, ghosts, p.form, {p.xi_n * m.E, p.xi_t * m.mu});
  const Constitution constitution(block.problem, block.body.n);
  const Column u = block.random_displacement(), f = block.force(*model, u);
  const Eigen::VectorXd slow = operators.forces(constitution, u);
  double worst = 0;
  for (Index a = 0; a < block.body.n; ++a)
    for (int i = 0; i < block.body.dim; ++i)
      worst = std::max(worst, std::abs(block.at(f, a)[i] - slow[a * block.body.dim + i]));
  EXPECT_LT(worst, 1e-13 * norm(f));
  const Energies fast = model->energies(u, Executor(1)),
                 other = operators.energies(constitution, u);
  EXPECT_NEAR(fast.internal, other.internal, 1e-13 * other.internal);
  EXPECT_NEAR(fast.stabilisation, other.stabilisation, 1e-13 * other.stabilisation);
}

TEST(VoronoiKernels, GiveTheForcesOfTheMapsWrittenOut) {
  for (const Form form : {Form::face_compatible, Form::conserving, Form::quasi_static}) {
    for (const double xi : {0.0, 1.0}) {
      expect_same_forces(cube(4, mixed()), {xi, 0.6 * xi, 0, 0, form});
      expect_same_forces(membrane(5, {{"left"}, {"right", scene::BoundaryKind::traction}}),
                         {xi, 0.6 * xi, 0, 0, form});
    }
  }
}

/// A plane of symmetry that is oblique has ghosts whose maps are no diagonals.
TEST(VoronoiKernels, ServeObliquePlanesOfSymmetry) {
  Block block = membrane(5, {{"left"}});
  for (BoundaryPiece& piece : block.boundary.pieces) {
    const Vec3 N = block.cells.walls[block.cells.faces[piece.face].wall].N;
    if (N[1] > -0.5) continue;
    piece.D = N * N.transpose();
    piece.centroid_point = piece.wall_point =
        block.body.bulk + static_cast<Index>(block.boundary.points.size());
    block.boundary.points.push_back(block.cells.faces[piece.face].C);
    block.boundary.owner.push_back(static_cast<Index>(&piece - block.boundary.pieces.data()));
  }
  std::vector<Vec3> X;
  for (Index a = 0; a < block.body.bulk; ++a) X.push_back(block.body.position(a));
  block.body.boundary.clear();
  block.make_body(X, block.body.h);
  expect_same_forces(block, {});
  expect_same_forces(block, {1, 1, 0, 0, Form::conserving});
}

TEST(VoronoiKernels, ThreadsDoNotChangeABit) {
  for (const Form form : {Form::face_compatible, Form::conserving}) {
    const Block block = cube(13, mixed());
    const auto model = block.model({1, 1, 0.1, 0.1, form});
    const Column u = block.random_displacement();
    const Column one = block.force(*model, u, 1);
    for (const int threads : {2, 3, 7}) {
      const Column other = block.force(*model, u, threads);
      EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(double)), 0)
          << threads << " threads";
      EXPECT_EQ(model->energies(u, Executor(1)).internal,
                model->energies(u, Executor(threads)).internal);
    }
  }
}

/// Where displacements and velocities are affine, P is the same in all cells and
/// sum V_a P_a : dF/dt is the power of the viscous stress (51)
///   J sigma F^-T,  sigma = (rho c1 c_p h + rho c2 h^2 |tr d|) d,  rho J = rho0,
/// with h the shortest branch vector and c_p the speed of longitudinal waves.
TEST(VoronoiKernels, ViscousPowerOfAffineMotionIsThatOfThePaper) {
  Mat3 H, L;
  H << 0.2, 0.1, -0.1, 0.05, -0.1, 0.15, 0.1, -0.1, 0.15;
  L << 3, -1, 2, 1, 2, -2, -3, 1, 4;
  for (const int dim : {2, 3}) {
    const Block block = dim == 3 ? cube(4, {}) : membrane(5, {});
    if (dim == 2) {
      H.row(2).setZero(), H.col(2).setZero();
      L.row(2).setZero(), L.col(2).setZero();
    }
    const scene::Material& m = block.problem.material;
    const Mat3 F = Mat3::Identity() + H, inverse = F.inverse();
    const Mat3 l = L * inverse, d = 0.5 * (l + l.transpose());
    const double c_p = std::sqrt((m.lambda + 2 * m.mu) / m.rho0), h = block.body.h_min;
    double volume = 0;
    for (Index a = 0; a < block.body.bulk; ++a) volume += block.body.V[a];
    const Column u = block.affine(H), v = block.affine(L);
    const auto inviscid = block.model();
    const Column elastic = block.force(*inviscid, u);
    for (const auto& [c1, c2] : {std::pair{0.1, 0.0}, {0.0, 0.3}, {0.2, 0.1}}) {
      const auto model = block.model({1, 1, c1, c2});
      Column f(u.size(), 0.0);
      model->forces(u, v, f, Executor(1));
      double power = 0;
      for (std::size_t k = 0; k < u.size(); ++k) power -= (f[k] - elastic[k]) * v[k];
      const double factor = m.rho0 * c1 * c_p * h + m.rho0 * c2 * h * h * std::abs(d.trace());
      const double expected = volume * factor * d.squaredNorm();
      EXPECT_NEAR(power, expected, 1e-10 * expected) << dim << " " << c1 << " " << c2;
      EXPECT_GT(expected, 0);
    }
  }
}

/// Rigid motion has no viscous force.
TEST(VoronoiKernels, ViscosityDoesNotFeelSpin) {
  const Block block = cube(4, {});
  const auto model = block.model({1, 1, 0.1, 0.1}), inviscid = block.model();
  const Column u = block.random_displacement();
  const Column elastic = block.force(*inviscid, u);
  Mat3 W;
  W << 0, 1, -2, -1, 0, 3, 2, -3, 0;
  const Column spin = block.column(
      [&](Index p) { return Vec3(W * (block.body.position(p) + block.at(u, p))); });
  Column g(u.size(), 0.0);
  model->forces(u, spin, g, Executor(1));
  double difference = 0;
  for (std::size_t k = 0; k < u.size(); ++k)
    difference = std::max(difference, std::abs(g[k] - elastic[k]));
  EXPECT_LT(difference, 1e-13 * norm(elastic));
}

/// Loads are conjugate to the place where they act: their power is A T . u(C) on every loaded
/// face, u(C) of (VOR.13) from H^V and the ghosts, for any displacement of particles and
/// boundary points.
TEST(VoronoiLoads, DoTheWorkOfTheFacesCentroids) {
  for (const bool flat : {false, true}) {
    const Block block = flat ? membrane(5, {{"left"}, {"right", scene::BoundaryKind::traction}})
                             : cube(4, mixed());
    const auto model = block.model();
    const Vec3 load = flat ? Vec3(2, -3, 0) : Vec3(2, -3, 5);
    const Stars stars(block.body, block.cells, block.boundary);
    const GhostSystems ghosts = solve_all_ghosts(stars, {}, Executor(1));
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Column u = random_direction(block, seed);
      Column f(u.size(), 0.0);
      block.add_loads(
          *model, [&](const Vec3&) { return load; }, f);
      double work = 0, expected = 0, scale = 0;
      for (std::size_t k = 0; k < u.size(); ++k) work += f[k] * u[k];
      for (Index a = 0; a < block.body.bulk; ++a) {
        // H^V_a and the places of the ghosts, summed up here.
        const Star star = stars(a);
        const Vec3 u_a = block.at(u, a);
        const std::size_t real = star.neighbours.size(), walls = star.ghosts.size();
        Mat3 mean = Mat3::Zero();
        for (const Neighbour& c : star.neighbours)
          mean += (block.at(u, c.b) - u_a) * c.gradient_vector().transpose() / star.V;
        std::vector<Vec3> branch(walls, Vec3::Zero());
        for (std::size_t g = 0; g < walls; ++g) {
          const GhostSystem& system = ghosts.system[ghosts.row[a]];
          for (std::size_t c = 0; c < real; ++c)
            branch[g] += system.T[g * real + c] * (block.at(u, star.neighbours[c].b) - u_a);
          for (std::size_t h = 0; h < walls; ++h) {
            if (star.ghosts[h].wall_point >= 0)
              branch[g] +=
                  system.R[g * walls + h] * (block.at(u, star.ghosts[h].wall_point) - u_a);
          }
          mean += branch[g] * star.ghosts[g].gradient_vector().transpose() / star.V;
        }
        for (std::size_t g = 0; g < walls; ++g) {
          const Ghost& ghost = star.ghosts[g];
          if (block.boundary.pieces[ghost.piece].tractions.empty()) continue;
          const Vec3 place = ghost.free * (u_a + 0.5 * branch[g] + mean * ghost.t);
          expected += ghost.A * load.dot(place);
          scale += ghost.A * load.norm() * place.norm();
        }
      }
      EXPECT_GT(scale, 0);
      EXPECT_NEAR(work, expected, 1e-13 * scale);
    }
  }
}

}  // namespace
}  // namespace concord::particle::voronoi::test
