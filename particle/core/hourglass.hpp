#pragma once
// How much of a displacement field alternates from particle to particle, where the gradients of
// a method do not see it. Definitions and reasons: README.md, "Hourglass numbers".

#include "particle/core/edges.hpp"

#include <span>

namespace concord::particle {

/// Norms of a state over the edges of the triangulation, with l_ab = u_ab - (H_a + H_b) X_ab/2
/// and the weights w_ab of Edges.
struct Roughness {
  double local = 0;  ///< N = sum_ab w_ab |l_ab|^2 [m^3]
  double alternating =
      0;              ///< C = 1/2 sum_a |sum_b w_ab l_ab|^2 / sum_b w_ab [m^3], 0 <= C <= N
  double strain = 0;  ///< S = sum_a V_a |E_a|^2, E = (H + H^T + H^T H)/2 [m^3]
  double motion = 0;  ///< sum_a V_a |H_a|^2 + |u_a|^2 sum_b w_ab [m^3]: scale of round-off

  /// (HG.1) and (HG.2); 0 for a body that has not moved. `energy`: internal energy and plastic
  /// work [J]; E: Young's modulus [Pa].
  double nonaffine_energy_share(double E, double energy) const;
  double nonaffine_energy(double E) const { return 0.5 * E * local; }
  double checkerboard() const;
};

/// Finds the edges when first asked, and keeps them. For bodies with edges alone.
class Hourglass {
 public:
  explicit Hourglass(const Body& body) : m_body(body) {}
  /// Whether the numbers mean anything: a body in one layer has no triangulation, no edges.
  bool defined() const { return !m_body.triangulation.simplices.empty(); }
  /// u: column of displacements; H: gradients H_a by the method's own interpolation.
  Roughness measure(std::span<const double> u, std::span<const Mat3> H);

 private:
  const Body& m_body;
  Edges m_edges;
  std::vector<double> m_weight;  ///< sum_b w_ab
  std::vector<Vec3> m_sum;       ///< sum_b w_ab l_ab
};

}  // namespace concord::particle
