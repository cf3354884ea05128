// One force evaluation of the Continuum Bond Method on the tensile bar, where nothing yields:
// plane strain, J2 plasticity beside the neo-Hookean solid of the same moduli.

#include "particle/delaunay/delaunay.hpp"
#include "scene/reader.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace concord;
using namespace concord::particle;

/// Argument: particles over the bar's 40 mm.
void cbm_step(benchmark::State& state, scene::MaterialModel model) {
  scene::Problem problem = scene::read_problem("tensile_bar");
  problem.material.model = model;
  const Body body =
      make_body(problem, problem.reference_length / state.range(0), 0, 1, CellSource::mesh);
  delaunay::Parameters parameters;
  parameters.xi_n = parameters.xi_t = 0;
  delaunay::DelaunayModel bar(body, problem, parameters);
  const Executor executor(1);
  Column u(body.X.size(), 0.0), v = u, f = u;
  for (Index a = 0; a < body.n; ++a) u[2 * a + 1] = 1e-4 * body.X[2 * a + 1];
  for (auto _ : state) {
    bar.forces(u, v, f, executor);
    bar.commit();
    benchmark::DoNotOptimize(f.data());
  }
  state.counters["particles"] = body.n;
  state.counters["per_particle"] =
      benchmark::Counter(static_cast<double>(body.n) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(cbm_step, j2, scene::MaterialModel::j2_hencky)
    ->Arg(73)
    ->Arg(600)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cbm_step, neo_hookean, scene::MaterialModel::neo_hookean)
    ->Arg(73)
    ->Arg(600)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
