// What the entries of a study file must not contradict among each other.

#include "studies/driver/study_entries.hpp"

#include <fmt/format.h>

namespace concord::studies {
namespace {

void check_selects(const std::vector<Case>& all, const Selector& selector, bool one,
                   const SourcePosition& where, const std::string& key) {
  std::vector<std::string> matching, titles;
  for (const Case& entry : all) {
    titles.push_back(entry.title());
    if (entry.matches(selector)) matching.push_back(entry.title());
  }
  std::string found =
      fmt::format("scene {}, method {}, variant {}", selector.scene.value_or("any"),
                  selector.method.value_or("any"), selector.variant.value_or("any"));
  if (selector.probe) found += ", probe " + *selector.probe;
  for (std::size_t at; (at = found.find('\n')) != std::string::npos;)
    found.replace(at, 1, " or ");
  if (matching.empty())
    throw InputError(where, key, found,
                     "a case of this study: " + fmt::format("{}", fmt::join(titles, "; ")));
  if (one && matching.size() > 1)
    throw InputError(where, key, found,
                     "one case, but it selects " +
                         fmt::format("{}", fmt::join(matching, "; ")));
}

void check_names(const std::vector<Case>& all) {
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (all[i].title() == all[j].title())
        throw InputError(all[i].where, "case.variant", all[i].title(),
                         "a scene, method, variant and probe that no other case has");
}

void check_claims(const Study& study, const std::vector<Case>& all) {
  for (std::size_t i = 0; i < study.claims.size(); ++i) {
    const Claim& claim = study.claims[i];
    for (std::size_t j = 0; j < i; ++j)
      if (study.claims[j].id == claim.id)
        throw InputError(claim.where, "claim.id", claim.id, "an id that no other claim has");
    const bool many = claim.kind == ClaimKind::value || claim.kind == ClaimKind::minimum;
    check_selects(all, claim.selector, !many, claim.where, "claim");
    if (claim.divided) check_selects(all, claim.other, true, claim.where, "claim.other");
  }
}

/// An error's reference is one case of the scene of every case that has the error.
void check_errors(const Study& study, const std::vector<Case>& all) {
  for (const ErrorEntry& entry : study.errors) {
    check_selects(all, entry.selector, false, entry.where, "error");
    if (entry.exact) continue;
    for (const Case& one : all) {
      if (!one.matches(entry.selector)) continue;
      Selector reference = entry.reference;
      if (!reference.scene) reference.scene = one.scene;
      check_selects(all, reference, true, entry.where, "error.reference");
    }
  }
}

/// Errors and times of different scenes do not stand on one front.
void check_plots(const Study& study, const std::vector<Case>& all) {
  for (const Plot& plot : study.plots) {
    if (plot.kind != "work_precision") continue;
    check_selects(all, plot.selector, false, plot.where, "plot");
    std::string scene;
    for (const Case& one : all) {
      if (!one.matches(plot.selector)) continue;
      if (!scene.empty() && one.scene != scene)
        throw InputError(plot.where, "plot.scene", scene + " and " + one.scene,
                         "cases of one scene in a work_precision plot");
      scene = one.scene;
    }
  }
}

void check_timing(const Study& study, const std::vector<Case>& all) {
  for (const Case& one : all)
    if (one.repeats > 0 && !study.timing)
      throw InputError(one.where, "case.repeats", std::to_string(one.repeats),
                       "timing = true of the study: runs beside each other cannot be timed");
}

/// A row of a heat map is of at least one case, whatever the column.
void check_heatmaps(const Study& study, const std::vector<Case>& all) {
  for (const Heatmap& map : study.heatmaps) {
    for (const HeatRow& row : map.rows)
      check_selects(all, row.selector, false, map.where, "heatmap.rows: " + row.label);
    for (const HeatColumn& column : map.columns)
      check_selects(all, column.selector, false, map.where, "heatmap.columns: " + column.label);
  }
}

/// Lines of a table are of at least one case, what they are compared with is one.
void check_tables(const Study& study, const std::vector<Case>& all) {
  for (const RunTable& table : study.tables)
    for (const TableLine& line : table.lines) {
      check_selects(all, line.selector, false, table.where, "table.rows: " + line.label);
      if (line.against)
        check_selects(all, *line.against, true, table.where, "table.against: " + line.label);
    }
}

}  // namespace

void check_study(const Study& study, const std::vector<Case>& all) {
  check_names(all);
  check_timing(study, all);
  check_plots(study, all);
  check_claims(study, all);
  check_errors(study, all);
  check_heatmaps(study, all);
  check_tables(study, all);
  for (const Signal& signal : study.signals)
    check_selects(all, signal.selector, false, signal.where, "signal");
  for (const Matched& matched : study.matched)
    check_selects(all, matched.selector, false, matched.where, "matched");
  for (const Reference& reference : study.references)
    check_selects(all, reference.selector, true, reference.where, "reference");
  for (const Comparison& comparison : study.comparisons) {
    check_selects(all, comparison.reference, true, comparison.where, "compare.reference");
    check_selects(all, comparison.selector, false, comparison.where, "compare");
  }
}

}  // namespace concord::studies
