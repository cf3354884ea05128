#include "particle/core/statics.hpp"

#include "scene/interrupt.hpp"

#include <Eigen/Geometry>

#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>
#include <Eigen/UmfPackSupport>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace concord::particle {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Number of rigid motions (of 6, or 3 in the plane) that the constraints leave free: rank
/// deficiency of the motions' values on the prescribed components, lengths over the body's
/// size.
int free_rigid_motions(const Body& body, const Constraints& constraints) {
  const int count = body.dim == 3 ? 6 : 3;
  Vec3 centre = Vec3::Zero();
  double size = 0;
  for (Index a = 0; a < body.n; ++a) centre += body.position(a) / body.n;
  for (Index a = 0; a < body.n; ++a) size = std::max(size, (body.position(a) - centre).norm());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  for (const PrescribedDof& dof : constraints.dofs()) {
    if (dof.condition < 0) continue;  // a boundary point's free component
    const Vec3 r = (body.position(dof.particle) - centre) / size;
    Eigen::VectorXd motion = Eigen::VectorXd::Zero(count);
    motion[dof.component] = 1;
    if (body.dim == 3) {
      for (int k = 0; k < 3; ++k) motion[3 + k] = Vec3::Unit(k).cross(r)[dof.component];
    } else {
      motion[2] = Vec3::UnitZ().cross(r)[dof.component];
    }
    normal += motion * motion.transpose();
  }
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(normal).eigenvalues();
  return static_cast<int>((values.array() < 1e-12 * std::max(1.0, values.maxCoeff())).count());
}

}  // namespace

/// The free part of the tangent and its factors. The pattern is found once: entry k of the
/// (column by column) matrix comes from value source[k] of the model's (row by row) one.
struct Statics::Factors {
  Eigen::CholmodSupernodalLLT<Sparse> cholesky;
  Eigen::UmfPackLU<Sparse> lu;
  Sparse free_free;
  std::vector<int> source;
  Eigen::Index entries = -1;
  bool cholesky_analysed = false, lu_analysed = false;
  double raise = 0;  ///< of the diagonal, over its mean

  /// An indefinite tangent is no news: the LU factorisation takes it.
  Factors() { cholesky.cholmod().print = 0; }

  void take(const ForceModel::Stiffness& K, const std::vector<Index>& equation, Index free) {
    if (K.nonZeros() != entries) build_pattern(K, equation, free);
    for (std::size_t k = 0; k < source.size(); ++k)
      free_free.valuePtr()[k] = K.valuePtr()[source[k]];
    if (raise == 0) return;
    const double added = raise * free_free.diagonal().sum() / std::max<Index>(free, 1);
    for (Index c = 0; c < free; ++c) free_free.coeffRef(c, c) += added;
  }

 private:
  void build_pattern(const ForceModel::Stiffness& K, const std::vector<Index>& equation,
                     Index free) {
    entries = K.nonZeros();
    cholesky_analysed = lu_analysed = false;
    source.clear();
    std::vector<int> outer{0}, inner;
    const int *begin = K.outerIndexPtr(), *column = K.innerIndexPtr();
    for (int c = 0; c < K.rows(); ++c) {
      if (equation[c] < 0) continue;
      for (int k = begin[c]; k < begin[c + 1];
           ++k) {  // structurally symmetric: row c as column
        const int r = column[k];
        if (equation[r] < 0) continue;
        inner.push_back(equation[r]);
        const int* place = std::lower_bound(column + begin[r], column + begin[r + 1], c);
        source.push_back(static_cast<int>(place - column));
      }
      outer.push_back(static_cast<int>(inner.size()));
    }
    const std::vector<double> zero(inner.size(), 0.0);
    free_free = Eigen::Map<const Sparse>(free, free, static_cast<Eigen::Index>(inner.size()),
                                         outer.data(), inner.data(), zero.data());
  }
};

Statics::Statics(const scene::Problem& problem, ForceModel& model,
                 const Constraints& constraints, const ExternalLoads& loads,
                 const Executor& executor, RigidMotions allowed)
    : m_problem(problem), m_model(model), m_constraints(constraints), m_loads(loads),
      m_executor(executor), m_work(model.body(), constraints, loads),
      m_factors(std::make_unique<Factors>()) {
  const Body& body = model.body();
  const int rigid =
      allowed == RigidMotions::allowed ? 0 : free_rigid_motions(body, constraints);
  if (rigid > 0) {
    throw InputError(
        {problem.file.string(), 0, 0}, "boundary",
        fmt::format("displacement conditions that leave {} rigid motion{} of the body free",
                    rigid, rigid > 1 ? "s" : ""),
        "for a static scene, [[boundary]] entries (fixed, symmetric, antisymmetric or "
        "displacement) that "
        "prevent every translation and rotation");
  }
  m_u.assign(body.X.size(), 0.0);
  m_v = m_f = m_u;
  m_equation.assign(static_cast<std::size_t>(body.n) * body.dim, 0);
  for (const PrescribedDof& dof : constraints.dofs())
    m_equation[dof.particle * body.dim + dof.component] = -1;
  for (Index& e : m_equation) e = e < 0 ? -1 : m_free++;
}

Statics::~Statics() = default;

/// Norm of the unbalanced force on free components; m_scale receives that of the internal
/// forces.
double Statics::evaluate(double t) {
  const Body& body = m_model.body();
  m_model.forces(m_u, m_v, m_f, m_executor);
  double internal = 0, residual = 0;
  for (const double f : m_f) internal += f * f;
  m_loads.add(t, m_f);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < body.dim; ++i) {
      const double f = m_f[static_cast<std::size_t>(a) * body.stride + i];
      if (m_equation[a * body.dim + i] >= 0) residual += f * f;
    }
  }
  m_scale = std::max(m_scale, std::sqrt(internal));
  return std::sqrt(residual);
}

bool Statics::try_displacement(const Column& trial, double t, double& residual) {
  m_u = trial;
  try {
    residual = evaluate(t);
  } catch (const BadState& bad) {
    m_failure =
        fmt::format("{} <= 0 or not a number at particle {}", bad.quantity, bad.particle);
    return false;
  }
  return std::isfinite(residual);
}

/// Factorises the tangent at m_u and solves for the correction of the free components;
/// `correction` holds the prescribed increments on entry when `lift`.
void Statics::solve(const Column& right, Column& correction, bool lift) {
  const Body& body = m_model.body();
  const ForceModel::Stiffness& K = m_model.tangent(m_u);
  Eigen::VectorXd b(m_free), x;
  const auto place = [&](Eigen::Index unknown) {
    return static_cast<std::size_t>(unknown / body.dim) * body.stride + unknown % body.dim;
  };
  for (Eigen::Index r = 0; r < K.rows(); ++r) {
    const Index e = m_equation[r];
    if (e < 0) continue;
    b[e] = right[place(r)];
    if (!lift) continue;
    for (ForceModel::Stiffness::InnerIterator it(K, r); it; ++it) {
      if (m_equation[it.col()] < 0) b[e] -= it.value() * correction[place(it.col())];
    }
  }
  Factors& f = *m_factors;
  f.take(K, m_equation, m_free);
  bool solved = false;
  if (m_model.has_potential()) {
    if (!f.cholesky_analysed) f.cholesky.analyzePattern(f.free_free);
    f.cholesky_analysed = true;
    f.cholesky.factorize(f.free_free);
    solved = f.cholesky.info() == Eigen::Success;
    if (solved) x = f.cholesky.solve(b);
  }
  if (!solved) {
    if (!f.lu_analysed) f.lu.analyzePattern(f.free_free);
    f.lu_analysed = true;
    f.lu.factorize(f.free_free);
    if (f.lu.info() != Eigen::Success) throw BadState{"tangent stiffness (singular)", -1};
    x = f.lu.solve(b);
  }
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < body.dim; ++i) {
      const Index e = m_equation[a * body.dim + i];
      if (e >= 0) correction[static_cast<std::size_t>(a) * body.stride + i] = x[e];
    }
  }
}

bool Statics::step_to(double t, const StaticsOptions& options, StaticsOutcome& outcome) {
  Column correction(m_u.size(), 0.0), trial = m_u;
  m_constraints.impose(t, trial);
  for (std::size_t k = 0; k < trial.size(); ++k) correction[k] = trial[k] - m_u[k];
  double residual = 0, before = 0;
  // Predictor: loads of the new step on the old state.
  if (!try_displacement(Column(m_u), t, before)) return false;
  if (m_free == 0) return try_displacement(trial, t, residual);
  solve(Column(m_f), correction, true);
  for (int it = 1; it <= options.most_iterations; ++it) {
    ++outcome.iterations;
    const Column base = m_u;
    double length = 1;
    bool accepted = false;
    for (int halving = 0; halving < 12 && !accepted; ++halving, length *= 0.5) {
      for (std::size_t k = 0; k < trial.size(); ++k)
        trial[k] = base[k] + length * correction[k];
      if (it == 1) m_constraints.impose(t, trial);
      // The first correction brings the prescribed motion in and may raise the residual.
      accepted = try_displacement(trial, t, residual) &&
                 (it == 1 || residual < before || residual <= options.tolerance * m_scale);
    }
    const bool small = before <= 100 * options.tolerance * m_scale;
    if (!accepted && it > 1 && small) {  // stagnation at round-off
      double again = 0;
      return try_displacement(base, t, again);
    }
    if (!accepted) return false;
    const bool polish = options.tolerance <= StaticsOptions().tolerance;
    if (it > 1 && residual <= options.tolerance * m_scale &&
        (!polish || residual > 0.25 * before))
      return true;
    if (residual == 0) return true;
    before = residual;
    std::fill(correction.begin(), correction.end(), 0.0);
    solve(Column(m_f), correction, false);
    scene::check_interrupt();
  }
  m_failure = fmt::format("residual {:.3g} of {:.3g} after {} iterations", residual, m_scale,
                          options.most_iterations);
  return before <= 100 * options.tolerance * m_scale;
}

const Column& Statics::settle(std::span<const double> guess, const StaticsOptions& options) {
  std::copy(guess.begin(), guess.end(), m_u.begin());
  m_factors->raise = 1e-9;
  StaticsOutcome outcome;
  bool reached = false;
  try {
    reached = step_to(0, options, outcome);
  } catch (const BadState& bad) {
    m_failure = bad.quantity;
  }
  if (reached) return m_u;
  throw SolveError("equilibrium", outcome.iterations, 0, -1,
                   "Newton's method finds no equilibrium to start from: " + m_failure);
}

State Statics::state() const {
  State s;
  s.t = m_t;
  s.u = m_u;
  s.unbalanced = m_f;
  s.external_work = m_work.total(m_u, {});
  return s;
}

void Statics::run(const StaticsOptions& options, Recorder& recorder, StaticsOutcome& outcome) {
  using Clock = std::chrono::steady_clock;
  auto begin = Clock::now();
  const auto pause = [&] {
    outcome.solve_s += std::chrono::duration<double>(Clock::now() - begin).count();
  };
  (void)evaluate(0);
  m_model.commit();
  m_work.start(0, m_u, m_f);
  recorder.row(state());
  double step = 1.0 / options.load_steps;
  const double smallest = step / std::ldexp(1.0, options.most_halvings);
  int next_frame = 1;
  while (m_t < 1 - 1e-12) {
    const double t = std::min(1.0, m_t + step);
    const Column start = m_u;
    const double scale = m_scale;
    bool reached = false;
    try {
      reached = step_to(t > 1 - 1e-12 ? 1.0 : t, options, outcome);
    } catch (const BadState& bad) {
      m_failure = bad.quantity;
    }
    if (!reached) {
      m_u = start;
      m_scale = scale;
      step *= 0.5;
      if (step >= smallest) continue;
      (void)evaluate(m_t);  // forces of the last equilibrium, for the result
      pause();
      throw SolveError(
          "equilibrium", outcome.iterations, m_t, -1,
          fmt::format("Newton's method does not converge beyond load parameter {:.6g}: {}", m_t,
                      m_failure));
    }
    m_model.commit();
    m_t = t > 1 - 1e-12 ? 1.0 : t;
    outcome.t = m_t;
    if (m_work.follows_steps()) m_work.step(m_t, m_u, m_f);
    pause();
    recorder.row(state());
    if (m_t == 1.0 ||
        (options.frames > 0 && m_t >= static_cast<double>(next_frame) / options.frames)) {
      recorder.frame(state());
      next_frame = static_cast<int>(m_t * options.frames) + 1;
    }
    if (options.progress) options.progress(m_t, "load " + std::to_string(m_t));
    begin = Clock::now();
    step = std::min(2 * step, 1.0 / options.load_steps);
  }
}

}  // namespace concord::particle
