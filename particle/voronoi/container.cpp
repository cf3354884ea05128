#include "particle/voronoi/container.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace concord::particle::voronoi {

bool FirstCuts::cut_cell(voro::voronoicell_neighbor& cell, double x, double y, double z) {
  const Vec3 X(x, y, z);
  const double h = m_region.scale.spacing;
  const bool box =
      m_box &&
      std::any_of(m_region.planes.begin(), m_region.planes.end(), [&](const Plane& plane) {
        return !plane.supporting && std::abs(plane.half.beyond(X)) < reach * h;
      });
  for (int k = 0; box && k < 3; ++k)
    for (const double sign : {-1.0, 1.0}) {
      const HalfSpace half{sign * Vec3::Unit(k), sign * X[k] + reach * h};
      if (!cut(cell, half, X, h, local_box)) return false;
    }
  for (std::size_t p = 0; p < m_region.planes.size(); ++p) {
    const Plane& plane = m_region.planes[p];
    if (!plane.supporting || plane.half.beyond(X) < -reach * h) continue;
    if (!cut(cell, plane.half, X, h, face_id({static_cast<Index>(p), 0}))) return false;
  }
  return true;
}

Container::Container(const Region& region, int dim, std::span<const Vec3> X, bool box)
    : m_first(region, box) {
  const double h = region.scale.spacing;
  Vec3 lower = region.lower, upper = region.upper;
  const double block = std::pow(voro::optimal_particles, 1.0 / dim) * h;
  std::array<int, 3> blocks{1, 1, 1};
  for (int k = 0; k < dim; ++k) {
    lower[k] -= h;
    upper[k] += h;
    blocks[k] = std::max(1, static_cast<int>((upper[k] - lower[k]) / block));
  }
  m_container = std::make_unique<voro::container>(lower[0], upper[0], lower[1], upper[1],
                                                  lower[2], upper[2], blocks[0], blocks[1],
                                                  blocks[2], false, false, false, 8);
  for (std::size_t a = 0; a < X.size(); ++a) {
    const Vec3 P = region.scale.factor * X[a];
    m_container->put(static_cast<int>(a), P[0], P[1], P[2]);
  }
  m_container->add_wall(m_first);
  m_place.assign(X.size(), {-1, -1});
  for (int ijk = 0; ijk < m_container->nxyz; ++ijk)
    for (int l = 0; l < m_container->co[ijk]; ++l) m_place[m_container->id[ijk][l]] = {ijk, l};
}

Solid solid_inside(std::span<const HalfSpace> half_spaces, const Vec3& lower,
                   const Vec3& upper) {
  const Vec3 centre = 0.5 * (lower + upper), half = 0.5 * (upper - lower);
  voro::voronoicell cell;
  cell.init(-half[0], half[0], -half[1], half[1], -half[2], half[2]);
  for (const HalfSpace& side : half_spaces)
    if (!cut(cell, side, centre, 1, 0)) return {};
  Solid solid;
  solid.volume = cell.volume();
  cell.centroid(solid.centroid[0], solid.centroid[1], solid.centroid[2]);
  solid.centroid += centre;
  return solid;
}

}  // namespace concord::particle::voronoi
