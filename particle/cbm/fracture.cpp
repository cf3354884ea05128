#include "particle/cbm/fracture.hpp"

#include <cmath>

namespace concord::particle::cbm {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

}  // namespace

/// c_0 = sqrt(E/rho), the speed of a bar: the paper does not say which speed of sound is meant.
FractureModel::FractureModel(const Body& body, const scene::Problem& problem, double beta)
    : ForceModel(body, problem),
      m_l(problem.fracture->length > 0 ? problem.fracture->length : body.h),
      m_viscosity(beta * m_l * std::sqrt(problem.material.E * problem.material.rho0)),
      m_by_energy(problem.fracture->criterion == scene::FractureCriterion::energy),
      m_network(body), m_buffers(body.n, m_network.bonds()) {
  m_viscous.assign(body.X.size(), 0.0);
  m_kept_viscous = m_viscous;
  set_limits(problem);
  cut(problem.fracture->cracks);
}

/// eps_crit = sqrt(2 G_f/(E l_c)) (32), as |x|^2 >= ((1 + eps_crit) |X|)^2; or G_f/l_c.
void FractureModel::set_limits(const scene::Problem& problem) {
  const double density = problem.fracture->energy_release_rate / m_l;
  const double stretch = 1 + std::sqrt(2 * density / problem.material.E);
  for (Index k = 0; k < static_cast<Index>(m_network.bonds()); ++k) {
    const Vec3 X = m_body.position(m_network.second(k)) - m_body.position(m_network.first(k));
    m_limit.push_back(m_by_energy ? density : stretch * stretch * X.squaredNorm());
  }
}

void FractureModel::cut(const std::vector<scene::PreCrack>& cracks) {
  for (const scene::PreCrack& crack : cracks) {
    const std::vector<Index> bonds = m_network.crossing(crack.from, crack.to),
                             triangles = m_network.triangles_of(bonds);
    for (const Index t : triangles) m_record.dead.push_back({before_start, t});
    unlimit(bonds);
    unlimit(m_network.remove(triangles));
  }
}

void FractureModel::unlimit(const std::vector<Index>& bonds) {
  for (const Index k : bonds) m_limit[k] = none;
}

/// Gradients, viscous pressures and stresses; returns the largest measure - limit of a bond.
double FractureModel::evaluate(std::span<const double> u, std::span<const double> v) {
  const double* X = m_body.X.data();
  gradient_rows(m_network, m_body.n, X, u.data(), v.data(), m_buffers);
  const double excess =
      pressures(m_network.bonds(), m_viscosity, 0.01 * m_l * m_l, m_limit.data(), m_buffers);
  stresses(0, m_body.n);
  if (!m_by_energy) return excess;
  return bond_works(m_network, m_body.n, X, u.data(), m_limit.data(), m_buffers);
}

void FractureModel::stresses(Index first, Index last) {
  const Index bad = stress_rows(m_constitution.kernel(), first, last,
                                m_network.inverse_omega().data(), m_buffers);
  if (bad >= 0) throw BadState{"det F", bad};
}

void FractureModel::pair_forces(std::span<double> f, Column& viscous) {
  force_rows(m_network, m_body.n, m_buffers);
  split_forces(m_body.n, m_buffers, f.data(), viscous.data());
}

void FractureModel::forces(std::span<const double> u, std::span<const double> v,
                           std::span<double> f, const Executor&) {
  (void)evaluate(u, v);
  pair_forces(f, m_viscous);
}

void FractureModel::advance(double t, double dt, std::span<const double> u,
                            std::span<const double> v, std::span<double> f, const Executor&) {
  if (evaluate(u, v) >= 0) break_bonds(failed(), {t, dt, u, v});
  pair_forces(f, m_kept_viscous);
}

std::vector<Index> FractureModel::failed() const {
  std::vector<Index> list;
  for (Index k = 0; k < static_cast<Index>(m_network.bonds()); ++k) {
    if (m_buffers.measures[2 * static_cast<std::size_t>(k) + 1] >= m_limit[k])
      list.push_back(k);
  }
  return list;
}

/// sum_p c_ip (x) zeta_ip of a column c: Omega_i H_i of the displacement.
Mat3 FractureModel::weighted_gradient(Index particle, std::span<const double> column) const {
  Mat3 sum = Mat3::Zero();
  for (const Index k : m_network.bonds_of(particle)) {
    const auto a = static_cast<std::size_t>(m_network.first(k)),
               b = static_cast<std::size_t>(m_network.second(k));
    const double* zeta = m_network.zeta() + 4 * static_cast<std::size_t>(k);
    const bool own = static_cast<Index>(a) == particle;
    const double* z = own ? zeta : zeta + 2;
    for (int i = 0; i < 2; ++i) {
      const double c_ab = column[2 * b + i] - column[2 * a + i], c = own ? c_ab : -c_ab;
      for (int j = 0; j < 2; ++j) sum(i, j) += c * z[j];
    }
  }
  return sum;
}

/// Omega_i W(F_i) - P_i : sum_p dx_ip (x) zeta_ip / 2, dx = dt v. What deletion takes from the
/// sum of these over the particles it touches is the energy released: the second term is the
/// work that the half kick after the deletion does with the new forces instead of the old ones,
/// -1/2 sum_j (f_j,new - f_j,old).dx_j.
double FractureModel::held_energy(Index particle, const Step& step) const {
  const Mat3 H = m_network.inverse_omega()[particle] * weighted_gradient(particle, step.u);
  const Mat3 P = m_constitution.stress(particle, H),
             change = step.dt * weighted_gradient(particle, step.v);
  return m_network.omega()[particle] * m_constitution.energy(particle, H).stored -
         0.5 * P.cwiseProduct(change).sum();
}

/// Section 3.3: the bonds go, and with them their triangles; bond vectors and averaging volumes
/// of the triangles' particles are rebuilt, then their gradients and stresses.
void FractureModel::break_bonds(const std::vector<Index>& bonds, const Step& step) {
  const std::vector<Index> triangles = m_network.triangles_of(bonds),
                           touched = m_network.vertices_of(triangles);
  const auto held = [&] {
    double sum = 0;
    for (const Index i : touched) sum += held_energy(i, step);
    return sum;
  };
  m_record.released += held();
  for (const Index k : bonds)
    m_record.broken.push_back({step.t, m_network.first(k), m_network.second(k)});
  for (const Index t : triangles) m_record.dead.push_back({step.t, t});
  unlimit(bonds);
  unlimit(m_network.remove(triangles));
  m_record.released -= held();
  for (const Index i : touched) {
    const Mat3 H = weighted_gradient(i, step.u);
    for (int j = 0; j < 2; ++j) {
      for (int k = 0; k < 2; ++k)
        m_buffers.gradient[4 * static_cast<std::size_t>(i) + 2 * k + j] = H(j, k);
    }
    stresses(i, i + 1);
  }
}

Energies FractureModel::energies(std::span<const double> u, const Executor&) {
  Energies e;
  for (Index a = 0; a < m_body.n; ++a) {
    const Mat3 H = m_network.inverse_omega()[a] * weighted_gradient(a, u);
    e.internal += m_network.omega()[a] * m_constitution.energy(a, H).stored;
  }
  return e;
}

void FractureModel::gradients(std::span<const double> u, std::span<Mat3> H) {
  for (Index a = 0; a < m_body.n; ++a)
    H[a] = m_constitution.complete(m_network.inverse_omega()[a] * weighted_gradient(a, u));
}

double FractureModel::viscous_damping_ratio(double omega_max) const {
  // As in the Delaunay method: damping (viscosity/rho) k^2 against stiffness c_p^2 k^2.
  const LameConstants& lame = m_constitution.kernel().constants.lame;
  return 0.5 * m_viscosity * omega_max / (lame.lambda + 2 * lame.mu);
}

/// Omega_i in place of V_i: rows zeta_ip/Omega_i, moduli scaled by Omega_i/V_i.
const ForceModel::Stiffness& FractureModel::tangent(std::span<const double> u) {
  GradientRows rows;
  rows.begin.assign(1, 0);
  std::vector<Mat3> H(m_body.n);
  std::vector<Moduli> moduli(m_body.n);
  gradients(u, H);
  for (Index a = 0; a < m_body.n; ++a) {
    for (const Index k : m_network.bonds_of(a)) {
      const double* zeta = m_network.zeta() + 4 * static_cast<std::size_t>(k);
      const bool own = m_network.first(k) == a;
      rows.neighbour.push_back(own ? m_network.second(k) : m_network.first(k));
      rows.g.emplace_back(m_network.inverse_omega()[a] *
                          (own ? Vec3(zeta[0], zeta[1], 0) : Vec3(zeta[2], zeta[3], 0)));
    }
    rows.begin.push_back(rows.neighbour.size());
    moduli[a] = m_network.omega()[a] / m_body.V[a] * m_constitution.tangent(a, H[a]);
  }
  m_tangent.emplace(m_body, rows);
  return m_tangent->assemble(moduli, {});
}

void FractureModel::intact_share(std::span<double> share) const {
  for (Index a = 0; a < m_body.n; ++a) share[a] = m_network.omega()[a] / m_body.V[a];
}

}  // namespace concord::particle::cbm
