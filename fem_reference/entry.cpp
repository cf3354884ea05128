#include "fem_reference/entry.hpp"

#include "fem_reference/run.hpp"

#include <deal.II/base/multithread_info.h>

#include <chrono>
#include <memory>
#include <optional>

namespace concord::fem {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

namespace {

/// Nodal interpolation of the initial state.
template <int dim>
void set_initial_state(const scene::Problem& problem, const Discretisation<dim>& discretisation,
                       State& state) {
  state.u.reinit(discretisation.dofs());
  state.internal.reinit(discretisation.dofs());
  state.external.reinit(discretisation.dofs());
  const auto interpolate = [&](const std::optional<scene::VectorExpression>& field,
                               State::Vector& out) {
    if (!field) return;
    std::vector<Vec3> values;
    for (const Vec3& X : discretisation.mesh().nodes) values.push_back((*field)(X, 0));
    discretisation.set_from_nodes(values, out);
  };
  interpolate(problem.initial_displacement, state.u);
  if (problem.is_static) return;
  state.v.reinit(discretisation.dofs());
  state.a.reinit(discretisation.dofs());
  interpolate(problem.initial_velocity, state.v);
}

/// The law and its fields; of a plastic material, also the history.
template <int dim> struct Material {
  Material(const scene::Problem& problem, const Options& options,
           const Discretisation<dim>& discretisation) {
    if (problem.material.plastic()) {
      flow.emplace(problem.material, options.yield_measure);
      points.emplace(*flow);
      fields = std::make_unique<PlasticFields<dim>>(discretisation, *points, problem.thickness);
    } else {
      elastic.emplace(problem, options.split_law);
      fields = std::make_unique<ElasticFields<dim>>(discretisation, *elastic);
    }
  }
  std::optional<Hyperelastic<dim>> elastic;
  std::optional<Elastoplastic<dim>> flow;
  std::optional<PlasticPoints<dim>> points;
  std::unique_ptr<NodalFields<dim>> fields;
};

template <int dim>
void run(const scene::Problem& problem, const scene::RunRequest& request,
         const Options& options, scene::Result& result) {
  const double started = now();
  if (request.progress) request.progress(0, "mesh and elements");
  const Discretisation<dim> discretisation(problem, request, options);
  Material<dim> material(problem, options, discretisation);
  const Prescribed<dim> prescribed(problem, discretisation);
  const Loads<dim> loads(problem, discretisation);
  result.h = request.h;
  result.particles = static_cast<long>(discretisation.mesh().nodes.size());
  result.unknowns =
      static_cast<long>(discretisation.dofs()) - static_cast<long>(prescribed.size());
  result.threads = 1;
  result.notes["element"] = options.element;
  result.notes["geometry"] = discretisation.curved() ? "isoparametric" : "straight-sided";
  if (options.split_law) result.notes["law"] = "split neo-Hookean";
  if (options.three_points) result.notes["quadrature"] = "3 points";
  if (material.flow) {
    const bool kirchhoff = options.yield_measure == YieldMeasure::kirchhoff;
    result.notes["yield"] = kirchhoff ? "Kirchhoff stress" : "Cauchy stress";
  }
  State state;
  set_initial_state(problem, discretisation, state);
  Observer<dim> observer(problem, request, discretisation, *material.fields, prescribed,
                         prescribed.size() == 0 && !loads.any(), result);
  Run<dim> parts{problem,
                 request,
                 options,
                 discretisation,
                 prescribed,
                 loads,
                 observer,
                 result,
                 state,
                 material.elastic ? &*material.elastic : nullptr,
                 material.points ? &*material.points : nullptr,
                 started};
  if (options.solver == Solver::statics)
    run_statics(parts);
  else if (options.solver == Solver::newmark)
    run_newmark(parts);
  else
    run_explicit(parts);
}

}  // namespace
}  // namespace concord::fem

void concord_fem_run(const concord::scene::Problem& problem,
                     const concord::scene::RunRequest& request,
                     concord::scene::Result& result) {
  using namespace concord;
  // One thread: sums in one order, the same bits on every machine setting.
  dealii::MultithreadInfo::set_thread_limit(1);
  const fem::Options options = fem::read_options(problem, request);
  result.notes["solver"] = options.solver == fem::Solver::statics   ? "static Newton"
                           : options.solver == fem::Solver::newmark ? "Newmark"
                                                                    : "explicit";
  if (problem.dim() == 2)
    fem::run<2>(problem, request, options, result);
  else
    fem::run<3>(problem, request, options, result);
}
