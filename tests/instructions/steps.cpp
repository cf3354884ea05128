// Whole time steps of the explicit integrator, for counting: count_steps [CASE ...]
// Every case runs `length` and then twice `length` steps; the difference belongs to the steps.

#include "tests/instructions/bodies.hpp"
#include "tests/instructions/counted.hpp"

#include "particle/core/leapfrog.hpp"
#include "particle/delaunay/delaunay.hpp"
#include "particle/delaunay/fracture.hpp"
#include "scene/reader.hpp"
#include "sph_reference/total_lagrangian/model.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>

namespace {

using namespace concord;
using namespace concord::particle;
using sph::PenaltyForm;

constexpr int length = 4;  ///< steps

/// The swinging cube (rubber) or the tensile bar's steel in plane strain, as a free unit body.
scene::Problem free_body(Dimension dimension, const char* material) {
  scene::Problem problem = scene::read_problem(material);
  problem.dimension = dimension;
  problem.thickness = 1;
  problem.is_static = false;
  problem.boundaries.clear();
  problem.quantities.clear();
  return problem;
}
scene::Problem rubber() { return free_body(Dimension::three_d, "swinging_cube"); }
/// Particles an edge: 729 particles.
int edge(const scene::Problem& problem) { return problem.dim() == 3 ? 9 : 27; }

/// Square or cube of side 1.
Body unit_body(const scene::Problem& problem) {
  const int n = edge(problem);
  return instructions::lattice(problem, {n, n, n}, 1.0 / (n - 1));
}

/// Stretches along the first axis by about `strain` a step.
scene::Problem steel(Dimension dimension, double strain) {
  scene::Problem problem = free_body(dimension, "tensile_bar");
  const double rate = strain * problem.material.longitudinal_wave_speed() * edge(problem) / 0.2;
  problem.initial_velocity.emplace();
  problem.initial_velocity->component[0] = scene::Expression("r*X", {{"r", rate}});
  return problem;
}

using Tune = std::function<void(LeapfrogOptions&)>;

/// The steps of `model` on `problem`: time steps of a fifth of h/c_p, prescribed, so that no
/// estimate of the stable one is counted.
void count_steps(const std::string& name, const scene::Problem& problem, const Body& body,
                 ForceModel& model, const Executor& executor, const Tune& tune) {
  const Constraints constraints(problem, body);
  const ExternalLoads loads(problem, model);
  const auto run = [&](int steps) {
    Leapfrog integrator(problem, model, constraints, loads, executor);
    Recorder recorder(problem, model, constraints, executor, "", false);
    LeapfrogOptions options;
    options.dt_fixed = 0.2 * body.h_min / problem.material.longitudinal_wave_speed();
    options.end_time = steps * options.dt_fixed;
    if (tune) tune(options);
    LeapfrogOutcome outcome;
    integrator.run(options, recorder, outcome);
    if (outcome.steps != steps)
      throw std::logic_error("another number of steps than asked for");
  };
  run(1);
  instructions::counted(name + " once", [&] { run(length); });
  instructions::counted(name + " twice", [&] { run(2 * length); });
  std::printf("case %s steps %d particles %d\n", name.c_str(), length, body.n);
}

void delaunay_steps(const std::string& name, const scene::Problem& problem, double xi,
                    double c1, const Tune& tune = {}) {
  const Body body = unit_body(problem);
  const Executor executor(1);
  delaunay::Parameters parameters;
  parameters.xi_n = parameters.xi_t = xi;
  parameters.c1 = c1;
  delaunay::DelaunayModel model(body, problem, parameters, executor);
  count_steps(name, problem, body, model, executor, tune);
}

/// A rod pushed at one end, so that most of it is at rest; `rest`: whether that is used.
void pulse_steps(const std::string& name, bool rest) {
  scene::Problem problem = rubber();
  problem.initial_displacement.reset();
  problem.initial_velocity.emplace();
  problem.initial_velocity->component[2] = scene::Expression("max(0, 0.1 - Z)", {});
  const Body body = instructions::lattice(problem, {5, 5, 80}, 0.05);
  const Executor executor(1);
  delaunay::DelaunayModel model(body, problem, {}, executor);
  count_steps(name, problem, body, model, executor,
              [&](LeapfrogOptions& o) { o.rest_regions = rest; });
}

/// A plane plate whose bonds could break, and do not: the plate swells slowly.
void breakable_steps(const std::string& name) {
  scene::Problem problem = free_body(Dimension::plane_stress, "pmma_plate");
  problem.fracture->cracks.clear();
  problem.fracture->arrival.clear();
  problem.fracture->energy_release_rate = 1e9;
  problem.initial_velocity.emplace();
  problem.initial_velocity->component[0] = scene::Expression("X", {});
  const Body body = unit_body(problem);
  delaunay::FractureModel model(body, problem, {});
  count_steps(name, problem, body, model, Executor(1), {});
}

void sph_steps(const std::string& name, double psi, PenaltyForm penalty, double alpha) {
  const scene::Problem problem = rubber();
  const Body body = unit_body(problem);
  const Executor executor(1);
  sph::TlsphOptions options;
  options.psi = psi, options.penalty = penalty, options.alpha = alpha;
  sph::TotalLagrangianSph model(body, problem, options, executor);
  count_steps(name, problem, body, model, executor, {});
}

// Strains a step of the steel, which yields at 0.0025: far below that to the end, and beyond it
// from the first step on.
constexpr double slow = 1e-6, fast = 5e-3;

struct Case {
  const char* name;
  std::function<void(const std::string&)> run;
};

using Name = const std::string&;
const Case cases[] = {
    {"plain", [](Name n) { delaunay_steps(n, rubber(), 0, 0); }},
    {"damped",
     [](Name n) {
       delaunay_steps(n, rubber(), 0, 0, [](LeapfrogOptions& o) { o.damping = 10; });
     }},
    {"recorded",
     [](Name n) {
       delaunay_steps(n, rubber(), 0, 0, [](LeapfrogOptions& o) { o.history_rows = 1000; });
     }},
    {"contact", [](Name n) { delaunay_steps(n, rubber(), 1, 0); }},
    {"contact_viscous", [](Name n) { delaunay_steps(n, rubber(), 1, 0.1); }},
    {"pulse", [](Name n) { pulse_steps(n, false); }},
    {"pulse_resting", [](Name n) { pulse_steps(n, true); }},
    {"plastic_elastic",
     [](Name n) { delaunay_steps(n, steel(Dimension::plane_strain, slow), 0, 0); }},
    {"plastic_flowing",
     [](Name n) { delaunay_steps(n, steel(Dimension::plane_strain, fast), 0, 0); }},
    {"plastic_elastic_3d",
     [](Name n) { delaunay_steps(n, steel(Dimension::three_d, slow), 0, 0); }},
    {"plastic_flowing_3d",
     [](Name n) { delaunay_steps(n, steel(Dimension::three_d, fast), 0, 0); }},
    {"breakable", [](Name n) { breakable_steps(n); }},
    {"sph_plain", [](Name n) { sph_steps(n, 0, PenaltyForm::ganzenmueller, 0); }},
    {"sph_penalty", [](Name n) { sph_steps(n, 0.07, PenaltyForm::ganzenmueller, 0); }},
    {"sph_potential", [](Name n) { sph_steps(n, 0.07, PenaltyForm::potential, 0); }},
    {"sph_viscous", [](Name n) { sph_steps(n, 0.07, PenaltyForm::ganzenmueller, 1); }},
};

}  // namespace

int main(int argc, char** argv) {
  instructions::tell_compiler();
  for (const Case& one : cases) {
    if (instructions::wanted(one.name, argc, argv)) one.run(one.name);
  }
}
