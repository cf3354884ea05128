#include "studies/driver/derive.hpp"

#include "studies/driver/history_file.hpp"
#include "studies/driver/signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path history_of(const Row& row, const fs::path& out) {
  return out / row.run / "history.csv";
}

/// The run that an entry's reference means for a row: of the row's scene unless it names one,
/// at the resolution asked for or the finest, first seed. Null where this mode has none.
const Row* reference_row(const Study& study, const std::vector<Row>& rows,
                         const ErrorEntry& entry, const Row& row) {
  Selector selector = entry.reference;
  if (!selector.scene) selector.scene = study.cases[row.case_index].scene;
  const Row* best = nullptr;
  for (const Row& other : rows) {
    const Case& owner = study.cases[other.case_index];
    if (!owner.matches(selector) || other.seed != owner.seeds.front()) continue;
    if (entry.reference_resolution && other.resolution != *entry.reference_resolution) continue;
    if (!best || other.resolution > best->resolution) best = &other;
  }
  return best;
}

/// A number, what it was compared with, or the reason why there is none.
struct Difference {
  Feature error;
  std::optional<double> reference;
};

Difference against(double value, double reference, bool is_signed) {
  if (reference == 0) return {{0, "the reference is 0: no relative error"}, reference};
  const double error = (value - reference) / std::abs(reference);
  return {{is_signed ? error : std::abs(error), ""}, reference};
}

Difference of_number(const ErrorEntry& entry, const Row& row, const Row* other) {
  const auto value = value_of(row, entry.quantity);
  if (!value) return {{0, why_absent(row, entry.quantity)}, {}};
  if (entry.exact) return against(*value, *entry.exact, entry.is_signed);
  const auto reference = value_of(*other, entry.quantity);
  if (!reference) return {{0, "of the reference: " + why_absent(*other, entry.quantity)}, {}};
  return against(*value, *reference, entry.is_signed);
}

Difference of_history(const ErrorEntry& entry, const Row& row, const Row& other,
                      const fs::path& out) {
  for (const Row* run : {&row, &other})
    if (!run->error.empty()) return {{0, run->error}, {}};
  const Record x = read_record(history_of(row, out), entry.column);
  if (!x.reason.empty()) return {{0, x.reason}, {}};
  const Record r = read_record(history_of(other, out), entry.column);
  if (!r.reason.empty()) return {{0, "of the reference: " + r.reason}, {}};
  return {history_difference(x.t, x.x, r.t, r.x), {}};
}

std::string title_of(const Study& study, const ErrorEntry& entry, const Row* other) {
  if (!other) return entry.exact ? fmt::format("{:g}", *entry.exact) : "";
  return fmt::format("{}, resolution {:g}", study.cases[other->case_index].title(),
                     other->resolution);
}

void add_error(const Study& study, const ErrorEntry& entry, const std::vector<Row>& rows,
               Row& row, const fs::path& out) {
  const Row* other = entry.exact ? nullptr : reference_row(study, rows, entry, row);
  if (other == &row) return;
  Difference difference{{0, "the reference does not run in this mode"}, {}};
  if (entry.of_history && other)
    difference = of_history(entry, row, *other, out);
  else if (entry.exact || other)
    difference = of_number(entry, row, other);
  json& source = row.summary["error_sources"][entry.name];
  source = json::object();
  source[entry.of_history ? "column" : "quantity"] =
      entry.of_history ? entry.column : entry.quantity;
  if (const std::string title = title_of(study, entry, other); !title.empty())
    source["reference"] = title;
  if (difference.reference) source["value"] = *difference.reference;
  if (difference.error.reason.empty())
    row.summary["errors"][entry.name] = difference.error.value;
  else
    source["reason"] = difference.error.reason;
  if (other && !balance_closes(study, *other).value_or(true))
    source["balance"] = balance_text(false);
}

/// The samples from `from` to `to` [s]; one less than 1e-9 of the record outside counts.
Record part_of(const Record& whole, const Signal& signal) {
  if (!whole.reason.empty() || whole.t.empty()) return whole;
  const double slack = 1e-9 * (whole.t.back() - whole.t.front());
  auto first = whole.t.begin(), last = whole.t.end();
  if (signal.from) first = std::lower_bound(first, last, *signal.from - slack);
  if (signal.to) last = std::upper_bound(first, last, *signal.to + slack);
  Record part;
  part.t.assign(first, last);
  part.x.assign(whole.x.begin() + (first - whole.t.begin()),
                whole.x.begin() + (last - whole.t.begin()));
  return part;
}

}  // namespace

void add_signals(const Study& study, std::vector<Row>& rows, const fs::path& out) {
  for (const Signal& signal : study.signals)
    for (Row& row : rows) {
      if (!study.cases[row.case_index].matches(signal.selector)) continue;
      json& target = row.summary["signals"][signal.name];
      target = json::object();
      target["column"] = signal.column;
      const Record whole = read_record(history_of(row, out), signal.column);
      const Record record = part_of(whole, signal);
      for (const std::string& name : signal.features) {
        const Feature feature =
            record.reason.empty()
                ? feature_of(name, record.t, record.x, {signal.level, signal.prominence})
                : Feature{0, record.reason};
        if (feature.reason.empty())
          target[name] = feature.value;
        else
          target["not_found"][name] = feature.reason;
      }
    }
}

void add_errors(const Study& study, std::vector<Row>& rows, const fs::path& out) {
  for (const ErrorEntry& entry : study.errors)
    for (Row& row : rows)
      if (study.cases[row.case_index].matches(entry.selector))
        add_error(study, entry, rows, row, out);
}

}  // namespace concord::studies
