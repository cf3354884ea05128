#include "studies/driver/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace {

/// A number, or the reason why there is none.
struct Measured {
  std::optional<double> value;
  std::string reason;
};

Measured pooled(const Study& study, const std::vector<Row>& rows, const Selector& selector,
                const std::string& quantity, const std::optional<double>& resolution,
                Pool pool) {
  std::vector<double> values;
  for (const Row& row : rows) {
    const Case& entry = study.cases[row.case_index];
    if (!entry.matches(selector) || (resolution && row.resolution != *resolution)) continue;
    const auto value = value_of(row, quantity);
    if (!value)
      return {{},
              fmt::format("{}, resolution {:g}, seed {}: {}", entry.title(), row.resolution,
                          row.seed, row.error.empty() ? "no " + quantity : row.error)};
    values.push_back(*value);
  }
  if (values.empty())
    return {{},
            resolution ? fmt::format("no run at resolution {:g}", *resolution)
                       : "no run of this case"};
  if (pool == Pool::max) return {*std::max_element(values.begin(), values.end()), ""};
  if (pool == Pool::min) return {*std::min_element(values.begin(), values.end()), ""};
  double sum = 0;
  for (const double value : values) sum += value;
  return {sum / static_cast<double>(values.size()), ""};
}

Measured slope(const Study& study, const Claim& claim, const std::vector<FitResult>& fits) {
  for (const FitResult& fit : fits)
    if (study.cases[fit.case_index].matches(claim.selector) && fit.quantity == claim.quantity)
      return {fit.line.slope, ""};
  return {{},
          "no fit of " + claim.quantity +
              ": a [[fit]] and three levels with values are needed"};
}

Measured gci(const Study& study, const Claim& claim,
             const std::vector<ReferenceResult>& references) {
  for (const ReferenceResult& reference : references)
    if (study.cases[reference.case_index].matches(claim.selector) &&
        reference.quantity == claim.quantity) {
      if (reference.convergence.asymptotic) return {reference.convergence.gci, ""};
      return {{}, reference.convergence.statement};
    }
  return {{}, "no [[reference]] for " + claim.quantity};
}

Measured measure(const Study& study, const Claim& claim, const std::vector<Row>& rows,
                 const std::vector<FitResult>& fits,
                 const std::vector<ReferenceResult>& references) {
  if (claim.kind == ClaimKind::slope) return slope(study, claim, fits);
  if (claim.kind == ClaimKind::gci) return gci(study, claim, references);
  Measured value =
      pooled(study, rows, claim.selector, claim.quantity, claim.resolution, claim.over_seeds);
  if (claim.kind == ClaimKind::value || !value.value) return value;
  const Measured other = pooled(study, rows, claim.other, claim.other_quantity,
                                claim.other_resolution, claim.over_seeds);
  if (!other.value) return other;
  if (*other.value == 0) return {{}, "the denominator is 0"};
  return {*value.value / *other.value, ""};
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
  return text;
}

std::vector<ClaimResult> judge(const Study& study, const std::vector<Row>& rows,
                               const std::vector<FitResult>& fits,
                               const std::vector<ReferenceResult>& references) {
  std::vector<ClaimResult> results;
  for (const Claim& claim : study.claims) {
    ClaimResult result{&claim, Verdict::fail, {}, ""};
    if (claim.full_only && !study.full) {
      result.verdict = Verdict::full_report_only;
      result.reason = "judged by the full report";
    } else {
      Measured measured = measure(study, claim, rows, fits, references);
      result.reason = std::move(measured.reason);
      if (measured.value) {
        result.measured = *measured.value * display_factor(claim.unit, claim.where);
        const bool holds = (!claim.minimum || *result.measured >= *claim.minimum) &&
                           (!claim.maximum || *result.measured <= *claim.maximum);
        result.verdict = holds ? Verdict::pass : Verdict::fail;
        if (!holds)
          result.reason = fmt::format("{:.4g} is not {}", *result.measured, bound_text(claim));
      }
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace concord::studies
