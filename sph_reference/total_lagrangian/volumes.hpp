#pragma once
// Volumes of the Voronoi cells of a triangulated body.

#include "particle/core/body.hpp"

#include <vector>

namespace concord::sph {

using particle::Body;

/// Volumes [m^3] of the particles' Voronoi cells within the body, thickness included, by
/// (TLS.17): each simplex is shared among its vertices by the pieces (vertex, midpoint of edge,
/// circumcentre of face, circumcentre of simplex), signed, which add up to the simplex, and in
/// the interior to the cells. Where a free surface leaves a particle nothing positive, its
/// volume of the triangulation.
std::vector<double> voronoi_volumes(const Body& body);

}  // namespace concord::sph
