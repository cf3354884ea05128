#include "particle/core/region_cells.hpp"

#include "particle/core/triangulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace concord::particle {
namespace {

/// Sets of joined cells (union-find with path halving).
class Sets {
 public:
  explicit Sets(std::size_t count) : m_parent(count) {
    std::iota(m_parent.begin(), m_parent.end(), Index{0});
  }
  Index root(Index c) {
    while (m_parent[c] != c) c = m_parent[c] = m_parent[m_parent[c]];
    return c;
  }
  void join(Index c, Index d) {
    const Index p = root(c), q = root(d);
    m_parent[std::max(p, q)] = std::min(p, q);
  }

 private:
  std::vector<Index> m_parent;
};

/// A facet that no face of the body holds, with the candidate (cell whose points all lie on the
/// surface) it belongs to; -1: the hull's.
struct Passage {
  std::array<Index, 3> sorted;
  Index candidate;
};

std::vector<Passage> passages(int dim, const HullCells& hull,
                              const std::vector<Index>& candidates,
                              const BodySurface& surface) {
  std::vector<Passage> found;
  const auto add = [&](std::array<Index, 3> v, Index candidate) {
    if (surface.share_a_face(v.data(), dim)) return;
    std::sort(v.begin(), v.begin() + dim);
    found.push_back({v, candidate});
  };
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Index* v = &hull.cells[static_cast<std::size_t>(candidates[c]) * (dim + 1)];
    for (int k = 0; k <= dim; ++k) add(opposite_facet(dim, v, k), static_cast<Index>(c));
  }
  for (std::size_t f = 0; f < hull.facets.size(); f += dim) {
    std::array<Index, 3> v{-1, -1, -1};
    std::copy_n(&hull.facets[f], dim, v.begin());
    add(v, -1);
  }
  std::sort(found.begin(), found.end(),
            [](const Passage& p, const Passage& q) { return p.sorted < q.sorted; });
  return found;
}

/// Drops the candidates that lie outside a non-convex body.
void drop_outside(int dim, const HullCells& hull, std::span<const double> volume,
                  const BodySurface& surface, std::span<const Vec3> X,
                  const std::vector<Index>& candidates, std::vector<Index>& dropped) {
  const std::vector<Passage> all = passages(dim, hull, candidates, surface);
  Sets sets(candidates.size());
  std::vector<Index> beside_inner;  // candidates whose neighbour has a point inside
  for (std::size_t i = 0; i < all.size();) {
    const bool pair = i + 1 < all.size() && all[i + 1].sorted == all[i].sorted;
    if (!pair && all[i].candidate >= 0) beside_inner.push_back(all[i].candidate);
    if (pair && all[i].candidate >= 0 && all[i + 1].candidate >= 0)
      sets.join(all[i].candidate, all[i + 1].candidate);
    i += pair ? 2 : 1;
  }
  std::vector<char> inside(candidates.size(), 0), known(candidates.size(), 0);  // of a set
  for (const Index c : beside_inner) inside[sets.root(c)] = known[sets.root(c)] = 1;
  std::vector<Index> largest(candidates.size(), -1);  // the set's best witness
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    Index& best = largest[sets.root(static_cast<Index>(c))];
    if (best < 0 || volume[candidates[c]] > volume[best]) best = candidates[c];
  }
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Index set = sets.root(static_cast<Index>(c));
    if (!known[set]) {
      Vec3 centroid = Vec3::Zero();
      for (int k = 0; k <= dim; ++k)
        centroid +=
            X[hull.cells[static_cast<std::size_t>(largest[set]) * (dim + 1) + k]] / (dim + 1);
      inside[set] = surface.winding_number(centroid) >= 0.5;
      known[set] = 1;
    }
    if (!inside[set]) dropped.push_back(candidates[c]);
  }
}

}  // namespace

std::vector<Index> cells_outside(int dim, const HullCells& hull, std::span<const double> volume,
                                 const BodySurface& surface, std::span<const Vec3> X,
                                 double flat) {
  const int nv = dim + 1;
  std::vector<Index> candidates, dropped;
  double whole = 0;
  for (std::size_t s = 0; s < volume.size(); ++s) {
    whole += std::abs(volume[s]);
    const Index* v = &hull.cells[s * nv];
    if (!std::all_of(v, v + nv, [&](Index a) { return surface.holds(a); })) continue;
    const bool along_face = std::abs(volume[s]) < flat && surface.share_a_face(v, nv);
    (along_face ? dropped : candidates).push_back(static_cast<Index>(s));
  }
  const bool convex = std::abs(whole - surface.volume()) <= 1e-10 * surface.volume();
  if (!convex) drop_outside(dim, hull, volume, surface, X, candidates, dropped);
  std::sort(dropped.begin(), dropped.end());
  return dropped;
}

}  // namespace concord::particle
