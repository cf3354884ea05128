// Which segments cross: by hand, touching and collinear ones too.

#include "particle/core/segments.hpp"

#include <gtest/gtest.h>

namespace concord::particle {
namespace {

Vec3 at(double x, double y) { return {x, y, 0}; }

/// In whichever order the two and their ends are given.
void expect_cross(bool cross, const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  for (const auto& [c, d] : {std::pair(a, b), std::pair(b, a)}) {
    EXPECT_EQ(segments_cross(p, q, c, d), cross) << c.transpose() << " to " << d.transpose();
    EXPECT_EQ(segments_cross(c, d, p, q), cross) << c.transpose() << " to " << d.transpose();
  }
}

}  // namespace

TEST(Segments, CrossWhereTheyHaveAPointWithin) {
  expect_cross(true, at(0, 0), at(2, 0), at(1, -1), at(1, 1));
  expect_cross(true, at(0, 0), at(2, 1), at(0, 1), at(2, 0));
  expect_cross(false, at(0, 0), at(2, 0), at(3, -1), at(3, 1));
  expect_cross(false, at(0, 0), at(2, 0), at(1, 1), at(1, 2));
  expect_cross(false, at(0, 0), at(2, 0), at(0, 1), at(2, 1));
  expect_cross(true, at(0, 0), at(2, 0), Vec3(1, -1, 5), Vec3(1, 1, -3));  // seen along Z
}

TEST(Segments, OfOneLineDoNotCross) {
  expect_cross(false, at(0, 0), at(2, 0), at(1, 0), at(3, 0));
  expect_cross(false, at(0, 0), at(2, 0), at(0, 0), at(2, 0));
  expect_cross(false, at(0, 0), at(2, 0), at(3, 0), at(4, 0));
  expect_cross(false, at(0, 0), at(2, 0), at(1, 0), at(1, 0));
}

/// A segment that ends on another one: only from its right, since the end counts as left.
TEST(Segments, ThatTouchCrossFromOneSide) {
  EXPECT_FALSE(segments_cross(at(0, 0), at(2, 0), at(1, 1), at(1, 0)));
  EXPECT_TRUE(segments_cross(at(0, 0), at(2, 0), at(1, -1), at(1, 0)));
}

/// From one side to the other, through the segment, through one of its ends or past it; with a
/// corner on it as often as without.
TEST(Segments, APathThroughACornerCrossesOnce) {
  const Vec3 p = at(0, 0), q = at(4, 0);
  for (const double x : {0.5, 1.0, 2.0, 3.5}) {
    const Vec3 from = at(1, -2), corner = at(x, 0), to = at(3, 2);
    const int crossings = (segments_cross(p, q, from, corner) ? 1 : 0) +
                          (segments_cross(p, q, corner, to) ? 1 : 0);
    EXPECT_EQ(crossings, 1) << x;
    EXPECT_EQ(segments_cross(q, p, from, corner) != segments_cross(q, p, corner, to), true);
  }
  for (const double x : {-0.5, 4.5}) {
    EXPECT_FALSE(segments_cross(p, q, at(x, -2), at(x, 0)));
    EXPECT_FALSE(segments_cross(p, q, at(x, 0), at(x, 2)));
  }
}

}  // namespace concord::particle
