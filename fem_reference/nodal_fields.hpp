#pragma once
// Fields of the material at nodes, and what its history says, for quantities and output.

#include "fem_reference/plastic_points.hpp"
#include "fem_reference/recovery.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace concord::fem {

template <int dim> class NodalFields {
 public:
  using Vector = dealii::Vector<double>;
  virtual ~NodalFields() = default;

  /// One value a node of the mesh: "von_mises", "pressure" (of Cauchy), "kirchhoff_mises" [Pa];
  /// of plastic materials "plastic_strain". Throws InputError for any other name.
  virtual std::vector<double> at_nodes(const std::string& field, const Vector& u) const = 0;
  /// Those of them that every frame holds.
  virtual std::vector<std::string> frame_fields() const = 0;
  /// F with its out-of-plane stretch; false where there is none.
  virtual bool complete(const dealii::Tensor<2, dim>& F, dealii::Tensor<2, 3>& F3) const = 0;
  virtual bool plastic() const { return false; }
  /// Of plastic materials: plastic work [J], and largest plastic strain of a quadrature point.
  virtual double plastic_work() const { return 0; }
  virtual double peak_plastic_strain() const { return 0; }
};

/// Evaluated at the nodes of each cell from its displacements, then averaged.
template <int dim> class ElasticFields : public NodalFields<dim> {
 public:
  ElasticFields(const Discretisation<dim>& discretisation, const Hyperelastic<dim>& law)
      : m_discretisation(discretisation), m_law(law) {}
  std::vector<double> at_nodes(const std::string& field,
                               const dealii::Vector<double>& u) const override;
  std::vector<std::string> frame_fields() const override { return {"von_mises"}; }
  bool complete(const dealii::Tensor<2, dim>& F, dealii::Tensor<2, 3>& F3) const override {
    return m_law.complete(F, F3);
  }

 private:
  const Discretisation<dim>& m_discretisation;
  const Hyperelastic<dim>& m_law;
};

/// Recovered from the committed states of the quadrature points; u plays no part.
template <int dim> class PlasticFields : public NodalFields<dim> {
 public:
  PlasticFields(const Discretisation<dim>& discretisation, const PlasticPoints<dim>& points,
                double thickness);
  std::vector<double> at_nodes(const std::string& field,
                               const dealii::Vector<double>& u) const override;
  std::vector<std::string> frame_fields() const override {
    return {"von_mises", "kirchhoff_mises", "plastic_strain"};
  }
  bool complete(const dealii::Tensor<2, dim>& F, dealii::Tensor<2, 3>& F3) const override;
  bool plastic() const override { return true; }
  double plastic_work() const override;
  double peak_plastic_strain() const override;

 private:
  const PlasticPoints<dim>& m_points;
  Recovery<dim> m_recovery;
  std::vector<double> m_JxW;  ///< [cell][point], thickness included
};

extern template class ElasticFields<2>;
extern template class ElasticFields<3>;
extern template class PlasticFields<2>;
extern template class PlasticFields<3>;

}  // namespace concord::fem
