#include "particle/core/hourglass.hpp"

#include "particle/core/state.hpp"

#include <cmath>

namespace concord::particle {
namespace {

/// Strain below which a motion of unit gradient, or by one spacing, is rigid to round-off: a
/// hundred times the 1e-15 to which differences of displacements sum up.
constexpr double resolved = 1e-13;

}  // namespace

double Roughness::nonaffine_energy_share(double E, double energy) const {
  const double own = nonaffine_energy(E);
  if (!(own > 0)) return 0;
  return own / (own + energy + E * resolved * resolved * motion);
}

double Roughness::checkerboard() const {
  if (!(alternating > 0)) return 0;
  return std::sqrt(alternating / (strain + resolved * resolved * motion));
}

Roughness Hourglass::measure(std::span<const double> u, std::span<const Mat3> H) {
  const Index n = m_body.bulk;
  if (m_edges.begin.empty()) {
    m_edges = make_edges(m_body);
    m_weight.assign(n, 0.0);
    for (Index a = 0; a < n; ++a) {
      for (std::size_t k = m_edges.begin[a]; k < m_edges.begin[a + 1]; ++k) {
        m_weight[a] += m_edges.weight[k];
        m_weight[m_edges.other[k]] += m_edges.weight[k];
      }
    }
  }
  Roughness r;
  m_sum.assign(n, Vec3::Zero());
  for (Index a = 0; a < n; ++a) {
    const Vec3 u_a = column_vector(u, m_body, a), X_a = m_body.position(a);
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = m_edges.begin[a]; k < m_edges.begin[a + 1]; ++k) {
      const Index b = m_edges.other[k];
      const double w = m_edges.weight[k];
      const Vec3 X_ab = m_body.position(b) - X_a;
      const Vec3 l_ab = column_vector(u, m_body, b) - u_a - 0.5 * ((H[a] + H[b]) * X_ab);
      r.local += w * l_ab.squaredNorm();
      sum += w * l_ab;
      m_sum[b] -= w * l_ab;
    }
    m_sum[a] += sum;
    const Mat3 E = 0.5 * (H[a] + H[a].transpose() + H[a].transpose() * H[a]);
    r.strain += m_body.V[a] * E.squaredNorm();
    r.motion += m_body.V[a] * H[a].squaredNorm() + m_weight[a] * u_a.squaredNorm();
  }
  for (Index a = 0; a < n; ++a) {
    if (m_weight[a] > 0) r.alternating += 0.5 * m_sum[a].squaredNorm() / m_weight[a];
  }
  return r;
}

}  // namespace concord::particle
