#include "studies/driver/drawing_json.hpp"

#include <algorithm>
#include <cmath>

namespace concord::studies {

using nlohmann::json;

void put(json& object, const char* key, const std::optional<std::string>& value) {
  if (value) object[key] = *value;
}

void put(json& object, const char* key, const std::optional<double>& value) {
  if (value && std::isfinite(*value)) object[key] = *value;
}

void put(json& object, const Selector& selector) {
  put(object, "scene", selector.scene);
  put(object, "method", selector.method);
  put(object, "variant", selector.variant);
  put(object, "probe", selector.probe);
}

namespace {

void put_text(json& object, const char* key, const std::string& value) {
  if (!value.empty()) object[key] = value;
}

/// One part of a selector: the text itself, or for a pattern what it stands for.
void put_expanded(json& object, const char* key, const std::optional<std::string>& pattern,
                  const Study& study, const Selector& selector, std::string Case::*part) {
  if (!pattern) return;
  if (pattern->find_first_of("*\n") == std::string::npos) {
    object[key] = *pattern;
    return;
  }
  std::vector<std::string> texts;
  for (const Case& entry : study.cases)
    if (entry.matches(selector) &&
        std::find(texts.begin(), texts.end(), entry.*part) == texts.end())
      texts.push_back(entry.*part);
  if (texts.empty()) texts.push_back(*pattern);  // none in this mode: selects nothing
  object[key] = texts;
}

void put_cases(json& object, const Study& study, const Selector& selector) {
  put_expanded(object, "scene", selector.scene, study, selector, &Case::scene);
  put_expanded(object, "method", selector.method, study, selector, &Case::method);
  put_expanded(object, "variant", selector.variant, study, selector, &Case::variant);
  put_expanded(object, "probe", selector.probe, study, selector, &Case::probe);
}

void put_range(json& object, const char* key, const std::optional<Range>& range) {
  if (range) object[key] = *range;
}

void put_window(json& object, const char* key, const std::optional<Window>& window) {
  if (!window) return;
  object[key] = json::object();
  put_range(object[key], "x", window->x);
  put_range(object[key], "y", window->y);
}

void put_panel(json& object, const Study& study, const Panel& panel) {
  put_cases(object, study, panel.selector);
  put(object, "resolution", panel.resolution);
  put_text(object, "color", panel.color);
  put_text(object, "caption", panel.caption);
  if (panel.difference) object["difference"] = *panel.difference;
  put(object, "time", panel.time);
  put_text(object, "draw", panel.draw);
}

json animation_json(const Animation& animation) {
  json object{{"frames", animation.frames}, {"seconds", animation.seconds}};
  put(object, "from", animation.from);
  put(object, "to", animation.to);
  return object;
}

json baseline_json(const Study& study, const Baseline& baseline) {
  json line = json::object();
  put_cases(line, study, baseline.selector);
  put(line, "resolution", baseline.resolution);
  put_text(line, "quantity", baseline.quantity);
  put_text(line, "label", baseline.label);
  return line;
}

}  // namespace

json plot_json(const Study& study, const Plot& plot) {
  json object{{"kind", plot.kind}};
  put_text(object, "quantity", plot.quantity);
  put_text(object, "title", plot.title);
  put_text(object, "note", plot.note);
  put_text(object, "statement", plot.statement);
  put_text(object, "source", plot.source);
  if (plot.kind == "work_precision") object["time"] = to_text(plot.time);
  put_text(object, "setting", plot.setting);
  put_text(object, "setting_y", plot.setting_y);
  put_text(object, "x", plot.x);
  put_text(object, "y", plot.y);
  put_text(object, "x_label", plot.x_label);
  put_text(object, "y_label", plot.y_label);
  put_text(object, "label", plot.label);
  put(object, "x_scale", plot.x_scale);
  put(object, "y_scale", plot.y_scale);
  put_cases(object, study, plot.selector);
  put(object, "resolution", plot.resolution);
  if (!plot.resolutions.empty()) object["resolutions"] = plot.resolutions;
  if (!plot.columns.empty()) object["columns"] = plot.columns;
  if (plot.change) object["change"] = true;
  put(object, "change_from", plot.change_from);
  if (plot.norm) object["norm"] = true;
  if (!plot.share_of.empty()) object["share_of"] = plot.share_of;
  put(object, "rate_over", plot.rate_over);
  if (plot.log) object["log"] = true;
  put(object, "slope", plot.slope);
  put_window(object, "inset", plot.inset);
  for (const Baseline& baseline : plot.baseline)
    object["baseline"].push_back(baseline_json(study, baseline));
  for (const Points& points : plot.points)
    object["points"].push_back({{"label", points.label}, {"x", points.x}, {"y", points.y}});
  return object;
}

bool has_run(const Study& study, const Panel& panel) {
  return std::any_of(study.cases.begin(), study.cases.end(), [&](const Case& entry) {
    if (!entry.matches(panel.selector)) return false;
    const auto& levels = entry.resolutions;
    return !panel.resolution ||
           std::find(levels.begin(), levels.end(), *panel.resolution) != levels.end();
  });
}

json picture_json(const Study& study, const Picture& picture) {
  json object{{"scale_displacement", picture.scale_displacement}, {"caption", ""}};
  put_panel(object, study, picture.body);
  if (picture.common_range) object["range"] = "common";
  if (picture.robust_range) object["range"] = "robust";
  if (picture.animate) object["animate"] = animation_json(*picture.animate);
  put_range(object, "range", picture.range);
  put_window(object, "crop", picture.crop);
  put(object, "columns", picture.columns);
  if (!picture.times.empty()) object["times"] = picture.times;
  for (const Panel& panel : picture.panels) {
    if (!study.full && !has_run(study, panel)) continue;  // of the full report only
    json one = json::object();
    put_panel(one, study, panel);
    object["panels"].push_back(one);
  }
  return object;
}

}  // namespace concord::studies
