#pragma once
// Prescribed displacements: fixed, symmetric, antisymmetric and given values, by physical
// group.

#include "fem_reference/discretisation.hpp"

#include <vector>

namespace concord::fem {

/// Every unknown whose value is given, with the condition that gives it. Groups of points,
/// curves, surfaces and volumes all act on the nodes of their closure.
template <int dim> class Prescribed {
 public:
  /// Conditions that disagree where groups meet were refused by scene::make_mesh.
  Prescribed(const scene::Problem& problem, const Discretisation<dim>& discretisation);

  std::size_t size() const { return m_entries.size(); }
  unsigned dof(std::size_t k) const { return m_entries[k].dof; }
  bool is_given(unsigned dof) const { return m_mask[dof] != 0; }
  bool depends_on_time() const { return m_depends_on_time; }
  /// Values at time t [m], in the order of dof(k).
  std::vector<double> values(double t) const;
  /// Throws InputError unless the conditions hold back every rigid motion, as statics needs.
  void require_support() const;

 private:
  struct Entry {
    unsigned dof;
    Index node;
    int component;
    const scene::BoundaryCondition* condition;
  };
  void add(const scene::BoundaryCondition& condition);
  double value(const Entry& entry, double t) const;

  const scene::Problem& m_problem;
  const Discretisation<dim>& m_discretisation;
  std::vector<Entry> m_entries;
  std::vector<char> m_mask;
  bool m_depends_on_time = false;
};

extern template class Prescribed<2>;
extern template class Prescribed<3>;

}  // namespace concord::fem
