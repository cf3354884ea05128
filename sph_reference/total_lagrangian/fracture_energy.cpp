// What deletion of pairs releases: equation (TLS.22) in README.md of this folder.

#include "sph_reference/total_lagrangian/fracture.hpp"

#include <algorithm>

namespace concord::sph {

/// (TLS.5) of u, and of dt v.
FracturingSph::Motion FracturingSph::motion(Index a, const Step& step) const {
  Mat3 H = Mat3::Zero(), change = Mat3::Zero();
  for (const Index p : m_springs.pairs_at(a)) {
    const Springs::Pair& pair = m_springs.pair(p);
    const double c = m_sph.neighbours().weight[pair.entry[0]];
    if (c == 0) continue;
    const Vec3 X = c * (m_body.position(pair.b) - m_body.position(pair.a));
    H.noalias() += difference(step.u, pair.a, pair.b) * X.transpose();
    change.noalias() += difference(step.v, pair.a, pair.b) * X.transpose();
  }
  const Mat3 inverse = particle::tensor_at(m_sph.neighbours().inverse_moment, m_body.dim, a);
  return {H * inverse, step.dt * change * inverse};
}

/// (TLS.22) of `particles` and of the penalties that depend on their gradients; nothing before
/// the start.
double FracturingSph::held_energy(std::span<const Index> particles, const Step& step) const {
  if (step.u.empty()) return 0;
  std::map<Index, Motion> motions;
  const auto motion_of = [&](Index a) -> const Motion& {
    const auto known = motions.find(a);
    return known != motions.end() ? known->second
                                  : motions.emplace(a, motion(a, step)).first->second;
  };
  double sum = 0;
  for (const Index a : particles) {
    const Motion& m = motion_of(a);
    const Mat3 P = m_constitution.stress(a, m.H);
    sum += m_body.V[a] *
           (m_constitution.energy(a, m.H).stored - 0.5 * P.cwiseProduct(m.change).sum());
    if (m_sph.penalty() == PenaltyForm::none) continue;
    for (const Index p : m_springs.pairs_at(a)) {
      const Springs::Pair& pair = m_springs.pair(p);
      const Index b = pair.other(a);
      if (m_sph.neighbours().stiffness[pair.entry[0]] == 0) continue;
      const bool twice = std::binary_search(particles.begin(), particles.end(), b);
      if (twice && b < a) continue;  // counted from the other end
      sum += held_by_pair(pair, motion_of(pair.a), motion_of(pair.b), step);
    }
  }
  return sum;
}

/// Energy of a pair's penalty less half of what the step changed it by: 1/2 k l.(l - dl)
/// (TLS.11); of (TLS.10), which has none, half the power -k (l.n) n.dx.
double FracturingSph::held_by_pair(const Springs::Pair& pair, const Motion& a, const Motion& b,
                                   const Step& step) const {
  const double k = m_sph.neighbours().stiffness[pair.entry[0]];
  const Vec3 X = m_body.position(pair.b) - m_body.position(pair.a),
             u = difference(step.u, pair.a, pair.b),
             dx = step.dt * difference(step.v, pair.a, pair.b);
  const Vec3 l = u - 0.5 * (a.H + b.H) * X;
  if (m_sph.penalty() == PenaltyForm::potential)
    return 0.5 * k * l.dot(l - dx + 0.5 * (a.change + b.change) * X);
  const Vec3 n = (X + u).normalized();
  return -0.5 * k * l.dot(n) * n.dot(dx);
}

}  // namespace concord::sph
