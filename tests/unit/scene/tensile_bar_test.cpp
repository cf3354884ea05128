// The library's tensile bar: its shape by hand, its arrangements, its motion.

#include "scene/geometry.hpp"
#include "scene/reader.hpp"

#include <cmath>
#include <gtest/gtest.h>

using namespace concord;
using namespace concord::scene;

namespace {

Mesh bar(const std::vector<Override>& overrides, double h = 0.55e-3, int order = 1) {
  const Problem problem = read_problem("tensile_bar", overrides);
  return make_mesh(problem, {h, CellShape::simplex, order, problem.layout});
}

/// Neck, grips and, between them, 2 (w + R) R minus two quarters of a circle [m^2].
double area(double grip, double R) {
  const double w = 3e-3, neck = 18e-3, height = 40e-3;
  const double ends = height - neck - 2 * R;
  return 2 * w * neck + grip * ends + 2 * (2 * (w + R) * R - M_PI * R * R / 2);
}

}  // namespace

TEST(TensileBar, HasTheAreaOfNeckGripsAndFillets) {
  // Chords of the fillets add about h^2/(12 R) of area along their length: 3e-4 of the whole.
  EXPECT_NEAR(mesh_volume(bar({})), area(18e-3, 6e-3), 5e-4 * area(18e-3, 6e-3));
  EXPECT_NEAR(mesh_volume(bar(
                  {{"parameters.grip_width", "12 mm"}, {"parameters.fillet_radius", "3 mm"}})),
              area(12e-3, 3e-3), 1e-3 * area(12e-3, 3e-3));
  EXPECT_NEAR(mesh_volume(bar(
                  {{"parameters.grip_width", "20 mm"}, {"parameters.fillet_radius", "4 mm"}})),
              area(20e-3, 4e-3), 1e-3 * area(20e-3, 4e-3))
      << "a straight shoulder";
}

TEST(TensileBar, ArrangementsAreThoseAskedFor) {
  const std::size_t free = bar({}).nodes.size();
  EXPECT_NEAR(static_cast<double>(free), 1800, 0.05 * 1800) << "the paper's particles";
  EXPECT_NE(bar({{"parameters.algorithm", "6"}}).nodes.size(), free);
  for (const char* rows : {"1", "2"}) {
    const Mesh mesh = bar({{"parameters.neck_mesh", rows}});
    int in_neck = 0;
    for (const Vec3& X : mesh.nodes) in_neck += std::abs(X[1] - 20e-3) < 9e-3 + 1e-9;
    EXPECT_EQ(in_neck, 34 * 12) << "round(18/.55) and round(6/.55) spacings";
    EXPECT_NEAR(mesh_boundary_area(mesh), mesh_boundary_area(bar({})), 1e-4)
        << "the rows' ends are inside";
  }
}

TEST(TensileBar, QuadraticNodesLieOnTheFillets) {
  const Mesh mesh = bar({}, 4e-3, 2);
  int on_fillet = 0;
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    const Entity& entity = mesh.entities[static_cast<std::size_t>(mesh.node_entity[a])];
    if (entity.dim != 1 || entity.flat) continue;
    const Vec3& X = mesh.nodes[a];
    const Vec3 centre(std::copysign(9e-3, X[0]), X[1] < 20e-3 ? 11e-3 : 29e-3, 0);
    EXPECT_NEAR((X - centre).norm(), 6e-3, 1e-12);
    ++on_fillet;
  }
  EXPECT_GE(on_fillet, 4 * 3);
}

TEST(TensileBar, FilletsThatDoNotFitAreAnError) {
  EXPECT_THROW(bar({{"parameters.fillet_radius", "7 mm"}}), InputError);
  EXPECT_THROW(bar({{"parameters.grip_width", "10 mm"}}), InputError);
}

// Its second derivative is Eq. (26): 120/T^5 t^3 - 180/T^4 t^2 + 60/T^3 t, times U.
TEST(TensileBar, TheTopMovesByEquation26) {
  const double U = 2e-3, tau = 0.8;
  const Problem problem = read_problem("tensile_bar", {{"parameters.tau", "0.8"}});
  const auto top = [&](double t) {
    for (const BoundaryCondition& bc : problem.boundaries)
      if (bc.group == "top") return bc.value(Vec3::Zero(), t)[1];
    throw std::runtime_error("no top");
  };
  EXPECT_EQ(top(0), 0);
  EXPECT_NEAR(top(tau), U, 1e-18);
  EXPECT_NEAR(top(1), U, 1e-18) << "and rests";
  for (const double t : {0.1, 0.37, 0.6}) {
    const double d = 1e-3, acceleration = (top(t + d) - 2 * top(t) + top(t - d)) / (d * d);
    EXPECT_NEAR(acceleration,
                U * (120 * std::pow(t, 3) / std::pow(tau, 5) - 180 * t * t / std::pow(tau, 4) +
                     60 * t / std::pow(tau, 3)),
                1e-4 * U);
  }
}
