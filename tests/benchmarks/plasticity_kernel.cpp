// Stress of a plastic body: time a particle and a force evaluation, one thread, everything
// elastic or everything flowing.

#include "particle/core/plasticity.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace concord;
using particle::plastic_width;

scene::Problem steel(Dimension dimension) {
  scene::Problem problem;
  problem.dimension = dimension;
  scene::Material& m = problem.material;
  m.model = scene::MaterialModel::j2_hencky;
  m.mu = 80.19e9, m.lambda = 164.21e9 - 2 * m.mu / 3;  // Table 1 of the CBM paper
  m.hardening = {450e6, 715e6, 129e6, 16.93};
  return problem;
}

/// Simple shear gamma and a stretch of a tenth of it, both growing a little from particle to
/// particle.
template <int Dim> struct Group {
  double h[Dim * Dim][plastic_width] = {}, p[Dim * Dim][plastic_width], j[plastic_width];
  Group(Index first, double gamma) {
    for (int l = 0; l < plastic_width; ++l) {
      const double g = gamma * (1 + 0.01 * std::sin(0.1 * (first + l)));
      h[Dim][l] = g;
      h[0][l] = 0.1 * g, h[Dim + 1][l] = -0.1 * g / (1 + 0.1 * g);
    }
  }
};

/// `start` is the shear committed first, `gamma` the one of the evaluations measured.
template <int Dim> void plastic_stress(benchmark::State& state, double start, double gamma) {
  const Index n = 1904;  // the tensile bar at the paper's finest spacing
  particle::PlasticHistory history(
      steel(Dim == 3 ? Dimension::three_d : Dimension::plane_strain), n);
  std::vector<Group<Dim>> groups;
  for (const double shear : {start, gamma}) {
    groups.clear();
    for (Index a = 0; a < n; a += plastic_width) {
      groups.emplace_back(a, shear);
      history.stress(a, plastic_width, groups.back().h, groups.back().p, groups.back().j);
    }
    if (shear == start) history.commit();
  }
  for (auto _ : state) {
    for (Index a = 0; a < n; a += plastic_width) {
      Group<Dim>& g = groups[static_cast<std::size_t>(a / plastic_width)];
      history.stress(a, plastic_width, g.h, g.p, g.j);
    }
    benchmark::ClobberMemory();
  }
  state.counters["s_per_particle"] = benchmark::Counter(
      n, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void plane(benchmark::State& state, double start, double gamma) {
  plastic_stress<2>(state, start, gamma);
}
void space(benchmark::State& state, double start, double gamma) {
  plastic_stress<3>(state, start, gamma);
}

BENCHMARK_CAPTURE(plane, elastic, 0.0, 1e-3);
BENCHMARK_CAPTURE(plane, unloaded, 0.3, 0.299);
BENCHMARK_CAPTURE(plane, flowing, 0.3, 0.3001);
BENCHMARK_CAPTURE(space, elastic, 0.0, 1e-3);
BENCHMARK_CAPTURE(space, flowing, 0.3, 0.3001);

}  // namespace
