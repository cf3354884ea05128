#pragma once
// The loops of one force evaluation of the Voronoi method, over a few rows of bonds at a time.
// Each bond is visited once, in the row of its lower-numbered particle a, and adds to both
// ends; what is added to one particle comes in ascending order of its neighbours, whoever works
// on which rows. Ghosts of a particle are finished at the end of its row.

#include "particle/voronoi/stencil.hpp"

namespace concord::particle::voronoi {

/// A linear map by its diagonal.
template <int Dim> struct DiagonalMap {
  static constexpr std::size_t size = Lanes<Dim>::stride;
  static CONCORD_INLINE Vec<Dim> times(const double* map, Vec<Dim> v) {
    return load<Vec<Dim>>(map) * v;
  }
  static CONCORD_INLINE Vec<Dim> transpose_times(const double* map, Vec<Dim> v) {
    return times(map, v);
  }
};

/// A linear map by its columns.
template <int Dim> struct FullMap {
  static constexpr std::size_t size = Dim * Lanes<Dim>::stride;
  static CONCORD_INLINE Vec<Dim> times(const double* map, Vec<Dim> v) {
    return Tensor<Dim>::load(map).times(v);
  }
  static CONCORD_INLINE Vec<Dim> transpose_times(const double* map, Vec<Dim> v) {
    Vec<Dim> r{};
    for (int k = 0; k < Dim; ++k)
      r[k] = lane_sum(load<Vec<Dim>>(map + k * Lanes<Dim>::stride) * v);
    return r;
  }
};

/// Vectors of the ghosts in columns of their own: u_ag, and the dual tau_g of u_ag.
template <int Dim> struct GhostVectors {
  double *displacement, *dual;
  CONCORD_INLINE double* u(Index g) const {
    return displacement + static_cast<std::size_t>(g) * Lanes<Dim>::stride;
  }
  CONCORD_INLINE double* tau(Index g) const {
    return dual + static_cast<std::size_t>(g) * Lanes<Dim>::stride;
  }
};

/// Rows of T that come next in a sweep.
template <int Dim> struct GhostCursor {
  const Ghosts<Dim>& ghosts;
  std::size_t row;
  GhostCursor(const Ghosts<Dim>& all, Index first)
      : ghosts(all), row(static_cast<std::size_t>(
                         std::lower_bound(all.particle.begin(), all.particle.end(), first) -
                         all.particle.begin())) {}
  CONCORD_INLINE bool at(Index a) const { return ghosts.particle[row] == a; }
};

template <int Dim> CONCORD_INLINE Vec<Dim> point_of(const double* column, Index p) {
  return load<Vec<Dim>>(column + static_cast<std::size_t>(p) * Lanes<Dim>::stride);
}

/// Ghosts of [first, last) are opened.
template <int Dim>
CONCORD_INLINE void open_ghosts(const Ghosts<Dim>& ghosts, Index first, Index last,
                                GhostVectors<Dim> vectors) {
  for (Index g = ghosts.begin[first]; g < ghosts.begin[last]; ++g)
    store(vectors.u(g), Vec<Dim>{}), store(vectors.tau(g), Vec<Dim>{});
}

/// V_a H^V_a += sum_g u_ag (x) B_ag (26) with what walls give to u_ag (VOR.6).
template <int Dim, class Map>
CONCORD_INLINE void ghost_gradients(const Ghosts<Dim>& ghosts, Index a, const double* u,
                                    Vec<Dim> u_a, GhostVectors<Dim> vectors, Tensor<Dim>& H_a) {
  for (Index g = ghosts.begin[a]; g < ghosts.begin[a + 1]; ++g) {
    Vec<Dim> u_ag = load<Vec<Dim>>(vectors.u(g));
    for (Index k = ghosts.R_begin[g]; k < ghosts.R_begin[g + 1]; ++k) {
      const Vec<Dim> w = point_of<Dim>(u, ghosts.R_wall[k]) - u_a;
      u_ag += Map::times(&ghosts.R[static_cast<std::size_t>(k) * Map::size], w);
    }
    store(vectors.u(g), u_ag);
    H_a.add_outer(u_ag, ghosts.record[g].B);
  }
}

/// V_a H^V_a = sum_b u_ab (x) B_ab + sum_g u_ag (x) B_ag (6), (26). H holds u in its vectors;
/// the rows' own particles are complete after it and get H^V_a. With v in place of u: its rate.
template <int Dim, class Map>
CONCORD_CLONES void gradient_rows(const Bonds& bonds, const Ghosts<Dim>& ghosts, Index first,
                                  Index last, const double* inverse_V, const double* X,
                                  const double* u, Window<Dim> H, GhostVectors<Dim> vectors) {
  GhostCursor<Dim> cursor(ghosts, first);
  const Index *begin = bonds.begin.data(), *other = bonds.other.data();
  const double* shapes = bonds.shape.data();
  for (Index a = first; a < last; ++a) {
    double* record = H.at(a);
    const Vec<Dim> u_a = load<Vec<Dim>>(record + vector_place<Dim>), X_a = point_of<Dim>(X, a);
    Tensor<Dim> H_a = Tensor<Dim>::load(record);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      double* H_b = H.at(other[k]);
      const double* shape = shapes + static_cast<std::size_t>(k) * shape_size;
      const Vec<Dim> twice_t = load<Vec<Dim>>(shape), X_ab = point_of<Dim>(X, other[k]) - X_a;
      const Vec<Dim> u_ab = (load<Vec<Dim>>(H_b + vector_place<Dim>) - u_a) *
                            broadcast(shape[ratio_at], Vec<Dim>{});
      H_a.add_outer(u_ab, X_ab + twice_t);
      scatter_outer<Dim>(H_b, u_ab, X_ab - twice_t);
    }
    if (cursor.at(a)) {
      for (Index k = ghosts.T_begin[cursor.row], end = ghosts.T_begin[cursor.row + 1]; k < end;
           ++k) {
        const Vec<Dim> u_ab = load<Vec<Dim>>(H.at(ghosts.T_other[k]) + vector_place<Dim>) - u_a;
        double* u_g = vectors.u(ghosts.T_ghost[k]);
        store(u_g, load<Vec<Dim>>(u_g) +
                       Map::times(&ghosts.T[static_cast<std::size_t>(k) * Map::size], u_ab));
      }
      ++cursor.row;
    }
    ghost_gradients<Dim, Map>(ghosts, a, u, u_a, vectors, H_a);
    for (auto& column : H_a.column) column *= broadcast(inverse_V[a], Vec<Dim>{});
    H_a.store(record);
  }
}

/// V_a H_a += sum_g z_ag (x) A_ag, z_ag = D (u(C) - u_a) + (I - D) (u_ag/2 + H^V_a t_ag)
/// (VOR.10).
template <int Dim>
CONCORD_INLINE void face_ghosts(const Ghosts<Dim>& ghosts, Index a, const double* u,
                                Vec<Dim> u_a, const Tensor<Dim>& mean,
                                GhostVectors<Dim> vectors, Tensor<Dim>& H_a) {
  for (Index g = ghosts.begin[a]; g < ghosts.begin[a + 1]; ++g) {
    const GhostRecord<Dim>& ghost = ghosts.record[g];
    Vec<Dim> z =
        load<Vec<Dim>>(vectors.u(g)) * broadcast(0.5, Vec<Dim>{}) + mean.times(ghost.t);
    if (ghost.prescribed()) z += ghost.D.times(point_of<Dim>(u, ghost.centroid) - u_a - z);
    H_a.add_outer(z, ghost.A);
  }
}

/// Bonds of a group of rows between the two halves of the contact law.
struct ContactBuffer {
  Column local, x, X;  ///< u_loc, x_ab, X_ab: a vector a bond
  Column products;     ///< u_loc.x_ab and |x_ab|^2
  Column K, share, s;  ///< A/L, then K_t; (K_n - K_t) s; s = u_loc.x_ab / |x_ab|^2

  ContactBuffer(const Bonds& bonds, int dim, bool contact) {
    if (!contact) return;
    Index most = 0;
    const Index n = bonds.particles();
    for (Index a = 0; a < n; ++a)
      most = std::max(most, bonds.begin[std::min(n, a + stress_width)] - bonds.begin[a]);
    const std::size_t size = static_cast<std::size_t>(most) + 8;
    local.assign(size * stride_of(dim), 0.0);
    x = X = local;
    products.assign(2 * size, 1.0);
    K.assign(size, 0.0);
    share = s = K;
  }
};

/// What one loop over rows of bonds makes of H^V: with Faces the gradients (VOR.9),
///   V_a H_a = sum_b [ u_ab/2 + (H^V_a + H^V_b)/2 t_ab ] (x) A_ab + walls,
/// else a copy of H^V_a; with Contact the first half of the contact law, u_loc = u_ab - (H^V_a
/// + H^V_b)/2 X_ab (29) and its products. H holds X in its vectors.
template <int Dim, bool Contact, bool Faces>
CONCORD_INLINE void local_rows(const Bonds& bonds, const Ghosts<Dim>& ghosts, Index first,
                               Index last, const double* inverse_V, const double* u,
                               Window<Dim> mean, Window<Dim> H, GhostVectors<Dim> vectors,
                               ContactBuffer& buffer) {
  constexpr std::size_t S = Lanes<Dim>::stride;
  const Index *begin = bonds.begin.data(), *other = bonds.other.data();
  const double* shapes = bonds.shape.data();
  const Vec<Dim> half = broadcast(0.5, Vec<Dim>{});
  double *local_out = buffer.local.data(), *x_out = buffer.x.data(), *X_out = buffer.X.data(),
         *products = buffer.products.data(), *ratio = buffer.K.data();
  for (Index a = first; a < last; ++a) {
    const double* mean_record = mean.at(a);
    double* record = H.at(a);
    const Tensor<Dim> mean_a = Tensor<Dim>::load(mean_record);
    const Vec<Dim> u_a = load<Vec<Dim>>(mean_record + vector_place<Dim>),
                   X_a = load<Vec<Dim>>(record + vector_place<Dim>);
    Tensor<Dim> H_a = Faces ? Tensor<Dim>::load(record) : mean_a;
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      const double* mean_b = mean.at(other[k]);
      double* H_b = H.records + (mean_b - mean.records);  // rings of one size
      const double* shape = shapes + static_cast<std::size_t>(k) * shape_size;
      const Vec<Dim> X_ab = load<Vec<Dim>>(H_b + vector_place<Dim>) - X_a,
                     u_ab = load<Vec<Dim>>(mean_b + vector_place<Dim>) - u_a;
      Tensor<Dim> sum = Tensor<Dim>::load(mean_b);
      for (int i = 0; i < Dim; ++i) sum.column[i] += mean_a.column[i];
      if constexpr (Faces) {
        const Vec<Dim> s = broadcast(shape[ratio_at], Vec<Dim>{});
        const Vec<Dim> affine = sum.times(shape) * half;
        H_a.add_outer((u_ab + affine) * s, X_ab);
        scatter_outer<Dim>(H_b, (u_ab - affine) * s, X_ab);
      }
      if constexpr (Contact) {
        const Vec<Dim> local = u_ab - sum.times(X_ab) * half, x_ab = X_ab + u_ab;
        store(local_out, local), store(x_out, x_ab), store(X_out, X_ab);
        store(products, lane_sums(local * x_ab, x_ab * x_ab));
        *ratio = 2 * shape[ratio_at];
        local_out += S, x_out += S, X_out += S, products += 2, ++ratio;
      }
    }
    if constexpr (Faces) {
      face_ghosts<Dim>(ghosts, a, u, u_a, mean_a, vectors, H_a);
      for (auto& column : H_a.column) column *= broadcast(inverse_V[a], Vec<Dim>{});
    }
    H_a.store(record);
  }
}

/// K_n = normal A_ab / L_ab, K_t = tangential A_ab / L_ab (50): xi_n E and xi_t G [Pa].
struct ContactFactors {
  double normal, tangential;
};

/// Scalars of the law for `count` bonds, four at a time.
CONCORD_INLINE void contact_scalars(Index count, const ContactFactors& factors,
                                    ContactBuffer& buffer) {
  typedef long long v4i __attribute__((vector_size(32)));
  const v4d tangential = broadcast(factors.tangential, v4d{}),
            difference = broadcast(factors.normal - factors.tangential, v4d{});
  for (Index k = 0; k < count; k += 4) {
    const v4d low = load<v4d>(&buffer.products[2 * k]),
              high = load<v4d>(&buffer.products[2 * k + 4]);
    const v4d s = __builtin_shuffle(low, high, v4i{0, 2, 4, 6}) /
                  __builtin_shuffle(low, high, v4i{1, 3, 5, 7});
    const v4d ratio = load<v4d>(&buffer.K[k]);
    store(&buffer.K[k], tangential * ratio);
    store(&buffer.share[k], difference * ratio * s);
    store(&buffer.s[k], s);
  }
}

/// Second half: with w = u_loc - s x_ab, q = K_t u_loc + (K_n - K_t) s x_ab and p = q + (K_n -
/// K_t) s w, the derivatives of (49). Adds p to f_a and -p to f_b, and q (x) X_ab to the
/// tensors of both: these sum up -2 Y_a, Y_a = dW/dH^V_a (VOR.14). Ghosts, whose law is linear:
/// r_g = K (u_ag - H^V_a X_ag), and 2 r_g (x) X_ag.
template <int Dim>
CONCORD_INLINE void contact_forces(const Bonds& bonds, const Ghosts<Dim>& ghosts, Index first,
                                   Index last, Window<Dim> mean, Window<Dim> Y,
                                   GhostVectors<Dim> vectors, const ContactBuffer& buffer) {
  constexpr std::size_t S = Lanes<Dim>::stride;
  const Index *begin = bonds.begin.data(), *other = bonds.other.data();
  const double *local_in = buffer.local.data(), *x_in = buffer.x.data(), *X = buffer.X.data();
  const double *K = buffer.K.data(), *share = buffer.share.data(), *s = buffer.s.data();
  for (Index a = first; a < last; ++a) {
    double* record = Y.at(a);
    Tensor<Dim> Y_a = Tensor<Dim>::load(record);
    Vec<Dim> f_a = load<Vec<Dim>>(record + vector_place<Dim>);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      double* Y_b = Y.at(other[k]);
      const Vec<Dim> local = load<Vec<Dim>>(local_in), x_ab = load<Vec<Dim>>(x_in),
                     X_ab = load<Vec<Dim>>(X);
      const Vec<Dim> c = broadcast(*share, Vec<Dim>{});
      const Vec<Dim> q = local * broadcast(*K, Vec<Dim>{}) + x_ab * c;
      const Vec<Dim> p = q + (local - x_ab * broadcast(*s, Vec<Dim>{})) * c;
      f_a += p;
      store(Y_b + vector_place<Dim>, load<Vec<Dim>>(Y_b + vector_place<Dim>) - p);
      Y_a.add_outer(q, X_ab);
      scatter_outer<Dim>(Y_b, q, X_ab);
      local_in += S, x_in += S, X += S, ++K, ++share, ++s;
    }
    for (Index g = ghosts.begin[a]; g < ghosts.begin[a + 1]; ++g) {
      const GhostRecord<Dim>& ghost = ghosts.record[g];
      if (!ghost.prescribed()) continue;
      const Vec<Dim> affine = Tensor<Dim>::load(mean.at(a)).times(ghost.X);
      const Vec<Dim> r = ghost.K.times(load<Vec<Dim>>(vectors.u(g)) - affine);
      store(vectors.tau(g), r);
      Y_a.add_outer(r + r, ghost.X);
    }
    Y_a.store(record);
    store(record + vector_place<Dim>, f_a);
  }
}

/// Gradients of faces and contact of rows [first, last), a group at a time: the division and
/// the chains of either half overlap over its bonds.
template <int Dim, bool Contact, bool Faces>
CONCORD_CLONES void face_rows(const Bonds& bonds, const Ghosts<Dim>& ghosts, Index first,
                              Index last, const double* inverse_V, const double* u,
                              const ContactFactors& factors, Window<Dim> mean, Window<Dim> H,
                              Window<Dim> Y, GhostVectors<Dim> vectors, ContactBuffer& buffer) {
  for (Index a = first; a < last; a += stress_width) {
    const Index end = std::min<Index>(a + stress_width, last);
    local_rows<Dim, Contact, Faces>(bonds, ghosts, a, end, inverse_V, u, mean, H, vectors,
                                    buffer);
    if constexpr (Contact) {
      contact_scalars(bonds.begin[end] - bonds.begin[a], factors, buffer);
      contact_forces<Dim>(bonds, ghosts, a, end, mean, Y, vectors, buffer);
    }
  }
}

}  // namespace concord::particle::voronoi
