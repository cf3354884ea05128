// Delaunay cells: the same for every number of threads and every way to them, on points in
// general and in special position.

#include "particle/core/delaunay_cells.hpp"
#include "particle/core/triangulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace concord::particle {
namespace {

/// Facets without their order.
std::set<std::array<Index, 3>> facet_set(const HullCells& hull) {
  std::set<std::array<Index, 3>> facets;
  for (std::size_t f = 0; f < hull.facets.size(); f += 3) {
    std::array<Index, 3> v{hull.facets[f], hull.facets[f + 1], hull.facets[f + 2]};
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());  // keeps orientation
    facets.insert(v);
  }
  return facets;
}

double volume_of(const HullCells& hull, const std::vector<Vec3>& X) {
  double volume = 0;
  std::array<Vec3, 4> P, g;
  for (std::size_t s = 0; s < hull.cells.size(); s += 4) {
    for (int k = 0; k < 4; ++k) P[k] = X[hull.cells[s + k]];
    volume += volume_gradients(3, P, g);
  }
  return volume;
}

/// Lattice points of a block, moved by up to `perturb` spacings inside it and in its faces,
/// slab by slab.
std::vector<Vec3> block(int nx, int ny, int nz, double perturb) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> random(-perturb, perturb);
  const auto place = [&](int i, int n) {
    return i == 0 || i == n - 1 ? i : i + random(generator);
  };
  std::vector<Vec3> X;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) X.emplace_back(place(i, nx), place(j, ny), place(k, nz));
  return X;
}

void expect_threads_do_not_matter(const std::vector<Vec3>& X) {
  const HullCells one = delaunay_cells(3, X, Executor(1));
  ASSERT_FALSE(one.cells.empty());
  for (const int threads : {2, 3, 5}) {
    const HullCells many = delaunay_cells(3, X, Executor(threads));
    EXPECT_EQ(many.cells, one.cells) << threads << " threads";
    EXPECT_EQ(facet_set(many), facet_set(one)) << threads << " threads";
  }
}

TEST(DelaunayCells, AreTheSameForEveryNumberOfThreads) {
  for (const double perturb : {0.25, 0.45})
    expect_threads_do_not_matter(block(64, 7, 6, perturb));
}

TEST(DelaunayCells, AreTheSameForCosphericalPointsThatAreNoGrid) {
  std::vector<Vec3> X = block(64, 6, 6, 0);
  X.erase(X.begin() + 1000, X.begin() + 1013);
  ASSERT_FALSE(lattice_cells(X));
  expect_threads_do_not_matter(X);
}

TEST(DelaunayCells, AreTheSameForCloudsWithWideGapsAndForUnsortedNumbers) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::vector<Vec3> X;  // a thin curved shell: spheres around its cells are wide
  for (int k = 0; k < 3000; ++k) {
    Vec3 x(normal(generator), normal(generator), normal(generator));
    X.push_back(x.normalized().cwiseProduct(Vec3(40, 1, 1)) * (1 + 1e-3 * normal(generator)));
  }
  expect_threads_do_not_matter(X);
}

TEST(DelaunayCells, FillTheHullWithPositiveCells) {
  const std::vector<Vec3> X = block(30, 5, 6, 0.3);
  const HullCells hull = delaunay_cells(3, X, Executor(2));
  EXPECT_NEAR(volume_of(hull, X), 29 * 4 * 5, 1e-9);
  std::array<Vec3, 4> P, g;
  for (std::size_t s = 0; s < hull.cells.size(); s += 4) {
    for (int k = 0; k < 4; ++k) P[k] = X[hull.cells[s + k]];
    ASSERT_GT(volume_gradients(3, P, g), 0);
    ASSERT_LT(hull.cells[s], hull.cells[s + 1]);
    ASSERT_LT(hull.cells[s + 1], std::min(hull.cells[s + 2], hull.cells[s + 3]));
  }
}

TEST(LatticeCells, AreThoseOfTheExactPredicates) {
  // Uneven grids, numbered at random: every box is cospherical to the last bit.
  std::vector<Vec3> X;
  for (const double x : {0.0, 0.1, 0.7, 0.8, 1.3})
    for (const double y : {-1.0, 0.3, 0.4})
      for (const double z : {0.0, 1 / 3.0, 2 / 3.0, 1.0}) X.emplace_back(x, y, z);
  std::shuffle(X.begin(), X.end(), std::mt19937_64(11));
  const auto lattice = lattice_cells(X);
  ASSERT_TRUE(lattice);
  const HullCells exact = delaunay_cells(3, X, Executor(1));
  EXPECT_EQ(lattice->cells, exact.cells);
  EXPECT_EQ(facet_set(*lattice), facet_set(exact));
  EXPECT_NEAR(volume_of(*lattice, X), 1.3 * 1.4 * 1.0, 1e-14);
}

TEST(LatticeCells, NeedAWholeGrid) {
  std::vector<Vec3> X = block(4, 3, 3, 0);
  EXPECT_TRUE(lattice_cells(X));
  std::vector<Vec3> moved = X;
  moved[13][1] += 1e-15;
  EXPECT_FALSE(lattice_cells(moved));
  X.pop_back();
  EXPECT_FALSE(lattice_cells(X));
  EXPECT_FALSE(lattice_cells(block(4, 4, 1, 0)));
}

}  // namespace
}  // namespace concord::particle
