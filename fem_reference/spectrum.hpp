#pragma once
// The critical time step of central differences for the explicit elements.

#include "fem_reference/internal_force.hpp"

#include "scene/geometry.hpp"

#include <cmath>
#include <vector>

namespace concord::fem {

/// Largest eigenvalue of M^-1 K on the free unknowns by power iteration on the differenced
/// force, (f(u + e x) - f(u)) / e, with e |x| = 1e-6 of the smallest cell: strains of about
/// 1e-6 keep both the truncation (1e-6) and the round-off (1e-10) far below the 1e-3 asked for.
class Spectrum {
 public:
  using Vector = InternalForce::Vector;

  /// `given` tells of an unknown whether it is prescribed; `cell`: size of the smallest cell
  /// [m].
  template <class Given>
  Spectrum(const InternalForce& force, const Vector& mass, const Given& given, double cell)
      : m_force(force), m_mass(mass), m_x(mass.size()), m_free(mass.size(), 1),
        m_probe(1e-6 * cell) {
    for (unsigned i = 0; i < m_x.size(); ++i) {
      if (given(i)) m_free[i] = 0;
      m_x[i] = m_free[i] != 0 ? scene::uniform_random(1, i, 0) - 0.5 : 0.0;
    }
  }

  /// Angular frequency omega_max [1/s] at u with internal force f(u); 0 when nothing is free.
  /// The growth ratio approaches the eigenvalue from below: the safety factor dt_factor covers
  /// it.
  double omega(const Vector& u, const Vector& f, int least, int most) {
    Vector moved(u.size()), y(u.size());
    double lambda = 0;
    for (int k = 0; k < most; ++k) {
      const double size = m_x.linfty_norm();
      if (size == 0) return 0;
      const double e = m_probe / size;
      moved = u;
      moved.add(e, m_x);
      if (m_force.force(moved, y) >= 0) return std::sqrt(m_lambda);
      y -= f;
      double old_norm = 0, new_norm = 0;
      for (unsigned i = 0; i < y.size(); ++i) {
        y[i] = m_free[i] != 0 ? y[i] / (e * m_mass[i]) : 0.0;
        old_norm += m_mass[i] * m_x[i] * m_x[i];
        new_norm += m_mass[i] * y[i] * y[i];
      }
      const double next = std::sqrt(new_norm / old_norm);
      m_x = y;
      if (next > 0) m_x *= 1 / next;
      const bool settled = k + 1 >= least && std::abs(next - lambda) <= 1e-3 * next;
      lambda = next;
      if (settled) break;
    }
    m_lambda = lambda;
    return std::sqrt(lambda);
  }

 private:
  const InternalForce& m_force;
  const Vector& m_mass;
  Vector m_x;
  std::vector<char> m_free;
  double m_probe, m_lambda = 0;
};

/// Iterations of the first estimate of a run.
constexpr int first_least = 20, first_most = 200;

}  // namespace concord::fem
