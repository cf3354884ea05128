// One force evaluation of total-Lagrangian SPH: time a particle and a directed neighbour, one
// thread.

#include "sph_reference/total_lagrangian/model.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>

namespace {

using namespace concord;

/// A cube of count^3 particles on a lattice of spacing h in sweep order, without triangulation:
/// SPH needs volumes alone.
particle::Body lattice(int count) {
  particle::Body body;
  body.n = count * count * count;
  body.h = body.h_min = 1.0 / (count - 1);
  for (int k = 0; k < count; ++k) {
    for (int j = 0; j < count; ++j) {
      for (int i = 0; i < count; ++i) {
        const double weight[2] = {1.0, 0.5};
        const auto on_face = [&](int c) { return c == 0 || c == count - 1; };
        body.V.push_back(std::pow(body.h, 3) * weight[on_face(i)] * weight[on_face(j)] *
                         weight[on_face(k)]);
        for (const double x : {i * body.h, j * body.h, k * body.h, 0.0}) body.X.push_back(x);
      }
    }
  }
  return body;
}

scene::Problem rubber() {
  scene::Problem problem;
  scene::Material& m = problem.material;
  m.E = 17e6, m.nu = 0.3, m.rho0 = 1100;  // the swinging cube's, Sec. 8.2 of the Delaunay paper
  m.lambda = m.E * m.nu / ((1 + m.nu) * (1 - 2 * m.nu)), m.mu = m.E / (2 * (1 + m.nu));
  return problem;
}

void tlsph_step(benchmark::State& state, const sph::TlsphOptions& options) {
  const particle::Executor executor(1);
  const particle::Body body =
      lattice(static_cast<int>(std::lround(std::cbrt(static_cast<double>(state.range(0))))));
  sph::TotalLagrangianSph model(body, rubber(), options, executor);
  particle::Column u(body.X.size()), v(body.X.size()), f(body.X.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (i % 4 == 3) continue;
    u[i] = 0.02 * std::sin(3 * body.X[i]);
    v[i] = std::cos(2 * body.X[i]);
  }
  for (auto _ : state) {
    model.forces(u, v, f, executor);
    benchmark::DoNotOptimize(f.data());
    benchmark::ClobberMemory();
  }
  using benchmark::Counter;
  const auto flags = Counter::kIsIterationInvariantRate | Counter::kInvert;
  state.counters["s_per_particle"] = Counter(static_cast<double>(body.n), flags);
  state.counters["s_per_neighbour"] = Counter(static_cast<double>(model.interactions()), flags);
  state.counters["neighbours"] = static_cast<double>(model.interactions()) / body.n;
}

sph::TlsphOptions with(double psi, sph::PenaltyForm penalty, double alpha) {
  sph::TlsphOptions options;
  options.psi = psi, options.penalty = penalty, options.alpha = alpha;
  return options;
}

void sizes(benchmark::internal::Benchmark* b) {
  for (const int n : {17 * 17 * 17, 34 * 34 * 34, 54 * 54 * 54}) b->Arg(n);
  b->Unit(benchmark::kMillisecond);
}

using sph::PenaltyForm;
BENCHMARK_CAPTURE(tlsph_step, ganzenmuller, with(0.07, PenaltyForm::ganzenmueller, 0))
    ->Apply(sizes);
BENCHMARK_CAPTURE(tlsph_step, no_penalty, with(0, PenaltyForm::ganzenmueller, 0))->Apply(sizes);
BENCHMARK_CAPTURE(tlsph_step, potential, with(0.07, PenaltyForm::potential, 0))->Apply(sizes);
BENCHMARK_CAPTURE(tlsph_step, ganzenmuller_viscous, with(0.07, PenaltyForm::ganzenmueller, 1))
    ->Apply(sizes);

}  // namespace
