#include "particle/core/quantities.hpp"

#include "scene/material.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace concord::particle {
namespace {

const std::array<const char*, 3> axes{"x", "y", "z"};

/// Unit of a quantity's values as the end of a column's name.
std::string unit_suffix(const scene::Quantity& q) {
  switch (q.kind) {
    case scene::QuantityKind::point:
    case scene::QuantityKind::average:
      return "_m";
    case scene::QuantityKind::reaction:
      return "_N";
    case scene::QuantityKind::maximum:
      break;
  }
  if (q.field == "velocity") return "_m_s";
  if (q.field == "von_mises" || q.field == "pressure" || q.field == "kirchhoff_mises")
    return "_Pa";
  if (q.field == "plastic_strain") return "";
  return q.field == "unbalanced_force" ? "_N" : "_m";
}

/// The pieces of the surface on a group of faces, with their areas.
std::vector<std::pair<Index, double>> piece_areas(const Body& body, const std::string& group,
                                                  const SourcePosition& where) {
  (void)body.mesh.group_facets(group, where);  // reports what is no group of faces
  const std::vector<Index>& entities = body.mesh.groups.at(group).entities;
  std::vector<std::pair<Index, double>> areas;
  for (std::size_t k = 0; k < body.surface.size(); ++k) {
    const SurfacePiece& piece = body.surface[k];
    if (std::find(entities.begin(), entities.end(), piece.entity) != entities.end())
      areas.emplace_back(static_cast<Index>(k), piece.area);
  }
  return areas;
}

}  // namespace

std::vector<double> material_field(const ForceModel& model, std::span<const Mat3> H,
                                   const std::string& name) {
  std::vector<double> result(H.size());
  for (Index a = 0; a < static_cast<Index>(H.size()); ++a) {
    if (name == "plastic_strain") {
      result[a] = model.constitution().plastic_strain(a, H[a]);
      continue;
    }
    const Mat3 F = Mat3::Identity() + H[a], P = model.constitution().stress(a, H[a]);
    if (name == "kirchhoff_mises")
      result[a] = scene::von_mises(P * F.transpose());
    else if (name == "pressure")
      result[a] = scene::pressure(scene::cauchy_stress(P, F));
    else
      result[a] = scene::von_mises(scene::cauchy_stress(P, F));
  }
  return result;
}

Quantities::Quantities(const scene::Problem& problem, const ForceModel& model,
                       const Constraints& constraints)
    : m_problem(problem), m_model(model), m_constraints(constraints) {
  for (const scene::Quantity& q : problem.quantities) {
    m_places.push_back(find_place(q));
    const bool vector = q.kind != scene::QuantityKind::maximum;
    for (int i = 0; i < (vector ? model.body().dim : 1); ++i) {
      m_names.push_back(vector ? q.name + "_" + axes[i] : q.name);
      m_columns.push_back(m_names.back() + unit_suffix(q));
    }
  }
}

Quantities::Place Quantities::find_place(const scene::Quantity& q) const {
  const Body& body = m_model.body();
  Place place;
  place.quantity = &q;
  const std::vector<char> inside =
      q.group.empty() ? std::vector<char>(body.n, 1) : points_of_group(body, q.group, q.where);
  switch (q.kind) {
    case scene::QuantityKind::point: {
      double distance = 1e300;
      for (Index a = 0; a < body.bulk; ++a) {
        const double d = (body.position(a) - q.at).squaredNorm();
        if (d < distance) distance = d, place.nearest = a;
      }
      if (distance > 1e-18 * body.h * body.h)
        place.offset = q.at - body.position(place.nearest);
      break;
    }
    case scene::QuantityKind::average:
      place.areas = body.inside() ? piece_areas(body, q.group, q.where)
                                  : ExternalLoads::group_areas(body, q.group, q.where);
      for (const auto& [a, share] : place.areas) place.area += share;
      break;
    case scene::QuantityKind::reaction:
      for (const PrescribedDof& dof : m_constraints.dofs()) {
        if (inside[dof.particle]) place.dofs.push_back(dof);
      }
      break;
    case scene::QuantityKind::maximum:
      for (Index a = 0; a < body.bulk; ++a) {
        if (inside[a] && !(q.interior_only && body.triangulation.on_boundary[a]))
          place.particles.push_back(a);
      }
      break;
  }
  return place;
}

void Quantities::append(const State& state, std::span<const Mat3> H,
                        std::vector<double>& values) const {
  for (const Place& place : m_places) {
    if (place.quantity->kind == scene::QuantityKind::maximum) {
      values.push_back(maximum(place, state, H));
      continue;
    }
    const Vec3 value = vector_value(place, state, H);
    for (int i = 0; i < m_model.body().dim; ++i) values.push_back(value[i]);
  }
}

Vec3 Quantities::vector_value(const Place& place, const State& state,
                              std::span<const Mat3> H) const {
  const Body& body = m_model.body();
  Vec3 sum = Vec3::Zero();
  if (place.quantity->kind == scene::QuantityKind::point) {
    // Between particles: the first-order expansion of the nearest one.
    sum = column_vector(state.u, body, place.nearest);
    if (!place.offset.isZero(0)) sum += H[place.nearest] * place.offset;
    return sum;
  }
  for (const auto& [a, share] : place.areas)
    sum +=
        share / place.area *
        (body.inside() ? at_face(body.surface[a], state, H) : column_vector(state.u, body, a));
  // The constraint force that keeps the group moving as prescribed: R = m a - f on prescribed
  // components.
  for (const PrescribedDof& dof : place.dofs) {
    const Index a = dof.particle;
    sum[dof.component] +=
        body.m[a] * column_vector(state.acceleration, body, a)[dof.component] -
        column_vector(state.unbalanced, body, a)[dof.component];
  }
  return sum;
}

/// u at the centroid of a piece: what is prescribed there, the expansion of its particle else.
/// Tractions do work on the formulation's own u there, (VOR.13), which differs by its error.
Vec3 Quantities::at_face(const SurfacePiece& piece, const State& state,
                         std::span<const Mat3> H) const {
  const Body& body = m_model.body();
  const Index a = piece.particle;
  Vec3 u = column_vector(state.u, body, a) + H[a] * (piece.C - body.position(a));
  for (int i = 0; i < body.dim; ++i) {
    if (piece.condition[i] >= 0) u[i] = column_vector(state.u, body, piece.point)[i];
  }
  return u;
}

double Quantities::maximum(const Place& place, const State& state,
                           std::span<const Mat3> H) const {
  const std::vector<double> values = field(place.quantity->field, state, H);
  double largest = -1e300;
  for (const Index a : place.particles) {
    if (std::isnan(values[a])) return values[a];
    largest = std::max(largest, values[a]);
  }
  return largest == -1e300 ? 0.0 : largest;
}

std::vector<double> Quantities::field(const std::string& name, const State& state,
                                      std::span<const Mat3> H) const {
  const Body& body = m_model.body();
  if (name == "displacement_error") return displacement_error(state);
  if (name != "displacement" && name != "velocity" && name != "unbalanced_force")
    return material_field(m_model, H, name);
  std::vector<double> result(body.bulk);
  const std::span<const double> column = name == "displacement" ? state.u
                                         : name == "velocity"   ? state.v
                                                                : state.unbalanced;
  for (Index a = 0; a < body.bulk; ++a) result[a] = column_vector(column, body, a).norm();
  if (name != "unbalanced_force") return result;
  // Forces on prescribed components are reactions; where everything is prescribed, they count.
  std::vector<char> prescribed(body.bulk, 0);
  for (const PrescribedDof& dof : m_constraints.dofs()) {
    if (dof.particle < body.bulk) prescribed[dof.particle] = 1;
  }
  if (std::count(prescribed.begin(), prescribed.end(), 0) == 0) return result;
  for (Index a = 0; a < body.bulk; ++a) {
    if (prescribed[a]) result[a] = 0;
  }
  return result;
}

std::vector<double> Quantities::displacement_error(const State& state) const {
  const Body& body = m_model.body();
  std::vector<double> result(body.bulk);
  for (Index a = 0; a < body.bulk; ++a) {
    const Vec3 exact = (*m_problem.exact_displacement)(body.position(a), state.t);
    result[a] = (column_vector(state.u, body, a) - exact).norm();
  }
  return result;
}

}  // namespace concord::particle
