#include "studies/driver/claims.hpp"

#include "studies/driver/work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace concord::studies {
namespace {

/// A number, or the reason why there is none.
struct Measured {
  std::optional<double> value;
  std::string reason;
  std::optional<double> place;       // of a minimum
  std::vector<std::string> remarks;  // what to know of the runs that gave the number
};

std::string run_title(const Study& study, const Row& row) {
  return fmt::format("{}, resolution {:g}, seed {}", study.cases[row.case_index].title(),
                     row.resolution, row.seed);
}

/// What a claim asks of runs, for the claim's own cases or the denominator's.
struct Wanted {
  const Selector& selector;
  const std::string& quantity;
  const std::optional<double>& resolution;
  Pool pool;
  const std::optional<Pool>& over_resolutions;
};

Measured pooled(const Study& study, const std::vector<Row>& rows, const Wanted& wanted,
                std::optional<std::size_t> only_case = std::nullopt) {
  std::map<double, std::vector<double>> values;  // of resolutions, or all under 0
  Measured measured;
  for (const Row& row : rows) {
    const Case& entry = study.cases[row.case_index];
    if (only_case ? row.case_index != *only_case : !entry.matches(wanted.selector)) continue;
    if (wanted.resolution && row.resolution != *wanted.resolution) continue;
    const auto value = value_of(row, wanted.quantity);
    if (!value)
      return {{}, run_title(study, row) + ": " + why_absent(row, wanted.quantity), {}, {}};
    values[wanted.over_resolutions ? row.resolution : 0].push_back(*value);
    if (!balance_closes(study, row).value_or(true))
      measured.remarks.push_back("energy balance does not close: " + run_title(study, row));
  }
  if (values.empty()) {
    measured.reason = wanted.resolution
                          ? fmt::format("no run at resolution {:g}", *wanted.resolution)
                          : "no run of this case";
    return measured;
  }
  std::vector<double> levels;
  for (const auto& [resolution, runs] : values) levels.push_back(pool_of(runs, wanted.pool));
  measured.value =
      wanted.over_resolutions ? pool_of(levels, *wanted.over_resolutions) : levels.front();
  return measured;
}

/// Value of a setting of the method or scene, as a number.
std::optional<double> setting_of(const Case& entry, const std::string& name) {
  for (const auto* settings : {&entry.set, &entry.scene_set}) {
    const auto found = settings->find(name);
    if (found == settings->end()) continue;
    try {
      return std::stod(found->second);
    } catch (const std::logic_error&) {
      return std::nullopt;  // a word
    }
  }
  return std::nullopt;
}

/// The least over the cases selected, and where it lies. A case without a value cannot hold it
/// and is named in the remarks.
Measured least(const Study& study, const Claim& claim, const std::vector<Row>& rows,
               const Wanted& wanted) {
  Measured best;
  best.reason = "no case has a value";
  std::vector<std::string> without;
  for (std::size_t c = 0; c < study.cases.size(); ++c) {
    if (!study.cases[c].matches(claim.selector)) continue;
    Measured one = pooled(study, rows, wanted, c);
    if (!one.value) {
      without.push_back("without a value: " + one.reason);
    } else if (!best.value || *one.value < *best.value) {
      best = std::move(one);
      if (!claim.setting.empty()) best.place = setting_of(study.cases[c], claim.setting);
    }
  }
  best.remarks.insert(best.remarks.end(), without.begin(), without.end());
  return best;
}

Measured slope(const Study& study, const Claim& claim, const std::vector<FitResult>& fits) {
  for (const FitResult& fit : fits)
    if (study.cases[fit.case_index].matches(claim.selector) && fit.quantity == claim.quantity)
      return {fit.line.slope, "", {}, {}};
  return {{},
          "no fit of " + claim.quantity + ": a [[fit]] and three levels with values are needed",
          {},
          {}};
}

Measured gci(const Study& study, const Claim& claim,
             const std::vector<ReferenceResult>& references) {
  for (const ReferenceResult& reference : references)
    if (study.cases[reference.case_index].matches(claim.selector) &&
        reference.quantity == claim.quantity) {
      if (reference.convergence.asymptotic) return {reference.convergence.gci, "", {}, {}};
      return {{}, reference.convergence.statement, {}, {}};
    }
  return {{}, "no [[reference]] for " + claim.quantity, {}, {}};
}

Measured measure(const Study& study, const Claim& claim, const std::vector<Row>& rows,
                 const std::vector<FitResult>& fits,
                 const std::vector<ReferenceResult>& references) {
  if (claim.kind == ClaimKind::slope) return slope(study, claim, fits);
  if (claim.kind == ClaimKind::gci) return gci(study, claim, references);
  if (claim.kind == ClaimKind::matched_ratio) {
    MatchedRatio ratio = matched_ratio(study, claim, rows);
    return {ratio.value, std::move(ratio.reason), {}, std::move(ratio.remarks)};
  }
  const Wanted wanted{claim.selector, claim.quantity, claim.resolution, claim.over_seeds,
                      claim.over_resolutions};
  Measured value = claim.kind == ClaimKind::minimum ? least(study, claim, rows, wanted)
                                                    : pooled(study, rows, wanted);
  const bool divided = claim.kind == ClaimKind::ratio || claim.divided;
  if (!divided || !value.value) return value;
  Measured other =
      pooled(study, rows,
             {claim.other, claim.other_quantity, claim.other_resolution,
              claim.other_over_seeds.value_or(claim.over_seeds), claim.other_over_resolutions});
  if (!other.value) return other;
  if (*other.value == 0) return {{}, "the denominator is 0", {}, {}};
  *value.value /= *other.value;
  value.remarks.insert(value.remarks.end(), other.remarks.begin(), other.remarks.end());
  return value;
}

/// Judges a number against the claim's bounds.
void weigh(const Claim& claim, const Measured& measured, ClaimResult& result) {
  const auto within = [](double value, const std::optional<double>& low,
                         const std::optional<double>& high) {
    return (!low || value >= *low) && (!high || value <= *high);
  };
  result.measured = *measured.value * display_factor(claim.unit, claim.where);
  result.place = measured.place;
  const bool placed = claim.setting_minimum || claim.setting_maximum;
  const bool holds = within(*result.measured, claim.minimum, claim.maximum) &&
                     (!placed || (result.place && within(*result.place, claim.setting_minimum,
                                                         claim.setting_maximum)));
  result.verdict = holds ? Verdict::pass : Verdict::fail;
  if (holds) return;
  const std::string where =
      !placed ? ""
              : fmt::format(" at {} {}", claim.setting,
                            result.place ? fmt::format("{:g}", *result.place) : "unknown");
  result.reason = fmt::format("{:.4g}{} is not {}", *result.measured, where, bound_text(claim));
}

}  // namespace

const char* to_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::full_report_only:
      return "full report only";
  }
  return "";
}

std::string bound_text(const Claim& claim) {
  const std::string unit = claim.unit == "1" ? "" : " " + claim.unit;
  std::string text;
  if (claim.minimum) text = fmt::format(">= {:g}{}", *claim.minimum, unit);
  if (claim.maximum)
    text += fmt::format("{}<= {:g}{}", text.empty() ? "" : " and ", *claim.maximum, unit);
  const auto &low = claim.setting_minimum, &high = claim.setting_maximum;
  if (!low && !high) return text;
  text += (text.empty() ? "at " : ", at ") + claim.setting;
  if (low && high)
    text +=
        *low == *high ? fmt::format(" {:g}", *low) : fmt::format(" {:g} to {:g}", *low, *high);
  else
    text += low ? fmt::format(" >= {:g}", *low) : fmt::format(" <= {:g}", *high);
  return text;
}

std::vector<ClaimResult> judge(const Study& study, const std::vector<Row>& rows,
                               const std::vector<FitResult>& fits,
                               const std::vector<ReferenceResult>& references) {
  std::vector<ClaimResult> results;
  for (const Claim& claim : study.claims) {
    ClaimResult result{&claim, Verdict::fail, {}, "", {}};
    if (claim.full_only && !study.full) {
      result.verdict = Verdict::full_report_only;
      result.reason = "judged by the full report";
    } else {
      const Measured measured = measure(study, claim, rows, fits, references);
      result.reason = measured.reason;
      if (measured.value) weigh(claim, measured, result);
      for (const std::string& remark : measured.remarks)
        result.reason += (result.reason.empty() ? "" : "; ") + remark;
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace concord::studies
