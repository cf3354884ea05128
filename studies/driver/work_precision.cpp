#include "studies/driver/work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace concord::studies {
namespace {

using Seeds = std::vector<const Row*>;

double number_at(const Row& row, const char* path) {
  return value_of(row, path).value_or(std::nan(""));
}

template <class Number> double mean_over(const Seeds& seeds, const Number& number) {
  double sum = 0;
  for (const Row* row : seeds) sum += number(*row);
  return sum / static_cast<double>(seeds.size());
}

/// Why a run gives no point; empty where it gives one.
std::string why_no_point(const Row& row, const std::string& quantity, WorkTime time) {
  const auto error = value_of(row, quantity);
  if (!error) return why_absent(row, quantity);
  if (*error == 0) return "the error is 0";
  const double setup = time == WorkTime::total ? number_at(row, "setup_s") : 0;
  if (!(setup + number_at(row, "wall_s") > 0)) return "no run time";
  return "";
}

nlohmann::json quartiles_of(const Row& row) {
  nlohmann::json quartiles = nlohmann::json::object();
  for (const char* key : {"repeats", "setup_s_quartiles", "wall_s_quartiles"})
    if (const auto found = row.summary.find(key); found != row.summary.end())
      quartiles[key] = *found;
  return quartiles;
}

WorkPoint point_of(const Study& study, const Seeds& seeds, const std::string& quantity,
                   WorkTime time) {
  const auto mean = [&seeds](const char* path) {
    return mean_over(seeds, [path](const Row& row) { return number_at(row, path); });
  };
  WorkPoint point;
  point.resolution = seeds.front()->resolution;
  point.seeds = seeds.size();
  point.quartiles = quartiles_of(*seeds.front());
  point.h = mean("h");
  point.setup_s = mean("setup_s");
  point.wall_s = mean("wall_s");
  point.time = point.wall_s + (time == WorkTime::total ? point.setup_s : 0);
  point.unknowns = mean("unknowns");
  point.particles = mean("particles");
  point.memory_mb = mean_over(seeds, [](const Row& row) {
    return number_at(row, "bytes_per_particle") * number_at(row, "particles") / 1e6;
  });
  const auto magnitude = [&quantity](const Row& row) {
    return std::abs(*value_of(row, quantity));
  };
  point.error = mean_over(seeds, magnitude);
  point.error_min = point.error_max = magnitude(*seeds.front());
  for (const Row* row : seeds) {
    point.error_min = std::min(point.error_min, magnitude(*row));
    point.error_max = std::max(point.error_max, magnitude(*row));
    point.runs.push_back(row->run.string());
    point.closes = point.closes && balance_closes(study, *row).value_or(true);
  }
  return point;
}

WorkCurve curve_of(const Study& study, const std::vector<Row>& rows, std::size_t case_index,
                   const std::string& quantity, WorkTime time) {
  std::map<double, Seeds> by_resolution;
  for (const Row& row : rows)
    if (row.case_index == case_index) by_resolution[row.resolution].push_back(&row);
  WorkCurve curve{case_index, {}, {}};
  for (const auto& [resolution, seeds] : by_resolution) {
    std::string reason;
    for (const Row* row : seeds)
      if (reason.empty()) reason = why_no_point(*row, quantity, time);
    if (reason.empty())
      curve.points.push_back(point_of(study, seeds, quantity, time));
    else
      curve.absent.emplace_back(resolution, reason);
  }
  return curve;
}

}  // namespace

std::vector<WorkCurve> work_curves(const Study& study, const std::vector<Row>& rows,
                                   const Selector& selector, const std::string& quantity,
                                   WorkTime time) {
  std::vector<WorkCurve> curves;
  for (std::size_t c = 0; c < study.cases.size(); ++c)
    if (study.cases[c].matches(selector))
      curves.push_back(curve_of(study, rows, c, quantity, time));
  return curves;
}

std::vector<std::size_t> pareto_front(std::span<const double> time,
                                      std::span<const double> error) {
  std::vector<std::size_t> order(time.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(time[a], error[a]) < std::pair(time[b], error[b]);
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    const bool twin = !front.empty() && time[front.back()] == time[i] &&
                      error[front.back()] == error[i];  // neither dominates the other
    if (front.empty() || error[i] < error[front.back()] || twin) front.push_back(i);
  }
  return front;
}

std::vector<std::pair<std::size_t, std::size_t>>
pareto_front(const std::vector<WorkCurve>& curves) {
  std::vector<double> time, error;
  std::vector<std::pair<std::size_t, std::size_t>> place, front;
  for (std::size_t c = 0; c < curves.size(); ++c)
    for (std::size_t p = 0; p < curves[c].points.size(); ++p) {
      place.emplace_back(c, p);
      time.push_back(curves[c].points[p].time);
      error.push_back(curves[c].points[p].error);
    }
  for (const std::size_t i : pareto_front(time, error)) front.push_back(place[i]);
  return front;
}

}  // namespace concord::studies
