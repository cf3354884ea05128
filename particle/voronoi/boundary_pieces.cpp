#include "particle/voronoi/boundary_pieces.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

#include <fmt/format.h>

namespace concord::particle::voronoi {
namespace {

using scene::BoundaryCondition;
using scene::BoundaryKind;

/// Projection onto the sum of the ranges of two projections.
Mat3 joined(const Mat3& D1, const Mat3& D2) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(D1 + D2);
  Mat3 D = Mat3::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vec3 e = eigen.eigenvectors().col(i);
    if (eigen.eigenvalues()[i] > 1e-9) D += e * e.transpose();
  }
  return D;
}

/// Projection onto what a condition prescribes on a wall with normal N (14).
Mat3 projection(const BoundaryCondition& bc, const Vec3& N, int dim) {
  Mat3 I = Mat3::Identity();
  if (dim == 2) I(2, 2) = 0;
  switch (bc.kind) {
    case BoundaryKind::fixed:
      return I;
    case BoundaryKind::symmetric:
      return N * N.transpose();
    case BoundaryKind::antisymmetric:
      return I - N * N.transpose();
    case BoundaryKind::displacement: {
      Mat3 D = Mat3::Zero();
      for (int i = 0; i < dim; ++i)
        D(i, i) = bc.value_from_exact || bc.value.component[i].has_value() ? 1 : 0;
      return D;
    }
    case BoundaryKind::traction:
      break;
  }
  return Mat3::Zero();
}

bool is_plane_of_symmetry(const BoundaryCondition& bc) {
  return bc.kind == BoundaryKind::symmetric || bc.kind == BoundaryKind::antisymmetric;
}

/// What all conditions make of one wall: a piece without particle and face.
BoundaryPiece on_wall(const scene::Problem& problem, const std::vector<Index>& conditions,
                      const Vec3& N) {
  BoundaryPiece piece{};
  bool planes_alone = true;
  for (const Index k : conditions) {
    const BoundaryCondition& bc = problem.boundaries[k];
    planes_alone &= is_plane_of_symmetry(bc);
    if (bc.kind == BoundaryKind::traction) {
      piece.tractions.push_back(k);
      continue;
    }
    const Mat3 D = projection(bc, N, problem.dim());
    for (int i = 0; i < problem.dim(); ++i) {
      if (piece.condition[i] < 0 && D(i, i) > 1e-9) piece.condition[i] = k;
    }
    piece.D = joined(piece.D, D);
  }
  piece.mirror = planes_alone && !conditions.empty();
  return piece;
}

/// Conditions of each wall, in the scene's order.
std::vector<std::vector<Index>> conditions_of(const scene::Problem& problem,
                                              const scene::Mesh& mesh, const Cells& cells) {
  std::vector<std::vector<Index>> conditions(cells.walls.size());
  for (std::size_t k = 0; k < problem.boundaries.size(); ++k) {
    const BoundaryCondition& bc = problem.boundaries[k];
    (void)mesh.group_nodes(bc.group, bc.where);  // reports a missing group
    const scene::Mesh::Group& group = mesh.groups.at(bc.group);
    bool anywhere = false;
    for (std::size_t w = 0; w < cells.walls.size(); ++w) {
      const Index wall = cells.walls[w].entity;
      const auto holds = [&](Index e) {
        const std::vector<Index>& closure = mesh.entities[e].closure;
        const bool bounds = mesh.entities[e].dim == mesh.dim &&
                            bc.kind != BoundaryKind::traction &&
                            std::find(closure.begin(), closure.end(), wall) != closure.end();
        return e == wall || bounds;
      };
      if (!std::any_of(group.entities.begin(), group.entities.end(), holds)) continue;
      conditions[w].push_back(static_cast<Index>(k));
      anywhere = true;
    }
    if (!anywhere)
      throw InputError(
          bc.where, "group",
          fmt::format("\"{}\", a group of dimension {} away from the plane faces of "
                      "the body, for a method whose particles lie inside it",
                      bc.group, group.dim),
          mesh.dim == 3 ? "a group of surfaces, or the body"
                        : "a group of curves, or the body");
  }
  return conditions;
}

}  // namespace

Boundary boundary_pieces(const scene::Problem& problem, const scene::Mesh& mesh,
                         const Cells& cells, std::span<const Vec3> X) {
  const std::vector<std::vector<Index>> conditions = conditions_of(problem, mesh, cells);
  std::vector<BoundaryPiece> of_wall;
  for (std::size_t w = 0; w < cells.walls.size(); ++w)
    of_wall.push_back(on_wall(problem, conditions[w], cells.walls[w].N));
  Boundary boundary;
  const auto bulk = static_cast<Index>(X.size());
  const auto add_point = [&](const Vec3& at) {
    boundary.points.push_back(at);
    boundary.owner.push_back(static_cast<Index>(boundary.pieces.size()));
    return bulk + static_cast<Index>(boundary.points.size()) - 1;
  };
  for (std::size_t f = cells.interior; f < cells.faces.size(); ++f) {
    const Face& face = cells.faces[f];
    const Wall& wall = cells.walls[face.wall];
    BoundaryPiece piece = of_wall[face.wall];
    piece.particle = face.a;
    piece.face = static_cast<Index>(f);
    if (!piece.D.isZero(0)) {
      const double distance = wall.offset - wall.N.dot(X[face.a]);
      const Vec3 W = X[face.a] + distance * wall.N;
      piece.centroid_point = piece.wall_point = add_point(face.C);
      if (!coincide(face.C, W, distance)) piece.wall_point = add_point(W);
    }
    boundary.pieces.push_back(piece);
  }
  return boundary;
}

}  // namespace concord::particle::voronoi
