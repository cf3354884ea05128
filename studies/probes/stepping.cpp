#include "studies/probes/stepping.hpp"

#include "scene/geometry.hpp"
#include "studies/probes/states.hpp"

#include <cmath>

namespace concord::probes {
namespace {

/// Motion about u: the free components of w, by central differences.
class Motion {
 public:
  Motion(scene::DiscreteBody& body, std::span<const double> u, double amplitude)
      : m_body(body), m_u(u.begin(), u.end()), m_free(free_components(body)), m_at(m_u),
        m_f0(m_u.size()), m_f(m_u.size()), m_w(m_u.size(), 0.0), m_v(m_u.size(), 0.0) {
    body.force(m_u, m_f0);
    const double size = amplitude * shortest_distance(body.positions());
    for (const int k : m_free)
      m_w[k] = size * (2 * scene::uniform_random(7, static_cast<std::uint64_t>(k), 0) - 1);
  }

  double norm2() const {
    double sum = 0;
    for (const int k : m_free) sum += mass(k) * m_w[k] * m_w[k];
    return sum;
  }

  /// v += kick f/m, w += dt v.
  void step(double kick, double dt) {
    for (const int k : m_free) m_at[k] = m_u[k] + m_w[k];
    m_body.force(m_at, m_f);
    m_bend2 = 0;
    for (const int k : m_free) {
      const double change = kick * (m_f[k] - m_f0[k]) / mass(k);
      m_bend2 += mass(k) * dt * dt * change * change;
      m_v[k] += change;
      m_w[k] += dt * m_v[k];
    }
  }

  /// Squared norm of the last second difference of w in time.
  double bend2() const { return m_bend2; }

 private:
  double mass(int k) const { return m_body.masses()[k / m_body.dim()]; }

  scene::DiscreteBody& m_body;
  std::vector<double> m_u;
  std::vector<int> m_free;
  std::vector<double> m_at, m_f0, m_f, m_w, m_v;
  double m_bend2 = 0;
};

}  // namespace

bool stays_bounded(scene::DiscreteBody& body, std::span<const double> u, double dt,
                   const SteppingOptions& options) {
  Motion motion(body, u, options.amplitude);
  const double limit = motion.norm2() * options.growth * options.growth;
  if (limit == 0) return true;
  for (long n = 0; n < options.steps; ++n) {
    motion.step(n == 0 ? 0.5 * dt : dt, dt);  // at rest at the start
    // Beyond the limit w alternates from step to step (second difference -4 w); what grows by
    // itself (buckling) bends little in a step.
    if (!(motion.norm2() < limit)) return motion.bend2() < motion.norm2();
  }
  return true;
}

double stable_step(scene::DiscreteBody& body, std::span<const double> u, double guess,
                   const SteppingOptions& options) {
  const auto stable = [&](double dt) { return stays_bounded(body, u, dt, options); };
  // A bracket that widens from 2 % about the guess: estimates are mostly that good.
  double low = guess / 1.02, high = guess * 1.02, widen = 1.1;
  if (stable(high)) {
    do {
      low = high;
      if (low > guess * options.widest) return guess * options.widest;
      high *= widen;
      widen *= widen;
    } while (stable(high));
  } else {
    for (; !stable(low); widen *= widen) {
      high = low;
      if (high < guess / options.widest) return guess / options.widest;
      low /= widen;
    }
  }
  while (high > low * (1 + options.tolerance)) {
    const double middle = std::sqrt(low * high);
    (stable(middle) ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace concord::probes
