// Gradient vectors against Eq. (27) of the Delaunay paper and their identities (29)-(33).

#include "particle/core/body.hpp"
#include "particle/core/reach.hpp"
#include "particle/delaunay/bonds.hpp"
#include "scene/reader.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

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

TEST_P(GradientVectors, AreKeptInRows) {
  const Bonds rows = make_bonds(body, true, Executor(2));
  ASSERT_EQ(rows.count(), bonds.size());
  const double scale = std::pow(body.h, body.dim - 1) * body.thickness;
  std::size_t k = 0;
  for (Index a = 0; a < body.n; ++a) {
    for (Index r = rows.begin[a]; r < rows.begin[a + 1]; ++r, ++k) {
      const Bond bond = bond_of(rows, body.dim, a, r);
      ASSERT_EQ(bond.a, bonds[k].a);
      ASSERT_EQ(bond.b, bonds[k].b);
      EXPECT_LT((bond.B_ab - bonds[k].B_ab).norm() + (bond.B_ba - bonds[k].B_ba).norm(),
                1e-15 * scale);
      const double L = (body.position(bond.b) - body.position(bond.a)).norm();
      EXPECT_DOUBLE_EQ(rows.area_over_length[r], interface_area(body.dim, bonds[k]) / L);
    }
  }
}

TEST_P(GradientVectors, AreTheSameBitsOnAnyNumberOfThreads) {
  const Body fine =
      make_body(problem, problem.reference_length / (body.dim == 3 ? 24 : 140), 0.1,
                9);  // more than one piece; the membrane's right end is finer
  ASSERT_GT(Executor::pieces(fine.n), 1u);
  const Bonds one = make_bonds(fine, true, Executor(1)),
              three = make_bonds(fine, true, Executor(3));
  EXPECT_EQ(one.count(), gradient_vectors(fine).size());
  EXPECT_EQ(one.begin, three.begin);
  EXPECT_EQ(one.other, three.other);
  EXPECT_EQ(one.B, three.B);
  EXPECT_EQ(one.area_over_length, three.area_over_length);
  EXPECT_EQ(one.surface.begin, three.surface.begin);
  EXPECT_EQ(one.surface.other, three.surface.other);
  EXPECT_EQ(one.surface.B_symmetric, three.surface.B_symmetric);
  EXPECT_EQ(one.surface.B_self, three.surface.B_self);
}

TEST_P(GradientVectors, OwnVectorOfBoundaryParticlesClosesTheSum) {  // (29)
  const Bonds rows = make_bonds(body, false, Executor(1));
  const Sums s = sums(body, bonds);
  const double scale = std::pow(body.h, body.dim - 1) * body.thickness;
  ASSERT_EQ(rows.surface.particle.back(), body.n);
  for (std::size_t p = 0; p + 1 < rows.surface.particle.size(); ++p) {
    Vec3 own = Vec3::Zero();
    for (int i = 0; i < body.dim; ++i) own[i] = rows.surface.B_self[p * body.dim + i];
    EXPECT_LT((own + s.over_second[rows.surface.particle[p]]).norm(), 1e-14 * scale);
  }
}

TEST_P(GradientVectors, ReachBoundsTheRows) {
  const Bonds rows = make_bonds(body, false, Executor(1));
  const Reach reach(rows.begin, rows.other);
  std::mt19937_64 generator(3);
  for (int trial = 0; trial < 50; ++trial) {
    const auto cut = static_cast<Index>(generator() % (body.n + 1));
    const Index top = reach.top(cut), bottom = reach.bottom(cut);
    EXPECT_LE(cut, top);
    EXPECT_LE(bottom, cut);
    for (const Bond& bond : bonds) {
      if (bond.a < cut) {
        EXPECT_LT(bond.b, top);
      }
      if (bond.b >= cut) {
        EXPECT_GE(bond.a, bottom);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GradientVectors,
                         testing::Values("swinging_cube", "cooks_membrane", "spinning_block"));

TEST(Deal, CoversThePartsOnceInOrder) {
  const std::vector<ParticleRange> parts{{3, 200}, {500, 501}, {640, 5000}};
  for (const int workers : {1, 2, 3, 7}) {
    const auto dealt = deal(parts, workers);
    ASSERT_EQ(dealt.size(), static_cast<std::size_t>(workers));
    std::vector<int> seen(5001, 0);
    std::size_t most = 0;
    for (const auto& ranges : dealt) {
      std::size_t own = 0;
      for (const ParticleRange& r : ranges) {
        own += r.last - r.first;
        for (Index a = r.first; a < r.last; ++a) ++seen[a];
      }
      most = std::max(most, own);
    }
    for (Index a = 0; a < 5001; ++a) {
      const bool in = std::any_of(parts.begin(), parts.end(), [&](const ParticleRange& r) {
        return a >= r.first && a < r.last;
      });
      EXPECT_EQ(seen[a], in ? 1 : 0) << a;
    }
    EXPECT_LE(most, 4558u / workers + 2 * Reach::chunk);
  }
}

TEST(Deal, GivesLessToWorkersWithWorkBesideTheirRun) {
  const ParticleRange all{0, 100'000};
  const Overlap overlap{3000, 1000};
  for (const int workers : {2, 3, 5}) {
    const auto dealt = deal({&all, 1}, workers, overlap);
    std::vector<double> work;
    for (int w = 0; w < workers; ++w) {
      ASSERT_EQ(dealt[w].size(), 1u);
      EXPECT_EQ(dealt[w][0].first, w > 0 ? dealt[w - 1][0].last : 0);
      work.push_back(dealt[w][0].last - dealt[w][0].first + (w > 0 ? overlap.below : 0) +
                     (w + 1 < workers ? overlap.above : 0));
    }
    EXPECT_EQ(dealt.back()[0].last, all.last);
    for (const double one : work) EXPECT_NEAR(one, work[0], 2 * Reach::chunk);
  }
  // More overlap than particles: everything is still done once.
  const auto dealt = deal({&all, 1}, 3, {1e6, 1e6});
  Index done = 0;
  for (const auto& ranges : dealt) {
    for (const ParticleRange& r : ranges) {
      EXPECT_EQ(r.first, done);
      done = r.last;
    }
  }
  EXPECT_EQ(done, all.last);
}

}  // namespace
}  // namespace concord::particle::delaunay
