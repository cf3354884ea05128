// Gradient vectors against Eq. (27) of the Delaunay paper and their identities (29)-(33).

#include "particle/core/body.hpp"
#include "particle/delaunay/bonds.hpp"
#include "scene/reader.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <map>

namespace concord::particle::delaunay {
namespace {

struct Sums {
  std::vector<Vec3> over_second;  ///< sum_b B_ab without b = a
  std::vector<Vec3> over_first;   ///< sum_a B_ab without a = b
  std::vector<Mat3> duality;      ///< sum_b X_ab (x) B_ab
};

Sums sums(const Body& body, const std::vector<Bond>& bonds) {
  Sums s{std::vector<Vec3>(body.n, Vec3::Zero()), std::vector<Vec3>(body.n, Vec3::Zero()),
         std::vector<Mat3>(body.n, Mat3::Zero())};
  for (const Bond& bond : bonds) {
    s.over_second[bond.a] += bond.B_ab;
    s.over_second[bond.b] += bond.B_ba;
    s.over_first[bond.b] += bond.B_ab;
    s.over_first[bond.a] += bond.B_ba;
    const Vec3 X_ab = body.position(bond.b) - body.position(bond.a);
    s.duality[bond.a] += X_ab * bond.B_ab.transpose();
    s.duality[bond.b] -= X_ab * bond.B_ba.transpose();
  }
  return s;
}

class GradientVectors : public testing::TestWithParam<const char*> {
 protected:
  scene::Problem problem = scene::read_problem(GetParam());
  Body body = make_body(problem, problem.reference_length / 5, 0.3, 9);
  std::vector<Bond> bonds = gradient_vectors(body);
};

TEST_P(GradientVectors, AreDualToBranchVectors) {  // (33)
  const Sums s = sums(body, bonds);
  for (Index a = 0; a < body.n; ++a) {
    Mat3 I = Mat3::Identity();
    if (body.dim == 2) I(2, 2) = 0;
    EXPECT_LT((s.duality[a] / body.V[a] - I).norm(), 1e-13);
  }
}

TEST_P(GradientVectors, SumToZeroOffTheBoundary) {  // (29), (31): B_aa = 0 there
  const Sums s = sums(body, bonds);
  const double scale = std::pow(body.h, body.dim - 1) * body.thickness;
  int interior = 0;
  for (Index a = 0; a < body.n; ++a) {
    if (body.triangulation.on_boundary[a]) continue;
    ++interior;
    EXPECT_LT(s.over_second[a].norm(), 1e-13 * scale);
    EXPECT_LT(s.over_first[a].norm(), 1e-13 * scale);
  }
  EXPECT_GT(interior, 0);
}

TEST_P(GradientVectors, AreAntisymmetricUnlessBothEndsAreOnTheBoundary) {  // (30)
  int surface_bonds_that_differ = 0;
  for (const Bond& bond : bonds) {
    const bool both =
        body.triangulation.on_boundary[bond.a] && body.triangulation.on_boundary[bond.b];
    if (!both)
      EXPECT_EQ(bond.B_ab, -bond.B_ba);
    else
      surface_bonds_that_differ += (bond.B_ab + bond.B_ba).norm() > 1e-6 * bond.B_ab.norm();
  }
  EXPECT_GT(surface_bonds_that_differ, 0);
}

/// (27): B_ab = 1/(n (n+1)) sum of the area vectors of the cluster's faces at b; the faces of
/// C_a are those opposite to a in each simplex at a, and, for a on the boundary, the boundary
/// facets at a.
TEST_P(GradientVectors, EqualTheSumOverFacesOfTheCluster) {
  const int n = body.dim, nv = n + 1;
  std::map<std::pair<Index, Index>, Vec3> by_faces;
  const auto area = [&](const Index* v) {
    if (n == 2) {
      const Vec3 e = body.position(v[1]) - body.position(v[0]);
      return Vec3(e[1], -e[0], 0);
    }
    return Vec3(0.5 * (body.position(v[1]) - body.position(v[0]))
                          .cross(body.position(v[2]) - body.position(v[0])));
  };
  const auto add_face = [&](Index a, const Index* v) {
    for (int k = 0; k < n; ++k)
      by_faces.try_emplace({a, v[k]}, Vec3::Zero()).first->second += area(v) / (n * nv);
  };
  const Triangulation& t = body.triangulation;
  for (std::size_t s = 0; s < t.size(); ++s) {
    const Index* v = &t.simplices[s * nv];
    constexpr int face3[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (int k = 0; k < nv; ++k) {
      Index face[3] = {0, 0, 0};
      for (int i = 0; i < n; ++i) face[i] = n == 3 ? v[face3[k][i]] : v[(k + 1 + i) % 3];
      add_face(v[k], face);
    }
  }
  for (std::size_t f = 0; f < t.boundary_entity.size(); ++f) {
    for (int k = 0; k < n; ++k) add_face(t.boundary[f * n + k], &t.boundary[f * n]);
  }
  const double scale = std::pow(body.h, n - 1) * body.thickness;
  for (const Bond& bond : bonds) {
    EXPECT_LT((bond.B_ab - by_faces.at({bond.a, bond.b}) * body.thickness).norm(),
              1e-13 * scale);
    EXPECT_LT((bond.B_ba - by_faces.at({bond.b, bond.a}) * body.thickness).norm(),
              1e-13 * scale);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GradientVectors,
                         testing::Values("swinging_cube", "cooks_membrane", "spinning_block"));

TEST(BondBlocks, KeepEveryBondOnceInsideAndTwiceAcross) {
  const scene::Problem problem = scene::read_problem("swinging_cube");
  const Body body = make_body(problem, 1.0 / 33, 0.2, 1);
  const std::vector<Bond> bonds = gradient_vectors(body);
  const Bonds blocked = block_bonds(body, bonds, {});
  ASSERT_GE(blocked.blocks.size(), 2u);
  std::size_t kept = 0, cut = 0;
  for (const BondBlock& block : blocked.blocks) {
    for (const BondRows* rows : {&block.regular, &block.surface}) {
      for (std::size_t r = 0; r + 1 < rows->begin.size(); ++r) {
        kept += rows->cut[r] - rows->begin[r];
        cut += rows->begin[r + 1] - rows->cut[r];
        for (Index k = rows->begin[r]; k < rows->begin[r + 1]; ++k) {
          const bool inside = rows->other[k] >= block.first && rows->other[k] < block.last;
          EXPECT_EQ(inside, k < rows->cut[r]);
        }
      }
    }
  }
  EXPECT_EQ(kept + cut / 2, bonds.size());
  EXPECT_EQ(cut % 2, 0u);
}

}  // namespace
}  // namespace concord::particle::delaunay
