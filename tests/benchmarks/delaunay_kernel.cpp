// One force evaluation and update of the Delaunay method, with and without contact, beside a
// STREAM triad of the same run.

#include "particle/core/elastic.hpp"
#include "particle/delaunay/delaunay.hpp"
#include "scene/reader.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>

namespace {

using namespace concord;
using namespace concord::particle;

/// Cube with n particles an edge, 25 % perturbed; made once a size.
const Body& cube(int edge) {
  static std::map<int, std::unique_ptr<Body>> bodies;
  static const scene::Problem problem = scene::read_problem("swinging_cube");
  auto& body = bodies[edge];
  if (!body) body = std::make_unique<Body>(make_body(problem, 1.0 / (edge - 1), 0.25, 1));
  return *body;
}

/// STREAM triad a = b + s c on arrays far beyond the caches: GB/s counted as three streams.
void triad(benchmark::State& state) {
  const std::size_t n = 20'000'000;
  Column a(n, 0.0), b(n, 1.0), c(n, 2.0);
  for (auto _ : state) {
    for (std::size_t k = 0; k < n; ++k) a[k] = b[k] + 3.0 * c[k];
    benchmark::DoNotOptimize(a.data());
    benchmark::ClobberMemory();
  }
  state.counters["GB_s"] = benchmark::Counter(
      3.0 * n * sizeof(double) * state.iterations() / 1e9, benchmark::Counter::kIsRate);
}
BENCHMARK(triad)->Name("triad")->Unit(benchmark::kMillisecond);

/// Arguments: particles an edge, contact on (1) or off (0), threads.
void delaunay_step(benchmark::State& state) {
  const Body& body = cube(static_cast<int>(state.range(0)));
  const scene::Problem problem = scene::read_problem("swinging_cube");
  delaunay::Parameters parameters;
  if (state.range(1) == 0) parameters.xi_n = parameters.xi_t = 0;
  delaunay::DelaunayModel model(body, problem, parameters);
  const Executor executor(static_cast<int>(state.range(2)));
  Column u(body.X.size(), 0.0), v = u, f = u;
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 u0 = (*problem.initial_displacement)(body.position(a), 0);
    for (int i = 0; i < 3; ++i) u[static_cast<std::size_t>(a) * 4 + i] = u0[i];
  }
  const double dt = 1e-6;
  for (auto _ : state) {
    model.forces(u, v, f, executor);
    executor.for_pieces(body.n, [&](std::size_t begin, std::size_t end) {  // as Leapfrog does
      for (std::size_t a = begin; a < end; ++a) {
        for (std::size_t k = a * 4; k < a * 4 + 4; ++k) {
          v[k] += dt / body.m[a] * f[k];
          u[k] += dt * v[k];
        }
      }
    });
    benchmark::DoNotOptimize(u.data());
  }
  state.counters["particles"] = body.n;
  state.counters["per_particle"] =
      benchmark::Counter(static_cast<double>(body.n) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["bonds_per_particle"] = static_cast<double>(model.interactions()) / body.n;
}
BENCHMARK(delaunay_step)
    ->Name("delaunay_step")
    ->ArgNames({"edge", "contact", "threads"})
    ->ArgsProduct({{17, 34, 54, 100}, {1, 0}, {1}})
    ->Args({54, 1, 2})
    ->Args({54, 0, 2})
    ->Unit(benchmark::kMillisecond);

}  // namespace
