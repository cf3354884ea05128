#pragma once
// A perturbed lattice with volumes of its own, and random states on it. SPH needs no
// triangulation, so none is made.

#include "scene/geometry.hpp"
#include "sph_reference/total_lagrangian/model.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace concord::sph {

inline const Executor one_thread(1);

/// Uniform in [-1, 1).
inline double random(std::uint64_t seed, std::uint64_t i) {
  return 2 * scene::uniform_random(seed, i, 0) - 1;
}

/// count particles a side at spacing .1 m, each moved by up to `perturb` spacings; volumes
/// within 20 % of the spacing's.
inline Body lattice(int dim, int count, double perturb) {
  Body body;
  body.dim = dim;
  body.stride = particle::stride_of(dim);
  body.h = body.h_min = 0.1;
  body.thickness = dim == 2 ? 0.5 : 1;
  body.n = 1;
  for (int i = 0; i < dim; ++i) body.n *= count;
  body.bulk = body.n;
  body.X.assign(static_cast<std::size_t>(body.n) * body.stride, 0.0);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0, rest = a; i < dim; ++i, rest /= count) {
      body.X[a * body.stride + i] = body.h * (rest % count + perturb * random(1, a * 3 + i));
    }
    body.V.push_back(std::pow(body.h, dim) * body.thickness * (1 + 0.2 * random(2, a)));
    body.m.push_back(1100 * body.V.back());
  }
  return body;
}

inline scene::Problem rubber(Dimension dimension,
                             scene::MaterialModel model = scene::MaterialModel::neo_hookean) {
  scene::Problem problem;
  problem.dimension = dimension;
  problem.thickness = space_dim(dimension) == 2 ? 0.5 : 1;
  scene::Material& m = problem.material;
  m.model = model;
  m.E = 17e6, m.nu = 0.3, m.rho0 = 1100;  // the swinging cube's
  m.lambda = m.E * m.nu / ((1 + m.nu) * (1 - 2 * m.nu)), m.mu = m.E / (2 * (1 + m.nu));
  return problem;
}

inline Column random_column(const Body& body, double size, std::uint64_t seed) {
  Column c(body.X.size(), 0.0);
  for (Index a = 0; a < body.n; ++a) {
    for (int i = 0; i < body.dim; ++i) c[a * body.stride + i] = size * random(seed, a * 3 + i);
  }
  return c;
}

inline Vec3 at(const Body& body, const Column& c, Index a) {
  Vec3 r = Vec3::Zero();
  for (int i = 0; i < body.dim; ++i) r[i] = c[static_cast<std::size_t>(a) * body.stride + i];
  return r;
}

/// u(X) = H X at every particle.
inline Column affine(const Body& body, const Mat3& H) {
  Column u(body.X.size(), 0.0);
  for (Index a = 0; a < body.n; ++a) {
    const Vec3 value = H * body.position(a);
    for (int i = 0; i < body.dim; ++i) u[a * body.stride + i] = value[i];
  }
  return u;
}

/// A rotation (about the third axis in the plane) less the identity.
inline Mat3 rotation(int dim, double angle) {
  const Vec3 axis = dim == 2 ? Vec3(0, 0, 1) : Vec3(1, 2, -0.5).normalized();
  Mat3 W;
  W << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  return std::sin(angle) * W + (1 - std::cos(angle)) * W * W;
}

inline double largest(const Column& c) {
  double m = 0;
  for (const double x : c) m = std::max(m, std::abs(x));
  return m;
}

inline TlsphOptions options(double psi, PenaltyForm penalty = PenaltyForm::ganzenmueller,
                            double support = 2.4) {
  TlsphOptions o;
  o.psi = psi, o.penalty = penalty, o.support = support;
  return o;
}

}  // namespace concord::sph
