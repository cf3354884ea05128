#include "particle/voronoi/operators.hpp"

#include "particle/core/sorted.hpp"

#include <algorithm>

namespace concord::particle::voronoi {
namespace {

using Block9 = Rows<9>::Block;

Vec3 vector_of(std::span<const double> u, const Body& body, Index p) {
  Vec3 r = Vec3::Zero();
  for (int i = 0; i < body.dim; ++i) r[i] = u[static_cast<std::size_t>(p) * body.stride + i];
  return r;
}

template <int M>
Eigen::Matrix<double, M, 1> apply(const Rows<M>& rows, std::span<const double> u,
                                  const Body& body) {
  Eigen::Matrix<double, M, 1> s = Eigen::Matrix<double, M, 1>::Zero();
  for (std::size_t k = 0; k < rows.point.size(); ++k)
    s += rows.block[k] * vector_of(u, body, rows.point[k]);
  return s;
}

Mat3 tensor(const Eigen::Matrix<double, 9, 1>& s) {
  Mat3 H;
  for (int i = 0; i < 3; ++i)
    for (int J = 0; J < 3; ++J) H(i, J) = s[3 * i + J];
  return H;
}

/// Row r of a map belongs to component i of a vector: tensors have entries 3 i + J, bonds two
/// vectors, ghosts one.
template <int M> constexpr int component_of(int r) { return M == 9 ? r / 3 : r % 3; }

/// Whether all components act on their own kind alone, as off oblique planes of symmetry.
template <int M> bool is_diagonal(const Rows<M>& rows) {
  for (const auto& block : rows.block)
    for (int r = 0; r < M; ++r)
      for (int i = 0; i < 3; ++i)
        if (i != component_of<M>(r) && block(r, i) != 0) return false;
  return true;
}

/// test^T change of such a map, a third of the work.
template <int M>
Mat3 diagonal_product(const typename Rows<M>::Block& test,
                      const typename Rows<M>::Block& change) {
  Mat3 value = Mat3::Zero();
  for (int r = 0; r < M; ++r) {
    const int i = component_of<M>(r);
    for (int j = 0; j < 3; ++j) value(i, j) += test(r, i) * change(r, j);
  }
  return value;
}

}  // namespace

Operators::Operators(const Stars& stars, const GhostSystems& ghosts, Form form,
                     const ContactFactors& factors)
    : m_stars(stars), m_ghosts(ghosts), m_form(form), m_factors(factors) {
  for (Index a = 0; a < stars.particles(); ++a)
    m_mean.push_back(mean_gradient(stars(a), system(a)));
}

/// H_a of the face-compatible form (VOR.9).
Rows<9> Operators::face_gradient(const Star& star) const {
  Rows<9> rows;
  const Mat3 I = Mat3::Identity();
  for (const Neighbour& ab : star.neighbours) {
    const Vec3 A = ab.A / ab.X.norm() / star.V * ab.X;
    const Block9 block = outer(0.5 * I, A);
    rows.add(ab.b, block);
    rows.add(star.a, -block);
    if (ab.t.isZero(0)) continue;
    for (const Index c : {star.a, ab.b}) {
      const Rows<9>& mean = m_mean[c];
      for (std::size_t k = 0; k < mean.point.size(); ++k)
        rows.add(mean.point[k], outer(0.5 * times(mean.block[k], ab.t), A));
    }
  }
  for (std::size_t g = 0; g < star.ghosts.size(); ++g) {
    const Ghost& ghost = star.ghosts[g];
    const Vec3 A = ghost.A / star.V * ghost.N;
    const Rows<3> face = face_displacement(star, system(star.a), g, m_mean[star.a]);
    for (std::size_t k = 0; k < face.point.size(); ++k)
      rows.add(face.point[k], outer(face.block[k], A));
    rows.add(star.a, outer(-I, A));  // z_ag is counted from x_a
    if (ghost.centroid_point >= 0) rows.add(ghost.centroid_point, outer(ghost.D, A));
  }
  rows.compress();
  return rows;
}

Element<9> Operators::gradient(Index a) const {
  if (m_form == Form::face_compatible) {
    const Rows<9> rows = face_gradient(m_stars(a));
    return {rows, rows};
  }
  return {m_mean[a], paper_test(m_stars(a), system(a), m_form)};
}

Element<6> Operators::bond(Index a, const Neighbour& ab) const {
  const auto rows_of = [&](const Rows<9>& H_a, const Rows<9>& H_b) {
    Rows<6> rows;
    Rows<6>::Block block = Rows<6>::Block::Zero();
    block.topRows<3>().setIdentity();
    rows.add(ab.b, block);
    rows.add(a, -block);
    for (const Rows<9>* H : {&H_a, &H_b}) {
      for (std::size_t k = 0; k < H->point.size(); ++k) {
        block.setZero();
        block.bottomRows<3>() = 0.5 * times(H->block[k], ab.X);
        rows.add(H->point[k], block);
      }
    }
    rows.compress();
    return rows;
  };
  Element<6> element{rows_of(m_mean[a], m_mean[ab.b]), {}};
  const bool inside = !m_stars.at_wall(a) && !m_stars.at_wall(ab.b);
  element.test = m_form == Form::face_compatible || inside
                     ? element.trial
                     : rows_of(mean_gradient_test(m_stars(a), system(a)),
                               mean_gradient_test(m_stars(ab.b), system(ab.b)));
  return element;
}

Element<3> Operators::ghost(Index a, std::size_t g) const {
  const Star star = m_stars(a);
  const Ghost& ghost = star.ghosts[g];
  const auto subtract_affine = [&](Rows<3>& rows, const Rows<9>& H) {
    for (std::size_t k = 0; k < H.point.size(); ++k)
      rows.add(H.point[k], -times(H.block[k], ghost.X));
    rows.compress();
  };
  Element<3> element;
  element.trial = ghost_rows(star, system(a), g);
  subtract_affine(element.trial, m_mean[a]);
  if (m_form == Form::face_compatible) {
    element.test = element.trial;
  } else {  // x_ag depends on x_a by -2 D (47); reactions on the wall
    element.test.add(a, -2 * ghost.D);
    if (ghost.wall_point >= 0) element.test.add(ghost.wall_point, 2 * ghost.D);
    subtract_affine(element.test, mean_gradient_test(star, system(a)));
  }
  return element;
}

ContactLaw Operators::bond_law(const Neighbour& ab, const Vec3& u_ab, const Vec3& h) const {
  return contact_law(m_factors, ab.A / ab.X.norm(), ab.X + u_ab, u_ab - h);
}

Mat3 Operators::ghost_stiffness(const Ghost& ghost) const {
  const double ratio = ghost.A / ghost.length();
  const Mat3 normal = ghost.N * ghost.N.transpose();
  const Mat3 K =
      ratio * (m_factors.normal * normal + m_factors.tangential * (Mat3::Identity() - normal));
  return ghost.D * K * ghost.D;
}

std::vector<Mat3> Operators::gradients(std::span<const double> u) const {
  std::vector<Mat3> H;
  for (Index a = 0; a < m_stars.particles(); ++a)
    H.push_back(tensor(apply(gradient(a).trial, u, body())));
  return H;
}

/// visit(element, dual(s, with derivative)) for all elements.
template <class Visit> void Operators::for_each_element(const Visit& visit) const {
  const auto volume = [&](Index a) { return m_stars(a).V; };
  for (Index a = 0; a < m_stars.particles(); ++a) {
    visit(gradient(a), [&](const Constitution& law, const Eigen::Matrix<double, 9, 1>& s,
                           auto& dual, auto* derivative, Energies& energies) {
      const Mat3 H = law.complete(tensor(s)), P = law.stress(a, H);
      for (int i = 0; i < 3; ++i)
        for (int J = 0; J < 3; ++J) dual[3 * i + J] = volume(a) * P(i, J);
      if (derivative) *derivative = volume(a) * law.tangent(a, H);
      energies.internal += volume(a) * law.energy(a, H).stored;
      energies.plastic += volume(a) * law.energy(a, H).plastic;
    });
    if (!contact()) continue;
    const Star star = m_stars(a);
    for (const Neighbour& ab : star.neighbours) {
      if (ab.b < a) continue;
      visit(bond(a, ab), [&](const Constitution&, const Eigen::Matrix<double, 6, 1>& s,
                             auto& dual, auto* derivative, Energies& energies) {
        const ContactLaw law = bond_law(ab, s.head<3>(), s.tail<3>());
        dual << law.p, -law.q;
        if (derivative) *derivative << law.p_x, law.p_y, -law.q_x, -law.q_y;
        energies.stabilisation += law.energy;
      });
    }
    for (std::size_t g = 0; g < star.ghosts.size(); ++g) {
      if (star.ghosts[g].wall_point < 0) continue;
      visit(ghost(a, g), [&](const Constitution&, const Vec3& s, auto& dual, auto* derivative,
                             Energies& energies) {
        const Mat3 K = ghost_stiffness(star.ghosts[g]);
        dual = K * s;
        if (derivative) *derivative = K;
        energies.stabilisation += 0.5 * s.dot(K * s);
      });
    }
  }
}

Eigen::VectorXd Operators::forces(const Constitution& constitution,
                                  std::span<const double> u) const {
  const int dim = body().dim;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(body().n) * dim);
  Energies ignored;
  for_each_element([&]<int M>(const Element<M>& element, const auto& law) {
    Eigen::Matrix<double, M, 1> dual;
    law(constitution, apply(element.trial, u, body()), dual,
        static_cast<Eigen::Matrix<double, M, M>*>(nullptr), ignored);
    for (std::size_t k = 0; k < element.test.point.size(); ++k) {
      const Vec3 share = element.test.block[k].transpose() * dual;
      f.segment(static_cast<Eigen::Index>(element.test.point[k]) * dim, dim) -= share.head(dim);
    }
  });
  return f;
}

Energies Operators::energies(const Constitution& constitution,
                             std::span<const double> u) const {
  Energies energies;
  for_each_element([&]<int M>(const Element<M>& element, const auto& law) {
    Eigen::Matrix<double, M, 1> dual;
    law(constitution, apply(element.trial, u, body()), dual,
        static_cast<Eigen::Matrix<double, M, M>*>(nullptr), energies);
  });
  return energies;
}

Operators::Matrix Operators::pattern() const {
  const Index n = body().n;
  const int dim = body().dim;
  std::vector<std::vector<Index>> seen(n);
  for (Index p = 0; p < n; ++p) seen[p].push_back(p);
  std::vector<std::size_t> compressed(n, 64);
  for_each_element([&]<int M>(const Element<M>& element, const auto&) {
    std::vector<Index> members = element.trial.point;
    members.insert(members.end(), element.test.point.begin(), element.test.point.end());
    sort_unique(members);
    for (const Index p : members) {
      seen[p].insert(seen[p].end(), members.begin(), members.end());
      if (seen[p].size() < 4 * compressed[p]) continue;
      sort_unique(seen[p]);
      compressed[p] = std::max<std::size_t>(64, seen[p].size());
    }
  });
  std::vector<int> outer{0}, inner;
  for (Index p = 0; p < n; ++p) {
    sort_unique(seen[p]);
    for (int i = 0; i < dim; ++i) {
      for (const Index q : seen[p]) {
        for (int k = 0; k < dim; ++k) inner.push_back(q * dim + k);
      }
      outer.push_back(static_cast<int>(inner.size()));
    }
    std::vector<Index>().swap(seen[p]);
  }
  const std::vector<double> zero(inner.size(), 0.0);
  return Eigen::Map<const Matrix>(n * dim, n * dim, static_cast<Eigen::Index>(inner.size()),
                                  outer.data(), inner.data(), zero.data());
}

void Operators::tangent(const Constitution& constitution, std::span<const double> u,
                        Matrix& K) const {
  const int dim = body().dim;
  std::fill_n(K.valuePtr(), K.nonZeros(), 0.0);
  const int *outer = K.outerIndexPtr(), *inner = K.innerIndexPtr();
  Energies ignored;
  for_each_element([&]<int M>(const Element<M>& element, const auto& law) {
    Eigen::Matrix<double, M, 1> dual;
    Eigen::Matrix<double, M, M> derivative;
    law(constitution, apply(element.trial, u, body()), dual, &derivative, ignored);
    const std::size_t members = element.trial.point.size();
    std::vector<typename Rows<M>::Block> change(members);
    for (std::size_t m = 0; m < members; ++m) change[m] = derivative * element.trial.block[m];
    const bool diagonal = is_diagonal(element.test);
    for (std::size_t k = 0; k < element.test.point.size(); ++k) {
      const int row = element.test.point[k] * dim, length = outer[row + 1] - outer[row];
      const int* first = inner + outer[row];
      const int* at = first;
      const auto& test = element.test.block[k];
      for (std::size_t m = 0; m < members; ++m) {
        at = std::lower_bound(at, first + length, element.trial.point[m] * dim);
        const Mat3 value = diagonal ? diagonal_product<M>(test, change[m])
                                    : Mat3(test.transpose() * change[m]);
        double* to = K.valuePtr() + outer[row] + (at - first);
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) to[i * length + j] += value(i, j);
      }
    }
  });
}

}  // namespace concord::particle::voronoi
