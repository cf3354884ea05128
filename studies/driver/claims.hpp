#pragma once
// Claims: what a study says beforehand, judged by what its runs gave.

#include "studies/driver/rows.hpp"

#include <optional>
#include <string>
#include <vector>

namespace concord::studies {

enum class Verdict { pass, fail, full_report_only };
const char* to_text(Verdict verdict);

struct ClaimResult {
  const Claim* claim = nullptr;
  Verdict verdict = Verdict::fail;
  std::optional<double> measured;  ///< in the claim's unit
  std::string reason;              ///< why it failed, or why there is no number
  std::optional<double> place;     ///< minimum: value of claim->setting where it is reached
};

/// "<= 1e-10 N", ">= 1.8 and <= 2.6".
std::string bound_text(const Claim& claim);

/// Judges every claim. A claim without a value fails and says why; one of the full report only
/// is not judged in quick mode. The reason names runs used whose energy balance does not close.
std::vector<ClaimResult> judge(const Study& study, const std::vector<Row>& rows,
                               const std::vector<FitResult>& fits,
                               const std::vector<ReferenceResult>& references);

}  // namespace concord::studies
