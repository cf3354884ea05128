#include "scene/expression.hpp"

#include <Eigen/LU>
#include <cmath>
#include <gtest/gtest.h>

using namespace concord;
using namespace concord::scene;

TEST(Expression, ValuesOfPositionTimeAndParameters) {
  const Expression e("U*sin(pi/2*X) + Y*Z^2 - t", {{"U", 3.0}});
  EXPECT_NEAR(e(Vec3(1, 2, 3), 0.5), 3 + 18 - 0.5, 1e-14);
  EXPECT_TRUE(e.depends_on_time());
  EXPECT_FALSE(Expression("X > 0.5 ? 1 : 0", {}).depends_on_time());
  EXPECT_EQ(Expression("X >= 0.5 ? 1 : 0", {})(Vec3(0.6, 0, 0), 0), 1);
}

TEST(Expression, ZeroIsSeen) {
  EXPECT_TRUE(Expression().is_zero());
  EXPECT_TRUE(Expression("0", {}).is_zero());
  EXPECT_TRUE(Expression("0.0*3", {}).is_zero());
  EXPECT_FALSE(Expression("0*X + 1", {}).is_zero());
}

// A copy must not share the variables of the original: one parser holds addresses.
TEST(Expression, CopiesAreIndependent) {
  auto first = std::make_unique<Expression>("X + t", std::map<std::string, double>{});
  const Expression copy(*first);
  Expression assigned;
  assigned = copy;
  first.reset();
  EXPECT_EQ(copy(Vec3(1, 0, 0), 2), 3);
  EXPECT_EQ(assigned(Vec3(2, 0, 0), 2), 4);
  EXPECT_EQ(copy.text(), "X + t");
}

TEST(Expression, RefusesBadText) {
  for (const char* text : {"", "  ", "1 +", "Q*X", "X = 2", "1, 2", "sin(", "1/0", "X Y"})
    EXPECT_THROW(Expression(text, {{"U", 1}}), InputError) << text;
}

TEST(Expression, UnknownNameListsTheKnownOnes) {
  try {
    const Expression e("Q*X", {{"amplitude", 1}}, {"f", 2, 5}, "initial.displacement.0");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(e.allowed().find("amplitude"), std::string::npos);
    EXPECT_EQ(e.where().line, 2);
  }
}

TEST(VectorExpression, GradientConvergesWithFourthOrder) {
  VectorExpression u;
  u.component = {Expression("sin(X)*cos(2*Y)", {}), Expression("exp(Z)*X", {}), std::nullopt};
  const Vec3 X(0.3, 0.4, 0.5);
  Mat3 exact = Mat3::Zero();
  exact(0, 0) = std::cos(0.3) * std::cos(0.8);
  exact(0, 1) = -2 * std::sin(0.3) * std::sin(0.8);
  exact(1, 0) = std::exp(0.5);
  exact(1, 2) = 0.3 * std::exp(0.5);
  const double coarse = (u.gradient(X, 0, 0.125) - exact).norm();
  const double fine = (u.gradient(X, 0, 0.0625) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.1);
  EXPECT_LT((u.gradient(X, 0, 1e-3) - exact).norm(), 1e-12);
}
