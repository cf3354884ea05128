// Tangent stiffness of total-Lagrangian SPH: gradient rows, moduli and linearised penalties for
// particle/core's assembly.

#include "particle/core/tangent.hpp"
#include "sph_reference/total_lagrangian/model.hpp"
namespace concord::sph {
namespace {

/// g_ab = c_ab (V_a K_a)^-1 X_ab (TLS.5).
particle::GradientRows gradient_rows(const Body& body, const Neighbours& rows) {
  particle::GradientRows g;
  DirectedRows all = directed_rows(rows);
  g.begin = std::move(all.begin);
  g.neighbour = std::move(all.other);
  g.g.resize(g.neighbour.size());
  for (Index a = 0; a < body.n; ++a) {
    const double* K =
        &rows.inverse_moment[static_cast<std::size_t>(a) * body.dim * body.stride];
    Mat3 inverse = Mat3::Zero();
    for (int j = 0; j < body.dim; ++j) {
      for (int i = 0; i < body.dim; ++i) inverse(i, j) = K[j * body.stride + i];
    }
    for (std::size_t k = g.begin[a]; k < g.begin[a + 1]; ++k) {
      const Vec3 X_ab = body.position(g.neighbour[k]) - body.position(a);
      g.g[k] = rows.weight[all.entry[k]] * (inverse * X_ab);
    }
  }
  return g;
}

/// (TLS.11): p = q = k l, l = x_ab - y_ab.
particle::PairTangent potential_pair(double k) {
  const Mat3 kI = k * Mat3::Identity();
  return {0, 0, Vec3::Zero(), kI, -kI, kI, -kI};
}

/// (TLS.10): p = k (l.n) n, n = x_ab/|x_ab|, q = 0. With N = I - n (x) n: dn = N dx/|x|, so
/// dp = k [n (x) n (dx - dy) + n (x) N l dx/|x| + (l.n) N dx/|x|].
particle::PairTangent ganzenmueller_pair(double k, const Vec3& l, const Vec3& x) {
  const double r = x.norm();
  const Vec3 n = x / r;
  const Mat3 nn = n * n.transpose(), N = Mat3::Identity() - nn;
  const Mat3 turning = (n * (N * l).transpose() + l.dot(n) * N) / r;
  return {0, 0, Vec3::Zero(), k * (nn + turning), -k * nn, Mat3::Zero(), Mat3::Zero()};
}

}  // namespace

const particle::ForceModel::Stiffness& TotalLagrangianSph::tangent(std::span<const double> u) {
  if (m_points.images() > 0) {
    throw InputError({}, "tlsph.planes", "mirror",
                     "truncated where a tangent is asked for: it knows no images");
  }
  const Executor one_thread(1);
  update_gradients(all_blocks(), state(all_blocks(), u, {}, {}, one_thread), one_thread);
  std::vector<particle::Moduli> moduli(m_body.n);
  for (Index a = 0; a < m_body.n; ++a) {
    moduli[a] = m_constitution.tangent(a, plane_gradient(a));
  }

  std::vector<particle::PairTangent> pairs;
  const bool penalised = penalty() != PenaltyForm::none;
  if (penalised) pairs.reserve(m_rows.directed / 2);
  for (Index a = 0; penalised && a < m_body.n; ++a) {
    for (std::size_t i = m_rows.begin[a]; i < m_rows.begin[a + 1]; ++i) {
      const Index b = m_rows.other[i];
      if (b < a) continue;
      const double k = m_rows.stiffness[i];
      const Vec3 X_ab = m_body.position(b) - m_body.position(a), l = local_displacement(a, b);
      const Vec3 x_ab = l + X_ab + 0.5 * (plane_gradient(a) + plane_gradient(b)) * X_ab;
      particle::PairTangent pair = penalty() == PenaltyForm::potential
                                       ? potential_pair(k)
                                       : ganzenmueller_pair(k, l, x_ab);
      pair.a = a, pair.b = b, pair.X_ab = X_ab;
      pairs.push_back(pair);
    }
  }
  if (!m_tangent) m_tangent.emplace(m_body, gradient_rows(m_body, m_rows));
  return m_tangent->assemble(moduli, pairs);
}

}  // namespace concord::sph
