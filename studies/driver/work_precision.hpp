#pragma once
// Time against error: curves, the Pareto front, and what a given error costs.

#include "studies/driver/rows.hpp"

#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace concord::studies {

/// One resolution of a case: means over its seeds. NaN where a run does not tell.
struct WorkPoint {
  double resolution = 0, h = 0;
  double error = 0, error_min = 0, error_max = 0;  ///< of the errors' magnitudes
  double time = 0;                                 ///< wall_s, or with setup_s [s]
  double setup_s = 0, wall_s = 0;
  double memory_mb = 0;  ///< bytes_per_particle times particles
  double unknowns = 0, particles = 0;
  std::size_t seeds = 0;
  std::vector<std::string> runs;  ///< folders beside study.json
  nlohmann::json quartiles;  ///< repeats and quartiles of the first seed, as in its summary
  bool closes = true;        ///< no run whose energy balance does not close
};

/// The points of a case from coarse to fine, and the resolutions without one, with the reason.
struct WorkCurve {
  std::size_t case_index = 0;
  std::vector<WorkPoint> points;
  std::vector<std::pair<double, std::string>> absent;
};

/// A curve for every case selected, in the study's order. A point needs an error above 0 and a
/// time above 0 of every seed.
std::vector<WorkCurve> work_curves(const Study& study, const std::vector<Row>& rows,
                                   const Selector& selector, const std::string& quantity,
                                   WorkTime time);

/// Indices of the points that no other one dominates, in the order of time: none has at most
/// their time and at most their error, one of them less. Spans of one size.
std::vector<std::size_t> pareto_front(std::span<const double> time,
                                      std::span<const double> error);

/// The front over all curves: (curve, point) in the order of time.
std::vector<std::pair<std::size_t, std::size_t>>
pareto_front(const std::vector<WorkCurve>& curves);

enum class MatchStatus { met, met_by_coarsest, not_reached, no_value };
/// "met", "met by the coarsest", "not reached", "no value".
const char* to_text(MatchStatus status);

/// What an error costs on a curve.
struct MatchedPoint {
  double level = 0;
  MatchStatus status = MatchStatus::no_value;
  /// Met: interpolated; met by the coarsest: of that resolution.
  std::optional<double> time, setup_s, wall_s, memory_mb, resolution;
  std::optional<double> finest_error, finest_time;
  std::string reason;    ///< no value
  bool dips = false;     ///< not reached, though an error of a coarser resolution is below
  bool closes = true;    ///< of the points used
  bool fastest = false;  ///< the least time of its scene at this level
};

/// The last place of the ladder, coarse to fine, where the error passes from above `level` to
/// at or below it; between its two resolutions straight lines over log(error) on logarithmic
/// scales. Nothing is extrapolated.
MatchedPoint match(const WorkCurve& curve, double level);

/// A [[matched]] table: a curve's points at every level.
struct MatchedCase {
  std::size_t case_index = 0;
  std::vector<MatchedPoint> at;  ///< in the order of the entry's levels
};

std::vector<MatchedCase> matched_cases(const Study& study, const std::vector<Row>& rows,
                                       const Matched& entry);

/// Scene by scene and level by level: which case is the fastest, and how much longer the best
/// case of every other method takes.
std::vector<std::string> sentences_of(const Study& study, const Matched& entry,
                                      const std::vector<MatchedCase>& cases);

/// Time of the claim's `other` at its level over that of the case selected.
struct MatchedRatio {
  std::optional<double> value;
  std::string reason;                ///< why there is no value
  std::vector<std::string> remarks;  ///< bounds, and runs whose energy balance does not close
};
MatchedRatio matched_ratio(const Study& study, const Claim& claim,
                           const std::vector<Row>& rows);

}  // namespace concord::studies
