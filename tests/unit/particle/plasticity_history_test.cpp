// The history of the particles: lanes against the law of one point, trial and committed states.

#include "plasticity_oracle.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace concord::particle::plasticity_test {
namespace {

constexpr int W = plastic_width;

scene::Problem problem_of(bool plane) {
  scene::Problem problem;
  problem.dimension = plane ? Dimension::plane_strain : Dimension::three_d;
  problem.material = steel();
  return problem;
}

/// One force evaluation: the particles from `first` on in groups of at most `group`.
template <int Dim> class Evaluation {
 public:
  Evaluation(PlasticHistory& history, const std::vector<Mat3>& H, Index first, int group)
      : P(H.size(), Mat3::Zero()), j(H.size()) {
    const int n = static_cast<int>(H.size());
    for (int begin = 0; begin < n; begin += group) {
      const int count = std::min(group, n - begin);
      double h[Dim * Dim][W], p[Dim * Dim][W], jump[W];
      for (int l = 0; l < W; ++l)
        for (int k = 0; k < Dim * Dim; ++k)  // the lanes beyond hold nonsense
          h[k][l] = l < count ? H[begin + l](k % Dim, k / Dim) : -7.0;
      history.stress(first + begin, count, h, p, jump);
      for (int l = 0; l < count; ++l) {
        for (int k = 0; k < Dim * Dim; ++k) P[begin + l](k % Dim, k / Dim) = p[k][l];
        j[begin + l] = jump[l];
      }
    }
  }
  std::vector<Mat3> P;
  std::vector<double> j;
};

/// Gradients of n particles at step k: some elastic, some flowing, some turned, a few far away.
std::vector<Mat3> gradients(int n, int k, bool plane) {
  std::vector<Mat3> H;
  for (int a = 0; a < n; ++a) {
    const auto seed = static_cast<std::uint64_t>(a);
    const double size = a % 4 == 0 ? 1e-4 : a % 4 == 1 ? 3e-3 : a % 4 == 2 ? 0.05 : 0.3;
    Mat3 G = k * size * random_matrix(seed, 0.3, plane) +
             size * random_matrix(97 * seed + static_cast<std::uint64_t>(k), 0.03, plane);
    if (a % 4 == 1 || a % 8 == 2)
      G = random_rotation(seed + static_cast<std::uint64_t>(k), plane) *
              (Mat3::Identity() + G) -
          Mat3::Identity();
    H.push_back(G);
  }
  return H;
}

template <int Dim> void lanes_equal_the_law() {
  const int n = 203;
  PlasticHistory history(problem_of(Dim == 2), n);
  const J2Hencky& law = history.law();
  std::vector<PlasticState> states(n);
  int plastic = 0;
  for (int k = 1; k <= 6; ++k) {
    const std::vector<Mat3> H = gradients(n, k, Dim == 2);
    const Evaluation<Dim> lanes(history, H, 0, W);
    for (int a = 0; a < n; ++a) {
      SCOPED_TRACE(testing::Message() << "particle " << a << " step " << k);
      const PlasticState old = history.committed(a);
      const J2Hencky::Update u = law.update(H[a], old);
      ASSERT_TRUE(u.sound);
      Mat3 P = u.P;
      if (Dim == 2) P(2, 2) = 0;
      // Round-off of the strain, at the largest stress that the strain as a whole carries.
      const Mat3 C = (Mat3::Identity() + H[a]).transpose() * (Mat3::Identity() + H[a]);
      const double strain = (C - Mat3::Identity()).norm() + old.A.norm();
      const double turn = H[a].norm();
      EXPECT_LT((lanes.P[a] - P).norm(),
                1e-13 * P.norm() + 2e-15 * law.shear_modulus() * (strain + turn));
      EXPECT_NEAR(lanes.j[a], scene::volume_change(H[a]), 1e-15 * (1 + turn));
      states[a] = u.state;
      plastic += u.yields;
    }
    history.commit();
    for (int a = 0; a < n; ++a) {
      const PlasticState state = history.committed(a);
      const double eps = states[a].eps_p;
      EXPECT_NEAR(state.eps_p, eps, 1e-13 * eps + 4e-15 * (1 + H[a].norm())) << a;
      EXPECT_LT((state.A - states[a].A).norm(), 1e-13 * (1 + H[a].squaredNorm())) << a;
    }
  }
  EXPECT_GT(plastic, n * 2);
  EXPECT_LT(plastic, n * 5);
}

TEST(PlasticHistory, LanesEqualTheLawInSpace) { lanes_equal_the_law<3>(); }
TEST(PlasticHistory, LanesEqualTheLawInThePlane) { lanes_equal_the_law<2>(); }

template <int Dim> void grouping_changes_no_bit() {
  const int n = 75;
  std::vector<PlasticHistory> histories(5, PlasticHistory(problem_of(Dim == 2), n));
  const int groups[] = {8, 1, 3, 7, 5};
  for (int k = 1; k <= 4; ++k) {
    const std::vector<Mat3> H = gradients(n, k, Dim == 2);
    std::vector<Evaluation<Dim>> all;
    for (int i = 0; i < 5; ++i) {
      all.emplace_back(histories[i], H, 0, groups[i]);
      histories[i].commit();
    }
    for (int i = 1; i < 5; ++i)
      for (int a = 0; a < n; ++a) {
        EXPECT_EQ(all[i].P[a], all[0].P[a]) << a;
        EXPECT_EQ(all[i].j[a], all[0].j[a]) << a;
        EXPECT_EQ(histories[i].committed(a).A, histories[0].committed(a).A) << a;
        EXPECT_EQ(histories[i].committed(a).eps_p, histories[0].committed(a).eps_p) << a;
      }
  }
}

TEST(PlasticHistory, GroupingChangesNoBitInSpace) { grouping_changes_no_bit<3>(); }
TEST(PlasticHistory, GroupingChangesNoBitInThePlane) { grouping_changes_no_bit<2>(); }

TEST(PlasticHistory, TrialsLeaveTheCommittedStateAlone) {
  const int n = 16;
  PlasticHistory history(problem_of(true), n);
  const std::vector<Mat3> H1 = gradients(n, 2, true), H2 = gradients(n, 5, true);
  const Evaluation<2> first(history, H1, 0, W);
  const Evaluation<2> far(history, H2, 0, W);
  const Evaluation<2> again(history, H1, 0, W);
  for (int a = 0; a < n; ++a) {
    EXPECT_EQ(first.P[a], again.P[a]);
    EXPECT_EQ(history.committed(a).eps_p, 0);
    EXPECT_EQ(history.committed(a).A, Mat3::Zero());
  }
  history.commit();
  for (int a = 0; a < n; ++a) {
    const PlasticState state = history.committed(a);
    EXPECT_NEAR(state.eps_p, history.law().update(H1[a], {}).state.eps_p, 1e-14) << a;
  }
  // Committing twice is committing once.
  const PlasticState before = history.committed(2);
  EXPECT_GT(before.eps_p, 0);
  history.commit();
  EXPECT_EQ(history.committed(2).A, before.A);
  EXPECT_EQ(history.committed(2).eps_p, before.eps_p);
}

TEST(PlasticHistory, WritesItsOwnParticlesAlone) {
  const int n = 24;
  PlasticHistory history(problem_of(true), n);
  const std::vector<Mat3> H = gradients(n, 3, true);
  const Evaluation<2> all(history, H, 0, W);
  // Particles 9, 10, 11 once more, at rest: their neighbours keep what they have.
  const Evaluation<2> some(history, std::vector<Mat3>(3, Mat3::Zero()), 9, W);
  EXPECT_EQ(some.P[0], Mat3::Zero());
  history.commit();
  for (int a = 0; a < n; ++a) {
    const double expected = a >= 9 && a < 12 ? 0 : history.law().update(H[a], {}).state.eps_p;
    EXPECT_NEAR(history.committed(a).eps_p, expected, 1e-14) << a;
  }
}

template <int Dim> void marks_bad_particles() {
  const int n = 8;
  PlasticHistory history(problem_of(Dim == 2), n);
  std::vector<Mat3> H = gradients(n, 1, Dim == 2);
  H[2](0, 0) = -1.5;
  H[5](1, 0) = std::nan("");
  const Evaluation<Dim> all(history, H, 0, W);
  for (int a = 0; a < n; ++a) {
    EXPECT_EQ(all.j[a] > -1.0, a != 2 && a != 5) << a;
    EXPECT_EQ(std::isnan(all.j[a]), a == 2 || a == 5) << a;
  }
}

TEST(PlasticHistory, MarksBadParticles) {
  marks_bad_particles<2>();
  marks_bad_particles<3>();
}

}  // namespace
}  // namespace concord::particle::plasticity_test
