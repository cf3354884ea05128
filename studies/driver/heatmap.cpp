#include "studies/driver/heatmap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace {

/// Runs of one cell, in the study's order.
std::vector<const Row*> runs_of(const Study& study, const std::vector<Row>& rows,
                                const HeatColumn& column, const HeatRow& row) {
  std::vector<const Row*> runs;
  for (const Row& run : rows) {
    const Case& entry = study.cases[run.case_index];
    if (!entry.matches(column.selector) || !entry.matches(row.selector)) continue;
    if (!row.resolution || run.resolution == *row.resolution) runs.push_back(&run);
  }
  return runs;
}

std::string why_no_run(const Study& study, const HeatColumn& column, const HeatRow& row) {
  if (!row.absent.empty()) return row.absent;
  const bool any = std::any_of(study.cases.begin(), study.cases.end(), [&](const Case& entry) {
    return entry.matches(column.selector) && entry.matches(row.selector);
  });
  if (!any) return "no case in this report";
  return row.resolution ? fmt::format("no run at resolution {:g}", *row.resolution)
                        : "did not run";
}

void take_evidence(HeatCell& cell, const Row& run) {
  cell.run = run.run.string();
  cell.command = run.command;
}

}  // namespace

double score_of(const HeatRow& row, double value) {
  const auto scale = [&row](double x) {
    if (!row.logarithmic) return x;
    return x > 0 ? std::log(x) : -INFINITY;
  };
  const double good = scale(row.good), bad = scale(row.bad);
  return std::clamp((scale(value) - bad) / (good - bad), 0.0, 1.0);
}

HeatCell heat_cell(const Study& study, const std::vector<Row>& rows, const HeatColumn& column,
                   const HeatRow& row) {
  HeatCell cell;
  const auto runs = runs_of(study, rows, column, row);
  if (runs.empty()) {
    cell.reason = why_no_run(study, column, row);
    return cell;
  }
  std::vector<double> values;
  for (const Row* run : runs) {
    const auto value = value_of(*run, row.quantity);
    if (!value) {
      cell.reason = why_absent(*run, row.quantity);
      take_evidence(cell, *run);
      return cell;
    }
    values.push_back(*value);
    cell.closes = cell.closes && balance_closes(study, *run).value_or(true);
  }
  const double pooled = pool_of(values, row.over_seeds);
  const auto holds = std::find(values.begin(), values.end(), pooled);
  take_evidence(
      cell,
      *runs[holds == values.end() ? 0 : static_cast<std::size_t>(holds - values.begin())]);
  cell.value = pooled * display_factor(row.unit);
  cell.score = score_of(row, *cell.value);
  return cell;
}

}  // namespace concord::studies
