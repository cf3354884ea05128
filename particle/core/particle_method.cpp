#include "particle/core/particle_method.hpp"

#include "particle/core/checkpoint.hpp"
#include "particle/core/interpolant.hpp"
#include "particle/core/leapfrog.hpp"
#include "particle/core/statics.hpp"
#include "scene/crc64.hpp"

#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace concord::particle {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Whether the run has mass damping: asked for, or that of a static scene's damped motion.
bool damped(const scene::Problem& problem, const scene::Settings& settings) {
  if (problem.is_static && settings.word("solver") != "explicit") return false;
  if (settings.number("damping") > 0) return true;
  return problem.is_static && !(settings.number("duration") > 0);
}

/// One run, so that what was reached can be told from wherever it ends.
struct Run {
  const scene::Problem& problem;
  const scene::RunRequest& request;
  const scene::Settings& settings;
  Body& body;
  ForceModel& model;
  const Constraints& constraints;
  const ExternalLoads& loads;
  const Executor& executor;
  Recorder& recorder;
  scene::Result& result;
  Checkpoints* checkpoints;  ///< nullptr: none
  bool resumes;

  void finish(const State& state) {
    result.t_end = state.t;
    for (const auto& [name, value] : recorder.quantities(state))
      result.quantities[name] = value;
    result.samples = recorder.samples(state);
    recorder.add_hourglass(result);
    recorder.add_cracks(result);
  }

  void statics() {
    Statics solver(problem, model, constraints, loads, executor);
    StaticsOptions options;
    options.load_steps = problem.load_steps;
    options.tolerance = settings.number("tolerance");
    options.frames = problem.frames;
    options.progress = request.progress;
    StaticsOutcome outcome;
    const auto tell = [&] {
      result.steps = outcome.iterations;
      result.wall_s = outcome.solve_s;
      finish(solver.state());
      if (problem.material.plastic()) recorder.add_invariants(result);
    };
    try {
      solver.run(options, recorder, outcome);
    } catch (...) {
      tell();
      throw;
    }
    tell();
  }

  void dynamics() {
    LeapfrogOptions options;
    options.end_time = problem.end_time;
    options.dt_factor = settings.number("dt_factor");
    options.dt_fixed = settings.number("dt");
    const scene::Material& material = problem.material;
    if (const double courant = settings.number("courant"); courant > 0)
      options.dt_fixed = courant * request.h / std::sqrt(material.E / material.rho0);
    options.damping = settings.number("damping");
    options.frames = problem.frames;
    options.history_rows = problem.history_rows;
    options.progress = request.progress;
    const double duration = settings.number("duration");
    if (problem.is_static && duration > 0)
      options.ramp_time = options.end_time = duration;
    else if (problem.is_static)
      relaxation(options);
    options.checkpoints = checkpoints;
    Leapfrog integrator(problem, model, constraints, loads, executor, options.ramp_time);
    if (settings.word("start") == "equilibrium" && !resumes) settle(integrator);
    LeapfrogOutcome outcome;
    const auto tell = [&] {
      result.steps = outcome.steps;
      result.dt = outcome.dt;
      result.wall_s = outcome.loop_s;
      tell_resumed(outcome);
      finish(integrator.state());
      recorder.add_invariants(result, options.damping > 0);
    };
    try {
      integrator.run(options, recorder, outcome);
    } catch (const InputError&) {  // of a checkpoint: nothing has been reached
      throw;
    } catch (const scene::OutputError&) {  // nothing more can be written
      throw;
    } catch (...) {
      tell();
      throw;
    }
    tell();
    if (options.stop_at_residual > 0 && !outcome.settled) {
      throw SolveError(
          "equilibrium", outcome.steps, outcome.t, -1,
          "the damped motion did not settle to the asked residual; more time: settle_time");
    }
  }

  /// Starts from the equilibrium near the problem's initial displacement.
  void settle(Leapfrog& integrator) const {
    const auto begin = Clock::now();
    Statics solver(problem, model, constraints, loads, executor,
                   Statics::RigidMotions::allowed);
    StaticsOptions options;
    options.tolerance = settings.number("tolerance");
    integrator.start_from(solver.settle(integrator.displacement(), options));
    result.setup_s += seconds_since(begin);
  }

  void tell_resumed(const LeapfrogOutcome& outcome) const {
    if (outcome.resumed_at.empty()) return;
    result.notes["resumed"] = fmt::format("after step {}", fmt::join(outcome.resumed_at, ", "));
    if (checkpoints->elsewhere())
      result.notes["resumed"] += ", with another program or processor: last bits may differ";
  }

  /// Damped dynamics for a static problem: loads ramp up over a few periods of the body's
  /// slowest wave, then the rest is damped out at about the critical rate of that mode, c = 2
  /// pi c_s / (2 L) per radian.
  void relaxation(LeapfrogOptions& options) const {
    double size = 0;
    for (Index a = 0; a < body.n; ++a)
      size = std::max(size, (body.position(a) - body.position(0)).norm());
    const double period = 4 * size / problem.material.shear_wave_speed();
    options.ramp_time = 2 * period;
    options.end_time = settings.number("settle_time") * period;
    if (options.damping == 0) options.damping = 2 * M_PI / period;
    options.stop_at_residual = std::max(1e-14, settings.number("tolerance"));
    options.frames = 0;
  }
};

}  // namespace

const std::vector<scene::ParameterInfo>& solver_parameters() {
  static const std::vector<scene::ParameterInfo> table{
      {"solver",
       "1",
       "auto",
       "auto | explicit | static",
       "auto: Newton for static scenes, leapfrog for dynamic ones; explicit on a static scene: "
       "damped dynamics",
       -1e300,
       1e300,
       {"auto", "explicit", "static"}},
      {"start",
       "1",
       "given",
       "given | equilibrium",
       "dynamic scenes: the initial displacement as it is given, or the equilibrium at t = 0 "
       "that Newton's method finds from there, pre-cracks open and nothing breaking",
       -1e300,
       1e300,
       {"given", "equilibrium"}},
      {"dt_factor", "1", "0.8", "(0, 1]",
       "time step over the critical one 2/omega_max, omega_max by Lanczos iteration on the "
       "linearised forces",
       1e-6, 1},
      {"dt", "s", "0", ">= 0", "fixed time step; 0: from dt_factor", 0},
      {"courant", "1", "0", ">= 0",
       "fixed time step over h/c_0, c_0 = sqrt(E/rho); 0: from dt or dt_factor", 0},
      {"damping", "1/s", "0", ">= 0",
       "mass-proportional damping rate c: force -c m v (0 on a static scene without duration: "
       "critical)",
       0},
      {"duration", "s", "0", ">= 0",
       "explicit on a static scene: t runs from 0 to 1 in this time, with the density's "
       "inertia and "
       "no damping but the one asked for; 0: damped dynamics until it has settled",
       0},
      {"settle_time", "1", "60", "> 2",
       "damped dynamics: longest time, in periods 4 L/c_s of the body", 2},
      {"tolerance", "1", "1e-12", "[1e-15, 1e-2]",
       "statics: unbalanced force over internal force at convergence (norms)", 1e-15, 1e-2},
  };
  return table;
}

ParticleMethod::ParticleMethod(scene::MethodInfo own) : m_info(std::move(own)) {
  const auto& shared = solver_parameters();
  m_info.parameters.insert(m_info.parameters.end(), shared.begin(), shared.end());
}

CellSource ParticleMethod::cells(const scene::Settings&) const { return CellSource::delaunay; }

void ParticleMethod::divide(Body&, const scene::Problem&, const scene::Settings&) const {}

Body ParticleMethod::make_particles(const scene::Problem& problem,
                                    const scene::RunRequest& request,
                                    const scene::Settings& settings,
                                    const Executor& executor) const {
  Body body =
      make_body(problem, request.h, request.perturb, request.seed, cells(settings), executor);
  divide(body, problem, settings);
  return body;
}

namespace {

/// Settings that contradict the scene or each other. Throws InputError.
void check_solver(const std::string& method, const scene::Problem& problem,
                  const scene::Settings& settings, bool viscous) {
  const std::string& solver = settings.word("solver");
  const auto reject = [&](const std::string& key, const std::string& found,
                          const std::string& allowed) {
    throw InputError({problem.file.string(), 0, 0}, method + key, found, allowed);
  };
  if (solver == "static" && !problem.is_static)
    reject(".solver", "static", "auto or explicit for a scene with an end_time");
  if (settings.word("start") != "given" && problem.is_static)
    reject(".start", settings.word("start"), "given for a static scene");
  if (settings.number("dt") > 0 && settings.number("courant") > 0)
    reject(".courant", "above 0 beside a time step dt", "one of the two");
  if (settings.number("duration") > 0 && !(problem.is_static && solver == "explicit")) {
    reject(".duration", solver + " solver, or a scene with an end_time",
           "solver = explicit on a static scene");
  }
  if (problem.is_static && solver == "explicit" && problem.material.plastic() &&
      !(settings.number("duration") > 0)) {
    reject(".duration", "0",
           "above 0 for a plastic material: damped vibrations would leave plastic strains that "
           "the load did not make");
  }
  if (problem.is_static && solver != "explicit" && viscous) {
    reject("", "artificial viscosity on a static solve",
           "viscosity 0, or solver = explicit (damped dynamics)");
  }
}

/// The displacement between the particles, from what the run's end left. Comes last, when the
/// model's memory is free again.
std::shared_ptr<const scene::Field> field_of(Body& body, const scene::Samples& samples) {
  std::vector<Mat3> H;
  H.reserve(samples.F.size());
  for (const Mat3& F : samples.F) H.push_back(F - Mat3::Identity());
  return std::make_shared<ParticleField>(body, samples.X, samples.u, std::move(H));
}

/// What a checkpoint must have been made with: everything but the number of threads.
RunFacts facts(const std::string& method, const scene::Problem& problem,
               const scene::RunRequest& request, const scene::Settings& settings,
               const Body& body) {
  RunFacts facts{{"scene", problem.name},
                 {"text of the scene", problem.normalised_text},
                 {"method", method},
                 {"spacing", fmt::format("{} m", request.h)},
                 {"perturb", fmt::format("{}", request.perturb)},
                 {"seed", fmt::format("{}", request.seed)},
                 {"frames", request.write_frames ? "on" : "off"}};
  for (const auto& [key, value] : settings.all()) facts.emplace_back(method + "." + key, value);
  std::uint64_t particles = scene::crc64_of(body.X);
  particles = scene::crc64_of(body.V, particles);
  particles = scene::crc64_of(body.m, particles);
  particles = scene::crc64_of(body.triangulation.simplices, particles);
  facts.emplace_back("particles",
                     fmt::format("{}, with the fingerprint {:016x}", body.bulk, particles));
  return facts;
}

}  // namespace

void ParticleMethod::run_kept(const scene::Problem& problem, const scene::RunRequest& request,
                              const scene::Keeping& keeping, scene::Result& result) const {
  const scene::Settings settings(m_info.name, m_info.parameters, request.settings);
  if (!breaks()) scene::refuse_fracture(problem, m_info.name);
  const bool newton = problem.is_static && settings.word("solver") != "explicit";
  if (newton && keeping.resume)
    throw InputError({keeping.file.string()}, "resume", "a static solve",
                     "runs of the explicit integrator: static solves have no checkpoints");
  const auto begin = Clock::now();
  const Executor executor(request.threads);
  Body body = make_particles(problem, request, settings, executor);
  std::unique_ptr<ForceModel> model = make_model(body, problem, settings, executor);
  const Constraints constraints(problem, body);
  const ExternalLoads loads(problem, *model);
  const bool dissipative = model->viscous() || damped(problem, settings);
  check_solver(m_info.name, problem, settings, model->viscous());
  // Of an earlier run, whose files are written over from here on.
  if (!keeping.resume && !keeping.file.empty()) std::filesystem::remove(keeping.file);
  Recorder recorder(problem, *model, constraints, executor, request.out, request.write_frames,
                    dissipative, keeping.resume);
  result.h = request.h;
  result.particles = body.bulk;
  result.unknowns = constraints.unknowns();
  result.threads = executor.threads();
  // Set-up is told as it is without a cache.
  result.setup_s = seconds_since(begin) + body.saved_s;
  if (body.saved_s > 0) result.notes["body"] = "from the cache";
  Checkpoints checkpoints(keeping,
                          [&] { return facts(m_info.name, problem, request, settings, body); });
  Run run{problem,
          request,
          settings,
          body,
          *model,
          constraints,
          loads,
          executor,
          recorder,
          result,
          keeping.file.empty() ? nullptr : &checkpoints,
          keeping.resume};
  const auto complete = [&] {
    model.reset();
    if (!result.samples.u.empty()) result.field = field_of(body, result.samples);
  };
  try {
    if (newton)
      run.statics();
    else
      run.dynamics();
  } catch (...) {
    complete();
    throw;
  }
  complete();
}

}  // namespace concord::particle
