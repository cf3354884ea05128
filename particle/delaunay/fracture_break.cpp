// What goes when bonds break, and the energy that goes with it.

#include "particle/delaunay/fracture.hpp"

#include "particle/core/sorted.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace concord::particle::delaunay {
/// Where bonds fail, or a fragment is turned inside out, the forces near them are computed once
/// more. A step that cannot be taken leaves everything as it was before.
void FractureModel::advance(double t, double dt, std::span<const double> u,
                            std::span<const double> v, std::span<double> f, const Executor&) {
  m_removal.simplices.clear();
  m_failed.clear();
  const Step step{t, dt, u, v};
  const Index bad = m_sweep->forces({0, m_body.n}, u.data(), v.data(), f.data(),
                                    m_kept_viscous.data(), &m_failed);
  if (m_failed.empty() && bad < 0) return;
  try {
    const std::vector<Index> inverted = bad < 0 ? std::vector<Index>() : inside_out(bad, step);
    for (const ParticleRange& part : influenced(break_bonds(m_failed, inverted, step)))
      sweep(part, u, v, f, m_kept_viscous, nullptr);
  } catch (const BadState&) {
    take_back();
    std::fill(m_kept_viscous.begin(), m_kept_viscous.end(), 0.0);
    throw;
  }
}

/// Particles with det F <= 0 or not a number; `first` is one. Throws BadState where one of them
/// has all its simplices: only fragments can be crushed.
std::vector<Index> FractureModel::inside_out(Index first, const Step& step) {
  std::vector<Index> list{first};
  m_sweep->gradients(step.u.data(), [&](Index a, const Mat3& H) {
    if (!((Mat3::Identity() + H).determinant() > 0)) list.push_back(a);
  });
  sort_unique(list);
  for (const Index a : list) {
    if (!(step.dt > 0) || m_network.whole(a)) throw BadState{"det F", a};
  }
  return list;
}

/// (DEL.8), before or now.
bool FractureModel::too_flat(Index particle, const Stencil& sum,
                             std::span<const double> u) const {
  const auto S = static_cast<std::size_t>(m_body.stride);
  const std::size_t n = sum.points.size();
  std::vector<Vec3> X(n), x(n);
  Mat3 F = Mat3::Identity();
  for (std::size_t p = 0; p < n; ++p) {
    X[p] = m_body.position(sum.points[p]) - m_body.position(particle);
    x[p] = X[p];
    for (int i = 0; i < m_body.dim; ++i)
      x[p][i] += u[sum.points[p] * S + i] - u[particle * S + i];
    F += (x[p] - X[p]) * sum.zeta[p].transpose() / sum.omega;
  }
  if (!(F.determinant() > 0)) return true;
  const Mat3 now = F.inverse().transpose();
  double largest = 0, largest_now = 0, length = 0, length_now = 0;
  for (std::size_t p = 0; p < n; ++p) {
    largest = std::max(largest, sum.zeta[p].norm());
    largest_now = std::max(largest_now, (now * sum.zeta[p]).norm());
    length = std::max(length, X[p].norm());
    length_now = std::max(length_now, x[p].norm());
  }
  return sum.omega < m_flatness * length * largest ||
         sum.omega < m_flatness * length_now * largest_now;
}

/// Simplices that go, ascending: those of the bonds, those at particles turned inside out, and
/// as long as there are any those of particles for which what is left is too flat.
std::vector<Index> FractureModel::going(const std::vector<Index>& bonds,
                                        const std::vector<Index>& inverted,
                                        std::span<const double> u) const {
  std::vector<Index> list = m_network.simplices_of(bonds), more;
  const auto take = [&](Index a) {
    const std::vector<Index> at = m_network.simplices_at(a);
    more.insert(more.end(), at.begin(), at.end());
  };
  for (const Index a : inverted) take(a);
  std::vector<Index> fresh = list;
  fresh.insert(fresh.end(), more.begin(), more.end());
  while (!fresh.empty()) {
    list.insert(list.end(), more.begin(), more.end());
    sort_unique(list);
    more.clear();
    for (const Index a : m_network.vertices_of(fresh)) {
      const Stencil sum = m_network.stencil(a, list);
      if (sum.omega > 0 && too_flat(a, sum, u)) take(a);
    }
    fresh.clear();
    sort_unique(more);
    std::set_difference(more.begin(), more.end(), list.begin(), list.end(),
                        std::back_inserter(fresh));
  }
  return list;
}

/// Section 3.3 of the paper: the bonds go, and with them their simplices, and (DEL.8); bond
/// vectors and averaging volumes of the simplices' particles, which are returned, are rebuilt.
/// Energies of fragments turned inside out are not defined: the account then takes what all
/// held at the step's begin.
std::vector<Index> FractureModel::break_bonds(const std::vector<Index>& bonds,
                                              const std::vector<Index>& inverted,
                                              const Step& step) {
  const std::vector<Index> simplices = going(bonds, inverted, step.u);
  std::vector<Index> touched = m_network.vertices_of(simplices);
  m_removal = {simplices,         {},           m_record.broken.size(), m_record.dead.size(),
               m_record.released, m_record.flat};
  m_record.released += held_energy(touched, step, inverted.empty() ? At::end : At::begin);
  for (const Index k : bonds)
    m_record.broken.push_back({step.t, m_network.ends(k).a, m_network.ends(k).b});
  remove(bonds, simplices, step.t);
  m_record.released -= held_energy(touched, step, At::end);
  if (!(step.dt > 0)) m_touched.clear();  // the first step is chosen after it
  return touched;
}

/// Bonds, and simplices that go with them.
void FractureModel::remove(const std::vector<Index>& bonds, const std::vector<Index>& simplices,
                           double t) {
  m_record.flat += static_cast<long>(simplices.size() - m_network.simplices_of(bonds).size());
  for (const Index s : simplices) m_record.dead.push_back({t, s});
  m_removal.bonds = m_network.remove(simplices);
  m_removal.bonds.insert(m_removal.bonds.end(), bonds.begin(), bonds.end());
  unlimit(m_removal.bonds);
  const std::vector<Index> touched = m_network.vertices_of(simplices);
  m_touched.insert(m_touched.end(), touched.begin(), touched.end());
}

void FractureModel::take_back() {
  if (m_removal.simplices.empty()) return;
  m_network.restore(m_removal.simplices);
  for (const Index k : m_removal.bonds) m_law.limit[k] = limit_of(k);
  m_record.broken.resize(m_removal.broken);
  m_record.dead.resize(m_removal.dead);
  m_record.released = m_removal.released;
  m_record.flat = m_removal.flat;
  m_removal = {};
  m_touched.clear();
  m_stiffening.reset();
}

/// The bound needs sums over all particles once, and those near the removals later.
FrequencyBound FractureModel::stiffened(std::span<const double> u) {
  if (m_touched.empty()) return {};
  sort_unique(m_touched);
  if (!m_stiffening) m_stiffening.emplace(m_body, m_network, m_constitution, m_law.contact);
  const FrequencyBound bound = m_stiffening->near(m_touched, u);
  m_touched.clear();
  return bound;
}

/// At a step's end Omega_i W(F_i) - Omega_i P_i : dF_i / 2 with dF from dx = dt v. What
/// deletion takes from the sum of these over the particles it touches is the energy released:
/// the second term is the work that the half kick after the deletion does with the new forces
/// instead of the old ones, -1/2 sum_j (f_j,new - f_j,old).dx_j. At its begin, F_i less dF_i,
/// the first half kick has the other sign.
double FractureModel::held_by_particle(Index particle, const Step& step, At at) const {
  const Mat3 dF = step.dt * gradient(particle, step.v);
  Mat3 H = gradient(particle, step.u);
  if (at == At::begin) H -= dF;
  const Mat3 P = m_constitution.stress(particle, H);
  const double half_kick = (at == At::begin ? -0.5 : 0.5) * P.cwiseProduct(dF).sum();
  return m_network.omega()[particle] * (m_constitution.energy(particle, H).stored - half_kick);
}

/// The same of a bond's contact: U - (p.dx - q.dy)/2.
double FractureModel::held_by_contact(Index bond, const Step& step, At at) const {
  if (!m_network.connected(bond)) return 0;
  const auto [a, b] = m_network.ends(bond);
  const Vec3 X = m_body.position(b) - m_body.position(a), dx = step.dt * along(bond, step.v);
  const Mat3 dH_a = step.dt * gradient(a, step.v), dH_b = step.dt * gradient(b, step.v);
  const double back = at == At::begin ? 1 : 0;
  const ContactLaw law =
      contact(bond, along(bond, step.u) - back * dx, gradient(a, step.u) - back * dH_a,
              gradient(b, step.u) - back * dH_b);
  const Vec3 dy = 0.5 * (dH_a + dH_b) * X;
  return law.energy - (0.5 - back) * (law.p.dot(dx) - law.q.dot(dy));
}

double FractureModel::held_energy(const std::vector<Index>& particles, const Step& step,
                                  At at) const {
  double sum = 0;
  std::vector<Index> bonds;
  for (const Index i : particles) {
    sum += held_by_particle(i, step, at);
    const std::span<const Index> own = m_network.bonds_of(i);
    bonds.insert(bonds.end(), own.begin(), own.end());
  }
  if (!m_law.contact.any()) return sum;
  sort_unique(bonds);
  for (const Index k : bonds) sum += held_by_contact(k, step, at);
  return sum;
}

}  // namespace concord::particle::delaunay
