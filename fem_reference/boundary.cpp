#include "fem_reference/boundary.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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
  std::vector<int> entry_of_dof(discretisation.dofs(), -1);
  for (const BoundaryCondition& bc : problem.boundaries) {
    if (bc.kind != BoundaryKind::traction) add(bc, entry_of_dof);
  }
}

template <int dim>
void Prescribed<dim>::add(const BoundaryCondition& bc, std::vector<int>& entry_of_dof) {
  const scene::Mesh& mesh = m_discretisation.mesh();
  const bool plane =
      bc.kind == BoundaryKind::symmetric || bc.kind == BoundaryKind::antisymmetric;
  const auto given = components(bc, plane ? mesh.group_axis(bc.group, bc.where) : -1);
  m_depends_on_time = m_depends_on_time || changes_in_time(m_problem, bc);
  for (const Index node : mesh.group_nodes(bc.group, bc.where)) {
    if (!m_discretisation.used(node)) continue;
    for (int i = 0; i < dim; ++i) {
      if (!given[i]) continue;
      const Entry entry{m_discretisation.dof(node, i), node, i, &bc};
      int& known = entry_of_dof[entry.dof];
      if (known >= 0) {
        require_same(m_entries[known], entry);
        continue;
      }
      known = static_cast<int>(m_entries.size());
      m_mask[entry.dof] = 1;
      m_entries.push_back(entry);
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

/// Compares at the start, at a third and at the end; 1e-9 relative and 1e-14 of the reference
/// length absolute are above round-off and below anything meant.
template <int dim>
void Prescribed<dim>::require_same(const Entry& first, const Entry& second) const {
  for (const double part : {0.0, 1.0 / 3, 1.0}) {
    const double t = part * m_problem.end_time;
    const double a = value(first, t), b = value(second, t);
    const double allowed =
        1e-9 * std::max(std::abs(a), std::abs(b)) + 1e-14 * m_problem.reference_length;
    if (std::abs(a - b) <= allowed) continue;
    const Vec3& X = m_discretisation.mesh().nodes[second.node];
    throw InputError(
        second.condition->where, "boundary",
        fmt::format(
            "groups \"{}\" and \"{}\" prescribe different displacements u_{} = {:g} m and "
            "{:g} m at their common point ({:g}, {:g}, {:g}), t = {:g}",
            first.condition->group, second.condition->group, "xyz"[second.component], a, b,
            X[0], X[1], X[2], t),
        "the same value where groups meet, or the component left \"free\" in one of them");
  }
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
