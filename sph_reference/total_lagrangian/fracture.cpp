#include "sph_reference/total_lagrangian/fracture.hpp"

#include "particle/core/checkpoint.hpp"
#include "particle/core/sorted.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace concord::sph {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

/// Ratio of V_a K_a's eigenvalues below which what is left around a particle counts as not
/// spanning the space. Right-angled corners, which must stand, have (pi - 2)/(pi + 2) = .22 in
/// the plane and (pi - 2)/(pi + 4) = .16 in space under any kernel; two neighbours at one
/// distance, seen under an angle of theta, have tan^2(theta/2): .15 is at 42 degrees. Corrected
/// gradients, and with them the highest frequency, grow as the inverse root.
constexpr double least_ratio = 0.15;

/// How many of the springs [begin, end) are at least as long as their limits, squares of
/// lengths.
template <int Dim>
CONCORD_CLONES Index count_long(std::size_t begin, std::size_t end, const Index* first,
                                const Index* second, const double* limit, const double* X,
                                const double* u) {
  constexpr int S = particle::Lanes<Dim>::stride;
  Index count = 0;
  for (std::size_t k = begin; k < end; ++k) {
    const auto a = static_cast<std::size_t>(first[k]) * S,
               b = static_cast<std::size_t>(second[k]) * S;
    double square = 0;
    for (int i = 0; i < Dim; ++i) {
      const double x = (X[b + i] - X[a + i]) + (u[b + i] - u[a + i]);
      square += x * x;
    }
    count += square >= limit[k] ? 1 : 0;
  }
  return count;
}

}  // namespace

/// c_0 = sqrt(E/rho), as in the Continuum Bond Method's model.
FracturingSph::FracturingSph(const Body& body, const scene::Problem& problem,
                             const FractureOptions& options, const Executor& executor)
    : ForceModel(body, problem),
      m_l(problem.fracture->length > 0 ? problem.fracture->length : body.h),
      m_by_energy(problem.fracture->criterion == scene::FractureCriterion::energy),
      m_sph(body, problem, options.sph, executor),
      m_springs(body, m_sph.neighbours(), options.springs),
      m_damping{2 * options.beta * m_l * std::sqrt(problem.material.E * problem.material.rho0),
                0, 0.01 * m_l * m_l},
      m_damping_loop(choose_damping(body.dim)), m_dead(body.triangulation.size(), 0) {
  m_viscous.assign(viscous() ? body.X.size() : 0, 0.0);
  m_kept_viscous = m_viscous;
  for (Index a = 0; a < body.n; ++a) m_whole.push_back(moment(a).trace());
  set_limits(problem);
  break_springs({}, m_springs.hidden_pairs(), {particle::before_start, 0, {}, {}});
  cut(problem.fracture->cracks);
}

/// eps_crit = sqrt(2 G_f/(E l_c)) (32), as |x|^2 >= ((1 + eps_crit) |X|)^2; or G_f/l_c.
void FracturingSph::set_limits(const scene::Problem& problem) {
  const double density = problem.fracture->energy_release_rate / m_l;
  const double stretch = 1 + std::sqrt(2 * density / problem.material.E);
  for (Index k = 0; k < m_springs.count(); ++k) {
    const Vec3 X = m_body.position(m_springs.second(k)) - m_body.position(m_springs.first(k));
    m_limit.push_back(m_by_energy ? density : stretch * stretch * X.squaredNorm());
  }
  if (m_by_energy) m_measure.assign(m_limit.size(), 0.0);
}

/// Springs that cross a pre-crack, and the pairs that do, whatever springs lie on their way.
void FracturingSph::cut(const std::vector<scene::PreCrack>& cracks) {
  for (const scene::PreCrack& crack : cracks) {
    break_springs(m_springs.springs_across(crack.from, crack.to),
                  m_springs.pairs_across(crack.from, crack.to),
                  {particle::before_start, 0, {}, {}});
  }
}

void FracturingSph::add_forces(std::span<const double> u, std::span<const double> v,
                               std::span<double> f, Column& viscous_part,
                               const Executor& executor) {
  m_sph.forces(u, {}, f, executor);
  if (!viscous()) return;
  m_sph.add_up(m_damping_loop, m_damping, v, viscous_part, executor);
  executor.for_pieces(f.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) f[k] += viscous_part[k];
  });
}

void FracturingSph::forces(std::span<const double> u, std::span<const double> v,
                           std::span<double> f, const Executor& executor) {
  add_forces(u, v, f, m_viscous, executor);
}

void FracturingSph::advance(double t, double dt, std::span<const double> u,
                            std::span<const double> v, std::span<double> f,
                            const Executor& executor) {
  const std::vector<Index> springs = failed(u, executor);
  if (!springs.empty()) {
    for (const Index k : springs) {
      if (!m_springs.simplices(k).empty())
        m_record.broken.push_back({t, m_springs.first(k), m_springs.second(k)});
    }
    break_springs(springs, {}, {t, dt, u, v});
  }
  add_forces(u, v, f, m_kept_viscous, executor);
}

/// Springs that meet the criterion at u, ascending.
std::vector<Index> FracturingSph::failed(std::span<const double> u, const Executor& executor) {
  std::vector<Index> list;
  if (m_by_energy) {
    find_works(u);
  } else {
    const auto count = m_body.dim == 3 ? count_long<3> : count_long<2>;
    const double any = executor.sum(m_limit.size(), [&](std::size_t begin, std::size_t end) {
      return count(begin, end, m_springs.firsts().data(), m_springs.seconds().data(),
                   m_limit.data(), m_body.X.data(), u.data());
    });
    if (any == 0) return list;
  }
  for (Index k = 0; k < m_springs.count(); ++k) {
    const Index a = m_springs.first(k), b = m_springs.second(k);
    const double measure =
        m_by_energy
            ? m_measure[k]
            : (m_body.position(b) - m_body.position(a) + difference(u, a, b)).squaredNorm();
    if (m_limit[k] < none && measure >= m_limit[k]) list.push_back(k);
  }
  return list;
}

/// The work of the stress along the spring, n.P N eps/2 with the mean P of its ends, for what
/// is stretched: the energy criterion of the Continuum Bond Method's model.
void FracturingSph::find_works(std::span<const double> u) {
  m_H.resize(m_body.n), m_P.resize(m_body.n);
  m_sph.gradients(u, m_H);
  for (Index a = 0; a < m_body.n; ++a) m_P[a] = m_constitution.stress(a, m_H[a]);
  for (Index k = 0; k < m_springs.count(); ++k) {
    const Index a = m_springs.first(k), b = m_springs.second(k);
    const Vec3 X = m_body.position(b) - m_body.position(a), x = X + difference(u, a, b);
    const double strain = x.norm() / X.norm() - 1;
    const double traction = x.normalized().dot(0.5 * (m_P[a] + m_P[b]) * X.normalized());
    m_measure[k] = strain > 0 ? 0.5 * traction * strain : 0;
  }
}

/// (TLS.18): springs and pairs go, moments of the particles of these pairs are rebuilt; a
/// particle whose moment cannot be inverted loses all it has left, in the next round.
void FracturingSph::break_springs(std::vector<Index> springs, std::vector<Index> pairs,
                                  const Step& step) {
  Neighbours& rows = m_sph.change_neighbours();
  while (!springs.empty() || !pairs.empty()) {
    const std::vector<Index> going = m_springs.break_up(springs, pairs);
    mark_dead(springs, step.t);
    std::vector<Index> touched;
    for (const Index p : going)
      touched.insert(touched.end(), {m_springs.pair(p).a, m_springs.pair(p).b});
    particle::sort_unique(touched);
    m_record.released += held_energy(touched, step);
    for (const Index p : going) {
      for (const std::size_t entry : m_springs.pair(p).entry) {
        rows.weight[entry] = 0;
        if (!rows.stiffness.empty()) rows.stiffness[entry] = 0;
      }
    }
    springs.clear(), pairs.clear();
    for (const Index a : rebuild(touched)) {
      for (const Index k : m_springs.springs_at(a)) {
        if (m_springs.whole(k)) springs.push_back(k);
      }
      for (const Index p : m_springs.pairs_at(a)) {
        if (m_springs.holds(p)) pairs.push_back(p);
      }
    }
    particle::sort_unique(springs), particle::sort_unique(pairs);
    m_record.released -= held_energy(touched, step);
  }
}

/// A simplex is dead when a spring on one of its edges is broken.
void FracturingSph::mark_dead(std::span<const Index> springs, double t) {
  for (const Index k : springs) {
    m_limit[k] = none;
    for (const Index s : m_springs.simplices(k)) {
      if (m_dead[s] == 0) m_record.dead.push_back({t, s});
      m_dead[s] = 1;
    }
  }
}

/// (V_a K_a)^-1 from the pairs that hold; zero where they do not span the space. Returns the
/// particles of which that is so.
std::vector<Index> FracturingSph::rebuild(std::span<const Index> particles) {
  const std::size_t size = static_cast<std::size_t>(m_body.dim) * m_body.stride;
  Neighbours& rows = m_sph.change_neighbours();
  std::vector<Index> lost;
  for (const Index a : particles) {
    double* inverse = &rows.inverse_moment[static_cast<std::size_t>(a) * size];
    if (invert_moment(m_body, moment(a), least_ratio, inverse)) continue;
    std::fill(inverse, inverse + size, 0.0);
    lost.push_back(a);
  }
  return lost;
}

/// V_a K_a (TLS.4), pairs in the order of their numbers.
Mat3 FracturingSph::moment(Index a) const {
  Mat3 K = Mat3::Zero();
  for (const Index p : m_springs.pairs_at(a)) {
    const Springs::Pair& pair = m_springs.pair(p);
    const Vec3 X = m_body.position(pair.b) - m_body.position(pair.a);
    K.noalias() += (m_sph.neighbours().weight[pair.entry[0]] * X) * X.transpose();
  }
  return K;
}

/// c_b - c_a of a column.
Vec3 FracturingSph::difference(std::span<const double> column, Index a, Index b) const {
  Vec3 d = Vec3::Zero();
  const auto stride = static_cast<std::size_t>(m_body.stride);
  for (int i = 0; i < m_body.dim; ++i) d[i] = column[b * stride + i] - column[a * stride + i];
  return d;
}

/// Which springs are whole, in bits of a column; the moments follow from that, with the same
/// bits (rebuild() knows no history).
void FracturingSph::keep(scene::Checkpoint& state) {
  ForceModel::keep(state);
  std::vector<char> whole(m_springs.count());
  for (Index k = 0; k < m_springs.count(); ++k) whole[k] = m_springs.whole(k) ? 1 : 0;
  state.fixed("sph.whole_springs", whole);
  state.fixed("sph.viscous_force", m_kept_viscous);
  if (state.restores()) {
    std::vector<Index> broken;
    for (Index k = 0; k < m_springs.count(); ++k) {
      if (whole[k] == 0 && m_springs.whole(k)) broken.push_back(k);
    }
    break_springs(broken, {}, {particle::before_start, 0, {}, {}});
  }
  particle::keep(m_record, state, m_body);
}

void FracturingSph::intact_share(std::span<double> share) const {
  for (Index a = 0; a < m_body.n; ++a) share[a] = moment(a).trace() / m_whole[a];
}

}  // namespace concord::sph
