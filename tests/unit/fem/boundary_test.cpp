// What method `fem` refuses, and how it says so.

#include "fem_scene.hpp"

#include <gmock/gmock.h>

#include <functional>

namespace concord::fem_test {
namespace {

using testing::HasSubstr;

template <class Error> std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error of the expected kind";
  return "";
}

TEST(Boundary, ContradictionNamesBothGroups) {
  const Folder folder;
  const auto problem =
      make_problem(folder, square_geo(), scene_text("plane strain", "static = true", R"(
[[boundary]]
group = "x0"
kind = "fixed"
[[boundary]]
group = "y0"
kind = "displacement"
value = ["free", "0.1*t"]
)"));
  const auto message = message_of<InputError>([&] { run(problem, 0.5, {{"element", "Q1"}}); });
  EXPECT_THAT(message, HasSubstr("x0"));
  EXPECT_THAT(message, HasSubstr("y0"));
}

TEST(Boundary, StaticsNeedsSupport) {
  const Folder folder;
  const auto problem =
      make_problem(folder, square_geo(), scene_text("plane strain", "static = true", R"(
[[boundary]]
group = "x0"
kind = "symmetric"
)"));
  EXPECT_THAT(message_of<InputError>([&] {
                run(problem, 0.5, {{"element", "P2"}});
              }),
              HasSubstr("rigid motion"));
}

TEST(Boundary, SolverMustFitSceneAndElement) {
  const Folder folder;
  const auto dynamic =
      make_problem(folder, square_geo(), scene_text("plane strain", "end_time = \"1 ms\"", R"(
[initial]
velocity = ["1", "0"]
)"));
  EXPECT_THROW(run(dynamic, 0.5, {{"element", "P1"}, {"solver", "explicit"}}), InputError);
  EXPECT_THROW(run(dynamic, 0.5, {{"solver", "static"}}), InputError);
  EXPECT_THROW(run(dynamic, 0.5, {{"element", "Q3"}}), InputError);
  EXPECT_THROW(run(dynamic, 0.5, {{"elemnt", "Q2"}}), InputError);
}

TEST(Boundary, PointAndFreeComponentsHold) {
  const Folder folder;
  const auto problem =
      make_problem(folder, square_geo(), scene_text("plane strain", "static = true", R"(
[[boundary]]
group = "origin"
kind = "fixed"
[[boundary]]
group = "y0"
kind = "displacement"
value = ["free", "0"]
[[boundary]]
group = "y1"
kind = "displacement"
value = ["free", "-0.1"]
[[quantity]]
name = "top"
kind = "reaction"
group = "y1"
[[quantity]]
name = "bottom"
kind = "reaction"
group = "y0"
[[quantity]]
name = "side"
kind = "average"
group = "x1"
)"));
  for (const char* element : {"P1", "P2", "Q1", "Q2"}) {
    const auto result = run(problem, 0.5, {{"element", element}});
    EXPECT_LT(result.quantities.at("top_y"), -1e4);
    EXPECT_NEAR(result.quantities.at("top_y") + result.quantities.at("bottom_y"), 0, 1e-5);
    EXPECT_NEAR(result.quantities.at("top_x"), 0, 1e-5);
    EXPECT_GT(result.quantities.at("side_x"), 0.01);
    EXPECT_NEAR(result.quantities.at("side_y"), -0.05, 1e-12);
  }
}

TEST(Boundary, FailureTellsStepTimeAndQuantity) {
  const Folder folder;
  // Twice the block's height downwards: no deformation with det F > 0 does that.
  const auto problem =
      make_problem(folder, square_geo(), scene_text("plane strain", "static = true", R"(
[[boundary]]
group = "y0"
kind = "fixed"
[[boundary]]
group = "y1"
kind = "displacement"
value = ["0", "-2*t"]
)"));
  try {
    run(problem, 0.5, {{"element", "Q1"}, {"max_halvings", "3"}});
    FAIL() << "no error";
  } catch (const SolveError& error) {
    EXPECT_GT(error.time(), 0);
    EXPECT_FALSE(error.quantity().empty());
    EXPECT_THAT(error.what(), HasSubstr("halved 3 times"));
  }
}

TEST(Boundary, WholeLoadAtOnceIsDividedWhereNeeded) {
  const Folder folder;
  // Dead pressure that a single Newton step from rest cannot carry.
  const auto problem =
      make_problem(folder, square_geo(), scene_text("plane strain", "static = true", R"(
[[boundary]]
group = "y0"
kind = "fixed"
[[boundary]]
group = "y1"
kind = "traction"
value = ["0", "-1.2e6"]
[[quantity]]
name = "bottom"
kind = "reaction"
group = "y0"
)"));
  const auto result = run(problem, 0.5, {{"element", "Q1"}});
  EXPECT_NEAR(result.quantities.at("bottom_y"), 1.2e6, 1e-2);
}

}  // namespace
}  // namespace concord::fem_test
