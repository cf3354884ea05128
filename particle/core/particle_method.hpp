#pragma once
// What all particle methods share of a run: body, boundary data, integrator or static solver,
// histories, frames, result.

#include "particle/core/force_model.hpp"
#include "scene/checkpoint.hpp"
#include "scene/discrete_body.hpp"

#include <memory>

namespace concord::particle {

/// A particle formulation as a Method. It says what it is and makes its force model; the rest
/// is the same for all. To add a formulation: derive, implement make_model, and register with
/// scene::RegisterMethod.
class ParticleMethod : public scene::Method,
                       public scene::Discretises,
                       public scene::Resumable {
 public:
  /// `own`: name, title, source and the formulation's own parameters; those of the solvers are
  /// appended.
  explicit ParticleMethod(scene::MethodInfo own);
  const scene::MethodInfo& info() const final { return m_info; }
  void run(const scene::Problem& problem, const scene::RunRequest& request,
           scene::Result& result) const final {
    run_kept(problem, request, {}, result);
  }
  /// Runs of the explicit integrator have checkpoints, static solves have none: to resume one
  /// of these throws InputError.
  void run_kept(const scene::Problem& problem, const scene::RunRequest& request,
                const scene::Keeping& keeping, scene::Result& result) const final;
  std::unique_ptr<scene::DiscreteBody> discretise(const scene::Problem& problem,
                                                  const scene::RunRequest& request) const final;

  /// The body as this formulation divides it: by default make_body's with these cells, and
  /// divide(). Throws InputError.
  virtual Body make_particles(const scene::Problem& problem, const scene::RunRequest& request,
                              const scene::Settings& settings, const Executor& executor) const;

  /// Which cells lie between the particles of this formulation.
  virtual CellSource cells(const scene::Settings& settings) const;

  /// Whether this formulation serves scenes with fracture; its models are then Fracturing.
  virtual bool breaks() const { return false; }

  /// How this formulation divides the body among its particles: may replace V and m of `body`,
  /// which come with the barycentric volumes sum |t|/(n+1). Called before make_model.
  virtual void divide(Body& body, const scene::Problem& problem,
                      const scene::Settings& settings) const;

  /// Forces of this formulation on `body`. Throws InputError for settings that it cannot serve.
  virtual std::unique_ptr<ForceModel> make_model(const Body& body,
                                                 const scene::Problem& problem,
                                                 const scene::Settings& settings,
                                                 const Executor& executor) const = 0;

 private:
  scene::MethodInfo m_info;
};

/// Parameters of the shared solvers: solver, dt_factor, damping, ... with their meaning.
const std::vector<scene::ParameterInfo>& solver_parameters();

}  // namespace concord::particle
