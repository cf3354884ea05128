#pragma once
// Solution at Gauss points and stresses at nodes.

#include "fem_reference/discretisation.hpp"
#include "fem_reference/nodal_fields.hpp"
#include "scene/method.hpp"

namespace concord::fem {

/// X, u, v (empty if v is), F and weights at Gauss points with p+2 points a direction: exact
/// for squares of errors to degree 2p+3 on affine cells.
template <int dim>
scene::Samples sample(const Discretisation<dim>& discretisation, const NodalFields<dim>& law,
                      double thickness, const dealii::Vector<double>& u,
                      const dealii::Vector<double>& v);

/// Stress at nodes: values of the cells around a node, averaged over those where the law gives
/// one; where none does (det F <= 0 at the node), mean of the neighbouring nodes in its cells.
struct NodalStress {
  std::vector<double> von_mises;  ///< sqrt(3/2 s:s), s the deviator of the Cauchy stress [Pa]
  std::vector<double> pressure;   ///< -tr(sigma)/3 [Pa]
  std::vector<double> kirchhoff_mises;  ///< J von Mises stress, of tau = J sigma [Pa]
};
template <int dim>
NodalStress nodal_stress(const Discretisation<dim>& discretisation,
                         const Hyperelastic<dim>& law, const dealii::Vector<double>& u);

}  // namespace concord::fem
