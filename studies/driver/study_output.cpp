#include "studies/driver/study_output.hpp"

#include "scene/output.hpp"
#include "studies/driver/drawing_json.hpp"
#include "studies/driver/measure_json.hpp"
#include "studies/driver/run_table.hpp"
#include "studies/driver/tables.hpp"

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace {

using nlohmann::json;

json number_or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? json(*value) : json(nullptr);
}

void name_case(json& object, const Case& entry) {
  object["scene"] = entry.scene;
  object["method"] = entry.method;
  object["variant"] = entry.variant;
}

const char* to_text(ClaimKind kind) {
  switch (kind) {
    case ClaimKind::slope:
      return "slope";
    case ClaimKind::value:
      return "value";
    case ClaimKind::ratio:
      return "ratio";
    case ClaimKind::gci:
      return "gci";
    case ClaimKind::minimum:
      return "minimum";
    case ClaimKind::matched_ratio:
      return "matched_ratio";
  }
  return "";
}

json claim_json(const ClaimResult& result) {
  const Claim& claim = *result.claim;
  json object{{"id", claim.id},
              {"statement", claim.statement},
              {"source", claim.source},
              {"source_value", claim.source_value},
              {"kind", to_text(claim.kind)},
              {"quantity", claim.quantity},
              {"unit", claim.unit},
              {"bound", bound_text(claim)},
              {"measured", number_or_null(result.measured)},
              {"verdict", to_text(result.verdict)}};
  put(object, claim.selector);
  put(object, "resolution", claim.resolution);
  put(object, "min", claim.minimum);
  put(object, "max", claim.maximum);
  if (claim.kind == ClaimKind::matched_ratio) {
    object["level"] = claim.level;
    object["time"] = to_text(claim.time);
  }
  put(object, "place", result.place);
  if (!claim.setting.empty()) object["setting"] = claim.setting;
  if (!result.reason.empty()) object["reason"] = result.reason;
  return object;
}

/// Order between a row's level and the next coarser one, NaN where there is none.
double order_at(const std::vector<Level>& levels, double resolution) {
  for (std::size_t i = 1; i < levels.size(); ++i)
    if (levels[i].resolution == resolution)
      return local_order(levels[i - 1].h, levels[i - 1].mean, levels[i].h, levels[i].mean);
  return std::nan("");
}

json row_json(const StudyResult& result, const Row& row) {
  const Case& entry = result.study->cases[row.case_index];
  json object = row.summary;
  name_case(object, entry);
  object["resolution"] = row.resolution;
  object["seed"] = row.seed;
  object["perturb"] = entry.perturb;
  object["settings"] = entry.set;
  object["scene_settings"] = entry.scene_set;
  if (!entry.probe.empty()) {
    object["probe"] = entry.probe;
    object["options"] = entry.options;
  }
  object["run"] = row.run.string();
  if (!row.command.empty()) object["command"] = row.command;
  if (!row.error.empty()) object["error"] = row.error;
  if (const auto closes = balance_closes(*result.study, row))
    object["balance"] = balance_text(*closes);
  json orders = json::object();
  for (std::size_t i = 0; i < result.study->fits.size(); ++i) {
    const std::string& quantity = result.study->fits[i].quantity;
    const double order =
        order_at(levels_of(result.rows, row.case_index, quantity), row.resolution);
    if (!std::isfinite(order)) continue;
    orders[quantity] = order;
    if (i == 0) object["local_order"] = order;
  }
  if (!orders.empty()) object["local_orders"] = orders;
  return object;
}

/// Marks what runs entered whose energy balance does not close.
void put_balance(json& object, const StudyResult& result, std::size_t case_index,
                 const std::vector<double>& resolutions) {
  if (!balances_close(*result.study, result.rows, case_index, resolutions))
    object["balance"] = balance_text(false);
}

json fit_json(const StudyResult& result, const FitResult& fit) {
  json object{{"quantity", fit.quantity},
              {"slope", fit.line.slope},
              {"r2", fit.line.r2},
              {"levels", fit.resolutions.size()},
              {"resolutions", fit.resolutions}};
  name_case(object, result.study->cases[fit.case_index]);
  put_balance(object, result, fit.case_index, fit.resolutions);
  return object;
}

json reference_json(const StudyResult& result, const ReferenceResult& reference) {
  const GridConvergence& convergence = reference.convergence;
  json object{{"quantity", reference.quantity},
              {"formal_order", reference.formal_order},
              {"resolutions", reference.resolutions},
              {"asymptotic", convergence.asymptotic},
              {"statement", convergence.statement}};
  name_case(object, result.study->cases[reference.case_index]);
  put_balance(object, result, reference.case_index, reference.resolutions);
  if (!reference.resolutions.empty()) object["value"] = reference.value;
  if (convergence.asymptotic) {
    object["order"] = convergence.order;
    object["gci"] = convergence.gci;
    object["safety_factor"] = convergence.safety_factor;
    object["extrapolated"] = convergence.extrapolated;
  }
  return object;
}

}  // namespace

bool StudyResult::passed() const {
  return !interrupted &&
         std::none_of(claims.begin(), claims.end(),
                      [](const ClaimResult& claim) { return claim.verdict == Verdict::fail; });
}

json study_json(const StudyResult& result) {
  const Study& study = *result.study;
  json object{{"name", study.name},
              {"title", study.title},
              {"question", study.question},
              {"source", study.source},
              {"paper_statement", study.paper_statement},
              {"mode", study.full ? "full" : "quick"},
              {"timing", study.timing},
              {"verdict", result.passed() ? "pass" : "fail"}};
  if (study.balance_tolerance) object["balance_tolerance"] = *study.balance_tolerance;
  if (result.interrupted) object["interrupted"] = true;
  for (const char* list : {"claims", "rows", "fits", "references", "matched", "heatmap",
                           "tables", "plots", "pictures"})
    object[list] = json::array();
  for (const ClaimResult& claim : result.claims) object["claims"].push_back(claim_json(claim));
  for (const Row& row : result.rows) object["rows"].push_back(row_json(result, row));
  for (const FitResult& fit : result.fits) object["fits"].push_back(fit_json(result, fit));
  for (const ReferenceResult& reference : result.references)
    object["references"].push_back(reference_json(result, reference));
  for (const Matched& matched : study.matched)
    object["matched"].push_back(matched_json(result, matched));
  for (const Heatmap& map : study.heatmaps)
    object["heatmap"].push_back(heatmap_json(result, map));
  for (const RunTable& table : study.tables)
    if (!lines_of(result.rows, study, table).empty())
      object["tables"].push_back(run_table_json(result, table));
  for (const Plot& plot : study.plots) {
    object["plots"].push_back(plot_json(study, plot));
    if (plot.kind == "work_precision") put_work_precision(object["plots"].back(), result, plot);
  }
  for (const Picture& picture : study.pictures) {
    const auto& panels = picture.panels;
    const bool any =
        panels.empty() ? has_run(study, picture.body)
                       : std::any_of(panels.begin(), panels.end(),
                                     [&](const Panel& panel) { return has_run(study, panel); });
    if (study.full || any) object["pictures"].push_back(picture_json(study, picture));
  }
  return object;
}

void write_study(const StudyResult& result, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "tables");
  for (const Table& table : tables_of(result)) {
    scene::write_file(folder / "tables" / (table.name + ".csv"), table.csv());
    scene::write_file(folder / "tables" / (table.name + ".md"), table.markdown());
  }
  scene::write_file(folder / "study.json", study_json(result).dump(1) + "\n");
}

}  // namespace concord::studies
