#include "studies/driver/rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace concord::studies {

std::optional<double> value_of(const Row& row, const std::string& quantity) {
  if (!row.error.empty()) return std::nullopt;
  const nlohmann::json* at = &row.summary;
  for (std::size_t begin = 0; begin <= quantity.size();) {
    const std::size_t end = std::min(quantity.find('.', begin), quantity.size());
    const auto found =
        at->is_object() ? at->find(quantity.substr(begin, end - begin)) : at->end();
    if (!at->is_object() || found == at->end()) return std::nullopt;
    at = &*found;
    begin = end + 1;
  }
  if (!at->is_number() || !std::isfinite(at->get<double>())) return std::nullopt;
  return at->get<double>();
}

namespace {

/// The text at a path of keys; nothing where there is none.
std::optional<std::string> text_at(const nlohmann::json& object,
                                   std::initializer_list<std::string> path) {
  const nlohmann::json* at = &object;
  for (const std::string& key : path) {
    const auto found = at->is_object() ? at->find(key) : at->end();
    if (!at->is_object() || found == at->end()) return std::nullopt;
    at = &*found;
  }
  return at->is_string() ? std::optional(at->get<std::string>()) : std::nullopt;
}

/// Why a comparison, a signal, an error or a probe has no such number.
std::optional<std::string> reason_of(const Row& row, const std::string& quantity) {
  const std::size_t dot = quantity.find('.'), last = quantity.rfind('.');
  if (dot == std::string::npos) return std::nullopt;
  const std::string group = quantity.substr(0, dot), name = quantity.substr(dot + 1);
  if (group == "signals" && last > dot)
    return text_at(row.summary, {"signals", quantity.substr(dot + 1, last - dot - 1),
                                 "not_found", quantity.substr(last + 1)});
  if (group == "quantities") return text_at(row.summary, {"notes", "not_measured"});
  if (group != "errors") return std::nullopt;
  if (auto reason = text_at(row.summary, {"error_sources", name, "reason"})) return reason;
  const auto comparisons = row.summary.find("comparisons");
  if (comparisons == row.summary.end()) return std::nullopt;
  for (const auto& [one, told] : comparisons->items())
    if (quantity.ends_with("_" + one)) return text_at(told, {"reason"});
  return std::nullopt;
}

}  // namespace

std::string why_absent(const Row& row, const std::string& quantity) {
  if (!row.error.empty()) return row.error;
  const auto reason = reason_of(row, quantity);
  return "no " + quantity + (reason ? ": " + *reason : "");
}

std::optional<bool> balance_closes(const Study& study, const Row& row) {
  const auto drift = value_of(row, "invariants.energy_drift");
  if (!study.balance_tolerance || !drift) return std::nullopt;
  return std::abs(*drift) <= *study.balance_tolerance;
}

bool balances_close(const Study& study, const std::vector<Row>& rows, std::size_t case_index,
                    const std::vector<double>& resolutions) {
  return std::none_of(rows.begin(), rows.end(), [&](const Row& row) {
    return row.case_index == case_index && !balance_closes(study, row).value_or(true) &&
           std::find(resolutions.begin(), resolutions.end(), row.resolution) !=
               resolutions.end();
  });
}

const char* balance_text(bool closes) { return closes ? "closes" : "does not close"; }

double pool_of(const std::vector<double>& values, Pool pool) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (pool == Pool::max) return *most;
  if (pool == Pool::min) return *least;
  if (pool == Pool::range) return *most - *least;
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

namespace {

double mean_of(const std::vector<const Row*>& rows, const std::string& quantity) {
  double sum = 0;
  for (const Row* row : rows)
    sum += value_of(*row, quantity).value_or(std::numeric_limits<double>::quiet_NaN());
  return sum / static_cast<double>(rows.size());
}

std::optional<Level> level_of(const std::vector<const Row*>& rows,
                              const std::string& quantity) {
  Level level;
  level.resolution = rows.front()->resolution;
  level.seeds = rows.size();
  level.minimum = std::numeric_limits<double>::infinity();
  level.maximum = -level.minimum;
  for (const Row* row : rows) {
    const auto value = value_of(*row, quantity);
    if (!value) return std::nullopt;
    level.minimum = std::min(level.minimum, *value);
    level.maximum = std::max(level.maximum, *value);
  }
  level.mean = mean_of(rows, quantity);
  level.h = mean_of(rows, "h");
  level.unknowns = mean_of(rows, "unknowns");
  level.wall_s = mean_of(rows, "wall_s");
  return level;
}

}  // namespace

std::vector<Level> levels_of(const std::vector<Row>& rows, std::size_t case_index,
                             const std::string& quantity) {
  std::map<double, std::vector<const Row*>> by_resolution;
  for (const Row& row : rows)
    if (row.case_index == case_index) by_resolution[row.resolution].push_back(&row);
  std::vector<Level> levels;
  for (const auto& [resolution, seeds] : by_resolution)
    if (auto level = level_of(seeds, quantity)) levels.push_back(*level);
  return levels;
}

std::vector<FitResult> fit_all(const Study& study, const std::vector<Row>& rows) {
  std::vector<FitResult> results;
  for (const Fit& fit : study.fits)
    for (std::size_t c = 0; c < study.cases.size(); ++c) {
      if (!study.cases[c].matches(fit.selector)) continue;
      auto levels = levels_of(rows, c, fit.quantity);
      if (levels.size() < (fit.finest ? fit.finest : 3)) continue;
      if (fit.finest)
        levels.erase(levels.begin(), levels.end() - static_cast<long>(fit.finest));
      std::vector<double> h, value;
      FitResult result{c, fit.quantity, {}, {}};
      for (const Level& level : levels) {
        h.push_back(level.h);
        value.push_back(level.mean);
        result.resolutions.push_back(level.resolution);
      }
      if (std::any_of(value.begin(), value.end(), [](double v) { return !(v > 0); })) continue;
      result.line = fit_loglog(h, value);
      results.push_back(std::move(result));
    }
  return results;
}

std::vector<ReferenceResult> references_of(const Study& study, const std::vector<Row>& rows) {
  std::vector<ReferenceResult> results;
  for (const Reference& reference : study.references)
    for (std::size_t c = 0; c < study.cases.size(); ++c) {
      if (!study.cases[c].matches(reference.selector)) continue;
      auto levels = levels_of(rows, c, reference.quantity);
      if (levels.size() > 3) levels.erase(levels.begin(), levels.end() - 3);
      ReferenceResult result{c, reference.quantity, reference.formal_order, {}, 0, {}};
      std::vector<double> h, value;
      for (const Level& level : levels) {
        h.push_back(level.h);
        value.push_back(level.mean);
        result.resolutions.push_back(level.resolution);
      }
      if (!value.empty()) result.value = value.back();
      if (value.size() == 3)
        result.convergence = grid_convergence(h, value, reference.formal_order);
      else
        result.convergence.statement = "not asymptotic: fewer than three levels have a value";
      results.push_back(std::move(result));
    }
  return results;
}

}  // namespace concord::studies
