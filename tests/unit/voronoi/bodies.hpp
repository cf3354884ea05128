#pragma once
// Bodies with conditions of the test's choice for the Voronoi model, and a small Newton solver.

#include "particle/voronoi/voronoi.hpp"
#include "scene/geometry.hpp"
#include "scene/reader.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace concord::particle::voronoi::test {

/// A condition on a group of the scene's geometry; `components` of a displacement.
struct Given {
  std::string group;
  scene::BoundaryKind kind = scene::BoundaryKind::fixed;
  std::array<bool, 3> components{true, true, true};
};

/// Particles in a lattice in the box [0, size], moved by up to `perturb` spacings at random.
inline std::vector<Vec3> lattice(const std::array<int, 3>& count, const Vec3& size,
                                 double perturb, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-perturb, perturb);
  std::vector<Vec3> X;
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) {
        Vec3 x;
        x[0] = (i + 0.5 + uniform(generator)) * size[0] / count[0];
        x[1] = (j + 0.5 + uniform(generator)) * size[1] / count[1];
        x[2] = (k + 0.5 + uniform(generator)) * size[2] / count[2];
        X.push_back(x);
      }
  return X;
}

/// A body of the scene's geometry with particles X; the conditions replace those of the scene.
struct Block {
  scene::Problem problem;
  scene::Mesh mesh;
  Cells cells;
  Boundary boundary;
  Body body;

  Block(const std::string& scene, double h, const std::vector<Vec3>& X,
        const std::vector<Given>& given, const std::vector<scene::Override>& overrides = {})
      : problem(scene::read_problem(scene, overrides)) {
    problem.boundaries.clear();
    for (const Given& g : given) {
      scene::BoundaryCondition bc;
      bc.group = g.group;
      bc.kind = g.kind;
      for (int i = 0; i < 3; ++i) {
        if (g.components[i]) bc.value.component[i].emplace();
      }
      problem.boundaries.push_back(bc);
    }
    mesh = scene::make_mesh(problem, {h, scene::CellShape::simplex, 1, scene::Layout::lattice});
    cells = make_cells(mesh, problem.dim(), problem.thickness, X);
    boundary = boundary_pieces(problem, mesh, cells, X);
    make_body(X, h);
  }

  /// What of a body the model reads.
  void make_body(const std::vector<Vec3>& X, double h) {
    body.dim = problem.dim();
    body.stride = stride_of(body.dim);
    body.bulk = static_cast<Index>(X.size());
    body.n = body.bulk + static_cast<Index>(boundary.points.size());
    body.h = body.h_min = h;
    body.thickness = problem.thickness;
    body.V.assign(body.n, 0.0);
    body.m.assign(body.n, 0.0);
    body.X.assign(static_cast<std::size_t>(body.n) * body.stride, 0.0);
    for (Index p = 0; p < body.n; ++p) {
      const Vec3 at = p < body.bulk ? X[p] : boundary.points[p - body.bulk];
      for (int i = 0; i < body.dim; ++i)
        body.X[static_cast<std::size_t>(p) * body.stride + i] = at[i];
      if (p < body.bulk) {
        body.V[p] = cells.V[p];
        body.m[p] = problem.material.rho0 * cells.V[p];
      } else {
        BoundaryPoint point;
        point.particle = boundary.pieces[boundary.owner[p - body.bulk]].particle;
        body.boundary.push_back(point);
      }
    }
  }

  std::unique_ptr<VoronoiModel> model(const Parameters& parameters = {}) const {
    return std::make_unique<VoronoiModel>(body, problem, cells, boundary, parameters);
  }

  Column column(const std::function<Vec3(Index)>& value) const {
    Column c(body.X.size(), 0.0);
    for (Index p = 0; p < body.n; ++p) {
      const Vec3 v = value(p);
      for (int i = 0; i < body.dim; ++i)
        c[static_cast<std::size_t>(p) * body.stride + i] = v[i];
    }
    return c;
  }
  Column affine(const Mat3& H, const Vec3& shift = Vec3::Zero()) const {
    return column([&](Index p) { return Vec3(H * body.position(p) + shift); });
  }
  /// Smooth finite deformation plus noise of `noise` spacings, on boundary points too.
  Column random_displacement(double noise = 0.05, unsigned seed = 3) const {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double L = problem.reference_length;
    return column([&](Index p) {
      const Vec3 X = body.position(p) / L;
      Vec3 u(0.2 * X[0] + 0.1 * X[1] * X[1], -0.15 * X[0] * X[1] + 0.1 * X[2],
             0.12 * X[0] - 0.1 * X[2]);
      u *= L;
      for (int i = 0; i < 3; ++i) u[i] += noise * body.h * uniform(generator);
      return u;
    });
  }
  Vec3 at(const Column& c, Index p) const {
    Vec3 r = Vec3::Zero();
    for (int i = 0; i < body.dim; ++i) r[i] = c[static_cast<std::size_t>(p) * body.stride + i];
    return r;
  }
  Column force(VoronoiModel& model, const Column& u, int threads = 1) const {
    Column f(body.X.size(), 0.0), v = f;
    model.forces(u, v, f, Executor(threads));
    return f;
  }
  /// Adds M T of the model's load terms, T = traction(N).
  void add_loads(const VoronoiModel& model, const std::function<Vec3(const Vec3& N)>& traction,
                 Column& f) const {
    for (const LoadTerm& term : model.load_terms()) {
      const Vec3 load = term.M * traction(term.N);
      for (int i = 0; i < body.dim; ++i)
        f[static_cast<std::size_t>(term.point) * body.stride + i] += load[i];
    }
  }

  /// Newton's method for the particles with boundary points held, on until round-off.
  Column solve(VoronoiModel& model, Column u,
               const std::function<Vec3(const Vec3& N)>& traction) const {
    const int dim = body.dim;
    const Eigen::Index unknowns = static_cast<Eigen::Index>(body.bulk) * dim;
    for (int iteration = 0; iteration < 4; ++iteration) {
      Column f = force(model, u);
      add_loads(model, traction, f);
      Eigen::VectorXd r(unknowns);
      for (Index a = 0; a < body.bulk; ++a)
        for (int i = 0; i < dim; ++i) r[a * dim + i] = at(f, a)[i];
      const Eigen::SparseMatrix<double> all = model.tangent(u);
      const Eigen::SparseMatrix<double> K = all.topLeftCorner(unknowns, unknowns);
      Eigen::VectorXd du;
      if (model.has_potential())
        du = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(K).solve(r);
      else
        du = Eigen::SparseLU<Eigen::SparseMatrix<double>>(K).solve(r);
      for (Index a = 0; a < body.bulk; ++a)
        for (int i = 0; i < dim; ++i)
          u[static_cast<std::size_t>(a) * body.stride + i] += du[a * dim + i];
    }
    return u;
  }

  /// Largest distance of a particle from the field u = H X.
  double error(const Column& u, const Mat3& H) const {
    double worst = 0;
    for (Index a = 0; a < body.bulk; ++a)
      worst = std::max(worst, (at(u, a) - H * body.position(a)).norm());
    return worst;
  }
};

inline double norm(const Column& c) {
  double s = 0;
  for (const double x : c) s += x * x;
  return std::sqrt(s);
}

inline std::vector<Given> on_all_faces(scene::BoundaryKind kind) {
  std::vector<Given> given;
  for (const char* face : {"x0", "x1", "y0", "y1", "z0", "z1"}) given.push_back({face, kind});
  return given;
}

/// A bit of everything on the cube's faces.
inline std::vector<Given> mixed() {
  using enum scene::BoundaryKind;
  return {{"x0", symmetric},
          {"x1", traction},
          {"y0", displacement, {true, false, true}},
          {"y1", antisymmetric},
          {"z0", fixed}};
}

/// Unit cube, n particles an edge.
inline Block cube(int n, const std::vector<Given>& given, unsigned seed = 1,
                  double perturb = 0.25) {
  return {"swinging_cube", 1.0 / n, lattice({n, n, n}, Vec3(1, 1, 1), perturb, seed), given};
}

/// Cook's membrane in the plane: 48 wide, 44 to 16 high, with oblique sides; n particles an
/// edge.
inline Block membrane(int n, const std::vector<Given>& given, unsigned seed = 1) {
  std::vector<Vec3> X = lattice({n, n, 1}, Vec3(1, 1, 0), 0.25, seed);
  for (Vec3& x : X) {
    const double bottom = 44 * x[0], top = 44 + 16 * x[0];
    x = 1e-3 * Vec3(48 * x[0], bottom + x[1] * (top - bottom), 0);
  }
  return {"cooks_membrane", 0.048 / n, X, given};
}

}  // namespace concord::particle::voronoi::test
