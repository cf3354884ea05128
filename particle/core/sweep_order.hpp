#pragma once
// The order of a body's particles.

#include "particle/core/parallel.hpp"

#include <span>
#include <vector>

namespace concord::particle {

/// Numbers of the points in sweep order: slabs of thickness about h along the longest axis of
/// the box [low, high], rows within a slab, places within a row, so that neighbours are near in
/// memory. Layers are centred at low + k h: a lattice with its first layer there stays in
/// layers when its points are moved by less than h/2. Points may lie a little outside the box.
std::vector<Index> sweep_order(int dim, double h, std::span<const Vec3> X, const Vec3& low,
                               const Vec3& high, const Executor& executor);

}  // namespace concord::particle
