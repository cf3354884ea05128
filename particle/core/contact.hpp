#pragma once
// Contact stabilisation between neighbours, the same for every formulation with a gradient a
// particle: of the displacement u_ab what the gradients do not explain,
//   u_loc = u_ab - (H_a + H_b) X_ab / 2,
// is taken by a spring along x_ab and one across it. In two halves for the bonds of a few rows
// at a time, so that divisions and chains of either half overlap over bonds. Equations: (7),
// (57), (58), (60) of the Delaunay paper; (29), (49), (50) of the Voronoi paper.

#include "particle/core/window.hpp"

#include <span>

namespace concord::particle {

/// K_n = normal A_ab / L_ab, K_t = tangential A_ab / L_ab: xi_n E and xi_t G [Pa].
struct ContactFactors {
  double normal, tangential;
  bool any() const { return normal > 0 || tangential > 0; }
};

/// Bonds of a group of rows between the two halves of the law.
struct ContactBuffer {
  Column local, x, X;  ///< u_loc, x_ab, X_ab: a vector a bond
  Column products;     ///< u_loc.x_ab and |x_ab|^2
  Column K, share, s;  ///< K_t, (K_n - K_t) s, s = u_loc.x_ab / |x_ab|^2

  /// Room for `stress_width` rows of bonds [begin[a], begin[a+1]); none without contact.
  ContactBuffer(std::span<const Index> begin, int dim, bool contact) {
    if (!contact) return;
    Index most = 0;
    const auto n = static_cast<Index>(begin.size()) - 1;
    for (Index a = 0; a < n; ++a)
      most = std::max(most, begin[std::min(n, a + stress_width)] - begin[a]);
    const std::size_t size = static_cast<std::size_t>(most) + group;
    local.assign(size * stride_of(dim), 0.0);
    x = X = local;
    products.assign(2 * size, 1.0);
    K.assign(size, 0.0);
    share = s = K;
  }

 private:
  static constexpr std::size_t group = 8;  ///< scalars are made in whole groups of bonds
};

/// First half: takes the bonds of a group of rows one after the other.
template <int Dim> class ContactInput {
 public:
  explicit CONCORD_INLINE ContactInput(ContactBuffer& buffer)
      : m_local(buffer.local.data()), m_x(buffer.x.data()), m_X(buffer.X.data()),
        m_products(buffer.products.data()) {}

  /// u_loc, x_ab = X_ab + u_ab and their products; `sum`: H_a + H_b.
  CONCORD_INLINE void add(Vec<Dim> X_ab, Vec<Dim> u_ab, const Tensor<Dim>& sum) {
    const Vec<Dim> local = u_ab - sum.times(X_ab) * broadcast(0.5, Vec<Dim>{}),
                   x_ab = X_ab + u_ab;
    store(m_local, local), store(m_x, x_ab), store(m_X, X_ab);
    store(m_products, lane_sums(local * x_ab, x_ab * x_ab));
    m_local += S, m_x += S, m_X += S, m_products += 2;
  }

 private:
  static constexpr std::size_t S = Lanes<Dim>::stride;
  double *m_local, *m_x, *m_X, *m_products;
};

/// Scalars of the law for `count` bonds, four at a time; `area_over_length`: A_ab/L_ab, which
/// is read up to a group's end and may be buffer.K itself.
CONCORD_INLINE void contact_scalars(Index count, const double* area_over_length,
                                    const ContactFactors& factors, ContactBuffer& buffer) {
  typedef long long v4i __attribute__((vector_size(32)));
  const v4d tangential = broadcast(factors.tangential, v4d{}),
            difference = broadcast(factors.normal - factors.tangential, v4d{});
  for (Index k = 0; k < count; k += 4) {
    const v4d low = load<v4d>(&buffer.products[2 * k]),
              high = load<v4d>(&buffer.products[2 * k + 4]);
    const v4d s = __builtin_shuffle(low, high, v4i{0, 2, 4, 6}) /
                  __builtin_shuffle(low, high, v4i{1, 3, 5, 7});
    v4d ratio;
    std::memcpy(&ratio, area_over_length + k, sizeof(v4d));
    store(&buffer.K[k], tangential * ratio);
    store(&buffer.share[k], difference * ratio * s);
    store(&buffer.s[k], s);
  }
}

/// Second half for rows [first, last): with w = u_loc - s x_ab, q = K_t u_loc + (K_n - K_t) s
/// x_ab and p = q + (K_n - K_t) s w. Adds p to f_a and -p to f_b, q (x) X_ab to the tensors of
/// both: -2 Q_a, Q_a = -1/2 sum_b q_ab (x) X_ab the adjoint of u_loc's sum over second
/// neighbours. Then close(a, tensor of a) for what else the row has.
template <int Dim, class Close>
CONCORD_INLINE void contact_forces(const Index* begin, const Index* other, Index first,
                                   Index last, Window<Dim> P, const ContactBuffer& buffer,
                                   const Close& close) {
  constexpr std::size_t S = Lanes<Dim>::stride;
  const double *local_in = buffer.local.data(), *x_in = buffer.x.data(), *X = buffer.X.data();
  const double *K = buffer.K.data(), *share = buffer.share.data(), *s = buffer.s.data();
  for (Index a = first; a < last; ++a) {
    double* record = P.at(a);
    Tensor<Dim> Q_a = Tensor<Dim>::load(record);
    Vec<Dim> f_a = load<Vec<Dim>>(record + vector_place<Dim>);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      double* P_b = P.at(other[k]);
      const Vec<Dim> local = load<Vec<Dim>>(local_in), x_ab = load<Vec<Dim>>(x_in);
      const Vec<Dim> c = broadcast(*share, Vec<Dim>{});
      const Vec<Dim> q = local * broadcast(*K, Vec<Dim>{}) + x_ab * c;
      const Vec<Dim> p = q + (local - x_ab * broadcast(*s, Vec<Dim>{})) * c;
      f_a += p;
      store(P_b + vector_place<Dim>, load<Vec<Dim>>(P_b + vector_place<Dim>) - p);
      Q_a.add_outer(q, X);
      scatter_outer<Dim>(P_b, q, X);
      local_in += S, x_in += S, X += S, ++K, ++share, ++s;
    }
    close(a, Q_a);
    Q_a.store(record);
    store(record + vector_place<Dim>, f_a);
  }
}

/// Energy K_t |u_loc|^2 / 2 + (K_n - K_t) (u_loc.x_ab)^2 / (2 |x_ab|^2) of a bond.
template <int Dim>
CONCORD_INLINE double contact_energy(const ContactFactors& factors, double area_over_length,
                                     Vec<Dim> X_ab, Vec<Dim> u_ab, const Tensor<Dim>& sum) {
  const Vec<Dim> x_ab = X_ab + u_ab,
                 local = u_ab - sum.times(X_ab) * broadcast(0.5, Vec<Dim>{});
  const v2d products = lane_sums(local * x_ab, x_ab * x_ab);
  const double normal2 = products[0] * products[0] / products[1];
  const double K_t = factors.tangential * area_over_length,
               K_n = factors.normal * area_over_length;
  return 0.5 * K_t * lane_sum(local * local) + 0.5 * (K_n - K_t) * normal2;
}

/// The law of one bond with its derivatives: p = dU/dx, q = -dU/dy at fixed X, of the place
/// x_ab and of y_ab = (F_a + F_b)/2 X_ab.
struct ContactLaw {
  Vec3 p, q;
  Mat3 p_x, p_y, q_x, q_y;
  double energy;  ///< [J]
};

/// With r = u_loc, c = K_n - K_t, s = r.x/|x|^2, w = r - s x: q = K_t r + c s x, p = q + c s w.
inline ContactLaw contact_law(const ContactFactors& factors, double area_over_length,
                              const Vec3& x, const Vec3& r) {
  const double K_t = factors.tangential * area_over_length,
               c = factors.normal * area_over_length - K_t;
  const double x2 = x.squaredNorm(), s = r.dot(x) / x2;
  const Vec3 w = r - s * x, s_y = -x / x2, s_x = (x + r - 2 * s * x) / x2;
  const Mat3 I = Mat3::Identity();
  ContactLaw law;
  law.q = K_t * r + c * s * x;
  law.p = law.q + c * s * w;
  law.q_y = -K_t * I + c * x * s_y.transpose();
  law.q_x = (K_t + c * s) * I + c * x * s_x.transpose();
  law.p_y = law.q_y + c * (w * s_y.transpose() - s * I - s * x * s_y.transpose());
  law.p_x = law.q_x + c * (w * s_x.transpose() + (s - s * s) * I - s * x * s_x.transpose());
  law.energy = 0.5 * K_t * r.squaredNorm() + 0.5 * c * s * s * x2;
  return law;
}

}  // namespace concord::particle
