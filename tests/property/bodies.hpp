#pragma once
// Bodies on which the properties of every particle method are tried.

#include "particle/core/elastic.hpp"
#include "particle/core/particle_method.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

namespace concord::particle::test {

/// A method with settings, on a scene at a resolution.
struct Variant {
  std::string name;  ///< for the test's name
  std::string method;
  std::map<std::string, std::string> settings;
};

inline void PrintTo(const Variant& variant, std::ostream* out) { *out << variant.name; }

/// Every registered particle method with its defaults, and with the settings that take other
/// paths through its kernels.
inline std::vector<Variant> variants() {
  using Settings = std::map<std::string, std::string>;
  // A perturbation that the properties are tried with turns cells of gmsh's mesh inside out.
  const Settings delaunay_cells{{"cells", "delaunay"}};
  std::vector<Variant> list;
  for (const scene::Method* method : scene::MethodRegistry::instance().all()) {
    const std::string& name = method->info().name;
    if (dynamic_cast<const ParticleMethod*>(method))
      list.push_back({name, name, name == "cbm" ? delaunay_cells : Settings{}});
  }
  list.push_back(
      {"cbm_contact", "cbm", {{"cells", "delaunay"}, {"xi_n", "0.1"}, {"xi_t", "0.1"}}});
  list.push_back({"delaunay_xi0", "delaunay", {{"xi_n", "0"}, {"xi_t", "0"}}});
  list.push_back(
      {"delaunay_xi_isotropic_half", "delaunay", {{"xi_n", "0.5"}, {"xi_t", "1.3"}}});
  list.push_back({"tlsph_psi0", "tlsph", {{"psi", "0"}}});
  list.push_back({"tlsph_potential", "tlsph", {{"penalty", "potential"}}});
  list.push_back({"voronoi_xi0", "voronoi", {{"xi_n", "0"}, {"xi_t", "0"}}});
  list.push_back({"voronoi_conserving", "voronoi", {{"force", "conserving"}}});
  list.push_back({"voronoi_static", "voronoi", {{"force", "static"}}});
  list.push_back({"tlsph_wendland", "tlsph", {{"kernel", "wendland-c2"}, {"support", "2.5"}}});
  return list;
}

/// Whether the method says that it, or this setting of it, has not the property.
inline bool declares(const Variant& variant, const std::string& property) {
  const auto& cannot = scene::MethodRegistry::instance().find(variant.method).info().cannot;
  if (cannot.count(property) > 0) return true;
  for (const auto& [key, value] : variant.settings) {
    if (cannot.count(property + " (" + key + "=" + value + ")") > 0) return true;
  }
  return false;
}

/// Whether the method refuses bodies with curved faces, such as the tensile bar.
inline bool refuses_curved_faces(const Variant& variant) {
  return declares(variant, "curved faces");
}

/// Scene, body and model together, in the order in which they depend on each other.
struct Bench {
  scene::Problem problem;
  Body body;
  Executor executor{1};
  std::unique_ptr<ForceModel> model;

  Bench(const Variant& variant, const std::string& scene, double resolution,
        const std::vector<scene::Override>& set = {}, double perturb = 0.25,
        std::uint64_t seed = 5)
      : problem(scene::read_problem(scene, set)),
        body(particles(variant, problem, resolution, perturb, seed)), model(make(variant)) {}

  static const ParticleMethod& method_of(const Variant& variant) {
    return dynamic_cast<const ParticleMethod&>(
        scene::MethodRegistry::instance().find(variant.method));
  }
  static scene::Settings settings_of(const Variant& variant) {
    return {variant.method, method_of(variant).info().parameters, variant.settings};
  }
  /// As the method's runs have them.
  static Body particles(const Variant& variant, const scene::Problem& problem,
                        double resolution, double perturb, std::uint64_t seed) {
    scene::RunRequest request;
    request.h = problem.reference_length / resolution;
    request.perturb = perturb;
    request.seed = seed;
    return method_of(variant).make_particles(problem, request, settings_of(variant),
                                             Executor(1));
  }
  /// With the volumes that the method wants.
  static Body divided(const Variant& variant, const scene::Problem& problem, Body body) {
    method_of(variant).divide(body, problem, settings_of(variant));
    return body;
  }
  std::unique_ptr<ForceModel> make(const Variant& variant) const {
    return method_of(variant).make_model(body, problem, settings_of(variant), executor);
  }

  Column zeros() const { return Column(body.X.size(), 0.0); }

  template <class F> Column column(const F& value) const {
    Column c = zeros();
    for (Index a = 0; a < body.n; ++a) {
      const Vec3 v = value(a);
      for (int i = 0; i < body.dim; ++i)
        c[static_cast<std::size_t>(a) * body.stride + i] = v[i];
    }
    return c;
  }

  /// Smooth finite deformation plus noise of `noise` spacings.
  Column random_displacement(double noise = 0.05, unsigned seed = 3) const {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    return column([&](Index a) {
      const Vec3 X = body.position(a) / problem.reference_length;
      Vec3 u(0.2 * X[0] + 0.1 * X[1] * X[1], -0.15 * X[0] * X[1] + 0.1 * X[2],
             0.12 * X[0] - 0.1 * X[2]);
      u *= problem.reference_length;
      for (int i = 0; i < 3; ++i) u[i] += noise * body.h * uniform(generator);
      return u;
    });
  }

  Column force(const Column& u, int threads = 1) {
    Column f = zeros();
    model->forces(u, zeros(), f, Executor(threads));
    return f;
  }

  Vec3 at(const Column& c, Index a) const {
    Vec3 r = Vec3::Zero();
    for (int i = 0; i < body.dim; ++i) r[i] = c[static_cast<std::size_t>(a) * body.stride + i];
    return r;
  }
};

inline double norm(const Column& c) {
  double s = 0;
  for (const double x : c) s += x * x;
  return std::sqrt(s);
}

/// u + s d.
inline Column moved(const Column& u, const Column& d, double s) {
  Column v = u;
  for (std::size_t k = 0; k < v.size(); ++k) v[k] += s * d[k];
  return v;
}

/// Components in [-1, 1].
inline Column random_direction(const Bench& b, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return b.column(
      [&](Index) { return Vec3(uniform(generator), uniform(generator), uniform(generator)); });
}

/// |K d + df/ds| / |K d|, the slope of the forces along d by a central difference of step s.
inline double tangent_error(Bench& b, const ForceModel::Stiffness& K, const Column& u,
                            const Column& d, double s) {
  const Column plus = b.force(moved(u, d, s)), minus = b.force(moved(u, d, -s));
  Eigen::VectorXd direction(K.cols()), difference(K.rows());
  for (Index a = 0; a < b.body.n; ++a) {
    for (int i = 0; i < b.body.dim; ++i) {
      const std::size_t k = static_cast<std::size_t>(a) * b.body.stride + i;
      direction[a * b.body.dim + i] = d[k];
      difference[a * b.body.dim + i] = -(plus[k] - minus[k]) / (2 * s);
    }
  }
  const Eigen::VectorXd product = K * direction;
  return (product - difference).norm() / product.norm();
}

/// Departure from symmetry, relative.
inline double asymmetry(const ForceModel::Stiffness& K) {
  return ForceModel::Stiffness(K - ForceModel::Stiffness(K.transpose())).norm() / K.norm();
}

/// Instantiated once, in forces_test.cpp, for the tests of all files.
class EveryMethod : public testing::TestWithParam<Variant> {};

inline std::string variant_name(const testing::TestParamInfo<Variant>& info) {
  return info.param.name;
}

}  // namespace concord::particle::test
