#pragma once
// The one quasi-static solver of all particle methods: Newton's method with the assembled
// tangent.

#include "particle/core/recorder.hpp"
#include "particle/core/work.hpp"

#include <functional>

namespace concord::particle {

struct StaticsOptions {
  int load_steps = 1;
  /// Converged when |r| <= tolerance * scale over free components, scale the norm of all
  /// internal forces (reactions included); at the default tolerance not before r stagnates at
  /// round-off, below 100 * tolerance * scale.
  double tolerance = 1e-12;
  int most_iterations = 40;  ///< per load step
  int most_halvings = 10;    ///< of a load step that does not converge
  int frames = 0;
  std::function<void(double, const std::string&)> progress;
};

struct StaticsOutcome {
  long iterations = 0;
  double t = 0;        ///< load parameter reached, 1 at the end
  double solve_s = 0;  ///< wall time without output
};

/// Equilibrium for load parameter t from 0 to 1. Each step starts with the tangent predictor
/// (prescribed increments lifted through the tangent), then Newton with backtracking on |r|;
/// CHOLMOD where the tangent is symmetric and positive definite, UMFPACK else. A step that
/// fails is halved.
class Statics {
 public:
  /// Rigid motions that the constraints leave free: an InputError, or allowed where the state
  /// that is looked for need not be the only one, see settle().
  enum class RigidMotions { refused, allowed };
  /// Throws InputError.
  Statics(const scene::Problem& problem, ForceModel& model, const Constraints& constraints,
          const ExternalLoads& loads, const Executor& executor,
          RigidMotions rigid = RigidMotions::refused);
  ~Statics();

  /// Throws SolveError when a step does not converge though halved, or the tangent is singular;
  /// the recorder then has all load steps reached. `outcome` is current whenever it throws.
  void run(const StaticsOptions& options, Recorder& recorder, StaticsOutcome& outcome);
  /// The equilibrium at t = 0 that Newton's method reaches from a displacement; nothing breaks.
  /// Free rigid motions, and particles without bonds, stay where they are up to round-off: the
  /// tangent's diagonal is raised by 1e-9 of its mean. Throws SolveError.
  const Column& settle(std::span<const double> guess, const StaticsOptions& options);
  State state() const;

 private:
  struct Factors;
  bool step_to(double t, const StaticsOptions& options, StaticsOutcome& outcome);
  double evaluate(double t);
  bool try_displacement(const Column& trial, double t, double& residual);
  void solve(const Column& right, Column& correction, bool lift);

  const scene::Problem& m_problem;
  ForceModel& m_model;
  const Constraints& m_constraints;
  const ExternalLoads& m_loads;
  const Executor& m_executor;
  std::vector<Index> m_equation;  ///< of each unknown (particle*dim + component): number among
                                  ///< the free ones, or -1
  Index m_free = 0;
  Column m_u, m_v, m_f;
  double m_scale = 0, m_t = 0;
  ExternalWork m_work;
  std::unique_ptr<Factors> m_factors;
  std::string m_failure;
};

}  // namespace concord::particle
