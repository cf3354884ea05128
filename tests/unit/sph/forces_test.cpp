// Properties of the forces: exact gradients of affine fields, derivatives of the potential,
// both momenta, tangent, rotation.

#include "sample.hpp"

#include <gtest/gtest.h>

namespace concord::sph {
namespace {

struct Case {
  Dimension dimension;
  scene::MaterialModel model;
  KernelShape kernel;
  PenaltyForm penalty;
  double psi;
};

Body body_of(const Case& c) {
  return space_dim(c.dimension) == 3 ? lattice(3, 5, 0.25) : lattice(2, 8, 0.25);
}
TlsphOptions options_of(const Case& c) {
  TlsphOptions o = options(c.psi, c.penalty);
  o.kernel = c.kernel;
  return o;
}

class Forces : public testing::TestWithParam<Case> {
 protected:
  Body body = body_of(GetParam());
  TotalLagrangianSph model{body, rubber(GetParam().dimension, GetParam().model),
                           options_of(GetParam()), one_thread};
  /// A rotation by half a radian with random strains of about 10 % on top.
  Column u = [this] {
    Column c = affine(body, rotation(body.dim, 0.5));
    const Column noise = random_column(body, 0.005, 7);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] += noise[i];
    return c;
  }();

  Column forces(const Column& at_u) {
    Column f(u.size());
    model.forces(at_u, {}, f, one_thread);
    return f;
  }
  double energy(const Column& at_u) {
    const particle::Energies e = model.energies(at_u, one_thread);
    return e.internal + e.stabilisation;
  }
};

TEST_P(Forces, GradientsOfAffineFieldsAreExact) {
  Mat3 H = Mat3::Zero();
  for (int i = 0; i < body.dim; ++i) {
    for (int j = 0; j < body.dim; ++j) H(i, j) = 0.1 * random(3, 3 * i + j);
  }
  std::vector<Mat3> found(body.n);
  model.gradients(affine(body, H), found);
  for (const Mat3& G : found) {
    EXPECT_LT((G - H).topLeftCorner(body.dim, body.dim).cwiseAbs().maxCoeff(), 2e-15);
    if (GetParam().dimension == Dimension::plane_stress) {
      EXPECT_LT(
          std::abs(scene::ElasticLaw(rubber(Dimension::three_d, GetParam().model).material,
                                     Dimension::three_d)
                       .stress(G)(2, 2)),
          1e-15 * 1e9);
    }
  }
}

TEST_P(Forces, AreDerivativesOfThePotential) {
  if (!model.has_potential()) return;
  const Column f = forces(u);
  const double d = 6e-4 * body.h, scale = largest(f);
  Column moved = u;
  for (Index a = 0; a < body.n; a += 7) {
    for (int i = 0; i < body.dim; ++i) {
      const std::size_t k = static_cast<std::size_t>(a) * body.stride + i;
      double difference = 0;  // fourth order: (-W(2d) + 8 W(d) - 8 W(-d) + W(-2d)) / (12 d)
      for (const auto& [step, weight] :
           {std::pair{2.0, -1.0}, {1.0, 8.0}, {-1.0, -8.0}, {-2.0, 1.0}}) {
        moved[k] = u[k] + step * d;
        difference += weight * energy(moved);
      }
      moved[k] = u[k];
      EXPECT_NEAR(f[k], -difference / (12 * d), 1e-9 * scale);
    }
  }
}

TEST_P(Forces, ConserveBothMomenta) {
  const Column f = forces(u);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  double size = 0, arm = 0;
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 x = body.position(a) + at(body, u, a), f_a = at(body, f, a);
    sum += f_a;
    moment += x.cross(f_a);
    size += f_a.norm();
    arm += x.norm() * f_a.norm();
  }
  EXPECT_GT(size, 1);
  EXPECT_LT(sum.norm(), 2e-15 * size);
  EXPECT_LT(moment.norm(), 2e-15 * arm);
}

TEST_P(Forces, VanishUnderRigidMotion) {
  const double scale = largest(forces(u));
  EXPECT_LT(largest(forces(affine(body, rotation(body.dim, 1.1)))), 1e-13 * scale);
  EXPECT_EQ(largest(forces(Column(u.size(), 0.0))), 0);
}

TEST_P(Forces, TangentMatchesDifferences) {
  const Eigen::MatrixXd K = model.tangent(u);
  const double scale = K.cwiseAbs().maxCoeff(), d = 1e-5 * body.h;
  for (Index b = 0; b < body.n; b += 11) {
    for (int j = 0; j < body.dim; ++j) {
      Column plus = u, minus = u;
      plus[b * body.stride + j] += d;
      minus[b * body.stride + j] -= d;
      const Column f_plus = forces(plus), f_minus = forces(minus);
      for (Index a = 0; a < body.n; ++a) {
        for (int i = 0; i < body.dim; ++i) {
          const std::size_t k = static_cast<std::size_t>(a) * body.stride + i;
          EXPECT_NEAR(K(a * body.dim + i, b * body.dim + j),
                      -(f_plus[k] - f_minus[k]) / (2 * d), 2e-8 * scale);
        }
      }
    }
  }
  const double asymmetry = (K - K.transpose()).cwiseAbs().maxCoeff();
  if (model.has_potential()) {
    EXPECT_LT(asymmetry, 1e-13 * scale);
  } else {
    EXPECT_GT(asymmetry, 1e-6 * scale);  // the penalty (28) has no potential
  }
}

using enum Dimension;
using enum scene::MaterialModel;
constexpr KernelShape cubic = KernelShape::cubic_spline, wendland = KernelShape::wendland_c2;
INSTANTIATE_TEST_SUITE_P(
    Options, Forces,
    testing::Values(
        Case{three_d, neo_hookean, cubic, PenaltyForm::none, 0},
        Case{three_d, st_venant_kirchhoff, wendland, PenaltyForm::potential, 0.3},
        Case{three_d, neo_hookean, cubic, PenaltyForm::ganzenmueller, 0.3},
        Case{plane_strain, neo_hookean, wendland, PenaltyForm::none, 0},
        Case{plane_strain, neo_hookean, cubic, PenaltyForm::ganzenmueller, 0.07},
        Case{plane_stress, neo_hookean, cubic, PenaltyForm::potential, 0.3},
        Case{three_d, neo_hookean_isochoric, wendland, PenaltyForm::potential, 0.3},
        Case{plane_strain, neo_hookean_isochoric, cubic, PenaltyForm::ganzenmueller, 0.07},
        Case{plane_stress, neo_hookean_isochoric, cubic, PenaltyForm::potential, 0.3},
        Case{plane_stress, st_venant_kirchhoff, cubic, PenaltyForm::ganzenmueller, 1}));

}  // namespace
}  // namespace concord::sph
