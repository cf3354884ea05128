// Setting up the swinging cube, phase by phase: what 1M particles wait for before the first
// step.

#include "particle/core/boundary.hpp"
#include "particle/delaunay/delaunay.hpp"
#include "particle/voronoi/cells.hpp"
#include "particle/voronoi/placement.hpp"
#include "scene/reader.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>

namespace {

using namespace concord;
using namespace concord::particle;

const scene::Problem& cube() {
  static const scene::Problem problem = scene::read_problem("swinging_cube");
  return problem;
}

scene::MeshRequest request_of(const benchmark::State& state) {
  scene::MeshRequest request;
  request.h = 1.0 / (static_cast<double>(state.range(0)) - 1);
  request.layout = cube().layout;
  request.shape = scene::CellShape::hypercube;  // as bodies ask for lattices
  return request;
}

/// Displacements of the particles in percent of the spacing.
double perturbation(const benchmark::State& state) {
  return 0.01 * static_cast<double>(state.range(1));
}

void count(benchmark::State& state, std::size_t particles) {
  state.counters["particles"] = static_cast<double>(particles);
  state.counters["us_per_particle"] = benchmark::Counter(
      1e-6 * static_cast<double>(particles) * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void setup_mesh(benchmark::State& state) {
  std::size_t particles = 0;
  for (auto _ : state) {
    scene::Mesh mesh = scene::make_mesh(cube(), request_of(state));
    if (state.range(1) > 0) scene::perturb(mesh, cube(), perturbation(state), 1);
    particles = mesh.nodes.size();
  }
  count(state, particles);
}

void setup_triangulation(benchmark::State& state) {
  scene::Mesh mesh = scene::make_mesh(cube(), request_of(state));
  if (state.range(1) > 0) scene::perturb(mesh, cube(), perturbation(state), 1);
  std::vector<Index> number(mesh.nodes.size());  // gmsh's own: slower to share among threads
  std::iota(number.begin(), number.end(), 0);
  for (auto _ : state) {
    const Triangulation t = triangulate(mesh, cube(), number, Executor(1));
    benchmark::DoNotOptimize(t.size());
  }
  count(state, mesh.nodes.size());
}

void setup_body(benchmark::State& state) {
  Index particles = 0;
  for (auto _ : state)
    particles = make_body(cube(), request_of(state).h, perturbation(state), 1).n;
  count(state, static_cast<std::size_t>(particles));
}

void setup_gradient_vectors(benchmark::State& state) {
  const Body body = make_body(cube(), request_of(state).h, perturbation(state), 1);
  for (auto _ : state) {
    const auto bonds = delaunay::gradient_vectors(body);
    benchmark::DoNotOptimize(bonds.size());
  }
  count(state, static_cast<std::size_t>(body.n));
}

void setup_model(benchmark::State& state) {
  const Body body = make_body(cube(), request_of(state).h, perturbation(state), 1);
  for (auto _ : state) {
    const delaunay::DelaunayModel model(body, cube(), delaunay::Parameters{});
    const Constraints constraints(cube(), body);
    const ExternalLoads loads(cube(), model);
    benchmark::DoNotOptimize(constraints.unknowns() + loads.none());
  }
  count(state, static_cast<std::size_t>(body.n));
}

/// Voronoi cells of particles inside the body, one fewer an edge.
void setup_voronoi_cells(benchmark::State& state) {
  const scene::MeshRequest request = request_of(state);
  scene::MeshRequest coarse = request;
  coarse.h = 0.5;
  const scene::Mesh surface = scene::make_mesh(cube(), coarse);
  const auto X = voronoi::place_particles(cube(), request.h, perturbation(state), 1);
  for (auto _ : state) {
    const voronoi::Cells cells = voronoi::make_cells(surface, 3, 1, X);
    benchmark::DoNotOptimize(cells.faces.data());
  }
  count(state, X.size());
}

/// Particles an edge; displacement in percent of the spacing (0: a lattice, whose cospherical
/// points are the slow case of a triangulation).
void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"edge", "perturb"})
      ->ArgsProduct({{34, 54, 100}, {25, 0}})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

BENCHMARK(setup_mesh)->Apply(sizes);
BENCHMARK(setup_triangulation)->Apply(sizes);
BENCHMARK(setup_body)->Apply(sizes);
BENCHMARK(setup_gradient_vectors)->Apply(sizes);
BENCHMARK(setup_model)->Apply(sizes);
BENCHMARK(setup_voronoi_cells)->Apply(sizes);

}  // namespace
