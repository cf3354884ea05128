#pragma once
// What a run with fracture tells of its cracks: columns of history.csv, numbers of
// summary.json, crack.csv.

#include "particle/core/boundary.hpp"
#include "particle/core/crack.hpp"
#include "particle/core/force_model.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace concord::scene {
class Checkpoint;
}

namespace concord::particle {

/// What a crack's way has cost since the start [J].
struct CrackCost {
  double damping = 0, deletion = 0;  ///< taken by viscosity, and by the deletion of bonds
};

/// Follows the cost from row to row of the history, and tells what the tip's way from 10 to 90
/// % of the ligament has cost; between rows the cost is linear in the advance.
class CrackToll {
 public:
  /// At a row: the tip's advance over the ligament, and the cost since the start.
  void add(double share, const CrackCost& cost);
  /// Nothing before the tip has passed both.
  std::optional<CrackCost> paid() const;
  /// Saved or restored (checkpoint.hpp).
  void keep(scene::Checkpoint& state);

 private:
  double m_share = 0;
  CrackCost m_cost;               ///< at the row before
  std::array<CrackCost, 2> m_at;  ///< where the tip passed them
  std::array<bool, 2> m_passed{};
};

/// Speed of Rayleigh waves [m/s]: the root of (2 - s)^2 = 4 sqrt(1 - s) sqrt(1 - s
/// c_s^2/c_p^2), s = (c_R/c_s)^2 < 1, with the longitudinal speed of the plate, c_p^2 = E/(rho
/// (1 - nu^2)), in plane stress. L. B. Freund, Dynamic Fracture Mechanics (Cambridge, 1990),
/// Sec. 2.4.
double rayleigh_speed(const scene::Material& material, Dimension dimension);

/// Follows the cracks of a run; those of a body of three dimensions as a slab in X-Y, seen
/// along Z. References must outlive the object.
class CrackQuantities {
 public:
  /// Throws InputError for an arrival group that is none.
  CrackQuantities(const scene::Problem& problem, const Body& body,
                  const Constraints& constraints, const Fracturing& fracturing);

  static std::vector<std::string> columns();
  /// Values of the columns at the present.
  void append(std::vector<double>& values);
  /// Everything for summary.json; what is not there (no arrival yet, no branch) is left out.
  std::map<std::string, double> quantities();
  /// How far the tip is ahead of the pre-crack's, over the ligament; 0 without a pre-crack.
  double advance_share();
  /// Effective toughness [J/m^2], (dD_vis + dD_del) / (da t): what damping and deletion take
  /// while the tip goes from 10 to 90 % of the ligament, over that way along the pre-crack
  /// times the thickness; the part of deletion; and over G_f. Branches count into what is
  /// taken, not into the way. Damping counts wherever in the body it acts.
  std::map<std::string, double> toughness(const CrackCost& cost) const;
  /// Dead triangles with their times and corners; in 3D the faces of dead tetrahedra.
  void write(const std::filesystem::path& file) const;

 private:
  void follow();
  void find_arrival();
  double mean_speed() const;

  const scene::Problem& m_problem;
  const Fracturing& m_fracturing;
  CrackBody m_body;
  double m_l;                  ///< l_c [m]
  double m_ligament = 0;       ///< from the pre-crack's tip to the body's end ahead [m]
  std::vector<char> m_at_end;  ///< particles of the arrival group that are counted
  std::vector<char> m_held;    ///< particles with a prescribed component
  std::optional<CrackTip> m_tip;
  std::vector<std::pair<double, double>> m_advances;  ///< (t, advance) whenever it rose
  std::optional<CrackStart> m_start;
  std::optional<double> m_arrival;
  std::size_t m_followed = 0, m_looked = 0;  ///< of the record
  double m_area = 0;
};

}  // namespace concord::particle
