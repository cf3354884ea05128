#include "particle/voronoi/rows.hpp"

#include <algorithm>
#include <numeric>

namespace concord::particle::voronoi {

/// d(M u (x) B)/du: entry (3 i + J, k) = M_ik B_J.
Rows<9>::Block outer(const Mat3& M, const Vec3& B) {
  Rows<9>::Block block;
  for (int i = 0; i < 3; ++i) {
    for (int J = 0; J < 3; ++J) block.row(3 * i + J) = M.row(i) * B[J];
  }
  return block;
}

/// d(H t)/du from dH/du.
Mat3 times(const Rows<9>::Block& H, const Vec3& t) {
  Mat3 block;
  for (int i = 0; i < 3; ++i)
    block.row(i) = t[0] * H.row(3 * i) + t[1] * H.row(3 * i + 1) + t[2] * H.row(3 * i + 2);
  return block;
}

template <int M> void Rows<M>::compress() {
  std::vector<std::size_t> order(point.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t j, std::size_t k) { return point[j] < point[k]; });
  Rows sums;
  for (const std::size_t k : order) {
    if (block[k].isZero(0)) continue;
    if (!sums.point.empty() && sums.point.back() == point[k])
      sums.block.back() += block[k];
    else
      sums.add(point[k], block[k]);
  }
  *this = std::move(sums);
}

/// u_ag (VOR.6).
Rows<3> ghost_rows(const Star& star, const GhostSystem& system, std::size_t g) {
  const std::size_t real = star.neighbours.size(), ghosts = star.ghosts.size();
  Rows<3> rows;
  for (std::size_t c = 0; c < real; ++c) {
    const Mat3& T = system.T[g * real + c];
    rows.add(star.neighbours[c].b, T);
    rows.add(star.a, -T);
  }
  for (std::size_t h = 0; h < ghosts; ++h) {
    const Mat3& R = system.R[g * ghosts + h];
    if (star.ghosts[h].wall_point < 0) continue;
    rows.add(star.ghosts[h].wall_point, R);
    rows.add(star.a, -R);
  }
  rows.compress();
  return rows;
}

namespace {

/// 1/V_a sum_b u_ab (x) B_ab over real neighbours.
Rows<9> neighbour_gradient(const Star& star) {
  Rows<9> rows;
  for (const Neighbour& ab : star.neighbours) {
    const Rows<9>::Block block = outer(Mat3::Identity(), ab.gradient_vector() / star.V);
    rows.add(ab.b, block);
    rows.add(star.a, -block);
  }
  return rows;
}

}  // namespace

/// H^V_a = 1/V_a [ sum_b u_ab (x) B_ab + sum_g u_ag (x) B_ag ] (6), (26).
Rows<9> mean_gradient(const Star& star, const GhostSystem& system) {
  Rows<9> rows = neighbour_gradient(star);
  for (std::size_t g = 0; g < star.ghosts.size(); ++g) {
    const Rows<3> ghost = ghost_rows(star, system, g);
    const Vec3 B = star.ghosts[g].gradient_vector() / star.V;
    for (std::size_t k = 0; k < ghost.point.size(); ++k)
      rows.add(ghost.point[k], outer(ghost.block[k], B));
  }
  rows.compress();
  return rows;
}

/// The derivative of H^V_a as the paper's forces take it: prescribed parts of ghosts held (43).
Rows<9> mean_gradient_test(const Star& star, const GhostSystem& system) {
  Rows<9> rows = neighbour_gradient(star);
  const std::size_t real = star.neighbours.size();
  for (std::size_t g = 0; g < star.ghosts.size(); ++g) {
    const Vec3 B = star.ghosts[g].gradient_vector() / star.V;
    for (std::size_t c = 0; c < real; ++c) {
      const Rows<9>::Block block = outer(system.T[g * real + c], B);
      rows.add(star.neighbours[c].b, block);
      rows.add(star.a, -block);
    }
  }
  return rows;
}

/// Internal forces of the paper's forms: static (42), conserving (43), both with the reaction
/// D P A of prescribed faces.
Rows<9> paper_test(const Star& star, const GhostSystem& system, Form form) {
  Rows<9> rows =
      form == Form::conserving ? mean_gradient_test(star, system) : neighbour_gradient(star);
  for (const Ghost& ghost : star.ghosts) {
    if (ghost.centroid_point < 0) continue;
    const Rows<9>::Block block = outer(ghost.D, ghost.A / star.V * ghost.N);
    rows.add(ghost.centroid_point, block);
    rows.add(star.a, -block);
  }
  rows.compress();
  return rows;
}

Rows<3> face_displacement(const Star& star, const GhostSystem& system, std::size_t g,
                          const Rows<9>& mean) {
  const Ghost& ghost = star.ghosts[g];
  Rows<3> rows;
  rows.add(star.a, ghost.free);
  const Rows<3> branch = ghost_rows(star, system, g);
  for (std::size_t k = 0; k < branch.point.size(); ++k)
    rows.add(branch.point[k], 0.5 * ghost.free * branch.block[k]);
  if (!ghost.t.isZero(0)) {
    for (std::size_t k = 0; k < mean.point.size(); ++k)
      rows.add(mean.point[k], ghost.free * times(mean.block[k], ghost.t));
  }
  rows.compress();
  return rows;
}

std::vector<LoadTerm> load_terms(const Stars& stars, const GhostSystems& ghosts,
                                 const Boundary& boundary, Form form) {
  std::vector<LoadTerm> terms;
  for (const Index a : ghosts.particle) {
    const Star star = stars(a);
    const GhostSystem& system = ghosts.system[ghosts.row[a]];
    for (std::size_t g = 0; g < star.ghosts.size(); ++g) {
      const Ghost& ghost = star.ghosts[g];
      const BoundaryPiece& piece = boundary.pieces[ghost.piece];
      if (piece.tractions.empty()) continue;
      Rows<3> rows;
      if (form == Form::face_compatible)
        rows = face_displacement(star, system, g, mean_gradient(star, system));
      else
        rows.add(a, ghost.free);
      const Vec3 C = stars.body().position(a) + 0.5 * ghost.X + ghost.t;
      for (const Index condition : piece.tractions) {
        for (std::size_t k = 0; k < rows.point.size(); ++k)
          terms.push_back(
              {rows.point[k], condition, ghost.A * rows.block[k].transpose(), C, ghost.N});
      }
    }
  }
  return terms;
}

template struct Rows<3>;
template struct Rows<6>;
template struct Rows<9>;

}  // namespace concord::particle::voronoi
