#pragma once
// The second half of the loops: stresses, and forces by the adjoints of both gradients.

#include "particle/core/stress_rows.hpp"
#include "particle/voronoi/kernels.hpp"
#include "particle/voronoi/voronoi.hpp"

namespace concord::particle::voronoi {

/// Puts P_a into a window, whose vectors stay.
template <int Dim> struct PutTensor {
  Window<Dim> P;
  CONCORD_INLINE void operator()(Index a, const Tensor<Dim>& P_a) const { P_a.store(P.at(a)); }
};

/// P_a of [first, last) in place of H_a. Returns the first particle with det F <= 0 or NaN, or
/// -1.
template <int Dim, StressLaw Law>
CONCORD_CLONES Index stresses(const StressConstants& c, Index first, Index last,
                              Window<Dim> H) {
  return stress_rows<Dim, Law>(c, first, last, H, PutTensor<Dim>{H});
}

/// Where forces on boundary points go; null in rows that belong to another part.
struct PointForces {
  double* f;
  template <int Dim> CONCORD_INLINE void set(Index p, Vec<Dim> value) const {
    if (f) store(f + static_cast<std::size_t>(p) * Lanes<Dim>::stride, value);
  }
  template <int Dim> CONCORD_INLINE void subtract(Index p, Vec<Dim> value) const {
    if (f) set<Dim>(p, point_of<Dim>(f, p) - value);
  }
};

/// Walls of particle a in the adjoint of (VOR.10): tau = P_a A_ag gives D tau to the particle
/// and -D tau to the boundary point; rho = (I - D) tau goes to Y_a, -2 rho (x) t_ag, and rho/2
/// to the dual of u_ag.
template <int Dim>
CONCORD_INLINE void face_walls(const Ghosts<Dim>& ghosts, Index a, const Tensor<Dim>& P_a,
                               GhostVectors<Dim> vectors, const PointForces& points,
                               Tensor<Dim>& Y_a, Vec<Dim>& f_a) {
  for (Index g = ghosts.begin[a]; g < ghosts.begin[a + 1]; ++g) {
    const GhostRecord<Dim>& ghost = ghosts.record[g];
    Vec<Dim> rho = P_a.times(ghost.A);
    if (ghost.prescribed()) {
      const Vec<Dim> reaction = ghost.D.times(rho);
      f_a += reaction;
      rho -= reaction;
      points.set<Dim>(ghost.wall, Vec<Dim>{});
      points.set<Dim>(ghost.centroid, -reaction);
    }
    Y_a.add_outer(-(rho + rho), ghost.t);
    store(vectors.tau(g), load<Vec<Dim>>(vectors.tau(g)) + rho * broadcast(0.5, Vec<Dim>{}));
  }
}

/// Walls of particle a in the paper's forms: reactions D P A and 2 r_g of contact (46), against
/// them the forces on the boundary points. r_g has then done its duty: T^T r_g = 0.
template <int Dim>
CONCORD_INLINE void paper_walls(const Ghosts<Dim>& ghosts, Index a, const Tensor<Dim>& P_a,
                                GhostVectors<Dim> vectors, const PointForces& points,
                                Vec<Dim>& f_a) {
  for (Index g = ghosts.begin[a]; g < ghosts.begin[a + 1]; ++g) {
    const GhostRecord<Dim>& ghost = ghosts.record[g];
    if (!ghost.prescribed()) continue;
    const Vec<Dim> reaction = ghost.D.times(P_a.times(ghost.A));
    const Vec<Dim> r = load<Vec<Dim>>(vectors.tau(g));
    f_a += reaction + (r + r);
    points.set<Dim>(ghost.wall, Vec<Dim>{});
    points.set<Dim>(ghost.centroid, -reaction);
    points.subtract<Dim>(ghost.wall, r + r);
    store(vectors.tau(g), Vec<Dim>{});
  }
}

/// tau_g += Y_a B_ag / V_a.
template <int Dim>
CONCORD_INLINE void ghost_duals(const Ghosts<Dim>& ghosts, Index a, const Tensor<Dim>& Y_a,
                                GhostVectors<Dim> vectors) {
  for (Index g = ghosts.begin[a]; g < ghosts.begin[a + 1]; ++g) {
    double* tau = vectors.tau(g);
    store(tau, load<Vec<Dim>>(tau) + Y_a.times(ghosts.record[g].B));
  }
}

/// Adjoint of (VOR.9): with A = A_ab/L_ab X_ab, f_a += (P_a + P_b) A/2, and -2 Y_a, -2 Y_b +=
/// (P_b - P_a) A/2 (x) 2 t_ab. The rows' own particles are complete after it: Y_a becomes
/// dW/dH^V_a / V_a. In the paper's forms no bonds: Y_a / V_a + P_a.
template <int Dim, Form form>
CONCORD_CLONES void dual_rows(const Bonds& bonds, const Ghosts<Dim>& ghosts, Index first,
                              Index last, const double* inverse_V, Window<Dim> P, Window<Dim> Y,
                              GhostVectors<Dim> vectors, PointForces points) {
  const Index *begin = bonds.begin.data(), *other = bonds.other.data();
  const double* shapes = bonds.shape.data();
  for (Index a = first; a < last; ++a) {
    double* record = Y.at(a);
    const Tensor<Dim> P_a = Tensor<Dim>::load(P.at(a));
    const Vec<Dim> X_a = load<Vec<Dim>>(P.at(a) + vector_place<Dim>);
    Tensor<Dim> Y_a = Tensor<Dim>::load(record);
    Vec<Dim> f_a = load<Vec<Dim>>(record + vector_place<Dim>);
    if constexpr (form == Form::face_compatible) {
      for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
        const double* P_b = P.at(other[k]);
        double* Y_b = Y.at(other[k]);
        const double* shape = shapes + static_cast<std::size_t>(k) * shape_size;
        const Vec<Dim> half_A = (load<Vec<Dim>>(P_b + vector_place<Dim>) - X_a) *
                                broadcast(shape[ratio_at], Vec<Dim>{});
        const Vec<Dim> from_a = P_a.times(half_A),
                       from_b = Tensor<Dim>::load(P_b).times(half_A);
        const Vec<Dim> flux = from_a + from_b, jump = from_b - from_a;
        f_a += flux;
        store(Y_b + vector_place<Dim>, load<Vec<Dim>>(Y_b + vector_place<Dim>) - flux);
        Y_a.add_outer(jump, shape);
        scatter_outer<Dim>(Y_b, jump, shape);
      }
      face_walls<Dim>(ghosts, a, P_a, vectors, points, Y_a, f_a);
    } else {
      paper_walls<Dim>(ghosts, a, P_a, vectors, points, f_a);
    }
    for (auto& column : Y_a.column) column *= broadcast(-0.5 * inverse_V[a], Vec<Dim>{});
    if constexpr (form == Form::quasi_static)  // (42): ghosts depend on nothing, but in contact
      ghost_duals<Dim>(ghosts, a, Y_a, vectors);
    if constexpr (form != Form::face_compatible) {
      for (int k = 0; k < Dim; ++k) Y_a.column[k] += P_a.column[k];
    }
    if constexpr (form != Form::quasi_static) ghost_duals<Dim>(ghosts, a, Y_a, vectors);
    Y_a.store(record);
    store(record + vector_place<Dim>, f_a);
  }
}

/// Adjoint of (VOR.6): f_a += sum_g T^T tau_g for bonds, R^T tau_g for walls; these only where
/// prescribed places count as the particle's own business, which they do not in the paper.
template <int Dim, class Map>
CONCORD_INLINE void ghost_bonds(const GhostCursor<Dim>& cursor, GhostVectors<Dim> vectors,
                                Window<Dim> Y, Vec<Dim>& f_a) {
  const Ghosts<Dim>& ghosts = cursor.ghosts;
  for (Index k = ghosts.T_begin[cursor.row], end = ghosts.T_begin[cursor.row + 1]; k < end;
       ++k) {
    double* f_b = Y.at(ghosts.T_other[k]) + vector_place<Dim>;
    const Vec<Dim> share =
        Map::transpose_times(&ghosts.T[static_cast<std::size_t>(k) * Map::size],
                             load<Vec<Dim>>(vectors.tau(ghosts.T_ghost[k])));
    f_a += share;
    store(f_b, load<Vec<Dim>>(f_b) - share);
  }
}

template <int Dim, class Map>
CONCORD_INLINE void ghost_walls(const Ghosts<Dim>& ghosts, Index a, GhostVectors<Dim> vectors,
                                const PointForces& points, Vec<Dim>& f_a) {
  for (Index g = ghosts.begin[a]; g < ghosts.begin[a + 1]; ++g) {
    const Vec<Dim> tau = load<Vec<Dim>>(vectors.tau(g));
    for (Index k = ghosts.R_begin[g]; k < ghosts.R_begin[g + 1]; ++k) {
      const Vec<Dim> share =
          Map::transpose_times(&ghosts.R[static_cast<std::size_t>(k) * Map::size], tau);
      f_a += share;
      points.subtract<Dim>(ghosts.R_wall[k], share);
    }
  }
}

/// Adjoint of (6): f_a += sum_b Y_a B_ab - Y_b B_ba + ghosts, Y the tensors that dual_rows
/// left. The rows' own particles are complete after it.
template <int Dim, class Map>
CONCORD_CLONES void force_rows(const Bonds& bonds, const Ghosts<Dim>& ghosts, Index first,
                               Index last, const double* X, Window<Dim> Y,
                               GhostVectors<Dim> vectors, bool walls, PointForces points) {
  GhostCursor<Dim> cursor(ghosts, first);
  const Index *begin = bonds.begin.data(), *other = bonds.other.data();
  const double* shapes = bonds.shape.data();
  for (Index a = first; a < last; ++a) {
    double* record = Y.at(a);
    const Tensor<Dim> Y_a = Tensor<Dim>::load(record);
    const Vec<Dim> X_a = point_of<Dim>(X, a);
    Vec<Dim> f_a = load<Vec<Dim>>(record + vector_place<Dim>);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      double* Y_b = Y.at(other[k]);
      const double* shape = shapes + static_cast<std::size_t>(k) * shape_size;
      const Vec<Dim> twice_t = load<Vec<Dim>>(shape), X_ab = point_of<Dim>(X, other[k]) - X_a;
      const Vec<Dim> force =
          (Y_a.times(X_ab + twice_t) + Tensor<Dim>::load(Y_b).times(X_ab - twice_t)) *
          broadcast(shape[ratio_at], Vec<Dim>{});
      f_a += force;
      store(Y_b + vector_place<Dim>, load<Vec<Dim>>(Y_b + vector_place<Dim>) - force);
    }
    if (cursor.at(a)) {
      ghost_bonds<Dim, Map>(cursor, vectors, Y, f_a);
      ++cursor.row;
    }
    if (walls) ghost_walls<Dim, Map>(ghosts, a, vectors, points, f_a);
    store(record + vector_place<Dim>, f_a);
  }
}

}  // namespace concord::particle::voronoi
