#include "fem_reference/nodal_fields.hpp"

#include "fem_reference/sampling.hpp"

#include <deal.II/fe/fe_values.h>

#include <algorithm>

namespace concord::fem {

template <int dim>
std::vector<double> ElasticFields<dim>::at_nodes(const std::string& field,
                                                 const dealii::Vector<double>& u) const {
  NodalStress stress = nodal_stress(m_discretisation, m_law, u);
  if (field == "von_mises") return std::move(stress.von_mises);
  if (field == "pressure") return std::move(stress.pressure);
  if (field == "kirchhoff_mises") return std::move(stress.kirchhoff_mises);
  throw InputError({}, "field", field, "a field of elastic materials");
}

template <int dim>
PlasticFields<dim>::PlasticFields(const Discretisation<dim>& discretisation,
                                  const PlasticPoints<dim>& points, double thickness)
    : m_points(points), m_recovery(discretisation) {
  dealii::FEValues<dim> values(discretisation.mapping(),
                               discretisation.element().base_element(0),
                               discretisation.force_rule(), dealii::update_JxW_values);
  for (const auto& cell : discretisation.triangulation().active_cell_iterators()) {
    values.reinit(cell);
    for (const double w : values.get_JxW_values()) m_JxW.push_back(w * thickness);
  }
}

template <int dim>
std::vector<double> PlasticFields<dim>::at_nodes(const std::string& field,
                                                 const dealii::Vector<double>&) const {
  const auto each = [&](const auto& value) {
    std::vector<double> values;
    values.reserve(m_JxW.size());
    for (const PlasticPoint<dim>& point : m_points.committed()) values.push_back(value(point));
    return m_recovery.at_nodes(values);
  };
  const Elastoplastic<dim>& law = m_points.law();
  if (field == "plastic_strain") return each([](const auto& p) { return p.eps_p; });
  if (field == "kirchhoff_mises")
    return each([&](const auto& p) { return law.measures(p).tau_eq; });
  if (field == "von_mises") {
    return each([&](const auto& p) {
      const auto m = law.measures(p);
      return m.tau_eq / m.J;
    });
  }
  if (field == "pressure") {
    return each([&](const auto& p) {
      const auto m = law.measures(p);
      return -m.mean_tau / m.J;
    });
  }
  throw InputError({}, "field", field, "a field of plastic materials");
}

template <int dim>
bool PlasticFields<dim>::complete(const dealii::Tensor<2, dim>& F,
                                  dealii::Tensor<2, 3>& F3) const {
  F3 = dealii::unit_symmetric_tensor<3>();
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) F3[i][j] = F[i][j];
  return true;
}

template <int dim> double PlasticFields<dim>::plastic_work() const {
  double sum = 0;
  for (std::size_t q = 0; q < m_JxW.size(); ++q) sum += m_JxW[q] * m_points.committed()[q].work;
  return sum;
}

template <int dim> double PlasticFields<dim>::peak_plastic_strain() const {
  double most = 0;
  for (const auto& point : m_points.committed()) most = std::max(most, point.eps_p);
  return most;
}

template class ElasticFields<2>;
template class ElasticFields<3>;
template class PlasticFields<2>;
template class PlasticFields<3>;

}  // namespace concord::fem
