#pragma once
// The loops of one force evaluation of the Voronoi method, over a few rows of bonds at a time.
// Each bond is visited once, in the row of its lower-numbered particle a, and adds to both
// ends; what is added to one particle comes in ascending order of its neighbours, whoever works
// on which rows. Ghosts of a particle are finished at the end of its row.

#include "particle/core/contact.hpp"
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

/// What one loop over rows of bonds makes of H^V: with Faces the gradients (VOR.9),
///   V_a H_a = sum_b [ u_ab/2 + (H^V_a + H^V_b)/2 t_ab ] (x) A_ab + walls,
/// else a copy of H^V_a; with Contact the first half of the contact law (29). H holds X in its
/// vectors.
template <int Dim, bool Contact, bool Faces>
CONCORD_INLINE void local_rows(const Bonds& bonds, const Ghosts<Dim>& ghosts, Index first,
                               Index last, const double* inverse_V, const double* u,
                               Window<Dim> mean, Window<Dim> H, GhostVectors<Dim> vectors,
                               ContactBuffer& buffer) {
  const Index *begin = bonds.begin.data(), *other = bonds.other.data();
  const double* shapes = bonds.shape.data();
  const Vec<Dim> half = broadcast(0.5, Vec<Dim>{});
  ContactInput<Dim> input(buffer);
  double* ratio = buffer.K.data();
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
        input.add(X_ab, u_ab, sum);
        *ratio++ = 2 * shape[ratio_at];
      }
    }
    if constexpr (Faces) {
      face_ghosts<Dim>(ghosts, a, u, u_a, mean_a, vectors, H_a);
      for (auto& column : H_a.column) column *= broadcast(inverse_V[a], Vec<Dim>{});
    }
    H_a.store(record);
  }
}

/// What ghosts add to the contact of row a (VOR.14), their law being linear: r_g = K (u_ag -
/// H^V_a X_ag), and 2 r_g (x) X_ag beside the bonds' q (x) X_ab, which sum up -2 Y_a.
template <int Dim> struct GhostContact {
  const Ghosts<Dim>& ghosts;
  Window<Dim> mean;
  GhostVectors<Dim> vectors;
  CONCORD_INLINE void operator()(Index a, Tensor<Dim>& Y_a) const {
    for (Index g = ghosts.begin[a]; g < ghosts.begin[a + 1]; ++g) {
      const GhostRecord<Dim>& ghost = ghosts.record[g];
      if (!ghost.prescribed()) continue;
      const Vec<Dim> affine = Tensor<Dim>::load(mean.at(a)).times(ghost.X);
      const Vec<Dim> r = ghost.K.times(load<Vec<Dim>>(vectors.u(g)) - affine);
      store(vectors.tau(g), r);
      Y_a.add_outer(r + r, ghost.X);
    }
  }
};

/// Gradients of faces and contact of rows [first, last), a group at a time.
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
      contact_scalars(bonds.begin[end] - bonds.begin[a], buffer.K.data(), factors, buffer);
      contact_forces<Dim>(bonds.begin.data(), bonds.other.data(), a, end, Y, buffer,
                          GhostContact<Dim>{ghosts, mean, vectors});
    }
  }
}

}  // namespace concord::particle::voronoi
