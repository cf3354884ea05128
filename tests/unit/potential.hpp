#pragma once
// Whether forces are minus the gradient of a model's energy, along one direction.

#include "particle/core/force_model.hpp"

#include <cmath>
#include <random>

namespace concord::particle::test {

/// Uniform random numbers in [-size, size] in every component of every particle.
inline Column random_column(const Body& body, double size, unsigned seed) {
  Column c(body.X.size(), 0.0);
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < body.dim; ++i)
      c[static_cast<std::size_t>(a) * body.stride + i] = uniform(generator);
  }
  return c;
}

struct AlongDirection {
  double slope;  ///< dE/ds of E(u + s w) at s = 0, by a difference of fourth order
  double power;  ///< -f.w
  double scale;  ///< sum of |f_k w_k|
};

/// Energy and forces of `model` at u along w, with steps s and 2 s.
inline AlongDirection along(ForceModel& model, const Column& u, const Column& w, double s) {
  const Executor one_thread(1);
  const Column still(u.size(), 0.0);
  Column f = still;
  model.forces(u, still, f, one_thread);
  AlongDirection result{0, 0, 0};
  for (std::size_t k = 0; k < u.size(); ++k)
    result.power -= f[k] * w[k], result.scale += std::abs(f[k] * w[k]);
  const auto energy = [&](double step) {
    Column moved = u;
    for (std::size_t k = 0; k < u.size(); ++k) moved[k] += step * w[k];
    const Energies e = model.energies(moved, one_thread);
    return e.internal + e.stabilisation;
  };
  result.slope = (8 * (energy(s) - energy(-s)) - (energy(2 * s) - energy(-2 * s))) / (12 * s);
  return result;
}

}  // namespace concord::particle::test
