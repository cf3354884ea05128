#include "fem_reference/quantities.hpp"

#include <deal.II/base/quadrature_lib.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace concord::fem {
namespace {

using scene::Quantity;
using scene::QuantityKind;

bool is_vector(const std::string& field) {
  return field == "displacement" || field == "velocity" || field == "displacement_error";
}

/// Integral of N_a over one cell or facet, nodes in gmsh's order.
std::vector<double> shape_integrals(const LagrangeShape& shape, bool simplex,
                                    const scene::Mesh& mesh, const Index* nodes) {
  const int n = shape.node_count();
  std::vector<double> N(n), sum(n, 0);
  std::vector<Vec3> dN(n);
  const auto add = [&](const Vec3& xi, double weight) {
    shape.evaluate(xi, N, dN);
    std::array<Vec3, 3> t{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (int a = 0; a < n; ++a) {
      for (int i = 0; i < shape.dim(); ++i) t[i] += dN[a][i] * mesh.nodes[nodes[a]];
    }
    const double measure = shape.dim() == 1   ? t[0].norm()
                           : shape.dim() == 2 ? t[0].cross(t[1]).norm()
                                              : t[0].cross(t[1]).dot(t[2]);
    for (int a = 0; a < n; ++a) sum[a] += weight * measure * N[a];
  };
  const auto run = [&]<int d>(const dealii::Quadrature<d>& rule) {
    for (unsigned q = 0; q < rule.size(); ++q) {
      Vec3 xi = Vec3::Zero();
      for (int i = 0; i < d; ++i) xi[i] = rule.point(q)[i];
      add(xi, rule.weight(q));
    }
  };
  if (shape.dim() == 1) run(dealii::Quadrature<1>(dealii::QGauss<1>(3)));
  if (shape.dim() == 2 && simplex) {
    run(dealii::Quadrature<2>(dealii::QWitherdenVincentSimplex<2>(3)));
  } else if (shape.dim() == 2) {
    run(dealii::Quadrature<2>(dealii::QGauss<2>(3)));
  }
  if (shape.dim() == 3 && simplex) {
    run(dealii::Quadrature<3>(dealii::QWitherdenVincentSimplex<3>(3)));
  } else if (shape.dim() == 3) {
    run(dealii::Quadrature<3>(dealii::QGauss<3>(3)));
  }
  return sum;
}

}  // namespace

template <int dim>
Quantities<dim>::Quantities(const scene::Problem& problem,
                            const Discretisation<dim>& discretisation,
                            const NodalFields<dim>& fields, const Prescribed<dim>& prescribed)
    : m_problem(problem), m_discretisation(discretisation), m_fields(fields),
      m_prescribed(prescribed) {
  const MeshField field(discretisation.mesh(), discretisation.mesh().nodes);
  for (const Quantity& quantity : problem.quantities) {
    m_probes.push_back(make_probe(quantity, field));
    name(quantity);
  }
}

template <int dim> void Quantities<dim>::name(const Quantity& q) {
  const std::string& field = q.field;
  std::string unit = "m";
  if (q.kind == QuantityKind::reaction || field == "unbalanced_force")
    unit = "N";
  else if (field == "velocity")
    unit = "m_s";
  else if (field == "von_mises" || field == "pressure" || field == "kirchhoff_mises")
    unit = "Pa";
  const bool scalar =
      q.kind == QuantityKind::maximum || (q.kind == QuantityKind::average && !is_vector(field));
  if (scalar) {
    m_keys.push_back(q.name);
    m_columns.push_back(field == "plastic_strain" ? q.name : q.name + "_" + unit);
    return;
  }
  for (int i = 0; i < dim; ++i) {
    m_keys.push_back(q.name + "_" + "xyz"[i]);
    m_columns.push_back(m_keys.back() + "_" + unit);
  }
}

template <int dim>
typename Quantities<dim>::Probe Quantities<dim>::make_probe(const Quantity& quantity,
                                                            const MeshField& field) const {
  const scene::Mesh& mesh = m_discretisation.mesh();
  Probe probe{&quantity, {}, {}};
  if (quantity.kind == QuantityKind::point) {
    const auto place = field.locate(quantity.at);
    if (place.excess > 0.5) {  // half a cell outside: not a matter of a coarse boundary
      throw InputError(quantity.where, "quantity.at", quantity.name, "a point of the body");
    }
    const Index* nodes =
        &mesh.cells[static_cast<std::size_t>(place.cell) * mesh.nodes_per_cell];
    probe.nodes.assign(nodes, nodes + mesh.nodes_per_cell);
    probe.weights = field.weights(place);
  } else if (quantity.kind == QuantityKind::average) {
    weigh_group(quantity.group, probe);
  } else if (quantity.kind == QuantityKind::reaction) {
    probe.nodes = mesh.group_nodes(quantity.group, quantity.where);
  } else {
    choose_nodes(quantity, probe);
  }
  return probe;
}

template <int dim>
void Quantities<dim>::weigh_group(const std::string& group, Probe& probe) const {
  const scene::Mesh& mesh = m_discretisation.mesh();
  const bool simplex = mesh.shape == scene::CellShape::simplex;
  const auto found = mesh.groups.find(group);
  const int group_dim = found == mesh.groups.end() ? -1 : found->second.dim;
  std::vector<double> weight(mesh.nodes.size(), 0);
  const auto add = [&](const LagrangeShape& shape, const Index* nodes) {
    const auto integrals = shape_integrals(shape, simplex, mesh, nodes);
    for (int a = 0; a < shape.node_count(); ++a) weight[nodes[a]] += integrals[a];
  };
  if (group_dim == dim - 1) {
    for (const Index f : mesh.group_facets(group, probe.quantity->where)) {
      add(m_discretisation.facet_shape(),
          &mesh.facets[static_cast<std::size_t>(f) * mesh.nodes_per_facet]);
    }
  } else if (group_dim == dim) {
    std::vector<char> inside(mesh.nodes.size(), 0);
    for (const Index n : mesh.group_nodes(group, probe.quantity->where)) inside[n] = 1;
    for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
      const Index* nodes = &mesh.cells[c * mesh.nodes_per_cell];
      const bool whole = std::all_of(nodes, nodes + mesh.nodes_per_cell,
                                     [&](Index n) { return inside[n] != 0; });
      if (whole) add(m_discretisation.cell_shape(), nodes);
    }
  } else {
    for (const Index n : mesh.group_nodes(group, probe.quantity->where)) weight[n] = 1;
  }
  double sum = 0;
  for (const double w : weight) sum += w;
  for (std::size_t n = 0; n < weight.size(); ++n) {
    if (weight[n] == 0) continue;
    probe.nodes.push_back(static_cast<Index>(n));
    probe.weights.push_back(weight[n] / sum);
  }
}

template <int dim>
void Quantities<dim>::choose_nodes(const Quantity& quantity, Probe& probe) const {
  const scene::Mesh& mesh = m_discretisation.mesh();
  std::vector<Index> all;
  if (!quantity.group.empty()) {
    all = mesh.group_nodes(quantity.group, quantity.where);
  } else {
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) all.push_back(static_cast<Index>(n));
  }
  std::vector<char> surface(mesh.nodes.size(), 0);
  if (quantity.interior_only) {
    for (const Index n : mesh.facets) surface[n] = 1;
  }
  std::erase_if(all, [&](Index n) { return surface[n] != 0 || !m_discretisation.used(n); });
  const auto given = [&](Index n) {
    bool any = false;
    for (int i = 0; i < dim; ++i)
      any = any || m_prescribed.is_given(m_discretisation.dof(n, i));
    return any;
  };
  if (quantity.field == "unbalanced_force" && !std::all_of(all.begin(), all.end(), given)) {
    std::erase_if(all, given);
  }
  if (all.empty()) {
    throw InputError(quantity.where, "quantity", quantity.name,
                     "a group with nodes inside the body at this resolution");
  }
  probe.nodes = std::move(all);
}

template <int dim>
std::vector<Vec3> Quantities<dim>::vector_field(const std::string& field,
                                                const State& state) const {
  if (field == "velocity") {
    if (state.v.size() == 0)
      return std::vector<Vec3>(m_discretisation.mesh().nodes.size(), Vec3::Zero());
    return m_discretisation.at_nodes(state.v);
  }
  std::vector<Vec3> u = m_discretisation.at_nodes(state.u);
  if (field != "displacement_error") return u;
  if (!m_problem.exact_displacement) {
    throw InputError({m_problem.file.string()}, "quantity.field", field,
                     "a field that needs no exact solution: this scene has none");
  }
  for (std::size_t n = 0; n < u.size(); ++n) {
    u[n] -= (*m_problem.exact_displacement)(m_discretisation.mesh().nodes[n], state.t);
  }
  return u;
}

template <int dim>
double Quantities<dim>::maximum(const Probe& probe, const State& state) const {
  const std::string& field = probe.quantity->field;
  double most = -1e300;
  if (!is_vector(field) && field != "unbalanced_force") {
    const auto values = m_fields.at_nodes(field, state.u);
    for (const Index n : probe.nodes) most = std::max(most, values[n]);
    return most;
  }
  if (field == "unbalanced_force") {
    for (const Index n : probe.nodes) {
      const Vec3 f = m_discretisation.node_value(state.external, n) -
                     m_discretisation.node_value(state.internal, n);
      most = std::max(most, f.norm());
    }
    return most;
  }
  const auto values = vector_field(field, state);
  for (const Index n : probe.nodes) most = std::max(most, values[n].norm());
  return most;
}

template <int dim>
std::vector<double> Quantities<dim>::evaluate(const State& state,
                                              const MassProduct& mass) const {
  std::vector<double> out;
  for (const Probe& probe : m_probes) {
    const Quantity& q = *probe.quantity;
    if (q.kind == QuantityKind::maximum) {
      out.push_back(maximum(probe, state));
      continue;
    }
    if (q.kind == QuantityKind::average && !is_vector(q.field)) {
      const auto values = m_fields.at_nodes(q.field, state.u);
      double sum = 0;
      for (std::size_t k = 0; k < probe.nodes.size(); ++k) {
        sum += probe.weights[k] * values[probe.nodes[k]];
      }
      out.push_back(sum);
      continue;
    }
    Vec3 sum = Vec3::Zero();
    if (q.kind == QuantityKind::reaction) {
      State::Vector force = state.internal;
      if (mass) mass(state.a, force);  // force = M a
      if (mass) force += state.internal;
      force -= state.external;
      for (const Index n : probe.nodes) sum += m_discretisation.node_value(force, n);
    } else {
      const auto values =
          vector_field(q.kind == QuantityKind::point ? "displacement" : q.field, state);
      for (std::size_t k = 0; k < probe.nodes.size(); ++k) {
        sum += probe.weights[k] * values[probe.nodes[k]];
      }
    }
    for (int i = 0; i < dim; ++i) out.push_back(sum[i]);
  }
  return out;
}

template class Quantities<2>;
template class Quantities<3>;

}  // namespace concord::fem
