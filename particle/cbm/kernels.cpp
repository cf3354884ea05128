#include "particle/cbm/kernels.hpp"

#include "particle/core/window.hpp"

#include <algorithm>
#include <cmath>

namespace concord::particle::cbm {
namespace {

typedef long long v4i __attribute__((vector_size(32)));

CONCORD_CLONES void gradients(const Index* begin, const Index* other, const double* zeta,
                              Index n, const double* X, const double* u, const double* v,
                              double* gradient, double* measures) {
  for (Index a = 0; a < n; ++a) {
    const auto at = static_cast<std::size_t>(a);
    const v2d X_a = load<v2d>(X + 2 * at), u_a = load<v2d>(u + 2 * at),
              v_a = load<v2d>(v + 2 * at);
    v4d H_a = load<v4d>(gradient + 4 * at);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      const auto b = static_cast<std::size_t>(other[k]), bond = static_cast<std::size_t>(k);
      const v2d u_ab = load<v2d>(u + 2 * b) - u_a, v_ab = load<v2d>(v + 2 * b) - v_a,
                x_ab = load<v2d>(X + 2 * b) - X_a + u_ab;
      const v4d z = load<v4d>(zeta + 4 * bond), twice{u_ab[0], u_ab[1], u_ab[0], u_ab[1]};
      H_a += twice * __builtin_shuffle(z, v4i{0, 0, 1, 1});
      store(gradient + 4 * b,
            load<v4d>(gradient + 4 * b) - twice * __builtin_shuffle(z, v4i{2, 2, 3, 3}));
      store(measures + 2 * bond, lane_sums(v_ab * x_ab, x_ab * x_ab));
    }
    store(gradient + 4 * at, H_a);
  }
}

CONCORD_CLONES double pressures_and_excess(std::size_t bonds, double viscosity,
                                           double softening, const double* __restrict limit,
                                           const double* __restrict measures,
                                           double* __restrict pressure) {
  double excess = -1;
#pragma omp simd reduction(max : excess)
  for (std::size_t k = 0; k < bonds; ++k) {
    const double x2 = measures[2 * k + 1];
    pressure[k] = -viscosity * measures[2 * k] / (x2 + softening);
    excess = std::max(excess, x2 - limit[k]);
  }
  return excess;
}

template <StressLaw Law>
CONCORD_CLONES Index stresses(const StressConstants& c, Index first, Index last,
                              const double* inverse_omega, const double* gradient,
                              double* stress, double* force) {
  Index bad_particle = -1;
  for (Index a = first; a < last; a += stress_width) {
    const int count = std::min<Index>(stress_width, last - a);
    double h[4][stress_width], p[4][stress_width], g[4][stress_width], w[stress_width];
    Tensor<2> P[stress_width], G[stress_width];
    for (int l = 0; l < stress_width; ++l) w[l] = inverse_omega[a + std::min(l, count - 1)];
    for (int l = 0; l < stress_width; l += 4) {
      const double* record[4];
      for (int i = 0; i < 4; ++i)
        record[i] = gradient + 4 * static_cast<std::size_t>(a + std::min(l + i, count - 1));
      tensors_to_lanes<2>(record, l, h);
    }
#pragma omp simd
    for (int l = 0; l < stress_width; ++l) {
      h[0][l] *= w[l], h[1][l] *= w[l], h[2][l] *= w[l], h[3][l] *= w[l];
      g[0][l] = 1 + h[3][l], g[1][l] = -h[2][l], g[2][l] = -h[1][l], g[3][l] = 1 + h[0][l];
    }
    const unsigned bad = stress_of_lanes<2, Law>(c, a, count, h, p);
    for (int l = 0; l < stress_width; l += 4) {
      lanes_to_tensors<2>(p, l, P + l);
      lanes_to_tensors<2>(g, l, G + l);
    }
    for (int l = 0; l < count; ++l) {
      const auto i = static_cast<std::size_t>(a + l);
      for (int k = 0; k < 2; ++k) {
        store(stress + 8 * i + 4 * k, P[l].column[k]);
        store(stress + 8 * i + 4 * k + 2, G[l].column[k]);
      }
      store(force + 4 * i, v4d{});
    }
    if (bad != 0 && bad_particle < 0) bad_particle = a + __builtin_ctz(bad);
  }
  return bad_particle;
}

/// x.(P_a + P_b) X_ab and |X_ab|^2 into the measures.
CONCORD_CLONES void stretch_powers(const Index* begin, const Index* other, Index n,
                                   const double* X, const double* u, const double* stress,
                                   double* measures, double* squares) {
  for (Index a = 0; a < n; ++a) {
    const auto at = static_cast<std::size_t>(a);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      const auto b = static_cast<std::size_t>(other[k]), bond = static_cast<std::size_t>(k);
      const v2d X_ab = load<v2d>(X + 2 * b) - load<v2d>(X + 2 * at),
                x_ab = X_ab + load<v2d>(u + 2 * b) - load<v2d>(u + 2 * at);
      const v2d P0 = load<v2d>(stress + 8 * at) + load<v2d>(stress + 8 * b),
                P1 = load<v2d>(stress + 8 * at + 4) + load<v2d>(stress + 8 * b + 4);
      const v2d PX = P0 * lane<0>(X_ab) + P1 * lane<1>(X_ab);
      store(measures + 2 * bond, lane_sums(x_ab * PX, x_ab * x_ab));
      squares[bond] = lane_sum(X_ab * X_ab);
    }
  }
}

CONCORD_CLONES double works_and_excess(std::size_t bonds, const double* __restrict limit,
                                       const double* __restrict squares,
                                       double* __restrict measures) {
  double excess = -1;
#pragma omp simd reduction(max : excess)
  for (std::size_t k = 0; k < bonds; ++k) {
    const double x2 = measures[2 * k + 1], L2 = squares[k], L = std::sqrt(L2),
                 l = std::sqrt(x2);
    const double strain = (x2 - L2) / (L * (l + L));
    const double work = 0.25 * measures[2 * k] / (l * L) * std::max(strain, 0.0);
    measures[2 * k + 1] = work;
    excess = std::max(excess, work - limit[k]);
  }
  return excess;
}

CONCORD_CLONES void pair_forces(const Index* begin, const Index* other, const double* zeta,
                                Index n, const double* pressure, const double* stress,
                                double* force) {
  for (Index a = 0; a < n; ++a) {
    const auto at = static_cast<std::size_t>(a);
    const v4d A0 = load<v4d>(stress + 8 * at), A1 = load<v4d>(stress + 8 * at + 4);
    v4d f_a = load<v4d>(force + 4 * at);
    for (Index k = begin[a], end = begin[a + 1]; k < end; ++k) {
      const auto b = static_cast<std::size_t>(other[k]), bond = static_cast<std::size_t>(k);
      const v4d B0 = load<v4d>(stress + 8 * b), B1 = load<v4d>(stress + 8 * b + 4);
      const v4d z = load<v4d>(zeta + 4 * bond);
      const double viscous = -pressure[bond];
      const v4d t = (A0 * lane<0>(z) + A1 * lane<1>(z) - B0 * lane<2>(z) - B1 * lane<3>(z)) *
                    v4d{1, 1, viscous, viscous};
      f_a += t;
      store(force + 4 * b, load<v4d>(force + 4 * b) - t);
    }
    store(force + 4 * at, f_a);
  }
}

CONCORD_CLONES void split(std::size_t n, const double* __restrict force, double* __restrict f,
                          double* __restrict viscous) {
  for (std::size_t a = 0; a < n; ++a) {
    const v2d part = load<v2d>(force + 4 * a + 2);
    store(f + 2 * a, load<v2d>(force + 4 * a) + part);
    store(viscous + 2 * a, part);
  }
}

}  // namespace

void gradient_rows(const Network& network, Index n, const double* X, const double* u,
                   const double* v, Buffers& buffers) {
  std::fill(buffers.gradient.begin(), buffers.gradient.end(), 0.0);
  gradients(network.begin(), network.other(), network.zeta(), n, X, u, v,
            buffers.gradient.data(), buffers.measures.data());
}

double pressures(std::size_t bonds, double viscosity, double softening, const double* limit,
                 Buffers& buffers) {
  return pressures_and_excess(bonds, viscosity, softening, limit, buffers.measures.data(),
                              buffers.pressure.data());
}

Index stress_rows(const KernelMaterial& material, Index first, Index last,
                  const double* inverse_omega, Buffers& buffers) {
  return with_law(material.law, [&](auto law) {
    return stresses<decltype(law)::value>(material.constants, first, last, inverse_omega,
                                          buffers.gradient.data(), buffers.stress.data(),
                                          buffers.force.data());
  });
}

double bond_works(const Network& network, Index n, const double* X, const double* u,
                  const double* limit, Buffers& buffers) {
  buffers.squares.resize(network.bonds());
  stretch_powers(network.begin(), network.other(), n, X, u, buffers.stress.data(),
                 buffers.measures.data(), buffers.squares.data());
  return works_and_excess(network.bonds(), limit, buffers.squares.data(),
                          buffers.measures.data());
}

void force_rows(const Network& network, Index n, Buffers& buffers) {
  pair_forces(network.begin(), network.other(), network.zeta(), n, buffers.pressure.data(),
              buffers.stress.data(), buffers.force.data());
}

void split_forces(Index n, const Buffers& buffers, double* f, double* viscous) {
  split(static_cast<std::size_t>(n), buffers.force.data(), f, viscous);
}

}  // namespace concord::particle::cbm
