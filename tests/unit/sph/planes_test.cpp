// Mirror particles: the force as the derivative of the energy, affine fields, the whole body of
// which a part is computed, threads, scenes with and without planes, Voronoi volumes.

#include "sample.hpp"

#include "particle/core/particle_method.hpp"
#include "scene/reader.hpp"
#include "sph_reference/total_lagrangian/volumes.hpp"

#include <gtest/gtest.h>

namespace concord::sph {
namespace {

/// A perturbed lattice whose first and last layers lie on the planes X_i = 0 and X_i = L.
Body box(int dim, int count) {
  Body body = lattice(dim, count, 0.25);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0, rest = a; i < dim; ++i, rest /= count) {
      const int place = rest % count;
      if (place == 0 || place == count - 1) body.X[a * body.stride + i] = body.h * place;
    }
  }
  return body;
}

/// Planes at X_i = 0 and X_i = L; antisymmetric: the bits of those of them in turn.
std::vector<Plane> planes_of(int dim, int count, unsigned antisymmetric) {
  std::vector<Plane> planes;
  for (int i = 0; i < 2 * dim; ++i)
    planes.push_back({i / 2, i % 2 * 0.1 * (count - 1), (antisymmetric >> i & 1) != 0});
  return planes;
}

TlsphOptions mirrored(PenaltyForm penalty, std::vector<Plane> planes) {
  TlsphOptions o = options(penalty == PenaltyForm::none ? 0 : 0.3, penalty);
  o.planes = std::move(planes);
  return o;
}

Dimension dimension_of(int dim) {
  return dim == 3 ? Dimension::three_d : Dimension::plane_strain;
}

Column force(TotalLagrangianSph& model, const Column& u, const Column& v,
             const Executor& executor = one_thread) {
  Column f(u.size(), 1e30);
  model.forces(u, v, f, executor);
  return f;
}

class Planes : public testing::TestWithParam<PenaltyForm> {};

/// Every particle, those on planes with displacements that no condition holds, in every
/// component.
TEST_P(Planes, ForceIsMinusTheGradientOfTheEnergy) {
  for (const auto& [dim, count, kinds] :
       {std::tuple{2, 5, 0b0110U}, {3, 4, 0b101010U}, {3, 4, 0b000111U}}) {
    const Body body = box(dim, count);
    TotalLagrangianSph model(body, rubber(dimension_of(dim)),
                             mirrored(GetParam(), planes_of(dim, count, kinds)), one_thread);
    EXPECT_GT(model.points().images(), 0);
    if (!model.has_potential()) continue;  // (TLS.10): PartEqualsTheWhole
    const Column u = random_column(body, 0.005, 7), f = force(model, u, {});
    const double d = 6e-4 * body.h, scale = largest(f);
    Column moved = u;
    for (Index a = 0; a < body.n; ++a) {
      for (int i = 0; i < dim; ++i) {
        const std::size_t k = static_cast<std::size_t>(a) * body.stride + i;
        double difference = 0;
        for (const auto& [step, weight] :
             {std::pair{2.0, -1.0}, {1.0, 8.0}, {-1.0, -8.0}, {-2.0, 1.0}}) {
          moved[k] = u[k] + step * d;
          const particle::Energies e = model.energies(moved, one_thread);
          difference += weight * (e.internal + e.stabilisation);
        }
        moved[k] = u[k];
        EXPECT_NEAR(f[k], -difference / (12 * d), 1e-9 * scale)
            << "particle " << a << " component " << i;
      }
    }
  }
}

/// u = H X with diagonal H fits symmetric planes through the origin; shear u_0 = g X_1 an
/// antisymmetric plane X_1 = 0.
TEST(PlanesGradient, IsExactForAffineFieldsThatFitThem) {
  for (const int dim : {2, 3}) {
    const Body body = box(dim, 6);
    Mat3 stretch = Mat3::Zero(), shear = Mat3::Zero();
    for (int i = 0; i < dim; ++i) stretch(i, i) = 0.1 * (i + 1);
    shear(0, 1) = 0.3;
    std::vector<Plane> symmetric, antisymmetric{{1, 0, true}};
    for (int i = 0; i < dim; ++i) symmetric.push_back({i, 0, false});
    for (const auto& [planes, H] : {std::pair{symmetric, stretch}, {antisymmetric, shear}}) {
      TotalLagrangianSph model(body, rubber(dimension_of(dim)),
                               mirrored(PenaltyForm::none, planes), one_thread);
      std::vector<Mat3> found(body.n);
      model.gradients(affine(body, H), found);
      for (const Mat3& G : found) EXPECT_LT((G - H).cwiseAbs().maxCoeff(), 2e-15);
    }
  }
}

/// One part of a body computed with symmetric planes, against the whole of it without: the
/// body, its reflections in X_i = 0, with particles on the planes once and their volumes for
/// all parts.
TEST_P(Planes, PartEqualsTheWhole) {
  for (const auto& [dim, count] : {std::pair{2, 6}, {3, 4}}) {
    const Body part = box(dim, count);
    Column u = random_column(part, 0.004, 3), v = random_column(part, 5, 4), whole_u, whole_v;
    std::vector<Plane> planes;
    for (int i = 0; i < dim; ++i) planes.push_back({i, 0, false});
    Body whole = part;
    whole.n = 0;
    whole.X.clear(), whole.V.clear(), whole.m.clear();
    std::vector<double> parts(part.n, 1.0);
    std::vector<Index> first(part.n, -1);
    for (Index a = 0; a < part.n; ++a) {
      for (int i = 0; i < dim; ++i) {
        const std::size_t k = static_cast<std::size_t>(a) * part.stride + i;
        if (part.X[k] == 0) u[k] = v[k] = 0, parts[a] *= 2;
      }
    }
    for (int mask = 0; mask < 1 << dim; ++mask) {
      for (Index a = 0; a < part.n; ++a) {
        bool again = false;
        for (int i = 0; i < dim; ++i)
          again = again || ((mask >> i & 1) != 0 && part.X[a * part.stride + i] == 0);
        if (again) continue;
        if (mask == 0) first[a] = whole.n;
        for (int i = 0; i < part.stride; ++i) {
          const double sign = i < dim && (mask >> i & 1) != 0 ? -1 : 1;
          whole.X.push_back(sign * part.X[a * part.stride + i]);
          whole_u.push_back(sign * u[a * part.stride + i]);
          whole_v.push_back(sign * v[a * part.stride + i]);
        }
        whole.V.push_back(parts[a] * part.V[a]);
        whole.m.push_back(parts[a] * part.m[a]);
        ++whole.n, whole.bulk = whole.n;
      }
    }
    TlsphOptions with = mirrored(GetParam(), planes), without = mirrored(GetParam(), {});
    with.alpha = without.alpha = 0.5, with.beta = without.beta = 1;
    TotalLagrangianSph small(part, rubber(dimension_of(dim)), with, one_thread);
    TotalLagrangianSph big(whole, rubber(dimension_of(dim)), without, one_thread);
    const Column f = force(small, u, v), g = force(big, whole_u, whole_v);
    for (Index a = 0; a < part.n; ++a) {
      Vec3 of_part = at(part, f, a);
      for (int i = 0; i < dim; ++i) {
        if (part.X[a * part.stride + i] == 0)
          of_part[i] = 0;  // held by the condition; zero by symmetry in the whole
      }
      EXPECT_LT((parts[a] * of_part - at(whole, g, first[a])).norm(), 1e-13 * largest(g)) << a;
    }
    const particle::Energies e = small.energies(u, one_thread),
                             all = big.energies(whole_u, one_thread);
    EXPECT_NEAR(std::pow(2, dim) * e.internal, all.internal, 1e-13 * all.internal);
    EXPECT_NEAR(std::pow(2, dim) * e.stabilisation, all.stabilisation, 1e-13 * all.internal);
  }
}

/// Opposite planes closer than the support: images of images, on both sides.
TEST(PlanesNear, ImagesOfImages) {
  const Body body = box(2, 3);
  TlsphOptions o = mirrored(PenaltyForm::none, {{0, 0, false}, {0, 0.2, false}});
  o.support = 4.5;
  TotalLagrangianSph model(body, rubber(Dimension::plane_strain), o, one_thread);
  // Maps of X: -X, .4 - X, X +- .4; and of -.4 - X and .8 - X the layer next to the body, .4
  // from it where R = .45.
  EXPECT_EQ(model.points().images(), 4 * body.n + 2 * 3);
}

TEST_P(Planes, ThreadsGiveTheSameBits) {
  const Body body = box(3, 12);
  TlsphOptions o = mirrored(GetParam(), planes_of(3, 12, 0b101010U));
  o.alpha = 0.5;
  TotalLagrangianSph model(body, rubber(Dimension::three_d), o, one_thread);
  const Column u = random_column(body, 0.004, 1), v = random_column(body, 10, 2),
               f = force(model, u, v);
  for (const int threads : {2, 3}) {
    const Executor executor(threads);
    TotalLagrangianSph other(body, rubber(Dimension::three_d), o, executor);
    EXPECT_EQ(force(other, u, v, executor), f);
  }
}

INSTANTIATE_TEST_SUITE_P(Penalties, Planes,
                         testing::Values(PenaltyForm::none, PenaltyForm::ganzenmueller,
                                         PenaltyForm::potential));

/// The method's model of a scene.
std::unique_ptr<particle::ForceModel>
model_of(const scene::Problem& problem, const Body& body,
         const std::map<std::string, std::string>& settings) {
  const auto& method = dynamic_cast<const particle::ParticleMethod&>(
      scene::MethodRegistry::instance().find("tlsph"));
  return method.make_model(
      body, problem, scene::Settings("tlsph", method.info().parameters, settings), one_thread);
}

TEST(PlanesSetting, TruncatedAndNoPlanesAllocateNothing) {
  const scene::Problem cube = scene::read_problem("swinging_cube"),
                       block = scene::read_problem("spinning_block");
  const Body body = particle::make_body(cube, 0.25, 0.25, 1),
             free_body = particle::make_body(block, 0.25, 0.25, 1);
  const auto points = [](const particle::ForceModel& m) {
    return dynamic_cast<const TotalLagrangianSph&>(m).points();
  };
  const auto with = model_of(cube, body, {});
  EXPECT_GT(points(*with).images(), body.n);
  EXPECT_EQ(symmetry_planes(cube, body).size(), 6U);
  for (const auto& model :
       {model_of(cube, body, {{"planes", "truncated"}}), model_of(block, free_body, {})}) {
    EXPECT_EQ(points(*model).images(), 0);
    EXPECT_EQ(points(*model).positions(), model->body().X.data());
    EXPECT_TRUE(points(*model).make_column().empty());
  }
  // Truncated: the bits of a model that was told of no planes.
  TlsphOptions plain;
  TotalLagrangianSph bare(body, cube, plain, one_thread);
  const Column u = random_column(body, 0.004, 1);
  Column f(u.size()), g(u.size());
  model_of(cube, body, {{"planes", "truncated"}})->forces(u, {}, f, one_thread);
  bare.forces(u, {}, g, one_thread);
  EXPECT_EQ(f, g);
  with->forces(u, {}, g, one_thread);
  EXPECT_NE(f, g);
}

TEST(PlanesSetting, APlaneThroughTheBodyIsAnInputError) {
  scene::Problem cube = scene::read_problem("swinging_cube");
  Body body = particle::make_body(cube, 0.25, 0, 1);
  for (Vec3& X : body.mesh.nodes) {
    if (X[0] == 1) X[0] = -0.25;
  }
  EXPECT_THROW(symmetry_planes(cube, body), InputError);
}

/// A lattice's mode of vibration is one of the method's too: f = -(1 + e) m w^2 u with one e
/// for all free components, those on planes, edges and corners included, of second order in h.
TEST(PlanesLattice, TheExactModeIsAModeOfSecondOrder) {
  const scene::Problem cube =
      scene::read_problem("swinging_cube", {{"parameters.U", "1e-9 m"}});
  std::vector<double> errors;
  for (const int N : {6, 12}) {
    Body body = particle::make_body(cube, 1.0 / N, 0, 1);
    body.V = voronoi_volumes(body);
    const auto model = model_of(cube, body, {{"psi", "0"}, {"support", "2"}});
    Column u(body.X.size(), 0.0), f = u;
    for (Index a = 0; a < body.n; ++a) {
      const Vec3 value = (*cube.initial_displacement)(body.position(a), 0);
      for (int i = 0; i < 3; ++i) u[a * 4 + i] = value[i];
    }
    model->forces(u, {}, f, one_thread);
    const std::vector<double>& V = body.V;
    const double w = std::sqrt(3.0) * M_PI / 2 * cube.material.shear_wave_speed(),
                 rho = cube.material.rho0;
    double lowest = 1e9, highest = -1e9;
    for (std::size_t k = 0; k < u.size(); ++k) {
      const double expected = -rho * V[k / 4] * w * w * u[k],
                   size = rho * V[k / 4] * w * w * 1e-9;
      if (std::abs(u[k]) < 1e-11) continue;  // held by a condition, or a node of the mode
      lowest = std::min(lowest, (f[k] - expected) / expected);
      highest = std::max(highest, (f[k] - expected) / expected);
      EXPECT_LT(std::abs(f[k] - expected), 0.2 * size);
    }
    EXPECT_LT(highest - lowest, 1e-5 * std::abs(lowest) + 1e-7);
    errors.push_back(std::abs(lowest));
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.1);
}

TEST(Volumes, OfALatticeAreThoseOfItsBoxes) {
  const scene::Problem cube = scene::read_problem("swinging_cube");
  const Body body = particle::make_body(cube, 0.2, 0, 1);
  const std::vector<double> V = voronoi_volumes(body);
  for (Index a = 0; a < body.n; ++a) {
    double expected = 0.2 * 0.2 * 0.2;
    for (int i = 0; i < 3; ++i)
      expected *= body.position(a)[i] == 0 || body.position(a)[i] == 1 ? 0.5 : 1;
    EXPECT_NEAR(V[a], expected, 1e-15);
  }
}

/// Against the shares of a fine grid of points among the nearest particles.
TEST(Volumes, AreThoseOfTheNearestPoints) {
  const scene::Problem cube = scene::read_problem("swinging_cube");
  const Body body = particle::make_body(cube, 0.34, 0.2, 3);
  const std::vector<double> V = voronoi_volumes(body);
  std::vector<double> counted(body.n, 0.0);
  const int fine = 80;
  for (int k = 0; k < fine * fine * fine; ++k) {
    const Vec3 X = Vec3(k % fine + 0.5, k / fine % fine + 0.5, k / fine / fine + 0.5) / fine;
    Index nearest = 0;
    for (Index a = 1; a < body.n; ++a) {
      if ((body.position(a) - X).squaredNorm() < (body.position(nearest) - X).squaredNorm())
        nearest = a;
    }
    counted[nearest] += 1.0 / (fine * fine * fine);
  }
  double sum = 0;
  for (Index a = 0; a < body.n; ++a) {
    sum += V[a];
    if (!body.triangulation.on_boundary[a]) {
      EXPECT_NEAR(V[a], counted[a], 0.02 * V[a]);
    }
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

}  // namespace
}  // namespace concord::sph
