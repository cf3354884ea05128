// Voronoi cells against the dual of CGAL's Delaunay triangulation, in a box whose walls are
// made by mirrored particles: neighbours, areas and centroids of faces.

#include "tests/unit/cells/bodies.hpp"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <map>

namespace concord::particle::voronoi {
namespace {

using namespace test;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>;
using Cell = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
using Dual =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;

struct DualFace {
  double A = 0;
  Vec3 C = Vec3::Zero();
};

Vec3 vec(const Kernel::Point_3& P) { return {P.x(), P.y(), P.z()}; }

/// Face dual to an edge: circumcentres of the tetrahedra around it.
DualFace dual_face(const Dual& dual, const Dual::Edge& edge, const Vec3& N) {
  std::vector<Vec3> corner;
  auto cell = dual.incident_cells(edge);
  const auto first = cell;
  do {
    corner.push_back(vec(dual.dual(cell)));
  } while (++cell != first);
  DualFace face;
  for (std::size_t i = 1; i + 1 < corner.size(); ++i) {
    const double A = .5 * (corner[i] - corner[0]).cross(corner[i + 1] - corner[0]).dot(N);
    face.A += A;
    face.C += A / 3 * (corner[0] + corner[i] + corner[i + 1]);
  }
  face.C /= face.A;
  face.A = std::abs(face.A);
  return face;
}

TEST(VoronoiDual, CellsAreTheDualOfDelaunaysTriangulation) {
  constexpr Index n = 300;
  const Vec3 size(1.1, .9, 1);
  const auto X = random_points(n, 3, .02 * size, .98 * size, 12);
  const scene::Mesh mesh = surface_of(problem_on(box(size[0], size[1], size[2]), "3D"), .5);
  const Cells cells = make_cells(mesh, 3, 1, X);

  std::vector<std::pair<Kernel::Point_3, Index>> points;
  const auto insert = [&](const Vec3& P, Index a) {
    points.emplace_back(Kernel::Point_3(P[0], P[1], P[2]), a);
  };
  for (Index a = 0; a < n; ++a) {
    insert(X[a], a);
    for (int k = 0; k < 3; ++k)
      for (const double wall : {0.0, size[k]}) {
        Vec3 mirrored = X[a];
        mirrored[k] = 2 * wall - mirrored[k];
        insert(mirrored, n + 6 * a + 2 * k + (wall > 0));
      }
  }
  const Dual dual(points.begin(), points.end());
  std::map<std::pair<Index, Index>, DualFace> expected;  // second: b, or -1 - (2 axis + side)
  for (const Dual::Edge& edge : dual.finite_edges()) {
    auto p = edge.first->vertex(edge.second), q = edge.first->vertex(edge.third);
    if (p->info() > q->info()) std::swap(p, q);
    const Index a = p->info(), b = q->info();
    if (a >= n || (b >= n && (b - n) / 6 != a)) continue;
    const Vec3 N = (vec(q->point()) - vec(p->point())).normalized();
    const DualFace face = dual_face(dual, edge, N);
    if (face.A > 1e-12) expected[{a, b < n ? b : -1 - (b - n) % 6}] = face;
  }
  ASSERT_EQ(cells.faces.size(), expected.size());
  for (const Face& face : cells.faces) {
    Index other = face.b;
    if (face.wall >= 0) {
      int axis = 0;
      const Vec3 N = cells.walls[face.wall].N;
      N.cwiseAbs().maxCoeff(&axis);
      other = -1 - (2 * axis + (N[axis] > 0));
    }
    const auto found = expected.find({face.a, other});
    ASSERT_NE(found, expected.end()) << face.a << " " << other;
    EXPECT_NEAR(face.A, found->second.A, 1e-11);  // circumcentres of slivers lose digits
    if (face.A > 1e-4) {
      EXPECT_LT((face.C - found->second.C).norm(), 1e-8);
    }
  }
}

}  // namespace
}  // namespace concord::particle::voronoi
