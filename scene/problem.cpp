#include "scene/problem.hpp"

#include "scene/material.hpp"

namespace concord::scene {
namespace {

// Difference steps as fractions of the reference length. The small one: truncation step^4 f5/30
// is 1e-13 for one wave a length. The large one serves fields that are polynomials of degree
// four at most, for which fourth-order differences are exact and only round-off counts.
constexpr double small_step = 1e-3, large_step = 0.125;
constexpr double same = 1e-11;

}  // namespace

const std::vector<std::string>& quantity_fields() {
  static const std::vector<std::string> fields{
      "displacement", "velocity",       "displacement_error", "von_mises",
      "pressure",     "plastic_strain", "kirchhoff_mises",    "unbalanced_force"};
  return fields;
}

Mat3 Problem::exact_gradient(const Vec3& X, double t) const {
  const Mat3 near = exact_displacement->gradient(X, t, small_step * reference_length);
  const Mat3 far = exact_displacement->gradient(X, t, large_step * reference_length);
  Mat3 G = (near - far).norm() <= same * near.norm() ? far : near;
  if (dim() == 2) {
    G.row(2).setZero();
    G.col(2).setZero();
  }
  return G;
}

Vec3 Problem::boundary_value(const BoundaryCondition& bc, const Vec3& X, double t,
                             const Vec3& N) const {
  if (bc.kind == BoundaryKind::displacement)
    return bc.value_from_exact ? (*exact_displacement)(X, t) : bc.value(X, t);
  if (bc.kind != BoundaryKind::traction) return Vec3::Zero();
  if (!bc.value_from_exact) return bc.value(X, t);
  return ElasticLaw(material, dimension).stress(exact_gradient(X, t)) * N;
}

void refuse_fracture(const Problem& problem, const std::string& method) {
  if (!problem.fracture) return;
  throw InputError(problem.fracture->where, "fracture",
                   "a scene with fracture for the method " + method,
                   "a method that can break the material: cbm, delaunay, tlsph");
}

}  // namespace concord::scene
