// What a crack measures, on made-up patterns in a lattice of triangles with spacing 1.

#include "particle/core/crack.hpp"
#include "particle/core/crack_quantities.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace concord::particle {
namespace {

constexpr int columns = 60, rows = 40;
constexpr double height = 0.86602540378443865;  // of a triangle

/// Equilateral triangles; the pre-crack ends at (10, about the middle) and points to the right.
CrackBody lattice() {
  CrackBody body;
  const auto at = [](int i, int j) { return j * columns + i; };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) body.X.emplace_back(i + 0.5 * (j % 2), height * j, 0);
  }
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const int shift =
          j % 2;  // the row above lies half a spacing to the right, or to the left
      body.triangles.push_back({at(i, j), at(i + 1, j), at(i + shift, j + 1)});
      body.triangles.push_back({at(i + 1 - shift, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return body;
}

const Vec3 tip(10.2, 20.2 * height, 0);
const CrackStart start{tip, Vec3::UnitX()};

/// The point `length` from p at an angle.
Vec3 from(const Vec3& p, double length, double degrees) {
  const double angle = degrees * M_PI / 180;
  return p + length * Vec3(std::cos(angle), std::sin(angle), 0);
}

bool crosses(const CrackBody& body, Index t, const Vec3& p, const Vec3& q) {
  const auto side = [](const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0;
  };
  for (int k = 0; k < 3; ++k) {
    const Vec3 a = body.X[body.triangles[t][k]], b = body.X[body.triangles[t][(k + 1) % 3]];
    if (side(p, q, a) != side(p, q, b) && side(a, b, p) != side(a, b, q)) return true;
  }
  return false;
}

/// Triangles that cuts go through, each dead once, at a time a unit of length.
struct Pattern {
  CrackBody body = lattice();
  std::vector<DeadSimplex> dead;
  double t = 0;

  Pattern() { kill(Vec3(-1, tip[1], 0), tip, true); }
  Pattern& cut(const Vec3& p, const Vec3& q) {
    kill(p, q, false);
    return *this;
  }
  CrackPaths paths() const { return crack_paths(body, start, dead, 3); }
  double advance() const {
    CrackTip follower(body, start);
    for (const DeadSimplex& d : dead) follower.add(d);
    return follower.advance();
  }

 private:
  void kill(const Vec3& p, const Vec3& q, bool before) {
    std::vector<std::pair<double, Index>> hit;
    for (Index triangle = 0; triangle < static_cast<Index>(body.triangles.size()); ++triangle) {
      const bool known = std::any_of(dead.begin(), dead.end(), [&](const DeadSimplex& d) {
        return d.simplex == triangle;
      });
      if (!known && crosses(body, triangle, p, q))
        hit.emplace_back((body.centroid(triangle) - p).norm(), triangle);
    }
    std::sort(hit.begin(), hit.end());
    for (const auto& [distance, triangle] : hit)
      dead.push_back({before ? before_start : t + distance, triangle});
    t += (q - p).norm();
  }
};

constexpr double spacing = 1, wiggle = 0.15;  // paths go from centroid to centroid

}  // namespace

TEST(CrackPattern, Straight) {
  Pattern pattern;
  pattern.cut(tip, from(tip, 30, 0));
  EXPECT_NEAR(pattern.advance(), 30, spacing);
  const CrackPaths paths = pattern.paths();
  EXPECT_NEAR(paths.main_length, 30, 30 * wiggle);
  EXPECT_TRUE(paths.branch_lengths.empty());
  EXPECT_TRUE(std::isnan(paths.mean_angle()));
  const Fragments parts = fragments(pattern.body, pattern.dead);
  EXPECT_EQ(parts.pieces, 1);
  EXPECT_EQ(parts.isolated, 0);
  // A cut of length l through a lattice of rows goes through two triangles a spacing.
  EXPECT_NEAR(dead_area(pattern.body, pattern.dead), 30 * height, 2 * height);
}

// The pre-crack of a mesh with a slit takes no triangle: the particle at its tip stands for it.
TEST(CrackPattern, FromASlit) {
  Pattern pattern;
  pattern.dead.clear();
  pattern.cut(from(tip, 5, 90), from(tip, 8, 90));  // elsewhere
  EXPECT_EQ(pattern.advance(), 0);
  EXPECT_EQ(pattern.paths().main_length, 0);
  pattern.cut(tip, from(tip, 30, 0));
  EXPECT_NEAR(pattern.advance(), 30, spacing);
  const CrackPaths paths = pattern.paths();
  EXPECT_NEAR(paths.main_length, 30, 30 * wiggle);
  EXPECT_TRUE(paths.branch_lengths.empty());
}

TEST(CrackPattern, ThroughTheBodyMakesTwoPieces) {
  Pattern pattern;
  pattern.cut(tip, tip + Vec3(columns, 0, 0));
  const Fragments parts = fragments(pattern.body, pattern.dead);
  EXPECT_EQ(parts.pieces, 2);
  EXPECT_EQ(parts.isolated, 0);
}

TEST(CrackPattern, OneFork) {
  Pattern pattern;
  pattern.cut(tip, from(tip, 35, 0)).cut(from(tip, 15, 0), from(from(tip, 15, 0), 12, 40));
  const CrackPaths paths = pattern.paths();
  EXPECT_NEAR(paths.main_length, 35, 35 * wiggle);
  ASSERT_EQ(paths.branch_lengths.size(), 1u);
  EXPECT_NEAR(paths.branch_lengths[0], 12, 2 * spacing);
  ASSERT_EQ(paths.branch_angles.size(), 1u);
  // Centroids of crossed triangles lie within .6 of the line: two chords of 12.
  EXPECT_NEAR(paths.branch_angles[0] * 180 / M_PI, 40, 2 * std::atan(1.2 / 12) * 180 / M_PI);
  EXPECT_NEAR(pattern.advance(), 35, spacing);
}

TEST(CrackPattern, TwoForksAndAnArmTooShort) {
  Pattern pattern;
  const Vec3 one = from(tip, 12, 0), two = from(tip, 24, 0);
  pattern.cut(tip, from(tip, 40, 0)).cut(one, from(one, 14, 50)).cut(two, from(two, 9, -60));
  pattern.cut(from(tip, 32, 0), from(from(tip, 32, 0), 2, 90));
  const CrackPaths paths = pattern.paths();
  EXPECT_NEAR(paths.main_length, 40, 40 * wiggle);
  ASSERT_EQ(paths.branch_lengths.size(), 2u);
  EXPECT_NEAR(paths.branch_lengths[0], 14, 2.5 * spacing);  // the longest comes first
  EXPECT_NEAR(paths.branch_lengths[1], 9, 2.5 * spacing);
  EXPECT_NEAR(paths.branches_length(), paths.branch_lengths[0] + paths.branch_lengths[1],
              1e-12);
}

TEST(CrackPattern, BranchOfABranch) {
  Pattern pattern;
  const Vec3 fork = from(tip, 10, 0), second = from(fork, 8, 45);
  pattern.cut(tip, from(tip, 40, 0)).cut(fork, from(fork, 18, 45));
  pattern.cut(second, from(second, 7, -10));
  EXPECT_EQ(pattern.paths().branch_lengths.size(), 2u);
}

TEST(CrackPattern, SprayOfIsolatedBreaks) {
  Pattern pattern;
  pattern.cut(tip, from(tip, 8, 0));
  const double advance = pattern.advance();
  const CrackPaths before = pattern.paths();
  for (const Index triangle : {200, 1100, 2050, 3300, 4400})
    pattern.dead.push_back({100.0, triangle});
  EXPECT_EQ(pattern.advance(), advance);
  EXPECT_EQ(pattern.paths().main_length, before.main_length);
  EXPECT_TRUE(pattern.paths().branch_lengths.empty());
  EXPECT_EQ(fragments(pattern.body, pattern.dead).pieces, 1);
}

TEST(CrackPattern, BreaksAheadCountWhenTheCrackReachesThem) {
  Pattern pattern;
  CrackTip follower(pattern.body, start);
  std::size_t seen = 0;
  const auto follow = [&] {
    for (; seen < pattern.dead.size(); ++seen) follower.add(pattern.dead[seen]);
  };
  follow();
  EXPECT_EQ(follower.advance(), 0);
  pattern.cut(from(tip, 12, 0), from(tip, 20, 0));
  follow();
  EXPECT_EQ(follower.advance(), 0);
  pattern.cut(tip, from(tip, 6, 0));
  follow();
  EXPECT_NEAR(follower.advance(), 6, spacing);
  pattern.cut(from(tip, 6, 0), from(tip, 12, 0));
  follow();
  EXPECT_NEAR(follower.advance(), 20, spacing);
}

TEST(CrackPattern, ParticleWithoutTrianglesIsIsolated) {
  Pattern pattern;
  const Index lone = 30 * columns + 30;
  for (Index t = 0; t < static_cast<Index>(pattern.body.triangles.size()); ++t) {
    const auto& v = pattern.body.triangles[t];
    if (std::find(v.begin(), v.end(), lone) != v.end()) pattern.dead.push_back({1.0, t});
  }
  const Fragments parts = fragments(pattern.body, pattern.dead);
  EXPECT_EQ(parts.isolated, 1);
  EXPECT_EQ(parts.pieces, 1);
}

// c_R/c_s = 0.9194 at nu = 1/4 in plane strain, where the equation is 3 s^3 - 24 s^2 + 56 s -
// 32 = 0 with the root s = 2 - 2/sqrt(3); Freund, Sec. 2.4.
TEST(RayleighSpeed, ClosedForm) {
  scene::Material material;
  material.E = 1, material.nu = 0.25, material.rho0 = 1;
  material.mu = 0.4, material.lambda = 0.4;
  const double ratio =
      rayleigh_speed(material, Dimension::plane_strain) / material.shear_wave_speed();
  EXPECT_NEAR(ratio, std::sqrt(2 - 2 / std::sqrt(3.0)), 1e-12);
  // In plane stress a plate with nu behaves as in plane strain with nu/(1 + nu).
  material.nu = 1.0 / 3, material.mu = 0.375, material.lambda = 0.75;
  EXPECT_NEAR(rayleigh_speed(material, Dimension::plane_stress) / material.shear_wave_speed(),
              ratio, 1e-12);
}

// A slab of prisms over the lattice, each in three tetrahedra: seen along Z it measures what
// the lattice does.
TEST(Crack, ASlabOfTetrahedraIsMeasuredFromAbove) {
  const CrackBody plane = lattice();
  const auto n = static_cast<Index>(plane.X.size());
  CrackBody slab;
  slab.thickness = 0.5;
  for (const double Z : {0.0, 0.5}) {
    for (const Vec3& X : plane.X) slab.X.emplace_back(X[0], X[1], Z);
  }
  std::vector<DeadSimplex> flat, solid;
  for (Index t = 0; t < static_cast<Index>(plane.triangles.size()); ++t) {
    const Corners& v = plane.triangles[t];
    slab.triangles.emplace_back(v[0], v[1], v[2], v[2] + n);
    slab.triangles.emplace_back(v[0], v[1], v[1] + n, v[2] + n);
    slab.triangles.emplace_back(v[0], v[0] + n, v[1] + n, v[2] + n);
    if (t % 31 != 7) continue;
    flat.push_back({1, t});
    for (Index k = 0; k < 3; ++k) solid.push_back({1, 3 * t + k});
  }
  ASSERT_GT(flat.size(), 3u);
  EXPECT_NEAR(dead_area(slab, solid), dead_area(plane, flat), 1e-12 * dead_area(plane, flat));
  EXPECT_EQ(slab.centroid(0)[2], 0);
  EXPECT_EQ(fragments(slab, solid).pieces, fragments(plane, flat).pieces);
  EXPECT_EQ(fragments(slab, solid).isolated, 2 * fragments(plane, flat).isolated);
}

// Rows at a twentieth of the ligament each; a cost that is linear in the advance comes out
// exactly wherever the marks lie between the rows, and what came before and after does not
// count.
TEST(CrackToll, IsPaidBetweenTenAndNinetyPercent) {
  CrackToll toll;
  toll.add(0, {7, 3});  // before the crack has moved
  toll.add(0, {11, 5});
  for (int k = 1; k <= 16; ++k) {
    const double share = 0.053 * k;
    toll.add(share, {11 + 20 * share, 5 + 10 * share});
    EXPECT_FALSE(toll.paid().has_value());
  }
  toll.add(0.954, {11 + 20 * 0.954, 5 + 10 * 0.954});
  toll.add(1, {1000, 1000});
  ASSERT_TRUE(toll.paid().has_value());
  EXPECT_NEAR(toll.paid()->damping, 16, 1e-12);
  EXPECT_NEAR(toll.paid()->deletion, 8, 1e-12);
}

// From before the first mark to behind the second within one row.
TEST(CrackToll, AJumpCostsItsShare) {
  CrackToll toll;
  toll.add(0, {1, 2});
  toll.add(1, {11, 22});
  ASSERT_TRUE(toll.paid().has_value());
  EXPECT_NEAR(toll.paid()->damping, 8, 1e-12);
  EXPECT_NEAR(toll.paid()->deletion, 16, 1e-12);
}

}  // namespace concord::particle
