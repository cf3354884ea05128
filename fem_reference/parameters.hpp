#pragma once
// Name, source and settings of the method `fem`; free of deal.II, so that listing methods costs
// nothing.

#include "scene/geometry.hpp"
#include "scene/method.hpp"

namespace concord::fem {

enum class Solver { explicit_leapfrog, newmark, statics };
enum class LinearChoice { automatic, direct, conjugate_gradients };

/// Stress that is held against the flow stress (24): of Kirchhoff (the paper, and J2 theory in
/// logarithmic strains), or of Cauchy (the choice of CalculiX, see README.md).
enum class YieldMeasure { kirchhoff, cauchy };

/// The settings of one run, read and checked.
struct Options {
  scene::CellShape shape = scene::CellShape::hypercube;
  int degree = 2;
  std::string element = "Q2";
  Solver solver = Solver::explicit_leapfrog;
  LinearChoice linear_solver = LinearChoice::automatic;
  bool split_law = false;     ///< the code gallery's neo-Hookean law instead of the scene's
  bool three_points = false;  ///< the 3-point rule of P2 in the plane
  YieldMeasure yield_measure = YieldMeasure::kirchhoff;
  double dt = 0;         ///< given time step [s]; 0: chosen by the method
  double dt_factor = 0;  ///< fraction of the critical step (explicit)
  double courant = 0;    ///< dt c_p p / h (Newmark)
  double beta = 0.25, gamma = 0.5;
  double tolerance =
      0;  ///< of the residual, relative to the size of the element forces; 0: default
  int max_iterations = 0;
  int max_halvings = 0;
};

const scene::MethodInfo& method_info();

/// Throws InputError for unknown settings, and for solvers that do not fit problem or element.
Options read_options(const scene::Problem& problem, const scene::RunRequest& request);

}  // namespace concord::fem
