#pragma once
// The plastic law in plane strain, for eight particles at a time: the vectorised form of
// J2Hencky::update, tested against it.

#include "particle/core/plasticity.hpp"

namespace concord::particle {

/// State of eight particles in plane strain.
struct PlaneStates {
  double A11[plastic_width], A22[plastic_width], A33[plastic_width], A12[plastic_width];
  double eps_p[plastic_width];
};

/// Constants of the law [Pa]; hardening as in Eq. (24).
struct PlaneLaw {
  double mu, kappa;
  scene::Hardening hardening;
};

/// Stress p and J - 1 of eight particles at H_ij = h[2 j + i] from `old`, and their new states.
/// Returns a bit for every lane whose strains are beyond the series used here or whose return
/// map needs more than three iterations: such a lane is left to J2Hencky::update, and its
/// results are of no use. No lane looks at another's values.
unsigned plane_lanes(const PlaneLaw& law, const double (&h)[4][plastic_width],
                     const PlaneStates& old, PlaneStates& next, double (&p)[4][plastic_width],
                     double (&j)[plastic_width]);

}  // namespace concord::particle
