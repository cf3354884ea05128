#include "fem_reference/discretisation.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_fe_field.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace concord::fem {
namespace {

/// Moves the corners of a mesh of order 2 as scene::perturb moves those of a mesh of order 1;
/// its sides become straight.
void perturb_corners(scene::Mesh& mesh, const LagrangeShape& cell, const LagrangeShape& facet,
                     const scene::Problem& problem, const scene::RunRequest& request) {
  if (mesh.order == 1) return scene::perturb(mesh, problem, request.perturb, request.seed);
  std::vector<Index> corner(mesh.nodes.size(), -1), node_of_corner;
  scene::Mesh linear = mesh;
  const auto shrink = [&](const std::vector<Index>& from, int stride, int keep) {
    std::vector<Index> out;
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (static_cast<int>(i) % stride >= keep) continue;
      if (corner[from[i]] < 0) {
        corner[from[i]] = static_cast<Index>(node_of_corner.size());
        node_of_corner.push_back(from[i]);
      }
      out.push_back(corner[from[i]]);
    }
    return out;
  };
  linear.order = 1;
  linear.cells = shrink(mesh.cells, mesh.nodes_per_cell, cell.corner_count());
  linear.facets = shrink(mesh.facets, mesh.nodes_per_facet, facet.corner_count());
  linear.nodes_per_cell = cell.corner_count();
  linear.nodes_per_facet = facet.corner_count();
  linear.nodes.clear();
  linear.node_entity.clear();
  for (const Index n : node_of_corner) {
    linear.nodes.push_back(mesh.nodes[n]);
    linear.node_entity.push_back(mesh.node_entity[n]);
  }
  scene::perturb(linear, problem, request.perturb, request.seed);
  for (std::size_t c = 0; c < node_of_corner.size(); ++c) {
    mesh.nodes[node_of_corner[c]] = linear.nodes[c];
  }
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    const Index* nodes = &mesh.cells[c * mesh.nodes_per_cell];
    for (int a = cell.corner_count(); a < cell.node_count(); ++a) {
      Vec3 mean = Vec3::Zero();
      for (const int k : cell.corners_of(a)) mean += mesh.nodes[nodes[k]];
      mesh.nodes[nodes[a]] = mean / static_cast<double>(cell.corners_of(a).size());
    }
  }
}

/// Whether every node beyond the corners lies where straight sides would put it.
bool is_curved(const scene::Mesh& mesh, const LagrangeShape& cell) {
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    const Index* nodes = &mesh.cells[c * mesh.nodes_per_cell];
    const double size = (mesh.nodes[nodes[1]] - mesh.nodes[nodes[0]]).norm();
    for (int a = cell.corner_count(); a < cell.node_count(); ++a) {
      Vec3 mean = Vec3::Zero();
      for (const int k : cell.corners_of(a)) mean += mesh.nodes[nodes[k]];
      mean /= static_cast<double>(cell.corners_of(a).size());
      if ((mean - mesh.nodes[nodes[a]]).norm() > 1e-9 * size) return true;  // above round-off
    }
  }
  return false;
}

scene::Mesh make_problem_mesh(const scene::Problem& problem, const scene::RunRequest& request,
                              const Options& options) {
  scene::MeshRequest wanted;
  wanted.h = request.h;
  wanted.shape = options.shape;
  wanted.order = options.degree;
  wanted.layout = problem.layout;
  scene::Mesh mesh = scene::make_mesh(problem, wanted);
  if (request.perturb > 0) {
    const LagrangeShape cell(mesh.dim, mesh.shape, mesh.order);
    const LagrangeShape facet(mesh.dim - 1, mesh.shape, mesh.order);
    perturb_corners(mesh, cell, facet, problem, request);
  }
  return mesh;
}

/// deal.II's vertex at each of gmsh's corners (lexicographic on hypercubes).
std::vector<int> dealii_corner(int corners, bool simplex) {
  if (simplex) return corners == 3 ? std::vector{0, 1, 2} : std::vector{0, 1, 2, 3};
  return corners == 4 ? std::vector{0, 1, 3, 2} : std::vector{0, 1, 3, 2, 4, 5, 7, 6};
}

}  // namespace

template <int dim>
Discretisation<dim>::Discretisation(const scene::Problem& problem,
                                    const scene::RunRequest& request, const Options& options)
    : m_mesh(make_problem_mesh(problem, request, options)),
      m_cell_shape(dim, m_mesh.shape, m_mesh.order),
      m_facet_shape(dim - 1, m_mesh.shape, m_mesh.order), m_three_points(options.three_points) {
  m_curved = m_mesh.order == 2 && is_curved(m_mesh, m_cell_shape);
  build_triangulation();
  if (m_mesh.shape == scene::CellShape::simplex) {
    m_element = std::make_unique<dealii::FESystem<dim>>(
        dealii::FE_SimplexP<dim>(options.degree), static_cast<unsigned>(dim));
  } else {
    m_element = std::make_unique<dealii::FESystem<dim>>(dealii::FE_Q<dim>(options.degree),
                                                        static_cast<unsigned>(dim));
  }
  m_dof_handler.reinit(m_triangulation);
  m_dof_handler.distribute_dofs(*m_element);
  number_nodes();
  build_mapping();
}

template <int dim> void Discretisation<dim>::build_triangulation() {
  const bool simplex = m_mesh.shape == scene::CellShape::simplex;
  const int corners = m_cell_shape.corner_count();
  const std::vector<int> place = dealii_corner(corners, simplex);
  std::vector<Index> vertex(m_mesh.nodes.size(), -1);
  std::vector<dealii::Point<dim>> points;
  std::vector<dealii::CellData<dim>> cells;
  for (std::size_t c = 0; c < m_mesh.cell_count(); ++c) {
    dealii::CellData<dim> cell(corners);
    for (int k = 0; k < corners; ++k) {
      const Index node = m_mesh.cells[c * m_mesh.nodes_per_cell + k];
      if (vertex[node] < 0) {
        vertex[node] = static_cast<Index>(points.size());
        m_node_of_vertex.push_back(node);
        dealii::Point<dim> X;
        for (int i = 0; i < dim; ++i) X[i] = m_mesh.nodes[node][i];
        points.push_back(X);
      }
      cell.vertices[place[k]] = vertex[node];
    }
    cells.push_back(cell);
  }
  if (!simplex) dealii::GridTools::consistently_order_cells(cells);
  try {
    m_triangulation.create_triangulation(points, cells, dealii::SubCellData());
  } catch (const dealii::ExceptionBase& error) {
    throw InputError({}, "geometry", error.get_exc_name(), "a mesh that deal.II can take");
  }
}

/// deal.II may turn a cell: its vertices tell where gmsh's corners, and with them all nodes,
/// lie on the reference cell; the element's support points do the rest.
template <int dim> void Discretisation<dim>::number_nodes() {
  const bool simplex = m_mesh.shape == scene::CellShape::simplex;
  const int corners = m_cell_shape.corner_count(), nodes = m_cell_shape.node_count();
  const std::vector<int> place = dealii_corner(corners, simplex);
  const auto& support = m_element->base_element(0).get_unit_support_points();
  m_node_dof.assign(m_mesh.nodes.size() * dim, dealii::numbers::invalid_dof_index);
  std::vector<Vec3> unit_vertex(corners);
  for (int k = 0; k < corners; ++k) unit_vertex[place[k]] = m_cell_shape.unit_nodes()[k];
  std::vector<dealii::types::global_dof_index> dofs(m_element->n_dofs_per_cell());
  for (const auto& cell : m_dof_handler.active_cell_iterators()) {
    cell->get_dof_indices(dofs);
    const Index* mesh_nodes = &m_mesh.cells[cell->active_cell_index() * m_mesh.nodes_per_cell];
    std::array<Vec3, 8> unit_corner;
    for (int v = 0; v < corners; ++v) {
      const Index node = m_node_of_vertex[cell->vertex_index(v)];
      const auto k = std::find(mesh_nodes, mesh_nodes + corners, node) - mesh_nodes;
      unit_corner[k] = unit_vertex[v];
    }
    for (int n = 0; n < nodes; ++n) {
      Vec3 xi = Vec3::Zero();
      for (const int k : m_cell_shape.corners_of(n)) xi += unit_corner[k];
      xi /= static_cast<double>(m_cell_shape.corners_of(n).size());
      for (int a = 0; a < nodes; ++a) {
        double distance = 0;
        for (int i = 0; i < dim; ++i) distance += std::abs(support[a][i] - xi[i]);
        if (distance > 1e-6) continue;
        for (int i = 0; i < dim; ++i) {
          m_node_dof[mesh_nodes[n] * dim + i] =
              dofs[m_element->component_to_system_index(i, a)];
        }
      }
    }
  }
}

template <int dim> void Discretisation<dim>::build_mapping() {
  if (m_curved) {
    m_positions.reinit(dofs());
    set_from_nodes(m_mesh.nodes, m_positions);
    m_mapping = std::make_unique<dealii::MappingFEField<dim, dim, dealii::Vector<double>>>(
        m_dof_handler, m_positions);
  } else if (m_mesh.shape == scene::CellShape::simplex) {
    m_mapping = std::make_unique<dealii::MappingFE<dim>>(dealii::FE_SimplexP<dim>(1));
  } else {
    m_mapping = std::make_unique<dealii::MappingQ1<dim>>();
  }
  m_smallest = 1e300;
  for (const auto& cell : m_triangulation.active_cell_iterators()) {
    m_smallest = std::min(m_smallest, cell->measure());
  }
  m_smallest = std::pow(m_smallest, 1.0 / dim);
}

template <int dim>
Vec3 Discretisation<dim>::node_value(const dealii::Vector<double>& values, Index node) const {
  Vec3 out = Vec3::Zero();
  if (!used(node)) return out;
  for (int i = 0; i < dim; ++i) out[i] = values[dof(node, i)];
  return out;
}

template <int dim>
std::vector<Vec3> Discretisation<dim>::at_nodes(const dealii::Vector<double>& values) const {
  std::vector<Vec3> out(m_mesh.nodes.size());
  for (std::size_t n = 0; n < out.size(); ++n)
    out[n] = node_value(values, static_cast<Index>(n));
  return out;
}

template <int dim>
void Discretisation<dim>::set_from_nodes(const std::vector<Vec3>& values,
                                         dealii::Vector<double>& out) const {
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!used(static_cast<Index>(n))) continue;
    for (int i = 0; i < dim; ++i) out[dof(static_cast<Index>(n), i)] = values[n][i];
  }
}

template <int dim> dealii::Quadrature<dim> Discretisation<dim>::gauss(int n) const {
  if (m_mesh.shape == scene::CellShape::simplex) {
    return dealii::QWitherdenVincentSimplex<dim>(n);
  }
  return dealii::QGauss<dim>(n);
}

/// deal.II's QGaussSimplex<2>(2) has 4 points; the rule of 3, exact to degree 2, is Strang and
/// Fix's first.
template <int dim> dealii::Quadrature<dim> Discretisation<dim>::force_rule() const {
  if constexpr (dim == 2) {
    if (m_three_points) {
      const double a = 1.0 / 6, b = 2.0 / 3;
      return dealii::Quadrature<2>(std::vector<dealii::Point<2>>{{a, a}, {b, a}, {a, b}},
                                   std::vector<double>(3, a));
    }
  }
  return gauss(degree() + (m_mesh.shape == scene::CellShape::simplex ? 0 : 1));
}

template class Discretisation<2>;
template class Discretisation<3>;

}  // namespace concord::fem
