// Readers of [[signal]], [[error]], [[matched]], [[heatmap]] and [[table]].

#include "studies/driver/signals.hpp"
#include "studies/driver/study_entries.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace concord::studies {
namespace {

/// A name that stands in a dotted path: small letters, digits, _.
std::string read_name(StrictTable& table) {
  std::string name = table.text("name");
  if (name.empty() ||
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
    table.reject(*table.node("name"), "small letters, digits and _");
  return name;
}

void read_exact(StrictTable& table, ErrorEntry& entry) {
  const auto exact = table.optional_number("exact");
  const std::string unit = table.text_or("unit", "1");
  if (!exact) {
    if (const auto* node = table.node("unit")) table.reject(*node, "only with `exact`");
    return;
  }
  if (*exact == 0) table.reject(*table.node("exact"), "not 0: errors are relative to it");
  entry.exact = *exact / display_factor(unit, entry.where);
}

void read_error_reference(StrictTable& table, ErrorEntry& entry) {
  if (!table.node("reference")) return;
  StrictTable reference = table.table("reference", "{ method = \"fem\", variant = \"Q2\" }");
  entry.reference = read_selector(reference);
  entry.reference_resolution = reference.optional_number("resolution");
  reference.finish();
}

int read_digits(StrictTable& table, int by_default) {
  const double digits = table.number_or("digits", by_default);
  if (digits != std::floor(digits) || digits < 1 || digits > 17)
    table.reject(*table.node("digits"), "significant digits, 1 to 17");
  return static_cast<int>(digits);
}

HeatRow read_heat_row(StrictTable table) {
  HeatRow row;
  row.label = table.text("label");
  row.selector = read_selector(table);
  row.quantity = table.text("quantity");
  row.resolution = table.optional_number("resolution");
  row.over_seeds = read_pool(table);
  row.unit = table.text_or("unit", "1");
  display_factor(row.unit, table.where());
  const auto good = table.optional_number("good"), bad = table.optional_number("bad");
  if (!good) table.missing("good", "the value, in `unit`, whose score is 1");
  if (!bad || *bad == *good) table.missing("bad", "the value, other than `good`, of score 0");
  row.good = *good;
  row.bad = *bad;
  const bool low = row.good < row.bad;
  if (choose<bool>(table, "better", {{"low", true}, {"high", false}}, &low) != low)
    table.reject(*table.node("better"),
                 low ? "\"low\": good is below bad" : "\"high\": good is above bad");
  const bool linear = false;
  row.logarithmic = choose<bool>(table, "scale", {{"linear", false}, {"log", true}}, &linear);
  if (row.logarithmic && !(row.good > 0 && row.bad > 0))
    table.reject(*table.node("scale"), "\"linear\", or good and bad above 0");
  row.digits = read_digits(table, row.digits);
  row.note = table.text_or("note", "");
  row.absent = table.text_or("absent", "");
  table.finish();
  return row;
}

TableColumn read_table_column(StrictTable table) {
  TableColumn column;
  column.label = table.text("label");
  column.quantity = table.text("quantity");
  column.unit = table.text_or("unit", "1");
  display_factor(column.unit, table.where());
  column.over_seeds = table.node("over_seeds") ? read_pool(table) : Pool::mean;
  column.digits = read_digits(table, column.digits);
  column.difference = table.flag_or("difference", false);
  table.finish();
  return column;
}

TableLine read_table_line(StrictTable table) {
  TableLine line;
  line.label = table.text("label");
  line.source_value = table.text_or("source_value", "");
  line.selector = read_selector(table);
  line.resolution = table.optional_number("resolution");
  if (table.node("against")) {
    StrictTable against = table.table("against", "a case: { variant = \"...\" }");
    line.against = read_selector(against);
    against.finish();
  }
  table.finish();
  return line;
}

}  // namespace

WorkTime read_work_time(StrictTable& table) {
  const WorkTime by_default = WorkTime::wall;
  return choose<WorkTime>(
      table, "time", {{"wall_s", WorkTime::wall}, {"total", WorkTime::total}}, &by_default);
}

Pool read_pool(StrictTable& table, const std::string& key) {
  const Pool by_default = Pool::max;
  return choose<Pool>(
      table, key,
      {{"max", Pool::max}, {"min", Pool::min}, {"mean", Pool::mean}, {"range", Pool::range}},
      &by_default);
}

Signal read_signal(StrictTable table) {
  Signal signal;
  signal.where = table.where();
  signal.name = read_name(table);
  signal.column = table.text("column");
  signal.features = table.texts("features");
  if (signal.features.empty())
    table.missing("features", "a list such as [\"first_peak\", \"period\"]");
  const auto& known = feature_names();
  for (const std::string& feature : signal.features)
    if (std::find(known.begin(), known.end(), feature) == known.end())
      throw InputError(table.node("features")->where, "signal.features",
                       scene::in_quotes(feature), scene::allowed_words(feature, known));
  signal.level = table.number_or("level", signal.level);
  signal.prominence = table.number_or("prominence", signal.prominence);
  if (!(signal.prominence > 0 && signal.prominence < 1))
    table.reject(*table.node("prominence"), "a fraction of the record's range, 0 to 1");
  signal.from = table.optional_number("from");
  signal.to = table.optional_number("to");
  if (signal.to && !(*signal.to > signal.from.value_or(0)))
    table.reject(*table.node("to"), "a time in s after `from`, or after 0");
  signal.selector = read_selector(table);
  table.finish();
  return signal;
}

ErrorEntry read_error(StrictTable table) {
  ErrorEntry entry;
  entry.where = table.where();
  entry.name = read_name(table);
  const bool of_number = false;
  entry.of_history =
      choose<bool>(table, "kind", {{"number", false}, {"history", true}}, &of_number);
  (entry.of_history ? entry.column : entry.quantity) =
      table.text(entry.of_history ? "column" : "quantity");
  if (!entry.of_history) {
    read_exact(table, entry);
    entry.is_signed = table.flag_or("signed", false);
  }
  read_error_reference(table, entry);
  if (entry.exact && table.node("reference"))
    table.reject(*table.node("reference"), "one of `reference` and `exact`");
  if (!entry.exact && !table.node("reference"))
    table.missing("reference", entry.of_history ? "a case: { method = \"fem\" }"
                                                : "a case, or `exact` with its `unit`");
  entry.selector = read_selector(table);
  table.finish();
  return entry;
}

Matched read_matched(StrictTable table) {
  Matched matched;
  matched.where = table.where();
  matched.title = table.text_or("title", "");
  matched.quantity = table.text("quantity");
  matched.note = table.text_or("note", "");
  matched.time = read_work_time(table);
  matched.levels = table.positive_numbers("levels");
  if (matched.levels.empty()) table.missing("levels", "relative errors such as [0.1, 0.01]");
  std::sort(matched.levels.begin(), matched.levels.end(), std::greater<>());
  matched.selector = read_selector(table);
  table.finish();
  return matched;
}

RunTable read_run_table(StrictTable table) {
  RunTable entry;
  entry.where = table.where();
  entry.title = table.text("title");
  entry.note = table.text_or("note", "");
  for (const StrictTable& column : table.inner_tables("columns"))
    entry.columns.push_back(read_table_column(column));
  for (const StrictTable& line : table.inner_tables("rows"))
    entry.lines.push_back(read_table_line(line));
  if (entry.columns.empty())
    table.missing("columns", "[{ label = \"...\", quantity = \"...\" }]");
  if (entry.lines.empty()) table.missing("rows", "[{ label = \"...\", variant = \"...\" }]");
  table.finish();
  return entry;
}

Heatmap read_heatmap(StrictTable table) {
  Heatmap map;
  map.where = table.where();
  map.title = table.text_or("title", "");
  for (StrictTable& entry : table.inner_tables("columns")) {
    map.columns.push_back({entry.text("label"), read_selector(entry)});
    entry.finish();
  }
  for (const StrictTable& entry : table.inner_tables("rows"))
    map.rows.push_back(read_heat_row(entry));
  if (map.columns.empty()) table.missing("columns", "[{ label = \"...\", method = \"fem\" }]");
  if (map.rows.empty())
    table.missing("rows", "[{ label = \"...\", quantity = \"...\", good = 0, bad = 1 }]");
  table.finish();
  return map;
}

}  // namespace concord::studies
