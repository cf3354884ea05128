#pragma once
// What the particles of a body are made of: the elastic law of the scene, or a plastic one with
// the history of every particle. One per force model; formulations ask it and know no model.

#include "particle/core/elastic.hpp"
#include "particle/core/plasticity.hpp"

#include <memory>
#include <optional>

namespace concord::particle {

class Constitution {
 public:
  /// Memory for `n` histories with plastic materials only.
  Constitution(const scene::Problem& problem, Index n);

  /// Constants, law and history for the stress kernels.
  const KernelMaterial& kernel() const { return m_kernel; }
  bool plastic() const { return m_history != nullptr; }

  /// H with its out-of-plane part: plane stress H_33 from P_33 = 0, else as given.
  Mat3 complete(const Mat3& H) const;
  /// First Piola stress of particle a at H, from its committed history [Pa].
  Mat3 stress(Index a, const Mat3& H) const;
  /// dP/dF likewise; consistent with the return mapping [Pa].
  scene::Tangent tangent(Index a, const Mat3& H) const;
  struct PointEnergy {
    double stored = 0;   ///< elastic energy [J/m^3]
    double plastic = 0;  ///< plastic work Psi_p(eps_p) [J/m^3]
  };
  PointEnergy energy(Index a, const Mat3& H) const;
  /// Equivalent plastic strain of particle a at H; 0 in elastic materials.
  double plastic_strain(Index a, const Mat3& H) const;

  /// While held, plastic materials answer elastically (PlasticHistory::hold).
  void hold(bool on) {
    if (m_history) m_history->hold(on);
  }

  /// The state of the last force evaluation becomes the one that later ones start from.
  void commit() {
    if (m_history) m_history->commit();
  }
  /// The histories, saved or restored.
  void keep(scene::Checkpoint& state) {
    if (m_history) m_history->keep(state);
  }

 private:
  std::optional<scene::ElasticLaw> m_law;
  std::unique_ptr<PlasticHistory> m_history;
  KernelMaterial m_kernel;
};

}  // namespace concord::particle
