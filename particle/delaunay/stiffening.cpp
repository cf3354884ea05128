#include "particle/delaunay/stiffening.hpp"

#include "particle/core/sorted.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>

namespace concord::particle::delaunay {
namespace {

template <class Matrix> double largest_eigenvalue(const Matrix& A) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(A, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// Largest eigenvalue of T^1/2 C T^1/2, T acting on the second index of each pair: that of the
/// stiffness sum_pq zeta_p.C.zeta_q with T = sum_p zeta_p (x) zeta_p / m_p.
template <int Dim> double of_stretching(const Mat3& T, const scene::Tangent& C) {
  using Small = Eigen::Matrix<double, Dim, Dim>;
  using Pairs = Eigen::Matrix<double, Dim * Dim, Dim * Dim>;
  const Eigen::SelfAdjointEigenSolver<Small> of_T(Small(T.topLeftCorner<Dim, Dim>()));
  const Small root = of_T.operatorSqrt();
  Pairs R = Pairs::Zero(), moduli;
  for (int i = 0; i < Dim; ++i) R.template block<Dim, Dim>(Dim * i, Dim * i) = root;
  for (int i = 0; i < Dim * Dim; ++i) {
    for (int j = 0; j < Dim * Dim; ++j)
      moduli(i, j) = C(i / Dim * 3 + i % Dim, j / Dim * 3 + j % Dim);
  }
  return largest_eigenvalue<Pairs>(R * moduli * R);
}

Vec3 value(std::span<const double> column, const Body& body, Index a) {
  Vec3 r = Vec3::Zero();
  for (int i = 0; i < body.dim; ++i)
    r[i] = column[static_cast<std::size_t>(a) * body.stride + i];
  return r;
}

}  // namespace

Stiffening::Stiffening(const Body& body, const Network& network,
                       const Constitution& constitution, const ContactFactors& contact)
    : m_body(body), m_network(network), m_constitution(constitution), m_contact(contact),
      m_weight(body.n, 0.0) {
  const LameConstants& lame = constitution.kernel().constants.lame;
  m_modulus = lame.lambda + 2 * lame.mu;
  for (Index a = 0; a < body.n; ++a) {
    const Element e = element(a);
    for (std::size_t k = 0; k < e.weight.size(); ++k) m_weight[e.sum.points[k]] += e.weight[k];
  }
}

/// max(K_n, K_t) of (60).
double Stiffening::contact_over_length(Index a, Index b) const {
  for (const Index k : m_network.bonds_of(a)) {
    if (m_network.ends(k).a == b || m_network.ends(k).b == b)
      return std::max(m_contact.normal, m_contact.tangential) *
             m_network.rows().area_over_length[k];
  }
  return 0;
}

/// A bond's u_loc is the mean of what its ends' sums leave of u_ab, so U_ab is at most the sum
/// of K/4 |u_ab - H_a X_ab|^2 and the same at b.
Stiffening::Element Stiffening::element(Index particle) const {
  Element e{m_network.stencil(particle), {}, {}};
  const auto n = static_cast<Eigen::Index>(e.sum.points.size());
  for (const Vec3& z : e.sum.zeta)
    e.weight.push_back(m_modulus * z.squaredNorm() / e.sum.omega);
  if (!m_contact.any() || n == 0) return e;
  e.contact = Eigen::MatrixXd::Zero(n, n);
  const Eigen::Index self =
      std::find(e.sum.points.begin(), e.sum.points.end(), particle) - e.sum.points.begin();
  Eigen::VectorXd left(n);  // u_ab - H_a X_ab of unit displacements
  for (Eigen::Index b = 0; b < n; ++b) {
    if (b == self) continue;
    const Vec3 X = m_body.position(e.sum.points[b]) - m_body.position(particle);
    for (Eigen::Index p = 0; p < n; ++p) left[p] = -e.sum.zeta[p].dot(X) / e.sum.omega;
    left[b] += 1, left[self] -= 1;
    e.contact += 0.5 * contact_over_length(particle, e.sum.points[b]) * left * left.transpose();
  }
  for (Eigen::Index p = 0; p < n; ++p) e.weight[p] += e.contact(p, p);
  return e;
}

/// (DEL.11).
double Stiffening::omega_squared(Index particle, const Element& e,
                                 std::span<const double> u) const {
  const auto n = static_cast<Eigen::Index>(e.sum.points.size());
  Mat3 T = Mat3::Zero(), H = Mat3::Zero();
  Eigen::VectorXd root(n);  // 1/sqrt(s_p m_p)
  for (Eigen::Index p = 0; p < n; ++p) {
    const Index point = e.sum.points[p];
    root[p] =
        e.weight[p] > 0 ? std::sqrt(m_weight[point] / (e.weight[p] * m_body.m[point])) : 0.0;
    const Vec3 z = root[p] * e.sum.zeta[p];
    T += z * z.transpose() / e.sum.omega;
    H += (value(u, m_body, point) - value(u, m_body, particle)) * e.sum.zeta[p].transpose() /
         e.sum.omega;
  }
  const scene::Tangent C = m_constitution.tangent(particle, m_constitution.complete(H));
  const double stretching = m_body.dim == 3 ? of_stretching<3>(T, C) : of_stretching<2>(T, C);
  if (e.contact.size() == 0) return stretching;
  return stretching +
         largest_eigenvalue<Eigen::MatrixXd>(root.asDiagonal() * e.contact * root.asDiagonal());
}

FrequencyBound Stiffening::near(const std::vector<Index>& touched, std::span<const double> u) {
  std::vector<Index> points = touched, particles;
  const auto add_points = [&](const std::vector<Index>& of, std::vector<Index>& list) {
    for (const Index a : of) {
      const std::vector<Index> more = m_network.stencil(a).points;
      list.insert(list.end(), more.begin(), more.end());
    }
    sort_unique(list);
  };
  add_points(touched, points);    // whose weights have changed
  add_points(points, particles);  // in whose sums they are
  std::map<Index, Element> elements;
  for (const Index p : points) m_weight[p] = 0;
  for (const Index a : particles) {
    const Element& e = elements.emplace(a, element(a)).first->second;
    for (std::size_t k = 0; k < e.weight.size(); ++k) {
      if (std::binary_search(points.begin(), points.end(), e.sum.points[k]))
        m_weight[e.sum.points[k]] += e.weight[k];
    }
  }
  FrequencyBound bound;
  for (const auto& [a, e] : elements) {
    const double omega = std::sqrt(std::max(0.0, omega_squared(a, e, u)));
    if (omega > bound.omega) bound = {omega, a};
  }
  return bound;
}

}  // namespace concord::particle::delaunay
