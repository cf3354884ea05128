#include "scene/exact_samples.hpp"
#include "scene/norms.hpp"
#include "scene/reader.hpp"

#include <Eigen/LU>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace concord;
using namespace concord::scene;
namespace fs = std::filesystem;

namespace {

/// The exact field of a problem times a factor.
class Scaled : public Field {
 public:
  Scaled(const Problem& problem, double factor) : m_problem(problem), m_factor(factor) {}
  void evaluate(std::span<const Vec3> X, std::span<Vec3> u,
                std::span<Mat3> gradient) const override {
    for (std::size_t i = 0; i < X.size(); ++i) {
      u[i] = m_factor * (*m_problem.exact_displacement)(X[i], m_problem.end_time);
      if (!gradient.empty())
        gradient[i] = m_factor * m_problem.exact_gradient(X[i], m_problem.end_time);
    }
  }

 private:
  const Problem& m_problem;
  double m_factor;
};

}  // namespace

TEST(Norms, RelativeL2ByHand) {
  const std::vector<Vec3> a{Vec3(1, 0, 0), Vec3(0, 2, 0)}, b{Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::vector<double> w{1, 3};
  EXPECT_DOUBLE_EQ(relative_l2(a, b, w), std::sqrt(3.0 / 4));
  const std::vector<Vec3> zero(2, Vec3::Zero());
  EXPECT_DOUBLE_EQ(relative_l2(a, zero, w), std::sqrt(1 + 3 * 4.0));  // absolute
}

TEST(Norms, ScaledSolutionHasTheScaleAsError) {
  const Problem p = read_problem("swinging_cube");
  Result r;
  r.t_end = p.end_time;
  r.field = std::make_shared<Scaled>(p, 1.01);
  for (double x = 0.1; x < 1; x += 0.2) {
    const Vec3 X(x, 0.5 * x, 1 - x);
    r.samples.X.push_back(X);
    r.samples.u.push_back(1.02 * (*p.exact_displacement)(X, r.t_end));
    r.samples.v.push_back(0.97 * (*p.exact_velocity)(X, r.t_end));
    r.samples.F.push_back(Mat3::Identity() + 1.04 * p.exact_gradient(X, r.t_end));
    r.samples.weight.push_back(x);
  }
  add_exact_errors(p, r);
  EXPECT_NEAR(r.errors.at("displacement_l2"), 0.02, 1e-12);
  EXPECT_NEAR(r.errors.at("velocity_l2"), 0.03, 1e-12);
  EXPECT_NEAR(r.errors.at("gradient_l2"), 0.04, 1e-10);
  EXPECT_NEAR(r.errors.at("displacement_l2_common"), 0.01, 1e-12);
  EXPECT_NEAR(r.errors.at("gradient_l2_common"), 0.01, 1e-10);
  EXPECT_NEAR(field_difference(p, *r.field, Scaled(p, 1)), 0.01, 1e-12);
  EXPECT_GT(r.errors.at("displacement_max"), 0);
}

class KeptSamples : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(m_folder);
    setenv("CONCORD_CACHE", m_folder.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("CONCORD_CACHE");
    fs::remove_all(m_folder);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& file : fs::directory_iterator(m_folder / "exact"))
      found.push_back(file.path());
    return found;
  }
  static void expect_same(const ExactSamples& a, const ExactSamples& b) {
    EXPECT_EQ(a.rule.points, b.rule.points);
    EXPECT_EQ(a.rule.weights, b.rule.weights);
    EXPECT_EQ(a.u, b.u);
    EXPECT_EQ(a.gradient, b.gradient);
  }

  fs::path m_folder =
      fs::path(testing::TempDir()) / ("concord-exact-" + std::to_string(::getpid()));
};

TEST_F(KeptSamples, HaveTheBitsOfComputedOnes) {
  const Problem p = read_problem("vortex");
  unsetenv("CONCORD_CACHE");
  const ExactSamples computed = exact_samples(p, p.end_time);
  ASSERT_GT(computed.u.size(), 100u);
  setenv("CONCORD_CACHE", m_folder.c_str(), 1);
  expect_same(exact_samples(p, p.end_time), computed);
  ASSERT_EQ(files().size(), 1u);
  const auto written = fs::last_write_time(files()[0]);
  expect_same(exact_samples(p, p.end_time), computed);
  EXPECT_EQ(fs::last_write_time(files()[0]), written) << "read, not written again";

  std::fstream damage(files()[0], std::ios::in | std::ios::out | std::ios::binary);
  damage.seekp(-8, std::ios::end);
  damage.put('!');
  damage.close();
  expect_same(exact_samples(p, p.end_time), computed);

  exact_samples(p, 0.5 * p.end_time);
  EXPECT_EQ(files().size(), 2u) << "another time is another file";
}

TEST(Norms, NothingWithoutAnExactSolution) {
  const Problem p = read_problem("cooks_membrane");
  Result r;
  add_exact_errors(p, r);
  EXPECT_TRUE(r.errors.empty());
}

// Eq. (29) of the Continuum Bond Method paper, without its factor 100.
TEST(Norms, FieldErrorByHand) {
  const std::vector<double> reference{3, 0, 4}, value{3, 2, 3};
  EXPECT_DOUBLE_EQ(field_error(reference, value), std::sqrt(5.0) / 5);
  EXPECT_DOUBLE_EQ(field_error(value, reference), std::sqrt(5.0) / std::sqrt(22.0))
      << "the first is the reference";
  EXPECT_EQ(field_error(reference, reference), 0);
  const std::vector<double> zero(3, 0);
  EXPECT_THROW(field_error(zero, value), std::invalid_argument);
}
