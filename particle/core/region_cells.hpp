#pragma once
// Which cells of a convex hull lie outside the body whose particles it holds.

#include "particle/core/body_surface.hpp"
#include "particle/core/delaunay_cells.hpp"

namespace concord::particle {

/// Cells that are no part of the body, ascending: those outside a non-convex body, and flat
/// ones along its faces, which come from round-off in the points. Flat cells inside (four
/// points of a lattice square) stay: their neighbours lean on them. `flat`: volume below which
/// a cell counts as flat [m^dim].
///
/// A cell with a point inside the body is part of it, and so is a cell that shares a facet with
/// one, if no face of the body holds that facet. What such steps do not reach is asked for its
/// winding number, once for all cells that they join: linear in the cells.
std::vector<Index> cells_outside(int dim, const HullCells& hull, std::span<const double> volume,
                                 const BodySurface& surface, std::span<const Vec3> X,
                                 double flat);

}  // namespace concord::particle
