#pragma once
// States of a discretised body that probes start from, and what they measure it by.

#include "studies/probes/probe.hpp"

#include <vector>

namespace concord::probes {

/// Options `stretch` (along X, 1: none) and `shear` (of X along Y): the homogeneous
/// deformation F = I + (stretch - 1) e_x (x) e_x + shear e_x (x) e_y about which a probe looks
/// at a body.
std::vector<scene::ParameterInfo> deformation_options();
/// u = (F - I) X of these options at every point.
std::vector<double> deformed(const scene::DiscreteBody& body, const scene::Settings& options);

/// Shortest distance between two points [m].
double shortest_distance(std::span<const Vec3> points);

/// Components that the scene does not prescribe: their numbers, point*dim + component.
std::vector<int> free_components(const scene::DiscreteBody& body);

/// Unknowns and points of a body into the result.
void tell_size(const scene::DiscreteBody& body, scene::Result& result);

/// Signs (-1)^(i_x), (-1)^(i_x + i_y), ... of the points' places on a lattice of spacing h: one
/// pattern for each nonzero k in {0, pi/h}^dim, 7 in space and 3 in the plane.
std::vector<std::vector<double>> checkerboards(const scene::DiscreteBody& body, double h);

}  // namespace concord::probes
