// One force evaluation of total-Lagrangian SPH: time a particle and a directed neighbour, by
// size, threads and support. One thread: CPU time; more: read the time, not the CPU's.

#include "sph_reference/total_lagrangian/model.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <memory>

namespace {

using namespace concord;

/// A cube of count^3 particles on a lattice of spacing h in sweep order, without triangulation:
/// SPH needs volumes alone.
particle::Body lattice(int count) {
  particle::Body body;
  body.n = body.bulk = count * count * count;
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

/// The model of the last run, which the benchmark repeats until it lasts long enough.
struct Bench {
  std::vector<std::int64_t> key;  ///< particles, threads, support and what is switched on
  particle::Body body;
  particle::Executor executor;
  std::unique_ptr<sph::TotalLagrangianSph> model;
  particle::Column u, v, f;
  double setup_s = 0;  ///< search and correction

  Bench(std::vector<std::int64_t> key_, const sph::TlsphOptions& options)
      : key(std::move(key_)),
        body(lattice(static_cast<int>(std::lround(std::cbrt(static_cast<double>(key[0])))))),
        executor(static_cast<int>(key[1])) {
    const auto start = std::chrono::steady_clock::now();
    model = std::make_unique<sph::TotalLagrangianSph>(body, rubber(), options, executor);
    setup_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    u.assign(body.X.size(), 0.0), v = f = u;
    for (std::size_t i = 0; i < u.size(); ++i) {
      if (i % 4 == 3) continue;
      u[i] = 0.02 * std::sin(3 * body.X[i]);
      v[i] = std::cos(2 * body.X[i]);
    }
  }
};

Bench& bench_of(const benchmark::State& state, sph::TlsphOptions options) {
  options.support = static_cast<double>(state.range(2));
  const std::vector<std::int64_t> key{state.range(0),
                                      state.range(1),
                                      state.range(2),
                                      options.psi > 0,
                                      static_cast<std::int64_t>(options.penalty),
                                      options.alpha > 0};
  static std::unique_ptr<Bench> last;
  if (!last || last->key != key) {
    last.reset();
    last = std::make_unique<Bench>(key, options);
  }
  return *last;
}

void tlsph_step(benchmark::State& state, const sph::TlsphOptions& options) {
  Bench& b = bench_of(state, options);
  for (auto _ : state) {
    b.model->forces(b.u, b.v, b.f, b.executor);
    benchmark::DoNotOptimize(b.f.data());
    benchmark::ClobberMemory();
  }
  using benchmark::Counter;
  const auto flags = Counter::kIsIterationInvariantRate | Counter::kInvert;
  const auto interactions = static_cast<double>(b.model->interactions());
  state.counters["s_per_particle"] = Counter(static_cast<double>(b.body.n), flags);
  state.counters["s_per_neighbour"] = Counter(interactions, flags);
  state.counters["neighbours"] = interactions / b.body.n;
  state.counters["setup_s"] = b.setup_s;
}

sph::TlsphOptions with(double psi, sph::PenaltyForm penalty, double alpha) {
  sph::TlsphOptions options;
  options.psi = psi, options.penalty = penalty, options.alpha = alpha;
  return options;
}

/// Cubes of count^3 particles, the last for a million.
constexpr int counts[] = {17, 34, 54, 100};

void one_thread(benchmark::internal::Benchmark* b) {
  for (const int support : {3, 2}) {
    for (const int n : counts) b->Args({n * n * n, 1, support});
  }
  b->ArgNames({"particles", "threads", "support"})->Unit(benchmark::kMillisecond);
}

void two_threads(benchmark::internal::Benchmark* b) {
  for (const int n : counts) b->Args({n * n * n, 2, 3});
  b->ArgNames({"particles", "threads", "support"});
  b->UseRealTime()->Unit(benchmark::kMillisecond);
}

void other_forms(benchmark::internal::Benchmark* b) {
  for (const int n : {17, 54}) b->Args({n * n * n, 1, 3});
  b->ArgNames({"particles", "threads", "support"})->Unit(benchmark::kMillisecond);
}

using sph::PenaltyForm;
BENCHMARK_CAPTURE(tlsph_step, ganzenmuller, with(0.07, PenaltyForm::ganzenmueller, 0))
    ->Apply(one_thread);
BENCHMARK_CAPTURE(tlsph_step, ganzenmuller, with(0.07, PenaltyForm::ganzenmueller, 0))
    ->Apply(two_threads);
BENCHMARK_CAPTURE(tlsph_step, no_penalty, with(0, PenaltyForm::ganzenmueller, 0))
    ->Apply(one_thread);
BENCHMARK_CAPTURE(tlsph_step, no_penalty, with(0, PenaltyForm::ganzenmueller, 0))
    ->Apply(two_threads);
BENCHMARK_CAPTURE(tlsph_step, potential, with(0.07, PenaltyForm::potential, 0))
    ->Apply(other_forms);
BENCHMARK_CAPTURE(tlsph_step, ganzenmuller_viscous, with(0.07, PenaltyForm::ganzenmueller, 1))
    ->Apply(other_forms);

}  // namespace
