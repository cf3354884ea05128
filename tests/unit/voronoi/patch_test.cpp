// The patch tests of the paper (Sec. 6.1): unit cube, E = 1 MPa, nu = 0.3, displacement (52)
// with alpha = 1e-4.

#include "particle/core/elastic.hpp"
#include "scene/material.hpp"
#include "tests/unit/voronoi/bodies.hpp"

namespace concord::particle::voronoi::test {
namespace {

using enum scene::BoundaryKind;

Mat3 gradient() {
  Mat3 H;
  H << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  return 1e-4 * H;
}

struct Patch : Block {
  Patch(int n, unsigned seed, const std::vector<Given>& given) : Block(cube(n, given, seed)) {
    scene::Material& m = problem.material;
    m.E = 1e6, m.nu = 0.3;
    m.lambda = m.E * m.nu / ((1 + m.nu) * (1 - 2 * m.nu));
    m.mu = m.E / (2 * (1 + m.nu));
    m.rho0 = 1000;
  }
  Vec3 traction(const Vec3& N) const {
    return scene::ElasticLaw(problem.material, problem.dimension).stress(gradient()) * N;
  }
  /// Largest force on a particle under the affine field.
  double unbalanced(const Parameters& parameters) const {
    const auto m = model(parameters);
    Column f = force(*m, affine(gradient()));
    add_loads(
        *m, [&](const Vec3& N) { return traction(N); }, f);
    double worst = 0;
    for (Index a = 0; a < body.bulk; ++a) worst = std::max(worst, at(f, a).norm());
    return worst;
  }
  /// Largest error of the equilibrium reached from rest.
  double error_at_rest(const Parameters& parameters) const {
    const auto m = model(parameters);
    Column u = affine(gradient());
    for (Index a = 0; a < body.bulk; ++a)
      for (int i = 0; i < body.dim; ++i) u[static_cast<std::size_t>(a) * body.stride + i] = 0;
    return error(solve(*m, u, [&](const Vec3& N) { return traction(N); }), gradient());
  }
};

std::vector<Given> loaded() {  // test C: the bottom prescribed, tractions elsewhere
  std::vector<Given> given = on_all_faces(traction);
  given[4] = {"z0", displacement};
  return given;
}

class PatchTests : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Edge, PatchTests, testing::Values(3, 4, 6));

TEST_P(PatchTests, TheFaceCompatibleFormPassesAllThree) {
  const int n = GetParam(), seeds = n == 3 ? 20 : n == 4 ? 4 : 1;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto s = static_cast<unsigned>(seed);
    EXPECT_LE(Patch(n, s, on_all_faces(displacement)).unbalanced({}), 1e-9) << seed;
    EXPECT_LE(Patch(n, s, loaded()).unbalanced({}), 1e-9) << seed;
    EXPECT_LE(Patch(n, s, on_all_faces(displacement)).error_at_rest({}), 1e-15) << seed;
    EXPECT_LE(Patch(n, s, loaded()).error_at_rest({}), 1e-15) << seed;
  }
}

/// The paper's size, 10^3.
TEST(PatchTestsOfThePaper, HoldAtTheSizeOfThePaper) {
  EXPECT_LE(Patch(10, 1, on_all_faces(displacement)).unbalanced({}), 1e-9);
  EXPECT_LE(Patch(10, 1, loaded()).unbalanced({}), 1e-9);
}

TEST(PaperForms, TheStaticOnePassesAllThree) {
  const Parameters form{1, 1, 0, 0, Form::quasi_static};
  EXPECT_LE(Patch(3, 1, on_all_faces(displacement)).unbalanced(form), 1e-9);
  EXPECT_LE(Patch(3, 1, on_all_faces(displacement)).error_at_rest(form), 1e-15);
  EXPECT_LE(Patch(3, 1, loaded()).error_at_rest(form), 1e-15);
}

TEST(PaperForms, TheConservingOneFailsTestCOnFreeFaces) {
  const Parameters form{1, 1, 0, 0, Form::conserving};
  EXPECT_LE(Patch(3, 1, on_all_faces(displacement)).unbalanced(form), 1e-9);
  EXPECT_LE(Patch(3, 1, on_all_faces(displacement)).error_at_rest(form), 1e-15);
  EXPECT_GT(Patch(3, 1, loaded()).error_at_rest(form), 1e-5);
}

}  // namespace
}  // namespace concord::particle::voronoi::test
