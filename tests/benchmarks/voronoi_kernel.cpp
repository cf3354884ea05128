// One force evaluation and update of the Voronoi method, with and without contact, in its three
// forms; to be read beside delaunay_step of the same run.

#include "particle/core/inside_body.hpp"
#include "particle/voronoi/voronoi.hpp"
#include "scene/reader.hpp"

#include <benchmark/benchmark.h>

#include <map>
#include <memory>

namespace {

using namespace concord;
using namespace concord::particle;

/// Swinging cube with n particles an edge, 25 % perturbed.
struct Cube {
  scene::Problem problem = scene::read_problem("swinging_cube");
  voronoi::Cells cells;
  voronoi::Boundary boundary;
  Body body;

  explicit Cube(int edge) {
    const double h = 1.0 / edge;
    const scene::Mesh mesh =
        scene::make_mesh(problem, {0.5});  // its facets matter, not its size
    std::vector<Vec3> X;
    for (std::uint64_t p = 0; p < static_cast<std::uint64_t>(edge) * edge * edge; ++p) {
      const std::uint64_t place[3] = {p / edge / edge, p / edge % edge, p % edge};
      Vec3 x;
      for (int i = 0; i < 3; ++i)
        x[i] =
            h * (static_cast<double>(place[i]) + 0.25 + 0.5 * scene::uniform_random(1, p, i));
      X.push_back(x);
    }
    X = in_sweep_order(mesh, X, h, Executor(1));
    cells = voronoi::make_cells(mesh, 3, 1, X);
    boundary = voronoi::boundary_pieces(problem, mesh, cells, X);
    body.bulk = static_cast<Index>(X.size());
    X.insert(X.end(), boundary.points.begin(), boundary.points.end());
    body.n = static_cast<Index>(X.size());
    body.h = body.h_min = h;
    body.V = cells.V;
    body.V.resize(X.size(), 0.0);
    for (const double V : body.V) body.m.push_back(problem.material.rho0 * V);
    body.X.assign(X.size() * 4, 0.0);
    for (std::size_t p = 0; p < X.size(); ++p)
      for (int i = 0; i < 3; ++i) body.X[4 * p + i] = X[p][i];
  }
};

const Cube& cube(int edge) {
  static std::map<int, std::unique_ptr<Cube>> cubes;
  auto& made = cubes[edge];
  if (!made) made = std::make_unique<Cube>(edge);
  return *made;
}

/// Arguments: particles an edge, contact on (1) or off (0), threads, form of the force.
void voronoi_step(benchmark::State& state) {
  const Cube& c = cube(static_cast<int>(state.range(0)));
  voronoi::Parameters parameters;
  if (state.range(1) == 0) parameters.xi_n = parameters.xi_t = 0;
  parameters.form = static_cast<voronoi::Form>(state.range(3));
  voronoi::VoronoiModel model(c.body, c.problem, c.cells, c.boundary, parameters);
  const Executor executor(static_cast<int>(state.range(2)));
  Column u(c.body.X.size(), 0.0), v = u, f = u;
  for (Index a = 0; a < c.body.bulk; ++a) {
    const Vec3 u0 = (*c.problem.initial_displacement)(c.body.position(a), 0);
    for (int i = 0; i < 3; ++i) u[static_cast<std::size_t>(a) * 4 + i] = u0[i];
  }
  const double dt = 1e-6;
  for (auto _ : state) {
    model.forces(u, v, f, executor);
    executor.for_pieces(c.body.bulk, [&](std::size_t begin, std::size_t end) {  // as Leapfrog
      for (std::size_t a = begin; a < end; ++a) {
        for (std::size_t k = a * 4; k < a * 4 + 4; ++k) {
          v[k] += dt / c.body.m[a] * f[k];
          u[k] += dt * v[k];
        }
      }
    });
    benchmark::DoNotOptimize(u.data());
  }
  state.counters["particles"] = c.body.bulk;
  state.counters["per_particle"] = benchmark::Counter(
      static_cast<double>(c.body.bulk) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["bonds_per_particle"] =
      static_cast<double>(model.interactions()) / c.body.bulk;
}
BENCHMARK(voronoi_step)
    ->Name("voronoi_step")
    ->ArgNames({"edge", "contact", "threads", "form"})
    ->ArgsProduct({{17, 34, 54}, {1, 0}, {1}, {0}})
    ->ArgsProduct({{34}, {1, 0}, {1}, {1}})
    ->Args({54, 1, 2, 0})
    ->Args({54, 0, 2, 0})
    ->Unit(benchmark::kMillisecond);

}  // namespace
