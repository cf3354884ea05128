#include "particle/voronoi/ghosts.hpp"

#include <Eigen/Dense>

#include <fmt/format.h>

namespace concord::particle::voronoi {
namespace {

using Eigen::MatrixXd;

/// Orthonormal basis of the range of a projection, as columns.
MatrixXd basis_of(const Mat3& projection) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(projection);
  int rank = 0;
  for (int i = 0; i < 3; ++i) rank += eigen.eigenvalues()[i] > 0.5;
  MatrixXd Q = eigen.eigenvectors().rightCols(rank);
  // Axis-aligned projections get unit vectors without round-off, so that T stays diagonal.
  Q = Q.unaryExpr([](double q) { return std::abs(q) < 1e-12 ? 0.0 : q; }).eval();
  for (int k = 0; k < rank; ++k) Q.col(k).normalize();
  return Q;
}

/// K_a (18) as (1 - H)^T (1 - H), H_cd = X_c.B_d / V_a; neighbours, then ghosts.
MatrixXd kernel_matrix(const Star& star) {
  const auto real = static_cast<Eigen::Index>(star.neighbours.size()),
             all = real + static_cast<Eigen::Index>(star.ghosts.size());
  MatrixXd X(all, 3), B(all, 3);
  for (Eigen::Index c = 0; c < all; ++c) {
    if (c < real) {
      X.row(c) = star.neighbours[c].X.transpose();
      B.row(c) = star.neighbours[c].gradient_vector().transpose();
    } else {
      X.row(c) = star.ghosts[c - real].X.transpose();
      B.row(c) = star.ghosts[c - real].gradient_vector().transpose();
    }
  }
  const MatrixXd rest = MatrixXd::Identity(all, all) - X * B.transpose() / star.V;
  return rest.transpose() * rest;
}

/// Matrix A of the free components with given bases, and where those of each ghost begin.
struct Free {
  std::vector<MatrixXd> Q;
  std::vector<Eigen::Index> first;
  MatrixXd A;

  Free(const Star& star, const MatrixXd& K, const std::vector<bool>& mirrored)
      : first(star.ghosts.size() + 1, 0) {
    const std::size_t ghosts = star.ghosts.size();
    const auto real = static_cast<Eigen::Index>(star.neighbours.size());
    for (std::size_t g = 0; g < ghosts; ++g) {
      Q.push_back(mirrored[g] ? MatrixXd(3, 0) : basis_of(star.ghosts[g].free));
      first[g + 1] = first[g] + Q[g].cols();
    }
    A.resize(size(), size());
    for (std::size_t g = 0; g < ghosts; ++g) {
      for (std::size_t h = 0; h < ghosts; ++h)
        A.block(first[g], first[h], Q[g].cols(), Q[h].cols()) =
            K(real + static_cast<Eigen::Index>(g), real + static_cast<Eigen::Index>(h)) *
            Q[g].transpose() * Q[h];
    }
  }
  Eigen::Index size() const { return first.back(); }
};

/// Among the ghosts that may become mirror images, those behind the plane that takes the
/// largest part in a motion of the free components, and behind planes parallel to it. False if
/// there are none.
bool mirror_most(const Star& star, const Free& free, const Eigen::VectorXd& motion,
                 std::vector<bool>& mirrored) {
  const std::size_t ghosts = star.ghosts.size();
  const auto may = [&](std::size_t g) { return star.ghosts[g].mirror && !mirrored[g]; };
  const auto parallel = [&](std::size_t g, std::size_t h) {
    return star.ghosts[g].N.cross(star.ghosts[h].N).norm() < 1e-9;
  };
  std::size_t most = ghosts;
  double largest = -1;
  for (std::size_t g = 0; g < ghosts; ++g) {
    if (!may(g)) continue;
    double part = 0;
    for (std::size_t h = 0; h < ghosts; ++h) {
      if (may(h) && parallel(g, h))
        part += motion.segment(free.first[h], free.Q[h].cols()).squaredNorm();
    }
    if (part > largest) largest = part, most = g;
  }
  if (most == ghosts) return false;
  for (std::size_t h = 0; h < ghosts; ++h) {
    if (h == most || (may(h) && parallel(most, h))) mirrored[h] = true;
  }
  return true;
}

/// Ghosts that are mirror images whatever the neighbours: those of a layer of one particle
/// between two parallel planes of symmetry.
std::vector<bool> between_planes(const Star& star) {
  std::vector<bool> between(star.ghosts.size(), false);
  for (std::size_t g = 0; g < star.ghosts.size(); ++g) {
    for (std::size_t h = 0; h < star.ghosts.size(); ++h) {
      if (star.ghosts[g].mirror && star.ghosts[h].mirror &&
          (star.ghosts[g].N + star.ghosts[h].N).norm() < 1e-9)
        between[g] = true;
    }
  }
  return between;
}

/// T and R by (VOR.6).
void fill(const Star& star, const MatrixXd& K, const Free& free, GhostSystem& system) {
  const std::size_t real = star.neighbours.size(), ghosts = star.ghosts.size();
  const auto& [Q, first, A] = free;
  const Eigen::Index size = free.size();
  system.T.assign(ghosts * real, Mat3::Zero());
  system.R.assign(ghosts * ghosts, Mat3::Zero());
  for (std::size_t g = 0; g < ghosts; ++g) system.R[g * ghosts + g] = 2 * star.ghosts[g].D;
  if (size == 0) return;
  const auto at = [&](std::size_t g) { return static_cast<Eigen::Index>(real + g); };
  const MatrixXd Z = A.ldlt().solve(MatrixXd::Identity(size, size));
  for (std::size_t g = 0; g < ghosts; ++g) {
    for (std::size_t h = 0; h < ghosts; ++h) {
      const Mat3 QZQ =
          Q[g] * Z.block(first[g], first[h], Q[g].cols(), Q[h].cols()) * Q[h].transpose();
      for (std::size_t c = 0; c < real; ++c)
        system.T[g * real + c] -= K(at(h), static_cast<Eigen::Index>(c)) * QZQ;
      for (std::size_t k = 0; k < ghosts; ++k)
        system.R[g * ghosts + k] -= 2 * K(at(h), at(k)) * QZQ * star.ghosts[k].D;
    }
  }
}

}  // namespace

Vec3 offset_of(const Face& face, const Vec3& X_a, const Vec3& X_b) {
  const Vec3 t = face.C - 0.5 * (X_a + X_b);
  return t.norm() <= 1e-12 * (X_b - X_a).norm() ? Vec3::Zero() : t;
}

Stars::Stars(const Body& body, const Cells& cells, const Boundary& boundary)
    : m_body(body), m_cells(cells), m_boundary(boundary) {
  const Index n = particles();
  m_begin.assign(n + 1, 0);
  m_begin_wall.assign(n + 1, 0);
  for (std::size_t f = 0; f < cells.interior; ++f)
    ++m_begin[cells.faces[f].a + 1], ++m_begin[cells.faces[f].b + 1];
  for (const BoundaryPiece& piece : boundary.pieces) ++m_begin_wall[piece.particle + 1];
  for (Index a = 0; a < n; ++a)
    m_begin[a + 1] += m_begin[a], m_begin_wall[a + 1] += m_begin_wall[a];
  m_face.resize(m_begin[n]);
  std::vector<Index> next(m_begin.begin(), m_begin.end() - 1);
  // Faces come by (a, b), so those at b with lower a are met first, in order; then its own.
  for (std::size_t f = 0; f < cells.interior; ++f)
    m_face[next[cells.faces[f].b]++] = static_cast<Index>(f);
  for (std::size_t f = 0; f < cells.interior; ++f)
    m_face[next[cells.faces[f].a]++] = static_cast<Index>(f);
}

Star Stars::operator()(Index a) const {
  Star star;
  star.a = a;
  const Vec3 X_a = m_body.position(a);
  star.V = m_cells.V[a];
  for (Index k = m_begin[a]; k < m_begin[a + 1]; ++k) {
    const Face& face = m_cells.faces[m_face[k]];
    const Index b = face.a == a ? face.b : face.a;
    const Vec3 X_b = m_body.position(b);
    // In the order of the face, so that t_ab has the same bits from both sides.
    const Vec3 t = a < b ? offset_of(face, X_a, X_b) : offset_of(face, X_b, X_a);
    star.neighbours.push_back({b, X_b - X_a, t, face.A});
  }
  for (Index k = m_begin_wall[a]; k < m_begin_wall[a + 1]; ++k) {
    const BoundaryPiece& piece = m_boundary.pieces[k];
    const Face& face = m_cells.faces[piece.face];
    const Wall& wall = m_cells.walls[face.wall];
    const double distance = wall.offset - wall.N.dot(X_a);
    Ghost ghost;
    ghost.N = wall.N;
    ghost.X = 2 * distance * wall.N;
    const Vec3 W = X_a + distance * wall.N;
    if (!coincide(face.C, W, distance)) ghost.t = face.C - W;
    ghost.A = face.A;
    ghost.D = piece.D;
    ghost.free = Mat3::Identity() - piece.D;
    if (m_cells.dim == 2) ghost.free(2, 2) = 0;
    ghost.centroid_point = piece.centroid_point;
    ghost.wall_point = piece.wall_point;
    ghost.piece = k;
    ghost.mirror = piece.mirror;
    star.ghosts.push_back(ghost);
  }
  return star;
}

GhostSystem solve_ghosts(const Star& star) {
  const MatrixXd K = kernel_matrix(star);
  GhostSystem system;
  system.mirrored = between_planes(star);
  while (true) {
    const Free free(star, K, system.mirrored);
    system.condition = 1;
    if (free.size() > 0) {
      const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(free.A);
      system.condition = eigen.eigenvalues()[0] / eigen.eigenvalues()[free.size() - 1];
      if (!system.determined() &&
          mirror_most(star, free, eigen.eigenvectors().col(0), system.mirrored))
        continue;
    }
    if (system.determined()) fill(star, K, free, system);
    return system;
  }
}

GhostSystems solve_all_ghosts(const Stars& stars, const SourcePosition& where,
                              const Executor& executor) {
  GhostSystems all;
  all.row.assign(stars.particles(), -1);
  for (Index a = 0; a < stars.particles(); ++a) {
    if (!stars.at_wall(a)) continue;
    all.row[a] = static_cast<Index>(all.particle.size());
    all.particle.push_back(a);
  }
  all.system.resize(all.particle.size());
  executor.for_pieces(all.particle.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      all.system[k] = solve_ghosts(stars(all.particle[k]));
  });
  for (std::size_t k = 0; k < all.particle.size(); ++k) {
    if (all.system[k].determined()) continue;
    const Vec3 X = stars.body().position(all.particle[k]);
    throw InputError(
        where, "geometry",
        fmt::format("particle {} at ({:.4g}, {:.4g}, {:.4g}) m whose ghosts are undetermined: "
                    "its neighbours and the prescribed faces of its cell do not span the space "
                    "in which they move (condition {:.1e})",
                    all.particle[k], X[0], X[1], X[2], all.system[k].condition),
        fmt::format(
            "conditions from {:g} on: two layers of particles between free faces (a "
            "finer resolution), planes of symmetry on both sides of one layer; at acute "
            "corners, where no resolution helps, displacements on one of the two faces "
            "or an end as wide as two particles",
            least_condition));
  }
  return all;
}

}  // namespace concord::particle::voronoi
