#pragma once
// What an explicit or static particle solver needs to know of a formulation: its forces,
// energies and tangent. Virtual dispatch happens once a step; the loops inside know everything
// at compile time.

#include "particle/core/body.hpp"
#include "particle/core/constitution.hpp"
#include "particle/core/fracturing.hpp"
#include "particle/core/parallel.hpp"

#include <Eigen/SparseCore>

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace concord::scene {
class Checkpoint;
}

namespace concord::particle {

/// A kernel met a state it cannot go on from. The caller adds step and time.
struct BadState {
  std::string quantity;  ///< "det F", "displacement", "velocity", "force"
  Index particle;
};

/// Consecutive particles [first, last).
struct ParticleRange {
  Index first, last;
  friend bool operator==(const ParticleRange&, const ParticleRange&) = default;
};

/// Stored energies [J].
struct Energies {
  double internal = 0;  ///< sum V_a U(F_a), Eq. (14); with plasticity the elastic part
  double plastic = 0;   ///< plastic work sum V_a Psi_p(eps_p,a)
  double stabilisation =
      0;  ///< contact energy (15) or penalty energy; 0 where the stabilisation has no potential
};

/// What a nominal traction on one piece of the surface adds to the force on one point: M T(X,
/// t) [N]. For formulations whose particles lie inside the body.
struct LoadTerm {
  Index point;            ///< particle or boundary point
  Index condition;        ///< of the traction, index into Problem::boundaries
  Mat3 M = Mat3::Zero();  ///< [m^2]
  Vec3 X, N;              ///< the piece's centroid [m] and outward unit normal
};

/// Forces of one formulation on one body. State is the displacement u = x - X (and velocity v),
/// not the position: H = F - I then has no cancellation, and small strains keep their relative
/// accuracy. Columns are over all points of the body; on boundary points u is what the scene
/// prescribes there (0 for free components) and f what this costs, -dW/du.
class ForceModel {
 public:
  ForceModel(const Body& body, const scene::Problem& problem)
      : m_body(body), m_constitution(problem, body.bulk) {}
  virtual ~ForceModel() = default;
  ForceModel(const ForceModel&) = delete;
  ForceModel& operator=(const ForceModel&) = delete;

  const Body& body() const { return m_body; }
  const Constitution& constitution() const { return m_constitution; }

  /// Takes the material state of the last forces() as the start of later evaluations, which all
  /// begin from the last state taken: to be called once for every accepted step.
  void commit() { m_constitution.commit(); }

  /// Saves or restores all that later forces depend on beside u and v, so that they have the
  /// same bits: here the material's history. A model that keeps more from step to step (what
  /// has broken, forces of the last step) overrides this, calls this one, and adds its items;
  /// one that is restored has been constructed in the same way as the one that was saved.
  virtual void keep(scene::Checkpoint& state);

  /// While held, plastic flow is off: forces respond elastically from the last state taken.
  void hold_flow(bool on) { m_constitution.hold(on); }

  /// f = internal and stabilisation force [N], overwritten; columns of `stride` doubles a
  /// particle. `v` is read only by models with viscosity. Allocates
  /// nothing that grows with the particles. Throws BadState for det F <= 0 or NaN (lowest
  /// particle number).
  virtual void forces(std::span<const double> u, std::span<const double> v, std::span<double> f,
                      const Executor& executor) = 0;

  /// Whether forces_of() and reach() are there. A model whose force on a particle is a sum in
  /// an order that no other particle, thread or part has a say in can offer them: it loops over
  /// the parts instead of [0, n), after computing what they need of their neighbours (stresses
  /// of the particles within reach), and `forces` is forces_of({{0, n}}). Regions at rest
  /// (rest_regions.hpp) live on it.
  virtual bool has_parts() const { return false; }

  /// Forces on the particles of `parts` (ascending, apart, not empty) alone, the same bits as
  /// forces() gives them; f of all others stays as it is. Reads u and v within reach() of the
  /// parts. With plasticity only the parts get a trial state, so a commit() after it is for
  /// particles that have none to take: those that have never been strained.
  virtual void forces_of(std::span<const ParticleRange> parts, std::span<const double> u,
                         std::span<const double> v, std::span<double> f,
                         const Executor& executor);

  /// The particles on whose state the forces on `part` depend: it and the rings of neighbours
  /// that the method reaches, rounded up to a range.
  virtual ParticleRange reach(ParticleRange part) const;

  /// Energies at displacement u.
  virtual Energies energies(std::span<const double> u, const Executor& executor) = 0;

  /// Displacement gradients H_a = F_a - I at u, one a particle (bulk of them); in plane stress
  /// H_33 follows from P_33 = 0.
  virtual void gradients(std::span<const double> u, std::span<Mat3> H) = 0;

  using Stiffness = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  /// K = -df/du (without viscosity) over dim*n unknowns (point*dim + component) at u [N/m];
  /// consistent with the return mapping. Structurally symmetric; valid until the next call.
  virtual const Stiffness& tangent(std::span<const double> u) = 0;

  /// How tractions act, where particles lie inside the body; else they act on the particles of
  /// the faces, and this is not asked for. Terms of one piece stand together.
  virtual const std::vector<LoadTerm>& load_terms() const;

  /// Whether the force is the gradient of a potential, so that the tangent is symmetric.
  virtual bool has_potential() const { return true; }

  /// Whether forces depend on velocity (artificial viscosity).
  virtual bool viscous() const { return false; }

  /// Largest viscous damping ratio of the highest mode, for the stable step: dt <=
  /// (2/w)(sqrt(1+z^2) - z). 0 without viscosity.
  virtual double viscous_damping_ratio(double omega_max) const { return 0 * omega_max; }

  /// The model's side that breaks bonds; nullptr where none can break.
  virtual Fracturing* fracturing() { return nullptr; }

  /// Pair interactions that one force evaluation visits (bonds, or directed neighbours), for
  /// cost tables.
  virtual std::size_t interactions() const = 0;

 protected:
  /// Adds sum V_a U(H_a) and the plastic work; gradient(a) gives H_a.
  template <class G>
  void add_internal_energy(Energies& e, const Executor& executor, const G& gradient) const {
    e.internal += executor.sum(m_body.bulk, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (auto a = static_cast<Index>(begin); a < static_cast<Index>(end); ++a)
        sum += m_body.V[a] * m_constitution.energy(a, gradient(a)).stored;
      return sum;
    });
    if (!m_constitution.plastic()) return;
    e.plastic += executor.sum(m_body.bulk, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (auto a = static_cast<Index>(begin); a < static_cast<Index>(end); ++a)
        sum += m_body.V[a] * m_constitution.energy(a, gradient(a)).plastic;
      return sum;
    });
  }

  const Body& m_body;
  Constitution m_constitution;
};

inline void ForceModel::forces_of(std::span<const ParticleRange>, std::span<const double>,
                                  std::span<const double>, std::span<double>, const Executor&) {
  throw std::logic_error("forces_of() of a model without parts");
}

inline const std::vector<LoadTerm>& ForceModel::load_terms() const {
  static const std::vector<LoadTerm> none;
  return none;
}

inline ParticleRange ForceModel::reach(ParticleRange) const { return {0, m_body.n}; }

}  // namespace concord::particle
