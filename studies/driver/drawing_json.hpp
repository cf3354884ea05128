#pragma once
// Pieces of study.json: selectors, plots, pictures.

#include "studies/driver/study_file.hpp"

#include <nlohmann/json.hpp>

namespace concord::studies {

/// Sets `key` where there is a (finite) value.
void put(nlohmann::json& object, const char* key, const std::optional<std::string>& value);
void put(nlohmann::json& object, const char* key, const std::optional<double>& value);
/// scene, method, variant as the study file gives them.
void put(nlohmann::json& object, const Selector& selector);

/// What reports draw. A selector with "*" becomes the list of scenes, methods and variants that
/// it stands for among the study's cases, so that readers need no patterns.
nlohmann::json plot_json(const Study& study, const Plot& plot);
/// Panels of cases that run in the full report only are left out of the quick one.
nlohmann::json picture_json(const Study& study, const Picture& picture);

/// Whether a case of the study, as it is run, has what the panel shows.
bool has_run(const Study& study, const Panel& panel);

}  // namespace concord::studies
