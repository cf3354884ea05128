#pragma once
// What a study leaves on disk: study.json and tables.

#include "studies/driver/claims.hpp"

#include <filesystem>

namespace concord::studies {

/// A study's results, judged.
struct StudyResult {
  const Study* study = nullptr;
  std::vector<Row> rows;
  std::vector<FitResult> fits;
  std::vector<ReferenceResult> references;
  std::vector<ClaimResult> claims;
  bool interrupted = false;
  /// True when no claim failed and the study was not interrupted.
  bool passed() const;
};

/// study.json as studies/README.md describes it.
nlohmann::json study_json(const StudyResult& result);

/// Writes study.json and tables/*.csv, *.md into `folder`.
void write_study(const StudyResult& result, const std::filesystem::path& folder);

}  // namespace concord::studies
