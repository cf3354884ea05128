#include "fem_reference/boundary.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include <array>

namespace concord::fem {
namespace {

using scene::BoundaryCondition;
using scene::BoundaryKind;

/// Which components a condition prescribes; `axis` is the normal direction of a plane group.
std::array<bool, 3> components(const BoundaryCondition& bc, int axis) {
  std::array<bool, 3> given{true, true, true};
  for (int i = 0; i < 3; ++i) {
    if (bc.kind == BoundaryKind::symmetric) given[i] = i == axis;
    if (bc.kind == BoundaryKind::antisymmetric) given[i] = i != axis;
    if (bc.kind == BoundaryKind::displacement && !bc.value_from_exact) {
      given[i] = bc.value.component[i].has_value();
    }
  }
  return given;
}

bool changes_in_time(const scene::Problem& problem, const BoundaryCondition& bc) {
  if (bc.kind != BoundaryKind::displacement) return false;
  if (bc.value_from_exact) return problem.exact_displacement->depends_on_time();
  return bc.value.depends_on_time();
}

}  // namespace

template <int dim>
Prescribed<dim>::Prescribed(const scene::Problem& problem,
                            const Discretisation<dim>& discretisation)
    : m_problem(problem), m_discretisation(discretisation), m_mask(discretisation.dofs(), 0) {
  for (const BoundaryCondition& bc : problem.boundaries) {
    if (bc.kind != BoundaryKind::traction) add(bc);
  }
}

template <int dim> void Prescribed<dim>::add(const BoundaryCondition& bc) {
  const scene::Mesh& mesh = m_discretisation.mesh();
  const bool plane =
      bc.kind == BoundaryKind::symmetric || bc.kind == BoundaryKind::antisymmetric;
  const auto given = components(bc, plane ? mesh.group_axis(bc.group, bc.where) : -1);
  m_depends_on_time = m_depends_on_time || changes_in_time(m_problem, bc);
  for (const Index node : mesh.group_nodes(bc.group, bc.where)) {
    if (!m_discretisation.used(node)) continue;
    for (int i = 0; i < dim; ++i) {
      if (!given[i]) continue;
      const unsigned dof = m_discretisation.dof(node, i);
      if (m_mask[dof] != 0) continue;  // given by another group too: make_mesh saw them agree
      m_mask[dof] = 1;
      m_entries.push_back({dof, node, i, &bc});
    }
  }
}

template <int dim> double Prescribed<dim>::value(const Entry& entry, double t) const {
  if (entry.condition->kind != BoundaryKind::displacement) return 0;
  const Vec3& X = m_discretisation.mesh().nodes[entry.node];
  return m_problem.boundary_value(*entry.condition, X, t, Vec3::Zero())[entry.component];
}

template <int dim> std::vector<double> Prescribed<dim>::values(double t) const {
  std::vector<double> out(m_entries.size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = value(m_entries[k], t);
  return out;
}

/// Rank of the rigid motions seen at the given unknowns: the smallest eigenvalue of their Gram
/// matrix, lengths scaled by the body's size; 1e-9 is far above round-off.
template <int dim> void Prescribed<dim>::require_support() const {
  constexpr int modes = dim == 3 ? 6 : 3;
  const scene::Mesh& mesh = m_discretisation.mesh();
  Vec3 low = mesh.nodes[mesh.cells[0]], high = low;
  for (const Vec3& X : mesh.nodes) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  const double size = (high - low).norm();
  Eigen::Matrix<double, modes, modes> gram = Eigen::Matrix<double, modes, modes>::Zero();
  for (const Entry& entry : m_entries) {
    const Vec3 r = (mesh.nodes[entry.node] - 0.5 * (low + high)) / size;
    Eigen::Matrix<double, modes, 1> motion = Eigen::Matrix<double, modes, 1>::Zero();
    motion[entry.component] = 1;
    for (int k = 0; k < modes - dim; ++k) {
      const Vec3 axis = dim == 3 ? Vec3::Unit(k) : Vec3::Unit(2);
      motion[dim + k] = axis.cross(r)[entry.component];
    }
    gram += motion * motion.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, modes, modes>> solver(gram);
  if (solver.eigenvalues()[0] > 1e-9) return;
  throw InputError(
      {m_problem.file.string()}, "boundary",
      fmt::format("{} prescribed components that leave a rigid motion free", m_entries.size()),
      "for a static scene, conditions that hold back all translations and rotations");
}

template class Prescribed<2>;
template class Prescribed<3>;

}  // namespace concord::fem
