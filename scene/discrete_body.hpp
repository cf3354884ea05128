#pragma once
// A body as a method discretises it: point masses and the forces between them. Tests of
// stability (spectra, checkerboards, critical steps) ask this and know no method.

#include "scene/method.hpp"

#include <Eigen/SparseCore>

#include <memory>
#include <span>

namespace concord::scene {

/// A discretised body. Vectors hold dim() doubles a point: entry point*dim() + component.
class DiscreteBody {
 public:
  virtual ~DiscreteBody() = default;
  virtual int dim() const = 0;
  virtual std::span<const Vec3> positions() const = 0;  ///< reference positions X [m]
  /// Lumped masses, one a point, all above 0 [kg]; those of the explicit integrator.
  virtual std::span<const double> masses() const = 0;
  /// A bit a component that the scene prescribes at this point; 0 for free ones.
  virtual unsigned prescribed(Index point) const = 0;
  /// f = internal and stabilisation force at displacement u [N], overwritten; also on
  /// prescribed components. No loads, no viscosity. Throws SolveError for det F <= 0 or NaN.
  virtual void force(std::span<const double> u, std::span<double> f) = 0;
  /// Stored energy, stabilisation included [J]; of a stabilisation without a potential nothing.
  virtual double energy(std::span<const double> u) = 0;
  /// Hydrostatic pressure -tr(sigma)/3 at every point [Pa].
  virtual void pressure(std::span<const double> u, std::span<double> p) = 0;
  /// K = -df/du at u over all components, prescribed ones included [N/m].
  virtual Eigen::SparseMatrix<double> stiffness(std::span<const double> u) = 0;
  /// The method's own estimate of the critical step of central differences, 2/omega_max, at u,
  /// before any safety factor [s].
  virtual double critical_step(std::span<const double> u) = 0;
};

/// A method that can show its discretised body. Methods that can derive from this beside Method
/// (found by dynamic_cast).
class Discretises {
 public:
  virtual ~Discretises() = default;
  /// `request`: h, perturb, seed, settings; nothing is written. Throws InputError as run() does.
  /// `problem` must outlive the body.
  virtual std::unique_ptr<DiscreteBody> discretise(const Problem& problem,
                                                   const RunRequest& request) const = 0;
};

}  // namespace concord::scene
