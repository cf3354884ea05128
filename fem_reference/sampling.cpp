#include "fem_reference/sampling.hpp"

#include <deal.II/fe/fe_values.h>

#include <Eigen/LU>

#include <cmath>

namespace concord::fem {

template <int dim>
scene::Samples sample(const Discretisation<dim>& discretisation, const NodalFields<dim>& law,
                      double thickness, const dealii::Vector<double>& u,
                      const dealii::Vector<double>& v) {
  const dealii::FESystem<dim>& element = discretisation.element();
  dealii::FEValues<dim> values(
      discretisation.mapping(), element, discretisation.gauss(discretisation.degree() + 2),
      dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
          dealii::update_quadrature_points);
  const dealii::FEValuesExtractors::Vector all(0);
  const unsigned points = values.n_quadrature_points;
  std::vector<dealii::Tensor<1, dim>> u_q(points), v_q(points);
  std::vector<dealii::Tensor<2, dim>> H_q(points);
  const auto vector = [](const dealii::Tensor<1, dim>& from) {
    Vec3 to = Vec3::Zero();
    for (int i = 0; i < dim; ++i) to[i] = from[i];
    return to;
  };
  scene::Samples out;
  for (const auto& cell : discretisation.dof_handler().active_cell_iterators()) {
    values.reinit(cell);
    values[all].get_function_values(u, u_q);
    values[all].get_function_gradients(u, H_q);
    if (v.size() != 0) values[all].get_function_values(v, v_q);
    for (unsigned q = 0; q < points; ++q) {
      dealii::Tensor<2, dim> F = H_q[q];
      for (int i = 0; i < dim; ++i) F[i][i] += 1;
      dealii::Tensor<2, 3> F3;
      const bool sound = law.complete(F, F3);
      Mat3 full = Mat3::Zero();
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) full(i, j) = sound ? F3[i][j] : std::nan("");
      }
      out.X.push_back(vector(values.quadrature_point(q)));
      out.u.push_back(vector(u_q[q]));
      if (v.size() != 0) out.v.push_back(vector(v_q[q]));
      out.F.push_back(full);
      out.weight.push_back(values.JxW(q) * thickness);
    }
  }
  return out;
}

namespace {

/// Means over the `count` contributions to each node. A node without any, where the law gives
/// no stress in any cell (det F <= 0 beside a singular corner, between sound Gauss points),
/// takes the mean over the nodes of its cells that have one.
void average(const scene::Mesh& mesh, const std::vector<int>& count,
             std::vector<double>& values) {
  const auto n = static_cast<std::size_t>(mesh.nodes_per_cell);
  for (std::size_t k = 0; k < count.size(); ++k)
    if (count[k] > 0) values[k] /= count[k];
  std::vector<double> sum(count.size(), 0.0);
  std::vector<int> around(count.size(), 0);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    const Index* nodes = &mesh.cells[c * n];
    for (std::size_t at = 0; at < n; ++at) {
      if (count[nodes[at]] > 0) continue;
      for (std::size_t a = 0; a < n; ++a) {
        if (count[nodes[a]] == 0) continue;
        sum[nodes[at]] += values[nodes[a]];
        ++around[nodes[at]];
      }
    }
  }
  for (std::size_t k = 0; k < count.size(); ++k)
    if (around[k] > 0) values[k] = sum[k] / around[k];
}

}  // namespace

template <int dim>
NodalStress nodal_stress(const Discretisation<dim>& discretisation,
                         const Hyperelastic<dim>& law, const dealii::Vector<double>& u) {
  const scene::Mesh& mesh = discretisation.mesh();
  const LagrangeShape& shape = discretisation.cell_shape();
  const std::vector<Vec3> u_nodes = discretisation.at_nodes(u);
  const int n = shape.node_count();
  std::vector<double> N(n);
  std::vector<std::vector<Vec3>> dN(n, std::vector<Vec3>(n));
  for (int at = 0; at < n; ++at) shape.evaluate(shape.unit_nodes()[at], N, dN[at]);
  const std::vector<double> zero(mesh.nodes.size(), 0);
  NodalStress out{zero, zero, zero};
  std::vector<int> count(mesh.nodes.size(), 0);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    const Index* nodes = &mesh.cells[c * n];
    for (int at = 0; at < n; ++at) {
      Mat3 J = Mat3::Zero(), slope = Mat3::Zero();
      for (int a = 0; a < n; ++a) {
        J += mesh.nodes[nodes[a]] * dN[at][a].transpose();
        slope += u_nodes[nodes[a]] * dN[at][a].transpose();
      }
      if (dim == 2) J(2, 2) = 1;
      const Mat3 H = slope * J.inverse();
      dealii::Tensor<2, dim> F;
      for (int i = 0; i < dim; ++i) {
        for (int j = 0; j < dim; ++j) F[i][j] = H(i, j) + (i == j ? 1 : 0);
      }
      dealii::SymmetricTensor<2, 3> sigma;
      dealii::Tensor<2, 3> F3;
      if (!law.cauchy(F, sigma) || !law.complete(F, F3)) continue;
      const double mises = std::sqrt(1.5) * deviator(sigma).norm();
      out.von_mises[nodes[at]] += mises;
      out.kirchhoff_mises[nodes[at]] += mises * determinant(F3);
      out.pressure[nodes[at]] += -trace(sigma) / 3;
      ++count[nodes[at]];
    }
  }
  for (auto* values : {&out.von_mises, &out.pressure, &out.kirchhoff_mises})
    average(mesh, count, *values);
  return out;
}

#define CONCORD_INSTANTIATE(dim)                                                               \
  template scene::Samples sample<dim>(const Discretisation<dim>&, const NodalFields<dim>&,     \
                                      double, const dealii::Vector<double>&,                   \
                                      const dealii::Vector<double>&);                          \
  template NodalStress nodal_stress<dim>(const Discretisation<dim>&, const Hyperelastic<dim>&, \
                                         const dealii::Vector<double>&)
CONCORD_INSTANTIATE(2);
CONCORD_INSTANTIATE(3);

}  // namespace concord::fem
