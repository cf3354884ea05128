#pragma once
// A beam that is torn apart, for the tests of fracture in 3D and of fragments.

#include "particle/core/leapfrog.hpp"
#include "particle/delaunay/fracture.hpp"
#include "scene/reader.hpp"

#include <algorithm>
#include <cmath>

namespace concord::particle::delaunay::fragments {
/// `free_beam`, 6 m along Z, whose halves fly apart; bonds break at a strain of .05.
inline scene::Problem torn() {
  scene::Problem problem = scene::read_problem("free_beam", {});
  problem.quantities.clear();
  problem.fracture.emplace();
  problem.fracture->energy_release_rate = 0.5 * 0.05 * 0.05 * problem.material.E * 0.25;
  problem.fracture->length = 0.25;
  problem.initial_velocity.emplace();
  problem.initial_velocity->component[0] = scene::Expression("0.2*Z*Y", {});
  problem.initial_velocity->component[2] = scene::Expression("2.5*tanh(Z - 3)", {});
  problem.end_time = 0.2;
  problem.history_rows = 60;
  problem.frames = 0;
  return problem;
}

using Settings = std::map<std::string, std::string>;

inline scene::Result run_torn(double perturb, std::uint64_t seed, Settings settings) {
  scene::RunRequest request;
  request.h = 0.25;
  request.perturb = perturb;
  request.seed = seed;
  settings.insert({{"xi_n", "0.1"}, {"xi_t", "0.1"}});
  request.settings = settings;
  scene::Result result;
  scene::MethodRegistry::instance().find("delaunay").run(torn(), request, result);
  return result;
}

inline Body torn_body(const scene::Problem& problem, std::uint64_t seed, double perturb = 0.2) {
  return make_body(problem, 0.25, perturb, seed);
}

inline std::size_t at(const Body& body, Index a) {
  return static_cast<std::size_t>(a) * body.stride;
}

/// Takes bonds apart all over the body: every `stride`-th particle moves by a third of h.
inline void break_some(FractureModel& model, const Body& body, int round, int stride = 37) {
  Column u(body.X.size(), 0.0), v = u, f = u;
  for (Index a = round * 11; a < body.n; a += stride)
    u[at(body, a) + round % body.dim] = (round % 2 == 0 ? 0.33 : -0.33) * body.h;
  model.advance(1 + round, 1e-9, u, v, f, Executor(1));
}

/// Height over longest bond, of what a particle sums over.
inline double thickness(const Body& body, const Network& network, Index a) {
  const Stencil sum = network.stencil(a);
  double zeta = 0, length = 0;
  for (std::size_t p = 0; p < sum.points.size(); ++p) {
    zeta = std::max(zeta, sum.zeta[p].norm());
    length = std::max(length, (body.position(sum.points[p]) - body.position(a)).norm());
  }
  return sum.omega / (zeta * length);
}

inline double omega_of(FractureModel& model, const scene::Problem& problem, const Body& body,
                       const Column& u) {
  const Constraints constraints(problem, body);
  const Executor one(1);
  return SpectralRadius(model, constraints, one).omega_max(u, 1e-4, 200);
}

/// A particle with one simplex left, and the model that it is left in.
struct Tip {
  Index particle = -1, simplex = -1;
};
inline Tip leave_a_tip(FractureModel& model, const Body& body) {
  for (int round = 0; round < 30; ++round) {
    break_some(model, body, round, 23);
    for (Index a = 0; a < body.n; ++a) {
      const std::vector<Index> left = model.network().simplices_at(a);
      if (left.size() == 1) return {a, left[0]};
    }
  }
  return {};
}

}  // namespace concord::particle::delaunay::fragments
