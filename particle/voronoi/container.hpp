#pragma once
// voro++ as this folder uses it: included by its .cpp files only.

#include "particle/voronoi/region.hpp"

#include <voro++.hh>

#include <memory>

namespace concord::particle::voronoi {

constexpr double reach = 4;  // in spacings: planes nearer than this cut a cell before its
                             // neighbours do, which keeps the search for those short
constexpr int local_box =
    -7;  // faces: particles >= 0, voro++'s box -1 to -6, planes from -8 on
inline int face_id(const PlaneSide& p) { return -8 - (2 * p.plane + p.side); }
inline PlaneSide plane_side(int id) { return {(-8 - id) / 2, (-8 - id) % 2}; }

/// Cuts a cell around X by a half-space. Planes enter voro++ as those between particles a
/// spacing apart would, so that its tolerance means the same length. False: nothing is left.
template <class Cell>
bool cut(Cell& cell, const HalfSpace& half, const Vec3& X, double spacing, int id) {
  const Vec3 n = spacing * half.N;
  return cell.nplane(n[0], n[1], n[2], -2 * spacing * half.beyond(X), id);
}

/// What cuts every cell at first: supporting planes in reach and, near re-entrant walls, behind
/// which no particles bound the search, a box around the particle.
class FirstCuts final : public voro::wall {
 public:
  FirstCuts(const Region& region, bool box) : m_region(region), m_box(box) {}
  bool point_inside(double, double, double) override { return true; }
  bool cut_cell(voro::voronoicell&, double, double, double) override { return true; }
  bool cut_cell(voro::voronoicell_neighbor& cell, double x, double y, double z) override;

 private:
  const Region& m_region;
  bool m_box;
};

/// All particles in voro++'s blocks, about 5.6 each (voro++'s own optimum).
class Container {
 public:
  Container(const Region& region, int dim, std::span<const Vec3> X, bool box);

  /// Computations with a memory of their own, one a thread.
  class Search {
   public:
    explicit Search(Container& c)
        : m_c(c),
          m_compute(*c.m_container, c.m_container->nx, c.m_container->ny, c.m_container->nz) {}
    /// False: a has no cell.
    bool cell(Index a, voro::voronoicell_neighbor& result) {
      const auto [ijk, l] = m_c.m_place[a];
      if (ijk < 0) return false;  // outside the box
      const int nx = m_c.m_container->nx, ny = m_c.m_container->ny;
      return m_compute.compute_cell(result, ijk, l, ijk % nx, ijk / nx % ny, ijk / nx / ny);
    }

   private:
    Container& m_c;
    voro::voro_compute<voro::container> m_compute;
  };

 private:
  struct Place {
    int block, slot;
  };
  FirstCuts m_first;
  std::unique_ptr<voro::container> m_container;
  std::vector<Place> m_place;
};

}  // namespace concord::particle::voronoi
