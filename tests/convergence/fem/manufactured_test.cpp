// A static manufactured solution at finite strain: fitted orders p+1 (displacement, L2) and p
// (gradient) of all elements.
//
// u = a phi with a constant vector a: F = I + a (x) grad phi, J = 1 + a.grad phi, cof F = J I -
// grad phi (x) a (the matrix determinant lemma). For P = mu F + (lambda ln J - mu) F^-T, with
// Div cof F = 0 and g(J) = (lambda ln J - mu)/J,
//   Div P = mu a Lap phi + g'(J) cof F h,  h = grad J = (grad grad phi) a,
//   g' = (lambda + mu - lambda ln J)/J^2, cof F h = J h - grad phi (a.h);  b = -Div P.

#include "fem_scene.hpp"
#include "fit.hpp"

#include "scene/norms.hpp"

#include <tuple>

namespace concord::fem_test {
namespace {

/// phi = prod sin(pi X_i); strains a.grad phi up to 0.4.
struct Solution {
  int dim;
  std::string body_force, exact;
};

std::string product(int dim, const std::string& kinds) {
  std::string out;
  for (int i = 0; i < dim; ++i) {
    const char axis = "XYZ"[i];
    out += fmt::format("{}{}(pi*{})", i ? "*" : "", kinds[i] == 'c' ? "cos" : "sin", axis);
  }
  return out;
}

Solution make_solution(int dim) {
  const std::string a[3] = {"0.08", "0.05", "-0.06"};
  std::string phi = product(dim, "sss"), first[3], second[3][3], J = "1", h[3], ah = "0";
  for (int i = 0; i < dim; ++i) {
    std::string kinds = "sss";
    kinds[i] = 'c';
    first[i] = "(pi*" + product(dim, kinds) + ")";
    J += "+(" + a[i] + ")*" + first[i];
    for (int j = 0; j < dim; ++j) {
      std::string both = "sss";
      both[i] = both[j] = 'c';
      second[i][j] = i == j ? "(-pi^2*" + phi + ")" : "(pi^2*" + product(dim, both) + ")";
    }
  }
  for (int j = 0; j < dim; ++j) {
    h[j] = "(0";
    for (int k = 0; k < dim; ++k) h[j] += "+(" + a[k] + ")*" + second[k][j];
    h[j] += ")";
    ah += "+(" + a[j] + ")*" + h[j];
  }
  Solution out{dim, "[", "["};
  const std::string dg = fmt::format("((lambda+mu-lambda*ln({0}))/({0})^2)", J);
  for (int i = 0; i < dim; ++i) {
    out.exact += fmt::format("{}\"({})*{}\"", i ? ", " : "", a[i], phi);
    out.body_force += fmt::format("{}\"-(mu*({})*(-{}*pi^2*{})+{}*(({})*{}-{}*({})))\"",
                                  i ? ", " : "", a[i], dim, phi, dg, J, h[i], first[i], ah);
  }
  out.exact += "]";
  out.body_force += "]";
  return out;
}

scene::Problem make(const Folder& folder, int dim, const std::string& layout = "lattice") {
  const Solution s = make_solution(dim);
  const std::string dimension = dim == 3 ? "3D" : "plane strain";
  return make_problem(folder, geo_of(dimension),
                      scene_text(dimension, "static = true\nlayout = \"" + layout + "\"",
                                 fmt::format(R"(
[exact]
displacement = {}
[body_force]
value = {}
[[boundary]]
group = "sides"
kind = "displacement"
value = "exact"
)",
                                             s.exact, s.body_force)));
}

struct Orders {
  double displacement, gradient, finest;
};

Orders orders(const scene::Problem& problem, const std::string& element,
              const std::vector<int>& levels, double perturb) {
  std::vector<double> h, e0, e1;
  for (const int n : levels) {
    auto result = run(problem, 1.0 / n, {{"element", element}}, perturb);
    scene::add_exact_errors(problem, result);
    h.push_back(1.0 / n);
    e0.push_back(result.errors.at("displacement_l2"));
    e1.push_back(result.errors.at("gradient_l2"));
    fmt::print(
        "  {} n {:3d}  unknowns {:6d}  newton {:2d}  L2 {:.4e}  gradient {:.4e}  {:.2f} s\n",
        element, n, result.unknowns, result.steps, e0.back(), e1.back(), result.wall_s);
  }
  return {fitted_order(h, e0), fitted_order(h, e1), e0.back()};
}

class Plane : public testing::TestWithParam<std::tuple<std::string, double>> {};

// Finest error at n = 32, measured on lattices and on perturbed meshes: P1 3.92e-3 and 4.19e-3,
// P2 1.73e-5 and 2.63e-5, Q1 9.88e-4 and 1.23e-3, Q2 7.70e-6 and 1.03e-5. The bounds leave 20 %
// above the larger.
TEST_P(Plane, OrdersPPlusOneAndP) {
  const auto [element, perturb] = GetParam();
  const Folder folder;
  const auto result = orders(make(folder, 2), element, {8, 16, 32}, perturb);
  const int p = element[1] - '0';
  EXPECT_NEAR(result.displacement, p + 1, 0.2);
  EXPECT_NEAR(result.gradient, p, 0.2);
  const std::map<std::string, double> bounds{
      {"P1", 5.0e-3}, {"P2", 3.2e-5}, {"Q1", 1.5e-3}, {"Q2", 1.24e-5}};
  EXPECT_LE(result.finest, bounds.at(element));
}

INSTANTIATE_TEST_SUITE_P(All, Plane,
                         testing::Combine(testing::Values("P1", "P2", "Q1", "Q2"),
                                          testing::Values(0.0, 0.2)));

class Solid : public testing::TestWithParam<std::string> {};

TEST_P(Solid, OrdersPPlusOneAndP) {
  const Folder folder;
  const int p = GetParam()[1] - '0';
  const std::vector<int> levels = p == 1 ? std::vector{4, 8, 12} : std::vector{2, 4, 6};
  const auto result = orders(make(folder, 3), GetParam(), levels, 0);
  EXPECT_NEAR(result.displacement, p + 1, 0.35);  // coarse levels: not yet asymptotic
  EXPECT_NEAR(result.gradient, p, 0.25);
}

INSTANTIATE_TEST_SUITE_P(All, Solid, testing::Values("P1", "P2", "Q1", "Q2"));

}  // namespace
}  // namespace concord::fem_test
