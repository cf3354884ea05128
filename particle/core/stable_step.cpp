#include "particle/core/stable_step.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace concord::particle {
namespace {

double dot(const Column& a, const Column& b, const Executor& executor) {
  return executor.sum(a.size(), [&](std::size_t begin, std::size_t end) {
    double s = 0;
    for (std::size_t k = begin; k < end; ++k) s += a[k] * b[k];
    return s;
  });
}

/// The stable step is that of the elastic response: what flows now may unload in the next step.
class ElasticResponse {
 public:
  explicit ElasticResponse(ForceModel& model) : m_model(model) { m_model.hold_flow(true); }
  ~ElasticResponse() { m_model.hold_flow(false); }
  ElasticResponse(const ElasticResponse&) = delete;
  ElasticResponse& operator=(const ElasticResponse&) = delete;

 private:
  ForceModel& m_model;
};

void scale(Column& a, double factor) {
  for (double& x : a) x *= factor;
}

}  // namespace

SpectralRadius::SpectralRadius(ForceModel& model, const Constraints& constraints,
                               const Executor& executor)
    : m_model(model), m_constraints(constraints), m_executor(executor) {
  const Body& body = model.body();
  m_root.assign(body.n, 1.0);  // any number for boundary points, which do not move
  for (Index a = 0; a < body.bulk; ++a) m_root[a] = std::sqrt(body.m[a]);
}

Column SpectralRadius::start() const {
  const Body& body = m_model.body();
  Column w(body.X.size(), 0.0);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < body.dim; ++i) {
      w[static_cast<std::size_t>(a) * body.stride + i] =
          scene::uniform_random(12345, a, i) - 0.5;
    }
  }
  return w;
}

/// Largest |w|/sqrt(m) of any component.
double SpectralRadius::largest_per_root(const Column& w) const {
  const Body& body = m_model.body();
  const auto stride = static_cast<std::size_t>(body.stride);
  std::vector<double> largest_of(Executor::pieces(m_root.size()), 0.0);
  m_executor.for_pieces(m_root.size(), [&](std::size_t begin, std::size_t end) {
    double& largest = largest_of[begin / Executor::piece];
    for (std::size_t a = begin; a < end; ++a) {
      for (int i = 0; i < body.dim; ++i)
        largest = std::max(largest, std::abs(w[a * stride + i]) / m_root[a]);
    }
  });
  return *std::max_element(largest_of.begin(), largest_of.end());
}

void SpectralRadius::apply_stiffness(std::span<const double> u, const Column& w,
                                     Column& result) {
  const auto stride = static_cast<std::size_t>(m_model.body().stride);
  // Displacements of 1e-6 spacings: error about 1e-8 relative.
  const double epsilon = 1e-6 * m_model.body().h_min / largest_per_root(w);
  for (const double sign : {1.0, -1.0}) {
    m_executor.for_pieces(m_root.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin * stride; k < end * stride; ++k)
        m_shifted[k] = u[k] + sign * epsilon * w[k] / m_root[k / stride];
    });
    m_model.forces(m_shifted, m_velocity, m_force, m_executor);
    m_executor.for_pieces(m_root.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin * stride; k < end * stride; ++k) {
        const double factor = -sign / (2 * epsilon * m_root[k / stride]);
        result[k] = (sign > 0 ? 0.0 : result[k]) + factor * m_force[k];
      }
    });
  }
  m_constraints.clear(result);
}

/// Half of the difference of the forces at velocities w/sqrt(m) and -w/sqrt(m).
void SpectralRadius::apply_damping(std::span<const double> u, const Column& w, Column& result) {
  const auto stride = static_cast<std::size_t>(m_model.body().stride);
  for (const double sign : {1.0, -1.0}) {
    m_executor.for_pieces(m_root.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin * stride; k < end * stride; ++k)
        m_velocity[k] = sign * w[k] / m_root[k / stride];
    });
    m_model.forces(u, m_velocity, m_force, m_executor);
    m_executor.for_pieces(m_root.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin * stride; k < end * stride; ++k)
        result[k] = (sign > 0 ? 0.0 : result[k]) - 0.5 * sign * m_force[k] / m_root[k / stride];
    });
  }
  m_constraints.clear(result);
}

double SpectralRadius::omega_max(std::span<const double> u, double tolerance, int most) {
  const ElasticResponse elastic(m_model);
  const std::size_t size = u.size();
  m_shifted.assign(size, 0.0);
  m_force.assign(size, 0.0);
  m_velocity.assign(m_model.viscous() ? size : 0, 0.0);  // else not read
  const Apply apply = [&](const Column& w, Column& result) { apply_stiffness(u, w, result); };
  return std::sqrt(std::max(0.0, largest_eigenvalue(size, apply, tolerance, most)));
}

/// Power iteration: C is not quite symmetric, and Lanczos' three terms do not forgive that.
double SpectralRadius::damping_max(std::span<const double> u, double tolerance, int most) {
  m_force.assign(u.size(), 0.0);
  m_velocity.assign(u.size(), 0.0);
  Column current = start(), next(u.size(), 0.0);
  m_constraints.clear(current);
  std::vector<double> estimates;
  for (int it = 0; it < most; ++it) {
    const double norm = std::sqrt(dot(current, current, m_executor));
    if (norm == 0) return 0;
    scale(current, 1 / norm);
    apply_damping(u, current, next);
    estimates.push_back(std::sqrt(dot(next, next, m_executor)));
    if (it >= 8 && estimates.back() - estimates[it - 5] < tolerance * estimates.back()) break;
    std::swap(current, next);
  }
  return estimates.back();
}

double SpectralRadius::largest_eigenvalue(std::size_t size, const Apply& apply,
                                          double tolerance, int most) {
  Column previous(size, 0.0), current = start(), next(size, 0.0);
  m_constraints.clear(current);
  const double norm = std::sqrt(dot(current, current, m_executor));
  if (norm == 0) return 0;
  scale(current, 1 / norm);
  std::vector<double> diagonal, off_diagonal, estimates;
  for (int it = 0; it < most; ++it) {
    apply(current, next);
    const double alpha = dot(current, next, m_executor);
    const double beta_before = off_diagonal.empty() ? 0.0 : off_diagonal.back();
    m_executor.for_pieces(size, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        next[k] -= alpha * current[k] + beta_before * previous[k];
    });
    diagonal.push_back(alpha);
    const auto count = static_cast<Eigen::Index>(diagonal.size());
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
    const Eigen::VectorXd d = Eigen::Map<const Eigen::VectorXd>(diagonal.data(), count);
    const Eigen::VectorXd e = Eigen::Map<const Eigen::VectorXd>(off_diagonal.data(), count - 1);
    eigen.computeFromTridiagonal(d, e, Eigen::EigenvaluesOnly);
    estimates.push_back(eigen.eigenvalues().maxCoeff());
    const double beta = std::sqrt(dot(next, next, m_executor));
    const bool exhausted = !(beta > 1e-9 * std::abs(estimates.back()));
    const bool settled =
        it >= 8 && estimates.back() - estimates[it - 5] < tolerance * estimates.back();
    if (exhausted || settled) break;
    off_diagonal.push_back(beta);
    std::swap(previous, current);
    current = next;
    scale(current, 1 / beta);
  }
  return estimates.back();
}

}  // namespace concord::particle
