#pragma once
// What a run carries from step to step.

#include <deal.II/lac/vector.h>

#include <functional>

namespace concord::fem {

struct State {
  using Vector = dealii::Vector<double>;
  Vector u, v, a;             ///< v and a stay empty in static runs
  Vector internal, external;  ///< nodal forces at u and t [N]
  double t = 0;
  long step = 0;             ///< time steps, or Newton iterations in static runs
  double external_work = 0;  ///< of loads and of prescribed displacements [J]
};

/// y = M x, with the mass of the integrator at hand; empty in static runs.
using MassProduct = std::function<void(const State::Vector& x, State::Vector& y)>;

}  // namespace concord::fem
