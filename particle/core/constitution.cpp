#include "particle/core/constitution.hpp"

namespace concord::particle {

Constitution::Constitution(const scene::Problem& problem, Index n)
    : m_kernel(kernel_material(problem)) {
  if (problem.material.plastic()) {
    m_history = std::make_unique<PlasticHistory>(problem, n);
    m_kernel.constants.history = m_history.get();
  } else {
    m_law.emplace(problem.material, problem.dimension);
  }
}

Mat3 Constitution::complete(const Mat3& H) const { return m_law ? m_law->complete(H) : H; }

Mat3 Constitution::stress(Index a, const Mat3& H) const {
  return m_law ? m_law->stress(H) : m_history->law().update(H, m_history->committed(a)).P;
}

scene::Tangent Constitution::tangent(Index a, const Mat3& H) const {
  return m_law ? m_law->tangent(H) : m_history->law().tangent(H, m_history->committed(a));
}

Constitution::PointEnergy Constitution::energy(Index a, const Mat3& H) const {
  if (m_law) return {m_law->energy(H), 0};
  const J2Hencky::Update update = m_history->law().update(H, m_history->committed(a));
  return {update.stored, update.plastic};
}

double Constitution::plastic_strain(Index a, const Mat3& H) const {
  return m_law ? 0.0 : m_history->law().update(H, m_history->committed(a)).state.eps_p;
}

}  // namespace concord::particle
