#include "particle/delaunay/fracture.hpp"

#include "particle/core/checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace concord::particle::delaunay {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

/// Three fifths of 1/3, the least height of a lattice's tetrahedra over their longest edge
/// (that of a cube's corner): what is left of a lattice is never too flat where it is not
/// deformed.
constexpr double largest_flatness = 0.2;

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
  m_touched.clear();  // the first step is chosen after it
  m_sweep = FractureSweep::make(m_body, m_network, m_law);
}

/// eps_crit = sqrt(2 G_f/(E l_c)) (CBM.32).
void FractureModel::set_limits(const scene::Problem& problem) {
  m_density = problem.fracture->energy_release_rate / m_l;
  m_critical = std::sqrt(2 * m_density / problem.material.E);
  m_flatness = std::min(std::sqrt(2 * m_critical), largest_flatness);
  for (Index k = 0; k < static_cast<Index>(m_network.bonds()); ++k)
    m_law.limit.push_back(limit_of(k));
}

/// |x|^2 >= ((1 + eps_crit) |X|)^2; or G_f/l_c.
double FractureModel::limit_of(Index bond) const {
  const auto [a, b] = m_network.ends(bond);
  const double stretch = 1 + m_critical;
  return m_law.by_energy
             ? m_density
             : stretch * stretch * (m_body.position(b) - m_body.position(a)).squaredNorm();
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
    const std::vector<Index> bonds = m_network.crossing(crack.from, crack.to);
    if (bonds.empty() && !ends_a_slit(crack.to)) {
      throw InputError(fracture.where, "fracture.crack", "a pre-crack that crosses no bond",
                       "a segment through the body, longer than its spacing; or one that ends "
                       "where a slit of the geometry does");
    }
    remove(bonds, going(bonds, {}, m_still), before_start);
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
ContactLaw FractureModel::contact(Index bond, const Vec3& u_ab, const Mat3& H_a,
                                  const Mat3& H_b) const {
  const auto [a, b] = m_network.ends(bond);
  const Vec3 X = m_body.position(b) - m_body.position(a);
  return contact_law(m_law.contact, m_network.rows().area_over_length[bond], X + u_ab,
                     u_ab - 0.5 * (H_a + H_b) * X);
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
        contact(k, along(k, u), gradients[m_network.ends(k).a], gradients[m_network.ends(k).b])
            .energy;
  }
  return e;
}

void FractureModel::gradients(std::span<const double> u, std::span<Mat3> H) {
  m_sweep->gradients(u.data(),
                     [&](Index a, const Mat3& H_a) { H[a] = m_constitution.complete(H_a); });
}

/// Before a rate was found, as in the method without fracture: damping (viscosity/rho) k^2
/// against stiffness c_p^2 k^2. On triangles that is a half to a third of what is true: pairs
/// damp modes of a bond's length, of which averaged gradients see little.
double FractureModel::viscous_damping_ratio(double omega_max) const {
  if (m_damping > 0) return 0.5 * m_damping / omega_max;
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
    const ContactLaw law = contact(k, along(k, u), H[a], H[b]);
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
  particle::keep(m_record, state, m_body);
  state.item("fracture.flat", m_record.flat);
  state.item("fracture.damping", m_damping);
  state.fixed("fracture.viscous", m_kept_viscous);
  if (!state.restores()) return;
  std::vector<Index> gone;
  for (const DeadSimplex& dead : m_record.dead) {
    if (m_network.alive(dead.simplex)) gone.push_back(dead.simplex);
  }
  unlimit(m_network.remove(gone));
  m_removal = {};
  m_touched.clear();
  m_stiffening.reset();
}

}  // namespace concord::particle::delaunay
