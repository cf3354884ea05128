#pragma once
// The body of any particle method as tests of stability see it.

#include "particle/core/boundary.hpp"
#include "particle/core/particle_method.hpp"
#include "scene/discrete_body.hpp"

namespace concord::particle {

/// Body, model and constraints of one method; points are particles. Boundary points, where a
/// method has them, stay where the scene wants them at t = 0. Plastic materials answer from
/// their virgin state at every call, since nothing is committed.
class ParticleBody final : public scene::DiscreteBody {
 public:
  /// As run() makes them. Throws InputError. `problem` must outlive the object.
  ParticleBody(const ParticleMethod& method, const scene::Problem& problem,
               const scene::RunRequest& request);

  int dim() const override { return m_body.dim; }
  std::span<const Vec3> positions() const override { return m_positions; }
  std::span<const double> masses() const override {
    return {m_body.m.data(), static_cast<std::size_t>(m_body.bulk)};
  }
  unsigned prescribed(Index point) const override { return m_prescribed[point]; }
  void force(std::span<const double> u, std::span<double> f) override;
  double energy(std::span<const double> u) override;
  void pressure(std::span<const double> u, std::span<double> p) override;
  Eigen::SparseMatrix<double> stiffness(std::span<const double> u) override;
  /// As Leapfrog takes it: Lanczos iteration on the linearised forces, reduced for viscosity.
  double critical_step(std::span<const double> u) override;

  const Body& body() const { return m_body; }

 private:
  /// Columns of `stride` doubles from vectors of dim.
  const Column& column(std::span<const double> u);

  scene::Settings m_settings;
  Executor m_executor;
  Body m_body;
  std::unique_ptr<ForceModel> m_model;
  Constraints m_constraints;
  std::vector<Vec3> m_positions;
  std::vector<unsigned> m_prescribed;
  Column m_u, m_f, m_v;
};

}  // namespace concord::particle
