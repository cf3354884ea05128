// Recovery of nodal values from those at quadrature points.

#include "fem_scene.hpp"

#include "fem_reference/recovery.hpp"

#include <deal.II/fe/fe_values.h>

namespace concord::fem_test {
namespace {

/// Largest error at nodes of f recovered from its values at the points of the internal force.
template <int dim, class F>
double recovery_error(const std::string& dimension, const std::string& element, double h,
                      const F& f) {
  const Folder folder;
  const auto problem =
      make_problem(folder, geo_of(dimension), scene_text(dimension, "static = true", R"toml(
[[boundary]]
group = "sides"
kind = "fixed"
)toml"));
  scene::RunRequest request;
  request.h = h;
  request.perturb = 0.2;
  request.settings = {{"element", element}};
  if (dim == 2 && element == "P2") request.settings["quadrature"] = "3";
  const fem::Options options = fem::read_options(problem, request);
  const fem::Discretisation<dim> body(problem, request, options);
  const fem::Recovery<dim> recovery(body);
  dealii::FEValues<dim> values(body.mapping(), body.element().base_element(0),
                               body.force_rule(), dealii::update_quadrature_points);
  std::vector<double> at_points;
  for (const auto& cell : body.triangulation().active_cell_iterators()) {
    values.reinit(cell);
    for (const auto& X : values.get_quadrature_points()) at_points.push_back(f(X[0], X[1]));
  }
  const auto nodal = recovery.at_nodes(at_points);
  double worst = 0;
  for (std::size_t n = 0; n < nodal.size(); ++n) {
    const Vec3& X = body.mesh().nodes[n];
    worst = std::max(worst, std::abs(nodal[n] - f(X.x(), X.y())));
  }
  return worst;
}

TEST(Recovery, LinearFieldsAreExact) {
  const auto linear = [](double x, double y) { return 0.3 + 2 * x - 5 * y; };
  for (const char* element : {"P2", "Q1", "Q2"}) {
    EXPECT_LE(recovery_error<2>("plane strain", element, 0.25, linear), 1e-12) << element;
    EXPECT_LE(recovery_error<3>("3D", element, 0.5, linear), 1e-12) << element;
  }
}

TEST(Recovery, SmoothFieldsConvergeWithTheSecondOrder) {
  const auto smooth = [](double x, double y) { return std::sin(3 * x + y * y); };
  for (const char* element : {"P2", "Q1", "Q2"}) {
    const double coarse = recovery_error<2>("plane strain", element, 1.0 / 8, smooth);
    const double fine = recovery_error<2>("plane strain", element, 1.0 / 32, smooth);
    EXPECT_GT(std::log2(coarse / fine) / 2, 1.6) << element;
    EXPECT_LE(fine, 1e-2);
  }
}

TEST(Recovery, OnePointCellsGiveTheirValue) {
  EXPECT_LE(recovery_error<2>("plane strain", "P1", 0.25, [](double, double) { return 7.0; }),
            1e-13);
  const double slope =
      recovery_error<2>("plane strain", "P1", 1.0 / 32, [](double x, double) { return x; });
  EXPECT_GT(slope, 1e-3);  // first order only, at the sides
  EXPECT_LE(slope, 1.0 / 32);
}

}  // namespace
}  // namespace concord::fem_test
