#pragma once
// What a particle run writes while it goes: history rows, frames, quantities of interest,
// conservation.

#include "particle/core/crack_quantities.hpp"
#include "particle/core/hourglass.hpp"
#include "particle/core/quantities.hpp"
#include "scene/continued_output.hpp"
#include "scene/method.hpp"

#include <filesystem>

namespace concord::particle {

/// Energies and momenta of a state.
struct Balance {
  double kinetic = 0, internal = 0, plastic = 0, stabilisation = 0;  ///< [J]
  double dissipation = 0, released = 0, external_work = 0;           ///< since the start [J]
  Vec3 linear = Vec3::Zero(),
       angular = Vec3::Zero();                 ///< sum m v [kg m/s], sum m x times v [kg m^2/s]
  double linear_scale = 0, angular_scale = 0;  ///< sum m |v|, sum m |x| |v|
  double stored() const { return kinetic + internal + plastic + stabilisation; }
  double total() const { return stored() + dissipation + released - external_work; }
};

class Recorder {
 public:
  /// `folder` empty: keeps the conservation record only. `dissipative`: the run has viscosity
  /// or damping, and a column for it. Throws InputError for quantities that name unknown
  /// groups. `resumes`: the files in the folder go on where keep() says.
  Recorder(const scene::Problem& problem, ForceModel& model, const Constraints& constraints,
           const Executor& executor, const std::filesystem::path& folder, bool frames,
           bool dissipative = false, bool resumes = false);

  /// Both throw OutputError when the file cannot be written. What was there before then stays
  /// as it was, here and on disk; no rows can follow.
  void row(const State& state);
  void frame(const State& state);
  /// Saved or restored, files included: to be asked last. Before it is saved they are brought
  /// to the disk. While it is restored, no file is changed before all have been found to be
  /// those of the checkpoint (InputError).
  void keep(scene::Checkpoint& state);
  /// Quantities of interest of a state: point and average as NAME_x.. [m], reaction as NAME_x..
  /// [N], maximum as NAME.
  std::vector<std::pair<std::string, double>> quantities(const State& state);

  /// Adds energy_drift: largest |energy_balance_J| over the rows relative to the largest
  /// kinetic + stored + plastic + |external work| (in static runs it holds the error of the
  /// trapezoidal rule for the external work); and for a body that is free, the largest change
  /// of momenta over the largest sum m|v| (sum m |x||v|): linear_momentum_drift, less the
  /// impulse of loads, where loads do not vary in time, and angular_momentum_drift, where there
  /// are none. Mass damping takes momentum: `damped` runs have no drift of it.
  void add_invariants(scene::Result& result, bool damped = false) const;
  /// Adds nonaffine_energy_share and checkerboard of the last row, their largest values
  /// (.._max), and the share of the energies summed over the rows
  /// (nonaffine_energy_share_mean). Nothing where bonds can break: across a crack it would
  /// measure the opening; nothing for bodies without edges (one layer of particles inside).
  void add_hourglass(scene::Result& result) const;
  /// Where bonds can break: adds what the cracks measure (CrackQuantities), energy_residual,
  /// the largest |energy_balance_J| over the largest |external work|, and dissipated_share of
  /// the last row, dissipation + released over that + stored, and the effective toughness;
  /// writes crack.csv.
  void add_cracks(scene::Result& result);

  /// Samples (particles with volumes) of a state.
  scene::Samples samples(const State& state);

 private:
  std::vector<std::string> columns() const;
  Balance balance(const State& state);
  void add_motion(const State& state, Balance& b) const;
  void follow(const Balance& b, const Vec3& impulse);
  void follow(const Balance& b, const Roughness& roughness);
  void add_row(const State& state);
  std::vector<double> safe_files();
  std::filesystem::path history_file() const { return m_folder / "history.csv"; }
  /// Gradients at a state, in a buffer that the next call overwrites.
  std::span<const Mat3> gradients(const State& state);

  const scene::Problem& m_problem;
  ForceModel& m_model;
  const Executor& m_executor;
  Quantities m_quantities;
  bool m_free, m_steady, m_unloaded;  ///< no displacement condition; constant loads; no loads
  bool m_dissipative;
  std::optional<CrackQuantities> m_crack;  ///< where bonds can break
  std::optional<Hourglass> m_hourglass;    ///< where none can, and there are edges
  std::filesystem::path m_folder;
  bool m_write_frames;
  scene::HistoryWriter m_history;
  std::uintmax_t m_history_bytes = 0;  ///< all rows that are there as a whole
  scene::FrameList m_frames;
  std::vector<std::uint64_t> m_frame_digests;  ///< of those that a checkpoint knows
  std::vector<Mat3> m_H;
  std::vector<double> m_values;
  /// Gathered over the rows.
  struct Account {
    bool any = false;
    Balance first, last;
    double largest_energy = 0, largest_work = 0, energy_change = 0, linear_change = 0,
           angular_change = 0, linear_scale = 0, angular_scale = 0;
    double share = 0, share_max = 0, checkerboard = 0, checkerboard_max = 0;
    double nonaffine_sum = 0, energy_sum = 0;  ///< over the rows [J]
    CrackToll crack_toll;
    void keep(scene::Checkpoint& state);
  };
  Account m_account;
};

}  // namespace concord::particle
