#pragma once
// Quantities of interest of a scene on the particles, with their places found once.

#include "particle/core/boundary.hpp"
#include "particle/core/force_model.hpp"
#include "particle/core/state.hpp"

#include <string>
#include <vector>

namespace concord::particle {

/// One value a particle: von_mises, pressure, kirchhoff_mises [Pa] or plastic_strain, from the
/// gradients H.
std::vector<double> material_field(const ForceModel& model, std::span<const Mat3> H,
                                   const std::string& name);

class Quantities {
 public:
  /// Throws InputError for quantities that name unknown groups. References must outlive the
  /// object.
  Quantities(const scene::Problem& problem, const ForceModel& model,
             const Constraints& constraints);

  /// Of every value: its name (NAME_x.. of vectors) and its column in history.csv (NAME_x_m).
  const std::vector<std::string>& names() const { return m_names; }
  const std::vector<std::string>& columns() const { return m_columns; }
  /// Appends the values at a state; H: its gradients.
  void append(const State& state, std::span<const Mat3> H, std::vector<double>& values) const;
  /// |u - exact| of every particle [m].
  std::vector<double> displacement_error(const State& state) const;

 private:
  struct Place {
    const scene::Quantity* quantity;
    Index nearest = 0;           ///< point: particle there, or nearest
    Vec3 offset = Vec3::Zero();  ///< from that particle to the point, zero if it lies there [m]
    std::vector<std::pair<Index, double>> areas;  ///< average: particles with their areas,
                                                  ///< or pieces of the surface with theirs
    double area = 0;
    std::vector<PrescribedDof> dofs;  ///< reaction: prescribed components of the group
    std::vector<Index> particles;     ///< maximum: where it is sought
  };
  Place find_place(const scene::Quantity& quantity) const;
  Vec3 vector_value(const Place& place, const State& state, std::span<const Mat3> H) const;
  Vec3 at_face(const SurfacePiece& piece, const State& state, std::span<const Mat3> H) const;
  double maximum(const Place& place, const State& state, std::span<const Mat3> H) const;
  std::vector<double> field(const std::string& name, const State& state,
                            std::span<const Mat3> H) const;

  const scene::Problem& m_problem;
  const ForceModel& m_model;
  const Constraints& m_constraints;
  std::vector<Place> m_places;
  std::vector<std::string> m_names, m_columns;
};

}  // namespace concord::particle
