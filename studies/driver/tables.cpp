#include "studies/driver/tables.hpp"

#include "studies/driver/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace concord::studies {
namespace {

using Cells = std::vector<std::string>;

std::string number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{:.6g}", *value) : "";
}

std::string exact(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "";
}

/// "does not close" where a run at these resolutions of a case has no closed energy balance.
std::string balance_cell(const StudyResult& result, std::size_t case_index,
                         const std::vector<double>& resolutions) {
  return balances_close(*result.study, result.rows, case_index, resolutions)
             ? ""
             : balance_text(false);
}

Cells case_cells(const Case& entry) { return {entry.scene, entry.method, entry.variant}; }

/// Quantities that any run has, as dotted paths.
std::set<std::string> quantities_of(const std::vector<Row>& rows) {
  std::set<std::string> quantities;
  for (const Row& row : rows)
    for (const char* group : {"errors", "invariants", "quantities", "signals"}) {
      const auto found = row.summary.find(group);
      if (found == row.summary.end() || !found->is_object()) continue;
      for (const auto& [name, value] : found->items()) {
        const std::string path = std::string(group) + "." + name;
        if (!value.is_object()) quantities.insert(path);
        if (!value.is_object()) continue;  // a signal: its features
        for (const auto& [feature, number] : value.items())
          if (number.is_number()) quantities.insert(path + "." + feature);
      }
    }
  return quantities;
}

Table runs_table(const StudyResult& result) {
  std::vector<std::string> costs{"h", "unknowns", "steps", "dt", "t_end"};
  if (result.study->timing)
    costs.insert(costs.end(), {"wall_s", "setup_s", "ns_per_particle_step"});
  costs.emplace_back("peak_rss_mb");
  const auto quantities = quantities_of(result.rows);
  Table table{"runs", {"scene", "method", "variant", "resolution", "seed"}, {}};
  table.columns.insert(table.columns.end(), costs.begin(), costs.end());
  table.columns.insert(table.columns.end(), quantities.begin(), quantities.end());
  const bool balance = result.study->balance_tolerance.has_value();
  if (balance) table.columns.emplace_back("energy balance");
  table.columns.emplace_back("error");
  for (const Row& row : result.rows) {
    Cells cells = case_cells(result.study->cases[row.case_index]);
    cells.push_back(fmt::format("{:g}", row.resolution));
    cells.push_back(std::to_string(row.seed));
    for (const std::string& cost : costs) cells.push_back(exact(value_of(row, cost)));
    for (const std::string& quantity : quantities)
      cells.push_back(exact(value_of(row, quantity)));
    const auto closes = balance_closes(*result.study, row);
    if (balance) cells.emplace_back(closes ? balance_text(*closes) : "");
    cells.push_back(row.error);
    table.cells.push_back(std::move(cells));
  }
  return table;
}

Table claims_table(const StudyResult& result) {
  Table table{
      "claims",
      {"id", "statement", "source", "source's value", "measured", "bound", "verdict", "reason"},
      {}};
  for (const ClaimResult& claim : result.claims)
    table.cells.push_back({claim.claim->id, claim.claim->statement, claim.claim->source,
                           claim.claim->source_value, number(claim.measured),
                           bound_text(*claim.claim), to_text(claim.verdict), claim.reason});
  return table;
}

Table fits_table(const StudyResult& result) {
  Table table{
      "fits",
      {"scene", "method", "variant", "quantity", "slope", "r2", "levels", "energy balance"},
      {}};
  for (const FitResult& fit : result.fits) {
    Cells cells = case_cells(result.study->cases[fit.case_index]);
    cells.insert(cells.end(), {fit.quantity, number(fit.line.slope), number(fit.line.r2),
                               std::to_string(fit.resolutions.size()),
                               balance_cell(result, fit.case_index, fit.resolutions)});
    table.cells.push_back(std::move(cells));
  }
  return table;
}

Table references_table(const StudyResult& result) {
  Table table{
      "references",
      {"scene", "method", "variant", "quantity", "value", "statement", "energy balance"},
      {}};
  for (const ReferenceResult& reference : result.references) {
    Cells cells = case_cells(result.study->cases[reference.case_index]);
    cells.insert(cells.end(),
                 {reference.quantity,
                  reference.resolutions.empty() ? "" : exact(reference.value),
                  reference.convergence.statement,
                  balance_cell(result, reference.case_index, reference.resolutions)});
    table.cells.push_back(std::move(cells));
  }
  return table;
}

Table convergence_table(const StudyResult& result, const std::string& quantity) {
  Table table{"convergence-" + slug(quantity),
              {"scene", "method", "variant", "resolution", "h [m]", "unknowns", "mean", "min",
               "max", "seeds", "local order", "time loop or solve [s]", "energy balance"},
              {}};
  for (std::size_t c = 0; c < result.study->cases.size(); ++c) {
    const auto levels = levels_of(result.rows, c, quantity);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const Level& level = levels[i];
      const double order =
          i == 0 ? std::nan("")
                 : local_order(levels[i - 1].h, levels[i - 1].mean, level.h, level.mean);
      Cells cells = case_cells(result.study->cases[c]);
      cells.insert(cells.end(),
                   {fmt::format("{:g}", level.resolution), number(level.h),
                    number(level.unknowns), number(level.mean), number(level.minimum),
                    number(level.maximum), std::to_string(level.seeds),
                    std::isfinite(order) ? fmt::format("{:.2f}", order) : "",
                    result.study->timing ? number(level.wall_s) : "",
                    balance_cell(result, c, {level.resolution})});
      table.cells.push_back(std::move(cells));
    }
  }
  return table;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string markdown_cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c == '\n' ? ' ' : c);
  return escaped;
}

}  // namespace

std::string Table::csv() const {
  std::string text;
  const auto line = [&text](const Cells& row) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i ? "," : "") + csv_cell(row[i]);
    text += '\n';
  };
  line(columns);
  for (const Cells& row : cells) line(row);
  return text;
}

std::string Table::markdown() const {
  std::string text;
  const auto line = [&text](const Cells& row) {
    text += '|';
    for (const std::string& cell : row) text += ' ' + markdown_cell(cell) + " |";
    text += '\n';
  };
  line(columns);
  line(Cells(columns.size(), "---"));
  for (const Cells& row : cells) line(row);
  return text;
}

std::vector<Table> tables_of(const StudyResult& result) {
  std::vector<Table> tables{runs_table(result), claims_table(result), fits_table(result),
                            references_table(result)};
  std::set<std::string> quantities;
  for (const Fit& fit : result.study->fits)
    if (quantities.insert(fit.quantity).second)
      tables.push_back(convergence_table(result, fit.quantity));
  for (Table& table : measure_tables(result)) tables.push_back(std::move(table));
  std::erase_if(tables, [](const Table& table) { return table.cells.empty(); });
  return tables;
}

}  // namespace concord::studies
