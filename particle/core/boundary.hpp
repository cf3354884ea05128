#pragma once
// Displacement conditions and external loads of a problem on the particles of a body.

#include "particle/core/force_model.hpp"

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace concord::particle {

/// One displacement component of one point that a boundary condition prescribes.
struct PrescribedDof {
  Index particle;  ///< point: a particle or a boundary point
  int component;
  Index condition;  ///< index into Problem::boundaries; -1: a boundary point's free component
  Vec3 normal;      ///< outward unit normal, for conditions that need it
};

/// Which components a displacement condition prescribes on its group; none in a traction.
/// Throws InputError where a plane of symmetry is none.
std::array<bool, 3> prescribed_components(const scene::BoundaryCondition& bc,
                                          const scene::Mesh& mesh);

/// The points of a body that lie in a group, one entry a point. Where particles lie inside, a
/// face of the body has those whose cells it bounds, and the boundary points on it. Throws
/// InputError for missing groups, and for groups that then have no points.
std::vector<char> points_of_group(const Body& body, const std::string& group,
                                  const SourcePosition& where);

/// Prescribed displacements. Where particles lie on the faces, a symmetric plane prescribes the
/// normal component, an antisymmetric one the tangential components; where they lie inside, the
/// boundary points are prescribed, their free components as 0, which nothing reads.
class Constraints {
 public:
  /// Throws InputError for groups of the wrong kind and where two conditions prescribe
  /// different values of one component.
  Constraints(const scene::Problem& problem, const Body& body);

  const std::vector<PrescribedDof>& dofs() const { return m_dofs; }
  /// Whether any prescribed value differs from zero at some time (found by sampling 0, T/2, T
  /// and asking the expressions).
  bool moving() const { return m_moving; }
  double value(const PrescribedDof& dof, double t) const;
  /// Sets the prescribed components of u to their values at t.
  void impose(double t, std::span<double> u) const;
  /// Zeroes the prescribed components of a column (forces, initial velocity).
  void clear(std::span<double> column) const;
  /// Number of the particles' displacement components left free.
  long unknowns() const {
    return static_cast<long>(m_body.n) * m_body.dim - static_cast<long>(m_dofs.size());
  }

 private:
  void find_on_faces();
  void find_inside();

  const scene::Problem& m_problem;
  const Body& m_body;
  std::vector<PrescribedDof> m_dofs;  ///< by point, then component
  bool m_moving = false;
};

/// External forces: gravity (21), body force V_b b(X_b, t), and nominal traction, (A_beta / n)
/// T a vertex of each facet, the lumping with which patch test C is exact (the boundary sums of
/// B_ab are A_beta/n); where particles lie inside, by the formulation's LoadTerms.
class ExternalLoads {
 public:
  ExternalLoads(const scene::Problem& problem, const ForceModel& model);

  bool none() const {
    return m_constant_dense.empty() && m_constant.empty() && !depend_on_time();
  }
  bool depend_on_time() const {
    return !m_varying.empty() || !m_terms.empty() || m_varying_body;
  }
  /// Adds the loads at time t to f.
  void add(double t, std::span<double> f) const {
    add_constant(f);
    add_varying(t, f);
  }
  /// The part that never changes, and has the potential -f.u; and the part that depends on
  /// time.
  void add_constant(std::span<double> f) const;
  void add_varying(double t, std::span<double> f) const;
  bool any_constant() const { return !m_constant_dense.empty() || !m_constant.empty(); }
  /// Points on which time-dependent loads act, sorted.
  std::vector<Index> varying_particles() const;
  /// Shares of every particle on the faces of a group in its area, for averages: pairs
  /// (particle, area). Where particles lie on the faces.
  static std::vector<std::pair<Index, double>>
  group_areas(const Body& body, const std::string& group, const SourcePosition& where);

 private:
  using Sums = std::map<Index, Vec3>;
  void add_facet_loads(Index condition, Sums& constant);
  void add_terms(const std::vector<LoadTerm>& terms, Sums& constant);
  void add_terms_at(double t, std::span<double> f) const;
  struct Entry {
    Index particle;
    Index condition;
    double area;  ///< A_beta/n [m^2]
    Vec3 normal;
  };
  Vec3 traction(const Entry& entry, double t) const;

  const scene::Problem& m_problem;
  const Body& m_body;
  Column m_constant_dense;                         ///< gravity and constant body force
  std::vector<std::pair<Index, Vec3>> m_constant;  ///< constant tractions, a point
  std::vector<Entry> m_varying;
  std::vector<LoadTerm> m_terms;  ///< varying ones
  bool m_varying_body = false;
};

/// Boundary facets (indices into Triangulation::boundary) whose entity belongs to the group.
std::vector<Index> group_boundary_facets(const Body& body, const std::string& group,
                                         const SourcePosition& where);

}  // namespace concord::particle
