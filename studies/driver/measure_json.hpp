#pragma once
// Work-precision plots, matched errors, heat maps and tables of study.json.

#include "studies/driver/study_output.hpp"

namespace concord::studies {

/// Adds `curves` and `front` to a plot of kind work_precision.
void put_work_precision(nlohmann::json& object, const StudyResult& result, const Plot& plot);
nlohmann::json matched_json(const StudyResult& result, const Matched& entry);
nlohmann::json heatmap_json(const StudyResult& result, const Heatmap& map);
nlohmann::json run_table_json(const StudyResult& result, const RunTable& entry);

}  // namespace concord::studies
