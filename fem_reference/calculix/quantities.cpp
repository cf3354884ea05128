#include "fem_reference/calculix/quantities.hpp"

#include "fem_reference/calculix/simplex.hpp"
#include "scene/material.hpp"

#include <algorithm>

namespace concord::calculix {
namespace {

using scene::Quantity;
using scene::QuantityKind;

std::size_t at(Index n) { return static_cast<std::size_t>(n); }

bool is_vector(const Quantity& q) {
  return q.kind == QuantityKind::point || q.field == "displacement" ||
         q.field == "displacement_error";
}

void check(const scene::Problem& problem, const Quantity& q) {
  if (q.kind == QuantityKind::reaction || q.kind == QuantityKind::point) return;
  if (q.field == "velocity" || q.field == "unbalanced_force")
    throw InputError(q.where, "quantity.field", q.field,
                     "displacement, displacement_error, von_mises, pressure, plastic_strain or "
                     "kirchhoff_mises for method calculix");
  if (q.field == "plastic_strain" && !problem.material.plastic())
    throw InputError(q.where, "quantity.field", q.field, "a field of an elastic material");
  if (q.field == "displacement_error" && !problem.exact_displacement)
    throw InputError(q.where, "quantity.field", q.field,
                     "a field that needs no exact solution: this scene has none");
}

}  // namespace

NodalFields nodal_fields(const scene::Mesh& mesh, const Record& record) {
  NodalFields fields;
  const std::vector<double> J = nodal_volume_ratio(mesh, record.u, record.t);
  for (std::size_t n = 0; n < record.stress.size(); ++n) {
    fields.von_mises.push_back(scene::von_mises(record.stress[n]));
    fields.pressure.push_back(scene::pressure(record.stress[n]));
    fields.kirchhoff_mises.push_back(J[n] * fields.von_mises.back());
  }
  return fields;
}

Quantities::Quantities(const scene::Problem& problem, const scene::Mesh& mesh)
    : m_problem(problem), m_mesh(mesh) {
  for (const Quantity& q : problem.quantities) {
    check(problem, q);
    Probe probe{&q, {}, {}, 0};
    if (q.kind == QuantityKind::point) {
      Place place = locate(mesh, q.at, q.where);
      probe.nodes = std::move(place.nodes);
      probe.weights = std::move(place.weights);
    } else if (q.kind == QuantityKind::average) {
      weigh_group(probe);
    } else if (q.kind == QuantityKind::reaction) {
      probe.set = m_sets.size();
      m_sets.push_back(mesh.group_nodes(q.group, q.where));
    } else {
      choose_nodes(probe);
    }
    m_probes.push_back(std::move(probe));
    name(q);
  }
  if (!problem.material.plastic()) return;
  m_keys.emplace_back("gauss_plastic_strain_max");
  m_columns.push_back(m_keys.back());
}

void Quantities::name(const Quantity& q) {
  std::string unit = "_m";
  if (q.kind == QuantityKind::reaction) unit = "_N";
  if (q.field == "von_mises" || q.field == "pressure" || q.field == "kirchhoff_mises")
    unit = "_Pa";
  if (q.field == "plastic_strain") unit.clear();
  const bool scalar =
      q.kind == QuantityKind::maximum || (q.kind == QuantityKind::average && !is_vector(q));
  for (int i = 0; i < (scalar ? 1 : m_mesh.dim); ++i) {
    m_keys.push_back(scalar ? q.name : q.name + "_" + "xyz"[i]);
    m_columns.push_back(m_keys.back() + unit);
  }
}

/// Weights of the mean over a group: int N_a dA or dV over facets or cells, equal ones for
/// groups of other dimensions.
void Quantities::weigh_group(Probe& probe) const {
  const Quantity& q = *probe.quantity;
  const std::vector<Index> members = m_mesh.group_nodes(q.group, q.where);
  const int dim = m_mesh.groups.at(q.group).dim;
  std::vector<double> weight(m_mesh.nodes.size(), 0);
  const auto add = [&](const QuadraticSimplex& shape, const SimplexRule& rule,
                       const Index* nodes) {
    std::vector<double> N(at(shape.node_count()));
    std::vector<Vec3> dN(N.size());
    for (std::size_t k = 0; k < rule.points.size(); ++k) {
      const double dV =
          rule.weights[k] *
          calculix::evaluate(m_mesh, shape, nodes, m_mesh.nodes, rule.points[k]).jacobian;
      shape.evaluate(rule.points[k], N, dN);
      for (std::size_t a = 0; a < N.size(); ++a) weight[at(nodes[a])] += dV * N[a];
    }
  };
  if (dim == m_mesh.dim - 1) {
    const QuadraticSimplex shape(dim);
    const SimplexRule rule(dim);
    for (const Index f : m_mesh.group_facets(q.group, q.where))
      add(shape, rule, &m_mesh.facets[at(f) * at(m_mesh.nodes_per_facet)]);
  } else if (dim == m_mesh.dim) {
    const QuadraticSimplex shape(dim);
    const SimplexRule rule(dim);
    std::vector<char> inside(m_mesh.nodes.size(), 0);
    for (const Index n : members) inside[at(n)] = 1;
    for (std::size_t c = 0; c < m_mesh.cell_count(); ++c) {
      const Index* nodes = &m_mesh.cells[c * at(m_mesh.nodes_per_cell)];
      if (std::all_of(nodes, nodes + m_mesh.nodes_per_cell,
                      [&](Index n) { return inside[at(n)] != 0; }))
        add(shape, rule, nodes);
    }
  } else {
    for (const Index n : members) weight[at(n)] = 1;
  }
  double sum = 0;
  for (const double w : weight) sum += w;
  for (std::size_t n = 0; n < weight.size(); ++n) {
    if (weight[n] == 0) continue;
    probe.nodes.push_back(static_cast<Index>(n));
    probe.weights.push_back(weight[n] / sum);
  }
}

void Quantities::choose_nodes(Probe& probe) const {
  const Quantity& q = *probe.quantity;
  if (!q.group.empty()) {
    probe.nodes = m_mesh.group_nodes(q.group, q.where);
  } else {
    for (std::size_t n = 0; n < m_mesh.nodes.size(); ++n)
      probe.nodes.push_back(static_cast<Index>(n));
  }
  if (q.interior_only) {
    std::vector<char> surface(m_mesh.nodes.size(), 0);
    for (const Index n : m_mesh.facets) surface[at(n)] = 1;
    std::erase_if(probe.nodes, [&](Index n) { return surface[at(n)] != 0; });
  }
  if (probe.nodes.empty())
    throw InputError(q.where, "quantity", q.name,
                     "a group with nodes inside the body at this resolution");
}

double Quantities::scalar(const std::string& field, const Record& record,
                          const NodalFields& fields, Index node) const {
  if (field == "von_mises") return fields.von_mises[at(node)];
  if (field == "pressure") return fields.pressure[at(node)];
  if (field == "kirchhoff_mises") return fields.kirchhoff_mises[at(node)];
  if (field == "plastic_strain") return record.plastic_strain[at(node)];
  return vector(field, record, node).norm();
}

Vec3 Quantities::vector(const std::string& field, const Record& record, Index node) const {
  Vec3 u = record.u[at(node)];
  if (field == "displacement_error")
    u -= (*m_problem.exact_displacement)(m_mesh.nodes[at(node)], record.t);
  return u;
}

std::vector<double> Quantities::evaluate(const Record& record,
                                         const NodalFields& fields) const {
  std::vector<double> out;
  for (const Probe& probe : m_probes) {
    const Quantity& q = *probe.quantity;
    if (q.kind == QuantityKind::maximum) {
      double most = -1e300;
      for (const Index n : probe.nodes)
        most = std::max(most, scalar(q.field, record, fields, n));
      out.push_back(most);
      continue;
    }
    if (q.kind == QuantityKind::average && !is_vector(q)) {
      double sum = 0;
      for (std::size_t k = 0; k < probe.nodes.size(); ++k)
        sum += probe.weights[k] * scalar(q.field, record, fields, probe.nodes[k]);
      out.push_back(sum);
      continue;
    }
    Vec3 sum = Vec3::Zero();
    if (q.kind == QuantityKind::reaction) {
      sum = record.reactions[probe.set];
    } else {
      for (std::size_t k = 0; k < probe.nodes.size(); ++k)
        sum += probe.weights[k] * vector(q.field, record, probe.nodes[k]);
    }
    for (int i = 0; i < m_mesh.dim; ++i) out.push_back(sum[i]);
  }
  if (m_problem.material.plastic()) out.push_back(record.gauss_plastic_strain_max);
  return out;
}

}  // namespace concord::calculix
