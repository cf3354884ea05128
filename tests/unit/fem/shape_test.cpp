// Shape functions in gmsh's node order.

#include "fem_reference/shape.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace concord::fem {
namespace {

class Shape : public testing::TestWithParam<std::tuple<int, scene::CellShape, int>> {
 protected:
  LagrangeShape m_shape{std::get<0>(GetParam()), std::get<1>(GetParam()),
                        std::get<2>(GetParam())};
};

TEST_P(Shape, IsOneAtItsNodeAndZeroAtTheOthers) {
  std::vector<double> N(m_shape.node_count());
  for (int b = 0; b < m_shape.node_count(); ++b) {
    m_shape.evaluate(m_shape.unit_nodes()[b], N, {});
    for (int a = 0; a < m_shape.node_count(); ++a) EXPECT_NEAR(N[a], a == b ? 1 : 0, 1e-15);
  }
}

TEST_P(Shape, SumsToOneAndReproducesPosition) {
  std::vector<double> N(m_shape.node_count());
  std::vector<Vec3> dN(m_shape.node_count());
  Vec3 xi(0.31, 0.17, 0.23);
  for (int i = m_shape.dim(); i < 3; ++i) xi[i] = 0;
  m_shape.evaluate(xi, N, dN);
  double sum = 0;
  Vec3 place = Vec3::Zero(), slope = Vec3::Zero();
  for (int a = 0; a < m_shape.node_count(); ++a) {
    sum += N[a];
    place += N[a] * m_shape.unit_nodes()[a];
    slope += dN[a];
  }
  EXPECT_NEAR(sum, 1, 1e-15);
  EXPECT_LE((place - xi).norm(), 1e-15);
  EXPECT_LE(slope.norm(), 1e-14);
  EXPECT_EQ(m_shape.excess(xi), 0);
}

TEST_P(Shape, GradientIsTheDerivative) {
  const int n = m_shape.node_count();
  std::vector<double> N(n), plus(n), minus(n);
  std::vector<Vec3> dN(n);
  const Vec3 xi(0.2, 0.1, 0.3);
  m_shape.evaluate(xi, N, dN);
  for (int i = 0; i < m_shape.dim(); ++i) {
    m_shape.evaluate(xi + 1e-3 * Vec3::Unit(i), plus, {});
    m_shape.evaluate(xi - 1e-3 * Vec3::Unit(i), minus, {});
    // Quadratic in each coordinate at most: central differences are exact.
    for (int a = 0; a < n; ++a) EXPECT_NEAR((plus[a] - minus[a]) / 2e-3, dN[a][i], 1e-11);
  }
}

/// Shapes of cells: lines are facets only and never written.
class CellShapes : public Shape {};

TEST_P(CellShapes, VtkOrderHoldsEveryNodeOnce) {
  std::vector<int> order = m_shape.vtk_order();
  ASSERT_EQ(order.size(), static_cast<std::size_t>(m_shape.node_count()));
  std::sort(order.begin(), order.end());
  for (int a = 0; a < m_shape.node_count(); ++a) EXPECT_EQ(order[a], a);
}

INSTANTIATE_TEST_SUITE_P(All, Shape,
                         testing::Combine(testing::Values(1, 2, 3),
                                          testing::Values(scene::CellShape::simplex,
                                                          scene::CellShape::hypercube),
                                          testing::Values(1, 2)));

INSTANTIATE_TEST_SUITE_P(All, CellShapes,
                         testing::Combine(testing::Values(2, 3),
                                          testing::Values(scene::CellShape::simplex,
                                                          scene::CellShape::hypercube),
                                          testing::Values(1, 2)));

TEST(ShapeOrder, TetrahedronSwapsGmshsLastTwoNodesForVtk) {
  const LagrangeShape shape(3, scene::CellShape::simplex, 2);
  EXPECT_EQ(shape.vtk_order(), (std::vector{0, 1, 2, 3, 4, 5, 6, 7, 9, 8}));
}

}  // namespace
}  // namespace concord::fem
