#pragma once
// The Voronoi particle method: gradient vectors of Voronoi cells, ghosts behind walls, contact
// stabilisation, artificial viscosity; three forms of the force.

#include "particle/core/force_model.hpp"
#include "particle/voronoi/boundary_pieces.hpp"

#include <memory>

namespace concord::particle::voronoi {

/// The force that acts on a particle.
enum class Form {
  face_compatible,  ///< exact gradient of a potential, faces' centroids shared by both cells
  conserving,       ///< the paper's dynamic form (43) with reactions D P A
  quasi_static      ///< the paper's static form (41), (42) with reactions D P A
};

/// Dimensionless parameters of Eqs. (50) and (51), and the form of the force.
struct Parameters {
  double xi_n = 1;  ///< K_n = xi_n E A_ab / L_ab
  double xi_t = 1;  ///< K_t = xi_t G A_ab / L_ab
  double c1 = 0;    ///< linear artificial viscosity
  double c2 = 0;    ///< quadratic artificial viscosity
  Form form = Form::face_compatible;
};

/// Forces of the Voronoi method on a body whose points are the particles, in the order of the
/// cells, and after them the boundary points. On a boundary point it returns the force that its
/// prescribed displacement has to balance: -dW/du in the face-compatible form, minus the
/// reaction in the others.
class VoronoiModel final : public ForceModel {
 public:
  /// `body`, `cells` and `boundary` must outlive the object. Throws InputError where ghosts of
  /// a particle are undetermined (a layer of one particle between free faces).
  VoronoiModel(const Body& body, const scene::Problem& problem, const Cells& cells,
               const Boundary& boundary, const Parameters& parameters,
               const Executor& executor = Executor(1));
  ~VoronoiModel() override;

  /// The adjoint of the face's displacement (VOR.13) in the face-compatible form, A T on the
  /// particle in the others (39).
  const std::vector<LoadTerm>& load_terms() const override;

  void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
              const Executor& executor) override;
  Energies energies(std::span<const double> u, const Executor& executor) override;
  /// Boundary points have the gradient of their particle.
  void gradients(std::span<const double> u, std::span<Mat3> H) override;
  const Stiffness& tangent(std::span<const double> u) override;
  bool has_potential() const override;
  bool viscous() const override;
  double viscous_damping_ratio(double omega_max) const override;
  std::size_t interactions() const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> m_implementation;
};

}  // namespace concord::particle::voronoi
