#pragma once
// The scene's quantities of interest, from nodal values.

#include "fem_reference/boundary.hpp"
#include "fem_reference/field.hpp"
#include "fem_reference/nodal_fields.hpp"
#include "fem_reference/state.hpp"

#include <string>
#include <vector>

namespace concord::fem {

/// Values of all quantities at one state. Point: displacement at a reference position. Average:
/// sum_a w_a f_a / sum_a w_a with w_a = integral of N_a over the group (1 on groups of points
/// and curves in 3D, of points in 2D); stresses are averaged from their nodal values. Reaction:
/// sum over the group's nodes of f_int + M a - f_ext, the force that the support exerts on the
/// body. Maximum: over the nodes of the group or body; of the magnitude for vectors.
template <int dim> class Quantities {
 public:
  Quantities(const scene::Problem& problem, const Discretisation<dim>& discretisation,
             const NodalFields<dim>& fields, const Prescribed<dim>& prescribed);

  /// Columns of history.csv ("tip_x_m") and keys of summary.json ("tip_x").
  const std::vector<std::string>& columns() const { return m_columns; }
  const std::vector<std::string>& keys() const { return m_keys; }
  /// In the order of columns(). `mass` may be empty (statics).
  std::vector<double> evaluate(const State& state, const MassProduct& mass) const;

 private:
  struct Probe {
    const scene::Quantity* quantity;
    std::vector<Index> nodes;
    std::vector<double> weights;  ///< point and average: sum to 1
  };
  Probe make_probe(const scene::Quantity& quantity, const MeshField& field) const;
  void weigh_group(const std::string& group, Probe& probe) const;
  void choose_nodes(const scene::Quantity& quantity, Probe& probe) const;
  void name(const scene::Quantity& quantity);
  std::vector<Vec3> vector_field(const std::string& name, const State& state) const;
  double maximum(const Probe& probe, const State& state) const;

  const scene::Problem& m_problem;
  const Discretisation<dim>& m_discretisation;
  const NodalFields<dim>& m_fields;
  const Prescribed<dim>& m_prescribed;
  std::vector<Probe> m_probes;
  std::vector<std::string> m_columns, m_keys;
};

extern template class Quantities<2>;
extern template class Quantities<3>;

}  // namespace concord::fem
