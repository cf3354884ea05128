#pragma once
// Internal force by sum factorisation (deal.II's MatrixFree) and the lumped mass, for explicit
// dynamics on quadrilaterals and hexahedra.

#include "fem_reference/discretisation.hpp"
#include "fem_reference/hyperelastic.hpp"
#include "fem_reference/internal_force.hpp"

#include <memory>

namespace concord::fem {

/// Gauss rule with p+1 points a direction; no matrix, no stored gradients. Serial, so that
/// results do not depend on a number of threads.
template <int dim>
std::unique_ptr<InternalForce> make_matrix_free(const Discretisation<dim>& discretisation,
                                                const Hyperelastic<dim>& law, double thickness);

/// Diagonal mass m_a = rho thickness sum_q N_a JxW [kg] by the Gauss-Lobatto rule whose points
/// are the nodes of Q1 or Q2 (the nodal quadrature keeps the order of the element on affine
/// cells).
template <int dim>
void lumped_mass(const Discretisation<dim>& discretisation, double rho, double thickness,
                 dealii::Vector<double>& mass);

}  // namespace concord::fem
