#pragma once
// What a particle run writes while it goes: history rows, frames, quantities of interest,
// conservation.

#include "particle/core/boundary.hpp"
#include "particle/core/force_model.hpp"
#include "scene/material.hpp"
#include "scene/method.hpp"
#include "scene/output.hpp"

#include <filesystem>

namespace concord::particle {

/// A state at one instant, as the recorder sees it. Columns of `stride` doubles a particle.
struct State {
  double t = 0;
  std::span<const double> u, v;  ///< displacement, velocity at the same instant
  std::span<const double>
      unbalanced;  ///< internal + external force, prescribed components included
  std::span<const double> acceleration;  ///< empty in static runs
  double external_work = 0;  ///< done since the start by loads and prescribed motion [J]
};

/// Energies and momenta of a state.
struct Balance {
  double kinetic = 0, internal = 0, plastic = 0, stabilisation = 0, external_work = 0;  ///< [J]
  Vec3 linear = Vec3::Zero(),
       angular = Vec3::Zero();                 ///< sum m v [kg m/s], sum m x times v [kg m^2/s]
  double linear_scale = 0, angular_scale = 0;  ///< sum m |v|, sum m |x| |v|
  double stored() const { return kinetic + internal + plastic + stabilisation; }
  double total() const { return stored() - external_work; }
};

class Recorder {
 public:
  /// `folder` empty: keeps the conservation record only. Throws InputError for quantities that
  /// name unknown groups.
  Recorder(const scene::Problem& problem, ForceModel& model, const Constraints& constraints,
           const Executor& executor, const std::filesystem::path& folder, bool frames);

  void row(const State& state);
  void frame(const State& state);
  /// Quantities of interest of a state: point and average as NAME_x.. [m], reaction as NAME_x..
  /// [N], maximum as NAME.
  std::vector<std::pair<std::string, double>> quantities(const State& state);

  /// Adds energy_drift: largest |kinetic + stored + plastic work - external work - its first
  /// value| over the rows, relative to the largest kinetic + stored + plastic + |external work|
  /// (in static runs it holds the error of the trapezoidal rule for the external work); and,
  /// for a body that is free and unloaded, linear_ and angular_momentum_drift: largest change
  /// of the vector over the largest sum m|v| (sum m |x||v|). Call only for runs without
  /// dissipation to get the first.
  void add_invariants(scene::Result& result, bool dissipative) const;

  /// Samples (particles with volumes) of a state.
  scene::Samples samples(const State& state);

 private:
  Balance balance(const State& state);
  /// Stress measures of all particles [Pa].
  struct Stresses {
    std::vector<double> von_mises, pressure, kirchhoff_mises;
  };
  Stresses stresses(std::span<const Mat3> H) const;
  std::vector<double> plastic_strains(std::span<const Mat3> H) const;
  double maximum(const scene::Quantity& quantity, const State& state);
  Vec3 at(std::span<const double> column, Index a) const;
  std::vector<double> values(const std::string& field, const State& state);

  const scene::Problem& m_problem;
  ForceModel& m_model;
  const Constraints& m_constraints;
  const Executor& m_executor;
  bool m_free;  ///< no displacement condition and no load: momenta are invariants
  scene::HistoryWriter m_history;
  scene::FrameWriter m_frames;
  bool m_any = false;
  Balance m_first;
  double m_largest_energy = 0, m_energy_change = 0, m_linear_change = 0, m_angular_change = 0,
         m_linear_scale = 0, m_angular_scale = 0;
};

}  // namespace concord::particle
