// The discretised body of the explicit elements, for tests of stability.

#include "fem_reference/boundary.hpp"
#include "fem_reference/element_table.hpp"
#include "fem_reference/entry.hpp"
#include "fem_reference/matrix_free.hpp"
#include "fem_reference/nodal_fields.hpp"
#include "fem_reference/spectrum.hpp"

#include <deal.II/base/multithread_info.h>

namespace concord::fem {
namespace {

/// Explicit dynamics need the lumped mass of Q1 and Q2, and a law without a history.
Options explicit_options(const scene::Problem& problem, const scene::RunRequest& request) {
  const Options options = read_options(problem, request);
  if (options.shape != scene::CellShape::hypercube) {
    throw InputError({problem.file.string()}, "fem.element", options.element,
                     "Q1 or Q2, which have a lumped mass");
  }
  if (problem.material.plastic()) {
    throw InputError({problem.file.string()}, "material.model", "a plastic material",
                     "an elastic one: fem has no explicit dynamics of plastic bodies");
  }
  return options;
}

/// Points are the nodes of the mesh that belong to cells. Forces come from the matrix-free
/// operator of the explicit runs, the stiffness from the table of Newton's method; both use
/// p+1 Gauss points a direction.
template <int Dim> class FemBody final : public scene::DiscreteBody {
 public:
  using Vector = InternalForce::Vector;

  FemBody(const scene::Problem& problem, const scene::RunRequest& request)
      : m_options(explicit_options(problem, request)),
        m_discretisation(problem, request, m_options), m_law(problem, m_options.split_law),
        m_points(m_law), m_fields(m_discretisation, m_law),
        m_prescribed(problem, m_discretisation),
        m_force(make_matrix_free(m_discretisation, m_law, problem.thickness)),
        m_thickness(problem.thickness), m_u(m_discretisation.dofs()),
        m_f(m_discretisation.dofs()) {
    lumped_mass(m_discretisation, problem.material.rho0, problem.thickness, m_mass);
    const std::vector<Vec3>& nodes = m_discretisation.mesh().nodes;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const auto node = static_cast<Index>(a);
      if (!m_discretisation.used(node)) continue;
      m_node.push_back(node);
      m_positions.push_back(nodes[a]);
      m_masses.push_back(m_mass[m_discretisation.dof(node, 0)]);
    }
  }

  int dim() const override { return Dim; }
  std::span<const Vec3> positions() const override { return m_positions; }
  std::span<const double> masses() const override { return m_masses; }
  unsigned prescribed(Index point) const override {
    unsigned bits = 0;
    for (int i = 0; i < Dim; ++i) {
      if (m_prescribed.is_given(m_discretisation.dof(m_node[point], i)))
        bits |= 1U << static_cast<unsigned>(i);
    }
    return bits;
  }

  void force(std::span<const double> u, std::span<double> f) override {
    take(u);
    check(m_force->force(m_u, m_f));
    for_dofs([&](std::size_t k, unsigned dof) { f[k] = -m_f[dof]; });
  }

  double energy(std::span<const double> u) override {
    take(u);
    return m_force->energy(m_u);
  }

  void pressure(std::span<const double> u, std::span<double> p) override {
    take(u);
    const std::vector<double> all = m_fields.at_nodes("pressure", m_u);
    for (std::size_t a = 0; a < m_node.size(); ++a) p[a] = all[m_node[a]];
  }

  Eigen::SparseMatrix<double> stiffness(std::span<const double> u) override {
    take(u);
    ElementTable<Dim, ElasticPoints<Dim>> table(m_discretisation, m_points, m_thickness);
    dealii::SparseMatrix<double> K(table.sparsity());
    check(table.tangent(m_u, m_f, K));
    std::vector<int> number(m_u.size(), -1);
    for_dofs([&](std::size_t k, unsigned dof) { number[dof] = static_cast<int>(k); });
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& entry : K)
      entries.emplace_back(number[entry.row()], number[entry.column()], entry.value());
    const auto size = static_cast<Eigen::Index>(m_node.size()) * Dim;
    Eigen::SparseMatrix<double> result(size, size);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

  double critical_step(std::span<const double> u) override {
    take(u);
    check(m_force->force(m_u, m_f));
    Spectrum spectrum(
        *m_force, m_mass, [&](unsigned dof) { return m_prescribed.is_given(dof); },
        m_discretisation.smallest_cell());
    return 2 / spectrum.omega(m_u, m_f, first_least, first_most);
  }

 private:
  template <class F> void for_dofs(const F& each) const {
    for (std::size_t a = 0; a < m_node.size(); ++a) {
      for (int i = 0; i < Dim; ++i) each(a * Dim + i, m_discretisation.dof(m_node[a], i));
    }
  }
  void take(std::span<const double> u) {
    for_dofs([&](std::size_t k, unsigned dof) { m_u[dof] = u[k]; });
  }
  static void check(long bad_element) {
    if (bad_element >= 0) throw SolveError("det F", 0, 0, bad_element);
  }

  Options m_options;
  Discretisation<Dim> m_discretisation;
  Hyperelastic<Dim> m_law;
  ElasticPoints<Dim> m_points;
  ElasticFields<Dim> m_fields;
  Prescribed<Dim> m_prescribed;
  std::unique_ptr<InternalForce> m_force;
  double m_thickness;
  Vector m_mass, m_u, m_f;
  std::vector<Index> m_node;
  std::vector<Vec3> m_positions;
  std::vector<double> m_masses;
};

}  // namespace
}  // namespace concord::fem

concord::scene::DiscreteBody*
concord_fem_discretise(const concord::scene::Problem& problem,
                       const concord::scene::RunRequest& request) {
  using namespace concord;
  dealii::MultithreadInfo::set_thread_limit(1);
  if (problem.dim() == 2) return new fem::FemBody<2>(problem, request);
  return new fem::FemBody<3>(problem, request);
}
