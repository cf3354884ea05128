#include "studies/probes/stepping.hpp"

#include "scene/geometry.hpp"
#include "studies/probes/states.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace concord::probes {
namespace {

/// Motion about u: the free components of w, by central differences, freed from time to time
/// of what does not alternate.
///
/// Differences in time of a motion obey the same recurrence as the motion itself. The k-th
/// difference multiplies a mode that goes as z^n by (z - 1)^k: by 2^k where it alternates (z
/// near -1), by next to nothing where it grows by itself (buckling: z = e^g, g^k). Going on
/// from 2^-k times the k-th difference therefore keeps the first and loses the second.
class Motion {
 public:
  Motion(scene::DiscreteBody& body, std::span<const double> u, double amplitude)
      : m_body(body), m_u(u.begin(), u.end()), m_free(free_components(body)), m_at(m_u),
        m_f0(m_u.size()), m_f(m_u.size()), m_v(m_u.size(), 0.0),
        m_past(order + 2, std::vector<double>(m_u.size(), 0.0)) {
    body.force(m_u, m_f0);
    const double size = amplitude * shortest_distance(body.positions());
    for (const int k : m_free)
      m_past[0][k] =
          size * (2 * scene::uniform_random(7, static_cast<std::uint64_t>(k), 0) - 1);
    m_start2 = norm2();
  }

  /// Whether anything moves.
  bool any() const { return m_start2 > 0; }

  /// v += kick f/m, w += dt v.
  void step(double kick, double dt) {
    const std::vector<double>& w = m_past[0];
    for (const int k : m_free) m_at[k] = m_u[k] + w[k];
    m_body.force(m_at, m_f);
    for (const int k : m_free) {
      m_v[k] += kick * (m_f[k] - m_f0[k]) / mass(k);
      m_at[k] = w[k] + dt * m_v[k];
    }
    std::rotate(m_past.begin(), m_past.end() - 1, m_past.end());
    for (const int k : m_free) m_past[0][k] = m_at[k];
  }

  /// Goes on from the alternating part of the last `order` + 2 states, at the amplitude of the
  /// start. Returns its growth since the start.
  double keep_alternating(double dt) {
    std::array<double, order + 1> binomial{};  // 2^-order (-1)^j (order over j)
    binomial[0] = std::ldexp(1.0, -order);
    for (int j = 1; j <= order; ++j) binomial[j] = -binomial[j - 1] * (order - j + 1) / j;
    for (const int k : m_free) {
      double now = 0, before = 0;
      for (int j = 0; j <= order; ++j) {
        now += binomial[j] * m_past[j][k];
        before += binomial[j] * m_past[j + 1][k];
      }
      m_past[0][k] = now;
      m_v[k] = (now - before) / dt;
    }
    const double ratio = size();
    m_growth *= ratio;
    if (!(ratio > 0)) return m_growth;
    for (const int k : m_free) {
      m_past[0][k] /= ratio;
      m_v[k] /= ratio;
    }
    return m_growth;
  }

  /// Norm of w over that of the start.
  double size() const { return std::sqrt(norm2() / m_start2); }

  /// Whether the last second difference of w in time is larger than w: 4 w where it alternates.
  bool alternates() const {
    double bend2 = 0;
    for (const int k : m_free) {
      const double bend = m_past[0][k] - 2 * m_past[1][k] + m_past[2][k];
      bend2 += mass(k) * bend * bend;
    }
    return !(bend2 < norm2());
  }

  static constexpr int order = 8;

 private:
  double mass(int k) const { return m_body.masses()[k / m_body.dim()]; }
  double norm2() const {
    double sum = 0;
    for (const int k : m_free) sum += mass(k) * m_past[0][k] * m_past[0][k];
    return sum;
  }

  scene::DiscreteBody& m_body;
  std::vector<double> m_u;
  std::vector<int> m_free;
  std::vector<double> m_at, m_f0, m_f, m_v;
  std::vector<std::vector<double>> m_past;  ///< w now and at the steps before
  double m_start2 = 0, m_growth = 1;
};

}  // namespace

bool stays_bounded(scene::DiscreteBody& body, std::span<const double> u, double dt,
                   const SteppingOptions& options) {
  constexpr long between = 2 * Motion::order;  // steps from one purge to the next
  Motion motion(body, u, options.amplitude);
  if (!motion.any()) return true;
  long since = 0;
  for (long n = 1; n <= options.steps; ++n) {
    motion.step(n == 1 ? 0.5 * dt : dt, dt);  // at rest at the start
    ++since;
    const bool large = !(motion.size() < options.growth);  // soon beyond what is linear
    if (large && since <= Motion::order) return !motion.alternates();
    if (!large && since < between) continue;
    if (!(motion.keep_alternating(dt) < options.growth)) return false;
    since = 0;
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
