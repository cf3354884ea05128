#pragma once
// External forces: nominal tractions on faces, gravity and body forces; all dead loads.

#include "fem_reference/discretisation.hpp"

#include <vector>

namespace concord::fem {

/// f_ext,ai = thickness (sum_faces N_a T_i dA + sum_cells N_a (rho0 g_i + b_i) dV), p+2 points
/// a direction. Parts that do not depend on time are integrated once.
template <int dim> class Loads {
 public:
  using Vector = dealii::Vector<double>;
  /// Throws InputError for tractions on groups that are not boundary faces.
  Loads(const scene::Problem& problem, const Discretisation<dim>& discretisation);

  /// f_ext at time t [N], overwritten.
  void evaluate(double t, Vector& f) const;
  bool depends_on_time() const { return m_depends_on_time; }
  bool any() const { return m_any; }

 private:
  struct FacetPoint {
    const scene::BoundaryCondition* condition;
    std::size_t facet;
    unsigned q;
    Vec3 X, N;
    double weight;  ///< dA times thickness
  };
  void collect_facets(const scene::BoundaryCondition& condition);
  Vec3 outward(std::size_t facet, const Vec3& normal) const;
  void add_traction(const FacetPoint& point, double t, Vector& f) const;
  void add_volume(double t, bool gravity, bool body_force, Vector& f) const;

  const scene::Problem& m_problem;
  const Discretisation<dim>& m_discretisation;
  std::vector<std::size_t> m_cell_of_facet;
  std::vector<Vec3> m_facet_xi;
  std::vector<double> m_facet_w;
  std::vector<std::vector<double>> m_facet_N;  ///< [q][node]
  std::vector<FacetPoint> m_varying;
  Vector m_constant;
  bool m_any = false, m_depends_on_time = false, m_body_varies = false;
};

extern template class Loads<2>;
extern template class Loads<3>;

}  // namespace concord::fem
