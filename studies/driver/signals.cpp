#include "studies/driver/signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace concord::studies {
namespace {

using Span = std::span<const double>;

Feature none(std::string reason) { return {std::nan(""), std::move(reason)}; }

double range_of(Span x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low;
}

/// Index of the first maximum inside the record: x has risen to it by more than `turn` from
/// the least value before, and falls by more than `turn` after.
std::optional<std::size_t> first_maximum(Span x, double turn) {
  std::size_t least = 0, greatest = 0;
  bool rising = false;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (rising) {
      if (x[i] > x[greatest]) greatest = i;
      if (x[greatest] - x[i] > turn) return greatest;
    } else {
      if (x[i] < x[least]) least = i;
      rising = x[i] - x[least] > turn;
      greatest = i;
    }
  }
  return std::nullopt;
}

struct Peak {
  double time = 0, value = 0;
};

/// Vertex of the parabola through three samples around i; the sample itself where they lie on
/// a line.
Peak vertex(Span t, Span x, std::size_t i) {
  const double a = t[i - 1] - t[i], b = t[i + 1] - t[i];
  const double fa = (x[i - 1] - x[i]) / a, fb = (x[i + 1] - x[i]) / b;
  const double curvature = (fb - fa) / (b - a), slope = fa - curvature * a;
  if (!(curvature < 0)) return {t[i], x[i]};
  const double at = std::clamp(-slope / (2 * curvature), a, b);
  return {t[i] + at, x[i] + at * (slope + curvature * at)};
}

Feature first_peak(Span t, Span x, const FeatureOptions& options, bool of_time) {
  const double turn = options.prominence * range_of(x);
  const auto at = first_maximum(x, turn);
  if (!at)
    return none(fmt::format("no maximum inside the record, to t = {:.4g} s, from which it "
                            "falls by {:g} % of its range after rising as much",
                            t.back(), 100 * options.prominence));
  const Peak peak = vertex(t, x, *at);
  return {of_time ? peak.time : peak.value, ""};
}

/// Times at which x passes `level`. One counts when x came from beyond the band of half width
/// `turn` on one side (or starts on the level) and goes beyond it on the other; of several
/// passages between, the middle of the first and the last.
std::vector<double> crossings(Span t, Span x, double level, double turn) {
  std::vector<double> times;
  int side = 0;  // of the band on which x was last
  std::optional<double> first, last;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double y = x[i] - level;
    if (i > 0 && (x[i - 1] - level) * y <= 0 && x[i] != x[i - 1]) {
      last = t[i] - y / (x[i] - x[i - 1]) * (t[i] - t[i - 1]);
      if (!first) first = last;
    }
    const int now = y > turn ? 1 : y < -turn ? -1 : 0;
    if (now == 0) continue;
    if (side == 0 && x[0] == level) times.push_back(t[0]);
    if (side == -now) times.push_back((*first + *last) / 2);
    side = now;
    first.reset();
  }
  return times;
}

Feature period(Span t, Span x, const FeatureOptions& options) {
  const double turn = options.prominence * range_of(x);
  const auto times = crossings(t, x, options.level, turn);
  const std::size_t periods = times.empty() ? 0 : (times.size() - 1) / 2;
  if (periods == 0)
    return none(fmt::format("{} crossing(s) of the level {:g} to t = {:.4g} s, 3 make a period",
                            times.size(), options.level, t.back()));
  return {(times[2 * periods] - times[0]) / static_cast<double>(periods), ""};
}

Feature mean(Span t, Span x) {
  double sum = 0;
  for (std::size_t i = 1; i < x.size(); ++i) sum += (t[i] - t[i - 1]) * (x[i] + x[i - 1]) / 2;
  return {sum / (t.back() - t.front()), ""};
}

Feature change(Span x, bool relative) {
  double largest = 0;
  for (const double value : x) largest = std::max(largest, std::abs(value - x[0]));
  if (!relative) return {largest, ""};
  if (x[0] == 0) return none("it starts at 0: no relative change");
  return {largest / std::abs(x[0]), ""};
}

std::string why_unfit(Span t, Span x) {
  if (x.size() < 2) return "fewer than two samples";
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]) || !std::isfinite(t[i]))
      return fmt::format("not a number in line {}", i + 2);
  for (std::size_t i = 1; i < t.size(); ++i)
    if (!(t[i] > t[i - 1])) return fmt::format("time does not ascend in line {}", i + 2);
  return "";
}

}  // namespace

const std::vector<std::string>& feature_names() {
  static const std::vector<std::string> names{
      "first_peak", "first_peak_time", "period", "initial",        "final",
      "minimum",    "maximum",         "mean",   "largest_change", "relative_change"};
  return names;
}

Feature feature_of(const std::string& name, Span t, Span x, const FeatureOptions& options) {
  if (t.size() != x.size()) throw std::invalid_argument("a record has a time a value");
  if (const std::string reason = why_unfit(t, x); !reason.empty()) return none(reason);
  if (name == "first_peak") return first_peak(t, x, options, false);
  if (name == "first_peak_time") return first_peak(t, x, options, true);
  if (name == "period") return period(t, x, options);
  if (name == "initial") return {x.front(), ""};
  if (name == "final") return {x.back(), ""};
  if (name == "minimum") return {*std::min_element(x.begin(), x.end()), ""};
  if (name == "maximum") return {*std::max_element(x.begin(), x.end()), ""};
  if (name == "mean") return mean(t, x);
  if (name == "largest_change") return change(x, false);
  if (name == "relative_change") return change(x, true);
  throw std::invalid_argument("no feature " + name);
}

Feature history_difference(Span t, Span x, Span t_reference, Span x_reference) {
  for (const auto& [times, values] : {std::pair{t, x}, std::pair{t_reference, x_reference}})
    if (const std::string reason = why_unfit(times, values); !reason.empty())
      return none(reason);
  const double length = t_reference.back() - t_reference.front();
  constexpr double ends_apart = 0.01;  // of the reference's length; ours: no source
  if (std::abs(t.back() - t_reference.back()) > ends_apart * length ||
      std::abs(t.front() - t_reference.front()) > ends_apart * length)
    return none(fmt::format("the records differ in time: {:.4g} to {:.4g} s, the reference's "
                            "{:.4g} to {:.4g} s",
                            t.front(), t.back(), t_reference.front(), t_reference.back()));
  double difference = 0, norm = 0;
  std::vector<double> d(t.size()), r(t.size());
  std::size_t k = 1;
  for (std::size_t i = 0; i < t.size(); ++i) {
    while (k + 1 < t_reference.size() && t_reference[k] < t[i]) ++k;
    const double s = std::clamp(
        (t[i] - t_reference[k - 1]) / (t_reference[k] - t_reference[k - 1]), 0.0, 1.0);
    r[i] = (1 - s) * x_reference[k - 1] + s * x_reference[k];
    d[i] = x[i] - r[i];
    if (i == 0) continue;
    const double half = (t[i] - t[i - 1]) / 2;
    difference += half * (d[i] * d[i] + d[i - 1] * d[i - 1]);
    norm += half * (r[i] * r[i] + r[i - 1] * r[i - 1]);
  }
  if (norm == 0) return none("the reference vanishes");
  return {std::sqrt(difference / norm), ""};
}

}  // namespace concord::studies
