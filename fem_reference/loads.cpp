#include "fem_reference/loads.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <map>

namespace concord::fem {
namespace {

using scene::BoundaryCondition;

bool changes_in_time(const scene::Problem& problem, const BoundaryCondition& bc) {
  if (bc.value_from_exact) return problem.exact_displacement->depends_on_time();
  return bc.value.depends_on_time();
}

/// Corners of the faces of a cell, gmsh's order.
std::vector<std::vector<int>> faces_of(int dim, bool simplex) {
  if (dim == 2 && simplex) return {{0, 1}, {1, 2}, {2, 0}};
  if (dim == 2) return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  if (simplex) return {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  return {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}};
}

/// The cell at each boundary facet.
std::vector<std::size_t> cells_at_facets(const scene::Mesh& mesh, int facet_corners) {
  std::map<std::vector<Index>, std::size_t> cell_of;
  const auto faces = faces_of(mesh.dim, mesh.shape == scene::CellShape::simplex);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    for (const auto& face : faces) {
      std::vector<Index> key;
      for (const int k : face) key.push_back(mesh.cells[c * mesh.nodes_per_cell + k]);
      std::sort(key.begin(), key.end());
      cell_of[key] = c;
    }
  }
  std::vector<std::size_t> out;
  for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
    const auto first =
        mesh.facets.begin() + static_cast<std::ptrdiff_t>(f) * mesh.nodes_per_facet;
    std::vector<Index> key(first, first + facet_corners);
    std::sort(key.begin(), key.end());
    const auto found = cell_of.find(key);
    out.push_back(found == cell_of.end() ? mesh.cell_count() : found->second);
  }
  return out;
}

template <int facet_dim> dealii::Quadrature<facet_dim> facet_rule(bool simplex, int n) {
  if constexpr (facet_dim == 2) {
    if (simplex) return dealii::QWitherdenVincentSimplex<2>(n);
  }
  return dealii::QGauss<facet_dim>(n);
}

}  // namespace

template <int dim>
Loads<dim>::Loads(const scene::Problem& problem, const Discretisation<dim>& discretisation)
    : m_problem(problem), m_discretisation(discretisation), m_constant(discretisation.dofs()) {
  const bool simplex = discretisation.mesh().shape == scene::CellShape::simplex;
  const auto rule = facet_rule<dim - 1>(simplex, discretisation.degree() + 2);
  const LagrangeShape& shape = discretisation.facet_shape();
  for (unsigned q = 0; q < rule.size(); ++q) {
    Vec3 xi = Vec3::Zero();
    for (int i = 0; i < dim - 1; ++i) xi[i] = rule.point(q)[i];
    m_facet_xi.push_back(xi);
    m_facet_w.push_back(rule.weight(q));
    m_facet_N.emplace_back(shape.node_count());
    shape.evaluate(xi, m_facet_N.back(), {});
  }
  for (const BoundaryCondition& bc : problem.boundaries) {
    if (bc.kind == scene::BoundaryKind::traction) collect_facets(bc);
  }
  const bool gravity = !problem.gravity.isZero(0);
  const bool body = problem.body_force && !problem.body_force->is_zero();
  m_body_varies = body && problem.body_force->depends_on_time();
  add_volume(0, gravity, body && !m_body_varies, m_constant);
  m_any = m_any || gravity || body;
  m_depends_on_time = m_body_varies || !m_varying.empty();
}

template <int dim> Vec3 Loads<dim>::outward(std::size_t facet, const Vec3& normal) const {
  const scene::Mesh& mesh = m_discretisation.mesh();
  const std::size_t cell = m_cell_of_facet[facet];
  const auto mean = [&](const Index* nodes, int corners) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < corners; ++k) sum += mesh.nodes[nodes[k]] / corners;
    return sum;
  };
  const Vec3 from = mean(&mesh.cells[cell * mesh.nodes_per_cell],
                         m_discretisation.cell_shape().corner_count());
  const Vec3 to = mean(&mesh.facets[facet * mesh.nodes_per_facet],
                       m_discretisation.facet_shape().corner_count());
  return normal.dot(to - from) < 0 ? Vec3(-normal) : normal;
}

template <int dim> void Loads<dim>::collect_facets(const BoundaryCondition& bc) {
  const scene::Mesh& mesh = m_discretisation.mesh();
  const LagrangeShape& shape = m_discretisation.facet_shape();
  const bool varies = changes_in_time(m_problem, bc);
  if (m_cell_of_facet.empty()) m_cell_of_facet = cells_at_facets(mesh, shape.corner_count());
  std::vector<double> N(shape.node_count());
  std::vector<Vec3> dN(shape.node_count());
  for (const Index facet : mesh.group_facets(bc.group, bc.where)) {
    if (m_cell_of_facet[facet] == mesh.cell_count()) {
      throw InputError(bc.where, "boundary.group", bc.group, "a group of faces of the body");
    }
    const Index* nodes = &mesh.facets[static_cast<std::size_t>(facet) * mesh.nodes_per_facet];
    for (unsigned q = 0; q < m_facet_xi.size(); ++q) {
      shape.evaluate(m_facet_xi[q], N, dN);
      Vec3 X = Vec3::Zero(), a = Vec3::Zero(), b = Vec3::Unit(2);
      if (dim == 3) b.setZero();
      for (int n = 0; n < shape.node_count(); ++n) {
        X += N[n] * mesh.nodes[nodes[n]];
        a += dN[n][0] * mesh.nodes[nodes[n]];
        if (dim == 3) b += dN[n][1] * mesh.nodes[nodes[n]];
      }
      const Vec3 normal = outward(static_cast<std::size_t>(facet), a.cross(b));
      const FacetPoint point{&bc,
                             static_cast<std::size_t>(facet),
                             q,
                             X,
                             normal.normalized(),
                             normal.norm() * m_facet_w[q] * m_problem.thickness};
      if (varies)
        m_varying.push_back(point);
      else
        add_traction(point, 0, m_constant);
      m_any = true;
    }
  }
}

template <int dim>
void Loads<dim>::add_traction(const FacetPoint& point, double t, Vector& f) const {
  const scene::Mesh& mesh = m_discretisation.mesh();
  const Vec3 T = m_problem.boundary_value(*point.condition, point.X, t, point.N);
  const Index* nodes = &mesh.facets[point.facet * mesh.nodes_per_facet];
  for (int n = 0; n < mesh.nodes_per_facet; ++n) {
    for (int i = 0; i < dim; ++i) {
      f[m_discretisation.dof(nodes[n], i)] += point.weight * m_facet_N[point.q][n] * T[i];
    }
  }
}

template <int dim>
void Loads<dim>::add_volume(double t, bool gravity, bool body_force, Vector& f) const {
  if (!gravity && !body_force) return;
  const dealii::FESystem<dim>& element = m_discretisation.element();
  const dealii::FiniteElement<dim>& scalar = element.base_element(0);
  dealii::FEValues<dim> values(
      m_discretisation.mapping(), scalar, m_discretisation.gauss(m_discretisation.degree() + 2),
      dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  std::vector<dealii::types::global_dof_index> dofs(element.n_dofs_per_cell());
  for (const auto& cell : m_discretisation.dof_handler().active_cell_iterators()) {
    values.reinit(static_cast<typename dealii::Triangulation<dim>::cell_iterator>(cell));
    cell->get_dof_indices(dofs);
    for (unsigned q = 0; q < values.n_quadrature_points; ++q) {
      Vec3 X = Vec3::Zero(), b = Vec3::Zero();
      for (int i = 0; i < dim; ++i) X[i] = values.quadrature_point(q)[i];
      if (gravity) b += m_problem.material.rho0 * m_problem.gravity;
      if (body_force) b += (*m_problem.body_force)(X, t);
      b *= values.JxW(q) * m_problem.thickness;
      for (unsigned a = 0; a < scalar.n_dofs_per_cell(); ++a) {
        for (unsigned i = 0; i < dim; ++i) {
          f[dofs[element.component_to_system_index(i, a)]] += values.shape_value(a, q) * b[i];
        }
      }
    }
  }
}

template <int dim> void Loads<dim>::evaluate(double t, Vector& f) const {
  f = m_constant;
  for (const FacetPoint& point : m_varying) add_traction(point, t, f);
  if (m_body_varies) add_volume(t, false, true, f);
}

template class Loads<2>;
template class Loads<3>;

}  // namespace concord::fem
