#pragma once
// Numbers drawn from a record over time: peaks, periods, extremes. Numbers only: no files.

#include <span>
#include <string>
#include <vector>

namespace concord::studies {

/// What to look for in a record.
struct FeatureOptions {
  double level = 0;          ///< whose crossings make the period, in the record's unit
  double prominence = 0.05;  ///< least turn of the record that counts, fraction of its range
};

/// A number, or the reason why there is none (then `reason` is not empty).
struct Feature {
  double value = 0;
  std::string reason;
};

/// Names of the features, in the order of studies/README.md.
const std::vector<std::string>& feature_names();

/// A feature of x(t) [unit of x; s for times]; t ascending, one size. A record of fewer than
/// two samples, or with a value that is not finite, has none. Peaks: the first sample from
/// which x falls by more than prominence*(max - min) after rising as much; a parabola goes
/// through it and its neighbours. Period: see studies/README.md. Throws std::invalid_argument
/// for an unknown name or spans of different size.
Feature feature_of(const std::string& name, std::span<const double> t,
                   std::span<const double> x, const FeatureOptions& options);

/// sqrt(int (x - r)^2 dt / int r^2 dt) by the trapezium rule at the times of x, r interpolated
/// linearly at them. No number, with a reason, where the records end more than 1 % of the
/// reference's length apart or the reference vanishes.
Feature history_difference(std::span<const double> t, std::span<const double> x,
                           std::span<const double> t_reference,
                           std::span<const double> x_reference);

}  // namespace concord::studies
