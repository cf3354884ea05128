#include "particle/delaunay/fracture.hpp"

#include "particle/core/checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace concord::particle::delaunay {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

ContactFactors contact_factors(const FractureParameters& p, const scene::Material& material) {
  return {p.xi_n * material.E, p.xi_t * material.mu};
}

}  // namespace

/// c_0 = sqrt(E/rho), the speed of a bar: the paper does not say which speed of sound is meant.
FractureModel::FractureModel(const Body& body, const scene::Problem& problem,
                             const FractureParameters& parameters)
    : ForceModel(body, problem),
      m_l(problem.fracture->length > 0 ? problem.fracture->length : body.h),
      m_network(body, contact_factors(parameters, problem.material).any()) {
  const scene::Material& material = problem.material;
  m_law.material = m_constitution.kernel();
  m_law.contact = contact_factors(parameters, material);
  m_law.viscosity = parameters.beta * m_l * std::sqrt(material.E * material.rho0);
  m_law.softening = 0.01 * m_l * m_l;
  m_law.by_energy = problem.fracture->criterion == scene::FractureCriterion::energy;
  m_viscous.assign(body.X.size(), 0.0);
  m_kept_viscous = m_still = m_viscous;
  set_limits(problem);
  cut(*problem.fracture);
  m_sweep = FractureSweep::make(m_body, m_network, m_law);
}

/// eps_crit = sqrt(2 G_f/(E l_c)) (CBM.32), as |x|^2 >= ((1 + eps_crit) |X|)^2; or G_f/l_c.
void FractureModel::set_limits(const scene::Problem& problem) {
  const double density = problem.fracture->energy_release_rate / m_l;
  const double stretch = 1 + std::sqrt(2 * density / problem.material.E);
  for (Index k = 0; k < static_cast<Index>(m_network.bonds()); ++k) {
    const Vec3 X = m_body.position(m_network.ends(k).b) - m_body.position(m_network.ends(k).a);
    m_law.limit.push_back(m_law.by_energy ? density : stretch * stretch * X.squaredNorm());
  }
}

/// Throws InputError for a cut through nothing, unless it tells where a slit of the mesh ends.
void FractureModel::cut(const scene::Fracture& fracture) {
  const auto ends_a_slit = [&](const Vec3& tip) {
    for (Index a = 0; a < m_body.n; ++a) {
      const Vec3 to_tip = tip - m_body.position(a);
      if (m_body.triangulation.on_boundary[a] != 0 && to_tip.head<2>().norm() < m_body.h)
        return true;
    }
    return false;
  };
  for (const scene::PreCrack& crack : fracture.cracks) {
    const std::vector<Index> bonds = m_network.crossing(crack.from, crack.to),
                             simplices = m_network.simplices_of(bonds);
    if (bonds.empty() && !ends_a_slit(crack.to)) {
      throw InputError(fracture.where, "fracture.crack", "a pre-crack that crosses no bond",
                       "a segment through the body, longer than its spacing; or one that ends "
                       "where a slit of the geometry does");
    }
    for (const Index t : simplices) m_record.dead.push_back({before_start, t});
    unlimit(bonds);
    unlimit(m_network.remove(simplices));
  }
}

void FractureModel::unlimit(const std::vector<Index>& bonds) {
  for (const Index k : bonds) m_law.limit[k] = none;
}

void FractureModel::sweep(ParticleRange part, std::span<const double> u,
                          std::span<const double> v, std::span<double> f, Column& viscous,
                          std::vector<Index>* failed) {
  const Index bad = m_sweep->forces(part, u.data(), v.data(), f.data(), viscous.data(), failed);
  if (bad >= 0) throw BadState{"det F", bad};
}

void FractureModel::forces(std::span<const double> u, std::span<const double> v,
                           std::span<double> f, const Executor&) {
  sweep({0, m_body.n}, u, v.empty() ? m_still : v, f, m_viscous, nullptr);
}

/// Where bonds fail, the forces near them are computed once more.
void FractureModel::advance(double t, double dt, std::span<const double> u,
                            std::span<const double> v, std::span<double> f, const Executor&) {
  m_failed.clear();
  sweep({0, m_body.n}, u, v, f, m_kept_viscous, &m_failed);
  if (m_failed.empty()) return;
  for (const ParticleRange& part : influenced(break_bonds(m_failed, {t, dt, u, v})))
    sweep(part, u, v, f, m_kept_viscous, nullptr);
}

/// Ranges of all whose forces change with the particles' gradients or bonds.
std::vector<ParticleRange>
FractureModel::influenced(const std::vector<Index>& particles) const {
  std::vector<ParticleRange> parts;
  for (const Index i : particles) {  // ascending, and so are both ends of their ranges
    const ParticleRange range = m_sweep->influence(i);
    if (!parts.empty() && range.first <= parts.back().last)
      parts.back().last = range.last;
    else
      parts.push_back(range);
  }
  return parts;
}

/// H_i = sum_p c_ip (x) zeta_ip / Omega_i of a column c.
Mat3 FractureModel::gradient(Index particle, std::span<const double> column) const {
  Mat3 sum = Mat3::Zero();
  for (const Index k : m_network.bonds_of(particle)) {
    const Vec3 c = along(k, column), z = m_network.zeta(k, particle);
    sum += (m_network.ends(k).a == particle ? c : Vec3(-c)) * z.transpose();
  }
  return m_network.inverse_omega()[particle] * sum;
}

/// c_ab = c_b - c_a.
Vec3 FractureModel::along(Index bond, std::span<const double> column) const {
  const auto S = static_cast<std::size_t>(m_body.stride), a = m_network.ends(bond).a * S,
             b = m_network.ends(bond).b * S;
  Vec3 difference = Vec3::Zero();
  for (int i = 0; i < m_body.dim; ++i) difference[i] = column[b + i] - column[a + i];
  return difference;
}

/// Law of a bond's contact, at x_ab and u_loc = u_ab - (H_a + H_b) X_ab / 2.
ContactLaw FractureModel::contact(Index bond, std::span<const double> u, const Mat3& H_a,
                                  const Mat3& H_b) const {
  const auto [a, b] = m_network.ends(bond);
  const Vec3 X = m_body.position(b) - m_body.position(a), u_ab = along(bond, u);
  return contact_law(m_law.contact, m_network.rows().area_over_length[bond], X + u_ab,
                     u_ab - 0.5 * (H_a + H_b) * X);
}

/// Omega_i W(F_i) - Omega_i P_i : dF_i / 2 with dF from dx = dt v. What deletion takes from the
/// sum of these over the particles it touches is the energy released: the second term is the
/// work that the half kick after the deletion does with the new forces instead of the old ones,
/// -1/2 sum_j (f_j,new - f_j,old).dx_j.
double FractureModel::held_by_particle(Index particle, const Step& step) const {
  const Mat3 H = gradient(particle, step.u), dF = step.dt * gradient(particle, step.v),
             P = m_constitution.stress(particle, H);
  return m_network.omega()[particle] *
         (m_constitution.energy(particle, H).stored - 0.5 * P.cwiseProduct(dF).sum());
}

/// The same of a bond's contact: U - (p.dx - q.dy)/2.
double FractureModel::held_by_contact(Index bond, const Step& step) const {
  if (!m_network.connected(bond)) return 0;
  const auto [a, b] = m_network.ends(bond);
  const ContactLaw law = contact(bond, step.u, gradient(a, step.u), gradient(b, step.u));
  const Vec3 X = m_body.position(b) - m_body.position(a), dx = step.dt * along(bond, step.v),
             dy = 0.5 * step.dt * (gradient(a, step.v) + gradient(b, step.v)) * X;
  return law.energy - 0.5 * (law.p.dot(dx) - law.q.dot(dy));
}

double FractureModel::held_energy(const std::vector<Index>& particles, const Step& step) const {
  double sum = 0;
  std::vector<Index> bonds;
  for (const Index i : particles) {
    sum += held_by_particle(i, step);
    const std::span<const Index> own = m_network.bonds_of(i);
    bonds.insert(bonds.end(), own.begin(), own.end());
  }
  if (!m_law.contact.any()) return sum;
  std::sort(bonds.begin(), bonds.end());
  bonds.erase(std::unique(bonds.begin(), bonds.end()), bonds.end());
  for (const Index k : bonds) sum += held_by_contact(k, step);
  return sum;
}

/// Section 3.3 of the paper: the bonds go, and with them their simplices; bond vectors and
/// averaging volumes of the simplices' particles, which are returned, are rebuilt.
std::vector<Index> FractureModel::break_bonds(const std::vector<Index>& bonds,
                                              const Step& step) {
  const std::vector<Index> simplices = m_network.simplices_of(bonds);
  std::vector<Index> touched = m_network.vertices_of(simplices);
  m_record.released += held_energy(touched, step);
  for (const Index k : bonds)
    m_record.broken.push_back({step.t, m_network.ends(k).a, m_network.ends(k).b});
  for (const Index t : simplices) m_record.dead.push_back({step.t, t});
  unlimit(bonds);
  unlimit(m_network.remove(simplices));
  m_record.released -= held_energy(touched, step);
  return touched;
}

Energies FractureModel::energies(std::span<const double> u, const Executor&) {
  Energies e;
  std::vector<Mat3> gradients(m_law.contact.any() ? m_body.n : 0);
  m_sweep->gradients(u.data(), [&](Index a, const Mat3& H) {
    e.internal += m_network.omega()[a] * m_constitution.energy(a, H).stored;
    if (!gradients.empty()) gradients[a] = H;
  });
  if (gradients.empty()) return e;
  for (Index k = 0; k < static_cast<Index>(m_network.bonds()); ++k) {
    if (!m_network.connected(k)) continue;
    e.stabilisation +=
        contact(k, u, gradients[m_network.ends(k).a], gradients[m_network.ends(k).b]).energy;
  }
  return e;
}

void FractureModel::gradients(std::span<const double> u, std::span<Mat3> H) {
  m_sweep->gradients(u.data(),
                     [&](Index a, const Mat3& H_a) { H[a] = m_constitution.complete(H_a); });
}

double FractureModel::viscous_damping_ratio(double omega_max) const {
  // As in the method without fracture: damping (viscosity/rho) k^2 against stiffness c_p^2 k^2.
  const LameConstants& lame = m_law.material.constants.lame;
  return 0.5 * m_law.viscosity * omega_max / (lame.lambda + 2 * lame.mu);
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
      const Ends& ends = m_network.ends(k);
      rows.neighbour.push_back(ends.a == a ? ends.b : ends.a);
      rows.g.emplace_back(m_network.inverse_omega()[a] * m_network.zeta(k, a));
    }
    rows.begin.push_back(rows.neighbour.size());
    moduli[a] = m_network.omega()[a] / m_body.V[a] * m_constitution.tangent(a, H[a]);
  }
  std::vector<PairTangent> pairs;
  for (Index k = 0; m_law.contact.any() && k < static_cast<Index>(m_network.bonds()); ++k) {
    if (!m_network.connected(k)) continue;
    const auto [a, b] = m_network.ends(k);
    const ContactLaw law = contact(k, u, H[a], H[b]);
    pairs.push_back(
        {a, b, m_body.position(b) - m_body.position(a), law.p_x, law.p_y, law.q_x, law.q_y});
  }
  m_tangent.emplace(m_body, rows);
  return m_tangent->assemble(moduli, pairs);
}

void FractureModel::intact_share(std::span<double> share) const {
  for (Index a = 0; a < m_body.n; ++a) share[a] = m_network.omega()[a] / m_body.V[a];
}

/// The simplices that are gone say what is left, to the bit; pre-cracks are cut already.
void FractureModel::keep(scene::Checkpoint& state) {
  ForceModel::keep(state);
  particle::keep(m_record, state);
  state.fixed("fracture.viscous", m_kept_viscous);
  if (!state.restores()) return;
  std::vector<Index> gone;
  for (const DeadSimplex& dead : m_record.dead) {
    if (m_network.alive(dead.simplex)) gone.push_back(dead.simplex);
  }
  unlimit(m_network.remove(gone));
}

}  // namespace concord::particle::delaunay
