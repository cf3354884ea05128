#include "particle/core/discrete_body.hpp"

#include "particle/core/stable_step.hpp"

#include <Eigen/LU>

#include <cmath>

namespace concord::particle {
namespace {

SolveError solve_error(const BadState& bad) { return {bad.quantity, 0, 0, bad.particle}; }

}  // namespace

ParticleBody::ParticleBody(const ParticleMethod& method, const scene::Problem& problem,
                           const scene::RunRequest& request)
    : m_settings(method.info().name, method.info().parameters, request.settings),
      m_executor(request.threads), 
      m_body(method.make_particles(problem, request, m_settings, m_executor)),
      m_model(method.make_model(m_body, problem, m_settings, m_executor)),
      m_constraints(problem, m_body) {
  for (Index a = 0; a < m_body.bulk; ++a) m_positions.push_back(m_body.position(a));
  m_prescribed.assign(m_body.bulk, 0);
  m_u.assign(m_body.X.size(), 0.0);
  m_f = m_v = m_u;
  for (const PrescribedDof& dof : m_constraints.dofs()) {
    if (dof.particle < m_body.bulk)
      m_prescribed[dof.particle] |= 1U << static_cast<unsigned>(dof.component);
    else
      m_u[static_cast<std::size_t>(dof.particle) * m_body.stride + dof.component] =
          m_constraints.value(dof, 0);
  }
}

const Column& ParticleBody::column(std::span<const double> u) {
  const int dim = m_body.dim, stride = m_body.stride;
  for (Index a = 0; a < m_body.bulk; ++a) {
    for (int i = 0; i < dim; ++i)
      m_u[static_cast<std::size_t>(a) * stride + i] = u[static_cast<std::size_t>(a) * dim + i];
  }
  return m_u;
}

void ParticleBody::force(std::span<const double> u, std::span<double> f) {
  try {
    m_model->forces(column(u), m_v, m_f, m_executor);
  } catch (const BadState& bad) {
    throw solve_error(bad);
  }
  const int dim = m_body.dim, stride = m_body.stride;
  for (Index a = 0; a < m_body.bulk; ++a) {
    for (int i = 0; i < dim; ++i)
      f[static_cast<std::size_t>(a) * dim + i] = m_f[static_cast<std::size_t>(a) * stride + i];
  }
}

double ParticleBody::energy(std::span<const double> u) {
  const Energies e = m_model->energies(column(u), m_executor);
  return e.internal + e.plastic + e.stabilisation;
}

void ParticleBody::pressure(std::span<const double> u, std::span<double> p) {
  std::vector<Mat3> H(m_body.bulk);
  m_model->gradients(column(u), H);
  for (Index a = 0; a < m_body.bulk; ++a) {
    const Mat3 F = Mat3::Identity() + H[a];
    p[a] = -(m_model->constitution().stress(a, H[a]) * F.transpose()).trace() /
           (3 * F.determinant());
  }
}

Eigen::SparseMatrix<double> ParticleBody::stiffness(std::span<const double> u) {
  const Eigen::SparseMatrix<double> K = m_model->tangent(column(u));
  const Eigen::Index unknowns = static_cast<Eigen::Index>(m_body.bulk) * m_body.dim;
  return K.topLeftCorner(unknowns, unknowns);
}

double ParticleBody::critical_step(std::span<const double> u) {
  SpectralRadius spectrum(*m_model, m_constraints, m_executor);
  try {
    const double omega = spectrum.omega_max(column(u));
    const double zeta = m_model->viscous_damping_ratio(omega);
    return 2 / omega * (std::sqrt(1 + zeta * zeta) - zeta);
  } catch (const BadState& bad) {
    throw solve_error(bad);
  }
}

std::unique_ptr<scene::DiscreteBody>
ParticleMethod::discretise(const scene::Problem& problem,
                           const scene::RunRequest& request) const {
  if (!breaks()) scene::refuse_fracture(problem, info().name);
  return std::make_unique<ParticleBody>(*this, problem, request);
}

}  // namespace concord::particle
