// Tables of work-precision plots, matched errors, heat maps and chosen cases.

#include "studies/driver/heatmap.hpp"
#include "studies/driver/run_table.hpp"
#include "studies/driver/tables.hpp"
#include "studies/driver/work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace concord::studies {
namespace {

using Cells = std::vector<std::string>;

std::string number(const std::optional<double>& value, int digits = 6) {
  return value && std::isfinite(*value) ? fmt::format("{:.{}g}", *value, digits) : "";
}

std::string mark(bool closes) { return closes ? "" : balance_text(false); }

Table work_table(const StudyResult& result, const Plot& plot, std::size_t n) {
  const auto curves =
      work_curves(*result.study, result.rows, plot.selector, plot.quantity, plot.time);
  const auto front = pareto_front(curves);
  Table table{fmt::format("work-precision-{}", n),
              {"scene", "method", "variant", "resolution", plot.quantity, "set-up [s]",
               "time loop or solve [s]", "memory [MB]", "unknowns", "Pareto front",
               "energy balance", "reason"},
              {}};
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const Case& entry = result.study->cases[curves[c].case_index];
    for (std::size_t p = 0; p < curves[c].points.size(); ++p) {
      const WorkPoint& point = curves[c].points[p];
      const bool best = std::find(front.begin(), front.end(), std::pair(c, p)) != front.end();
      table.cells.push_back({entry.scene, entry.method, entry.variant, number(point.resolution),
                             number(point.error), number(point.setup_s), number(point.wall_s),
                             number(point.memory_mb), number(point.unknowns), best ? "yes" : "",
                             mark(point.closes), ""});
    }
    for (const auto& [resolution, reason] : curves[c].absent)
      table.cells.push_back({entry.scene, entry.method, entry.variant, number(resolution), "",
                             "", "", "", "", "", "", reason});
  }
  return table;
}

Table matched_table(const StudyResult& result, const Matched& entry, std::size_t n) {
  Table table{fmt::format("matched-{}", n),
              {"scene", "method", "variant", entry.quantity, "status", "set-up [s]",
               "time loop or solve [s]", "memory [MB]", "resolution", "fastest", "finest error",
               "energy balance", "reason"},
              {}};
  for (const MatchedCase& one : matched_cases(*result.study, result.rows, entry)) {
    const Case& owner = result.study->cases[one.case_index];
    for (const MatchedPoint& point : one.at)
      table.cells.push_back({owner.scene, owner.method, owner.variant, number(point.level),
                             to_text(point.status), number(point.setup_s, 4),
                             number(point.wall_s, 4), number(point.memory_mb, 4),
                             number(point.resolution, 4), point.fastest ? "yes" : "",
                             number(point.finest_error, 4), mark(point.closes), point.reason});
  }
  return table;
}

Table sentences_table(const StudyResult& result, const Matched& entry, std::size_t n) {
  Table table{fmt::format("matched-{}-sentences", n), {"who is fastest"}, {}};
  const auto cases = matched_cases(*result.study, result.rows, entry);
  for (const std::string& text : sentences_of(*result.study, entry, cases))
    table.cells.push_back({text});
  return table;
}

Table heatmap_table(const StudyResult& result, const Heatmap& map, std::size_t n) {
  Table table{fmt::format("heatmap-{}", n),
              {"test", "method", "value", "unit", "score", "energy balance", "reason", "run",
               "command"},
              {}};
  for (const HeatRow& row : map.rows)
    for (const HeatColumn& column : map.columns) {
      const HeatCell cell = heat_cell(*result.study, result.rows, column, row);
      table.cells.push_back({row.label, column.label, number(cell.value, row.digits), row.unit,
                             number(cell.score, 3), mark(cell.closes), cell.reason, cell.run,
                             cell.command});
    }
  return table;
}

Table run_table(const StudyResult& result, const RunTable& entry, std::size_t n) {
  Table table{fmt::format("table-{}", n), {"", "source"}, {}};
  for (const TableColumn& column : entry.columns)
    table.columns.push_back(
        column.unit == "1" ? column.label : fmt::format("{} [{}]", column.label, column.unit));
  for (const TableLine* line : lines_of(result.rows, *result.study, entry)) {
    Cells cells{line->label, line->source_value};
    for (const TableColumn& column : entry.columns)
      cells.push_back(
          number(table_cell(*result.study, result.rows, *line, column).value, column.digits));
    table.cells.push_back(std::move(cells));
  }
  return table;
}

}  // namespace

std::vector<Table> measure_tables(const StudyResult& result) {
  std::vector<Table> tables;
  std::size_t n = 0;
  for (const Plot& plot : result.study->plots)
    if (plot.kind == "work_precision") tables.push_back(work_table(result, plot, ++n));
  n = 0;
  for (const Matched& entry : result.study->matched) {
    tables.push_back(matched_table(result, entry, ++n));
    tables.push_back(sentences_table(result, entry, n));
  }
  n = 0;
  for (const Heatmap& map : result.study->heatmaps)
    tables.push_back(heatmap_table(result, map, ++n));
  n = 0;
  for (const RunTable& entry : result.study->tables)
    tables.push_back(run_table(result, entry, ++n));
  return tables;
}

}  // namespace concord::studies
