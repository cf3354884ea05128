#pragma once
// The laws as element integrals ask for them: one quadrature point after the other, with or
// without a history.

#include "fem_reference/elastoplastic.hpp"
#include "fem_reference/hyperelastic.hpp"

#include <vector>

namespace concord::fem {

/// A law without history: the number of the point does not matter.
template <int dim> class ElasticPoints {
 public:
  using Tensor2 = dealii::Tensor<2, dim>;
  using Tensor4 = dealii::Tensor<4, dim>;
  explicit ElasticPoints(const Hyperelastic<dim>& law) : m_law(law) {}

  void resize(std::size_t) {}
  bool stress(std::size_t, const Tensor2& F, Tensor2& P) { return m_law.stress(F, P); }
  bool tangent(std::size_t, const Tensor2& F, Tensor2& P, Tensor4& A) {
    return m_law.tangent(F, P, A);
  }
  double energy(std::size_t, const Tensor2& F) const { return m_law.energy(F); }
  static constexpr bool symmetric() { return true; }

 private:
  const Hyperelastic<dim>& m_law;
};

/// Committed and trial state of every quadrature point. A stress or tangent writes the trial
/// state from the committed one, whatever was asked before; commit() alone moves on, so that a
/// step that failed leaves no trace.
template <int dim> class PlasticPoints {
 public:
  using Tensor2 = dealii::Tensor<2, dim>;
  using Tensor4 = dealii::Tensor<4, dim>;
  using Point = PlasticPoint<dim>;
  explicit PlasticPoints(const Elastoplastic<dim>& law) : m_law(law) {}

  /// Every point as before any deformation.
  void resize(std::size_t points) {
    m_committed.assign(points, {});
    m_trial.assign(points, {});
  }
  bool stress(std::size_t q, const Tensor2& F, Tensor2& P) {
    return m_law.stress(F, m_committed[q], P, m_trial[q]);
  }
  bool tangent(std::size_t q, const Tensor2& F, Tensor2& P, Tensor4& A) {
    return m_law.tangent(F, m_committed[q], P, A, m_trial[q]);
  }
  /// Stored energy of the last evaluation [J/m^3].
  double energy(std::size_t q, const Tensor2&) const {
    return m_law.measures(m_trial[q]).stored;
  }
  bool symmetric() const { return m_law.symmetric(); }

  /// The states of the last evaluation become the committed ones.
  void commit() { m_committed = m_trial; }
  const std::vector<Point>& committed() const { return m_committed; }
  const Elastoplastic<dim>& law() const { return m_law; }

 private:
  const Elastoplastic<dim>& m_law;
  std::vector<Point> m_committed, m_trial;
};

}  // namespace concord::fem
