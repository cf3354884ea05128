#include "studies/driver/run_table.hpp"

#include <algorithm>

namespace concord::studies {
namespace {

/// The run of the line's `against` that has a run's resolution and seed; null where there is
/// none.
const Row* partner_of(const Study& study, const std::vector<Row>& rows, const Row& run,
                      const Selector& against) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& other) {
    return study.cases[other.case_index].matches(against) &&
           other.resolution == run.resolution && other.seed == run.seed;
  });
  return found == rows.end() ? nullptr : &*found;
}

/// A run's number in the column; nothing with the reason set where it has none.
std::optional<double> number_of(const Row& run, const TableColumn& column, TableCell& cell) {
  const auto value = value_of(run, column.quantity);
  if (!value) cell.reason = why_absent(run, column.quantity);
  return value;
}

bool selects(const TableLine& line, const Study& study, const Row& run) {
  return study.cases[run.case_index].matches(line.selector) &&
         (!line.resolution || run.resolution == *line.resolution);
}

}  // namespace

std::vector<const TableLine*> lines_of(const std::vector<Row>& rows, const Study& study,
                                       const RunTable& table) {
  std::vector<const TableLine*> lines;
  for (const TableLine& line : table.lines) {
    if (std::any_of(rows.begin(), rows.end(),
                    [&](const Row& run) { return selects(line, study, run); }))
      lines.push_back(&line);
  }
  return lines;
}

TableCell table_cell(const Study& study, const std::vector<Row>& rows, const TableLine& line,
                     const TableColumn& column) {
  TableCell cell;
  std::vector<double> values;
  if (column.difference && !line.against) return cell;
  for (const Row& run : rows) {
    if (!selects(line, study, run)) continue;
    const Row* partner =
        column.difference ? partner_of(study, rows, run, *line.against) : nullptr;
    if (column.difference && partner == nullptr) continue;
    const auto value = number_of(run, column, cell);
    const auto base = partner ? number_of(*partner, column, cell) : std::optional(0.0);
    if (!value || !base) return cell;
    values.push_back(*value - *base);
    cell.closes = cell.closes && balance_closes(study, run).value_or(true) &&
                  (!partner || balance_closes(study, *partner).value_or(true));
  }
  cell.runs = values.size();
  if (values.empty())
    cell.reason =
        column.difference ? "no run with a partner to compare with" : "no run in this report";
  else
    cell.value = pool_of(values, column.over_seeds) * display_factor(column.unit);
  return cell;
}

}  // namespace concord::studies
