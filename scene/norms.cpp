#include "scene/norms.hpp"

#include "scene/exact_samples.hpp"

#include <cassert>
#include <cmath>
#include <stdexcept>

namespace concord::scene {
namespace {

/// Accumulates sum w |a - b|^2 and sum w |b|^2.
struct RelativeNorm {
  double difference = 0, reference = 0;
  template <class A, class B> void add(double w, const A& a, const B& b) {
    difference += w * (a - b).squaredNorm();
    reference += w * b.squaredNorm();
  }
  double value() const {
    return reference > 0 ? std::sqrt(difference / reference) : std::sqrt(difference);
  }
};

/// In plane problems the third row and column of a gradient belong to the material, not to the
/// displacement field.
Mat3 in_plane(const Mat3& G, int dim) {
  if (dim == 3) return G;
  Mat3 plane = Mat3::Zero();
  plane.topLeftCorner<2, 2>() = G.topLeftCorner<2, 2>();
  return plane;
}

void add_sample_errors(const Problem& problem, Result& result) {
  const Samples& s = result.samples;
  RelativeNorm u, v, G;
  double largest = 0;
  for (std::size_t a = 0; a < s.X.size(); ++a) {
    const Vec3 exact = (*problem.exact_displacement)(s.X[a], result.t_end);
    u.add(s.weight[a], s.u[a], exact);
    largest = std::max(largest, (s.u[a] - exact).norm());
    if (!s.v.empty() && problem.exact_velocity)
      v.add(s.weight[a], s.v[a], (*problem.exact_velocity)(s.X[a], result.t_end));
    if (!s.F.empty())
      G.add(s.weight[a], in_plane(s.F[a] - Mat3::Identity(), problem.dim()),
            problem.exact_gradient(s.X[a], result.t_end));
  }
  if (s.X.empty()) return;
  result.errors["displacement_l2"] = u.value();
  result.errors["displacement_max"] = largest;
  if (!s.v.empty() && problem.exact_velocity) result.errors["velocity_l2"] = v.value();
  if (!s.F.empty()) result.errors["gradient_l2"] = G.value();
}

void add_common_errors(const Problem& problem, Result& result) {
  const ExactSamples exact = exact_samples(problem, result.t_end);
  const Quadrature& rule = exact.rule;
  std::vector<Vec3> u(rule.points.size());
  std::vector<Mat3> gradient(rule.points.size());
  result.field->evaluate(rule.points, u, gradient);
  RelativeNorm displacement, G;
  for (std::size_t q = 0; q < rule.points.size(); ++q) {
    displacement.add(rule.weights[q], u[q], exact.u[q]);
    G.add(rule.weights[q], in_plane(gradient[q], problem.dim()), exact.gradient[q]);
  }
  result.errors["displacement_l2_common"] = displacement.value();
  result.errors["gradient_l2_common"] = G.value();
}

}  // namespace

double relative_l2(std::span<const Vec3> a, std::span<const Vec3> b,
                   std::span<const double> weight) {
  assert(a.size() == b.size() && a.size() == weight.size());
  RelativeNorm norm;
  for (std::size_t i = 0; i < a.size(); ++i) norm.add(weight[i], a[i], b[i]);
  return norm.value();
}

double field_error(std::span<const double> reference, std::span<const double> value) {
  assert(reference.size() == value.size());
  double difference = 0, scale = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    difference += (reference[i] - value[i]) * (reference[i] - value[i]);
    scale += reference[i] * reference[i];
  }
  if (!(scale > 0)) throw std::invalid_argument("a reference that is zero everywhere");
  return std::sqrt(difference / scale);  // (29)
}

void add_exact_errors(const Problem& problem, Result& result) {
  if (!problem.exact_displacement) return;
  add_sample_errors(problem, result);
  if (result.field) add_common_errors(problem, result);
}

double field_difference(const Problem& problem, const Field& field, const Field& reference) {
  const Quadrature rule = common_quadrature(problem);
  std::vector<Vec3> u(rule.points.size()), other(rule.points.size());
  field.evaluate(rule.points, u, {});
  reference.evaluate(rule.points, other, {});
  return relative_l2(u, other, rule.weights);
}

}  // namespace concord::scene
