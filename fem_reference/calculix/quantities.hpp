#pragma once
// The scene's quantities from nodal values.

#include "fem_reference/calculix/deck.hpp"
#include "fem_reference/calculix/records.hpp"

namespace concord::calculix {

/// Stresses at nodes, and plastic strain: what frames and maxima take.
struct NodalFields {
  std::vector<double> von_mises, pressure;  ///< of the Cauchy stress [Pa]
  std::vector<double> kirchhoff_mises;      ///< J times von_mises, J the mean of the cells [Pa]
};
NodalFields nodal_fields(const scene::Mesh& mesh, const Record& record);

class Quantities {
 public:
  /// Throws InputError for quantities that a static run of CalculiX does not give.
  Quantities(const scene::Problem& problem, const scene::Mesh& mesh);

  const NodeSets& reaction_sets() const { return m_sets; }
  /// Names in summary.json, and columns of history.csv with their units, in the same order;
  /// gauss_plastic_strain_max is the last of plastic scenes.
  const std::vector<std::string>& keys() const { return m_keys; }
  const std::vector<std::string>& columns() const { return m_columns; }
  std::vector<double> evaluate(const Record& record, const NodalFields& fields) const;

 private:
  struct Probe {
    const scene::Quantity* quantity = nullptr;
    std::vector<Index> nodes;
    std::vector<double> weights;
    std::size_t set = 0;  ///< of a reaction
  };
  void weigh_group(Probe& probe) const;
  void choose_nodes(Probe& probe) const;
  void name(const scene::Quantity& quantity);
  double scalar(const std::string& field, const Record& record, const NodalFields& fields,
                Index node) const;
  Vec3 vector(const std::string& field, const Record& record, Index node) const;

  const scene::Problem& m_problem;
  const scene::Mesh& m_mesh;
  std::vector<Probe> m_probes;
  NodeSets m_sets;
  std::vector<std::string> m_keys, m_columns;
};

}  // namespace concord::calculix
