#include "sph_reference/total_lagrangian/volumes.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <array>
#include <cmath>

namespace concord::sph {
namespace {

/// The point at equal distances from the vertices; rows of `edges`: from the first vertex to
/// the others.
Vec3 circumcentre(const Vec3& first, const Mat3& edges, int dim) {
  Vec3 half_squares = 0.5 * edges.rowwise().squaredNorm();
  if (dim == 2) half_squares[2] = 0;
  return first + edges.inverse() * half_squares;
}

/// +1 or -1 as (i, j, k, the fourth) is an even or odd permutation of (0, 1, 2, 3).
int parity(int i, int j, int k) {
  const std::array<int, 4> p{i, j, k, 6 - i - j - k};
  int sign = 1;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < a; ++b) sign = p[b] > p[a] ? -sign : sign;
  }
  return sign;
}

/// Adds to share[i] the pieces (p_i, mid_ij, C) of a triangle with circumcentre C.
void share_triangle(const std::array<Vec3, 4>& p, const Vec3& C, double orientation,
                    std::array<double, 4>& share) {
  for (int i = 0; i < 3; ++i) {
    for (const int next : {1, 2}) {
      const int j = (i + next) % 3;
      const double piece = (0.5 * (p[j] - p[i])).cross(C - p[i])[2] / 2;
      share[i] += (next == 1 ? orientation : -orientation) * piece;
    }
  }
}

/// Adds to share[i] the pieces (p_i, mid_ij, C_ijk, C) of a tetrahedron with circumcentre C.
void share_tetrahedron(const std::array<Vec3, 4>& p, const Vec3& C, double orientation,
                       std::array<double, 4>& share) {
  for (int l = 0; l < 4; ++l) {
    const std::array<int, 3> face{(l + 1) % 4, (l + 2) % 4, (l + 3) % 4};
    const Vec3 normal = (p[face[1]] - p[face[0]]).cross(p[face[2]] - p[face[0]]);
    const Vec3 C_face = C - normal * (normal.dot(C - p[face[0]]) / normal.squaredNorm());
    for (const int i : face) {
      const Vec3 wedge = (C_face - p[i]).cross(C - p[i]);
      for (const int j : face) {
        if (j == i) continue;
        const int k = 6 - l - i - j;
        share[i] += orientation * parity(i, j, k) * (0.5 * (p[j] - p[i])).dot(wedge) / 6;
      }
    }
  }
}

}  // namespace

std::vector<double> voronoi_volumes(const Body& body) {
  const particle::Triangulation& t = body.triangulation;
  const int vertices = body.dim + 1;
  std::vector<double> V(body.n, 0.0);
  for (std::size_t s = 0; s < t.size(); ++s) {
    const Index* v = &t.simplices[s * vertices];
    std::array<Vec3, 4> p;
    Mat3 edges = Mat3::Identity();
    for (int i = 0; i < vertices; ++i) {
      p[i] = body.position(v[i]);
      if (i > 0) edges.row(i - 1) = p[i] - p[0];
    }
    const double det = edges.determinant();
    if (std::abs(det) < 1e-10 * std::pow(body.h, body.dim))
      continue;  // flat cells of lattices: nothing to share
    std::array<double, 4> share{};
    const Vec3 C = circumcentre(p[0], edges, body.dim);
    (body.dim == 2 ? share_triangle : share_tetrahedron)(p, C, det > 0 ? 1 : -1, share);
    for (int i = 0; i < vertices; ++i) V[v[i]] += share[i] * body.thickness;
  }
  for (Index a = 0; a < body.n; ++a) {
    if (!(V[a] > 0)) V[a] = body.V[a];
  }
  return V;
}

}  // namespace concord::sph
