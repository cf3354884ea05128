#pragma once
// Volumes of the Voronoi cells of a triangulated body.

#include "sph_reference/total_lagrangian/planes.hpp"

#include <vector>

namespace concord::sph {

/// Volumes [m^3] of the particles' Voronoi cells within the body, thickness included, by
/// (TLS.17): each simplex is shared among its vertices by the pieces (vertex, midpoint of edge,
/// circumcentre of face, circumcentre of simplex), signed, which add up to the simplex, and in
/// the interior to the cells. Where a free surface leaves a particle nothing positive, its
/// volume of the triangulation.
std::vector<double> voronoi_volumes(const Body& body);

/// The body's volumes, but those of the Voronoi cells where two or more planes meet: there the
/// triangulation of a lattice gives 1/6 to 1/3 of a cell where the images need 1/4 (an edge),
/// which costs an order of convergence. Elsewhere the body's, which agree with its masses, are
/// the better ones (README).
std::vector<double> volumes_at_planes(const Body& body, const std::vector<Plane>& planes);

}  // namespace concord::sph
