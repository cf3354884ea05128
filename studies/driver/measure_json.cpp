#include "studies/driver/measure_json.hpp"

#include "studies/driver/drawing_json.hpp"
#include "studies/driver/heatmap.hpp"
#include "studies/driver/run_table.hpp"
#include "studies/driver/work_precision.hpp"

#include <algorithm>

namespace concord::studies {
namespace {

using nlohmann::json;

void put_text(json& object, const char* key, const std::string& value) {
  if (!value.empty()) object[key] = value;
}

void put_balance(json& object, bool closes) {
  if (!closes) object["balance"] = balance_text(false);
}

json point_json(const WorkPoint& point, bool pareto) {
  json object{{"resolution", point.resolution},
              {"error", point.error},
              {"error_min", point.error_min},
              {"error_max", point.error_max},
              {"time", point.time},
              {"seeds", point.seeds},
              {"runs", point.runs},
              {"pareto", pareto}};
  for (const auto& [key, value] :
       {std::pair{"h", point.h}, std::pair{"setup_s", point.setup_s},
        std::pair{"wall_s", point.wall_s}, std::pair{"memory_mb", point.memory_mb},
        std::pair{"unknowns", point.unknowns}, std::pair{"particles", point.particles}})
    put(object, key, std::optional(value));
  object.update(point.quartiles);
  put_balance(object, point.closes);
  return object;
}

json matched_point_json(const MatchedPoint& point) {
  json object{
      {"level", point.level}, {"status", to_text(point.status)}, {"fastest", point.fastest}};
  put(object, "time", point.time);
  put(object, "setup_s", point.setup_s);
  put(object, "wall_s", point.wall_s);
  put(object, "memory_mb", point.memory_mb);
  put(object, "resolution", point.resolution);
  put(object, "finest_error", point.finest_error);
  put(object, "finest_time", point.finest_time);
  put_text(object, "reason", point.reason);
  put_balance(object, point.closes);
  return object;
}

json cell_json(const HeatCell& cell) {
  json object{{"value", cell.value ? json(*cell.value) : json(nullptr)},
              {"score", cell.score ? json(*cell.score) : json(nullptr)}};
  put_text(object, "reason", cell.reason);
  put_text(object, "run", cell.run);
  put_text(object, "command", cell.command);
  put_balance(object, cell.closes);
  return object;
}

json heat_row_json(const HeatRow& row) {
  json object{{"label", row.label},
              {"quantity", row.quantity},
              {"unit", row.unit},
              {"good", row.good},
              {"bad", row.bad},
              {"better", row.good < row.bad ? "low" : "high"},
              {"scale", row.logarithmic ? "log" : "linear"},
              {"digits", row.digits},
              {"cells", json::array()}};
  put(object, row.selector);
  put(object, "resolution", row.resolution);
  put_text(object, "note", row.note);
  return object;
}

json case_json(const Case& entry) {
  return {{"scene", entry.scene}, {"method", entry.method}, {"variant", entry.variant}};
}

}  // namespace

void put_work_precision(json& object, const StudyResult& result, const Plot& plot) {
  const auto curves =
      work_curves(*result.study, result.rows, plot.selector, plot.quantity, plot.time);
  const auto front = pareto_front(curves);
  object["front"] = front;
  object["curves"] = json::array();
  for (std::size_t c = 0; c < curves.size(); ++c) {
    json curve = case_json(result.study->cases[curves[c].case_index]);
    curve["points"] = curve["absent"] = json::array();
    for (std::size_t p = 0; p < curves[c].points.size(); ++p) {
      const bool on_front =
          std::find(front.begin(), front.end(), std::pair(c, p)) != front.end();
      curve["points"].push_back(point_json(curves[c].points[p], on_front));
    }
    for (const auto& [resolution, reason] : curves[c].absent)
      curve["absent"].push_back({{"resolution", resolution}, {"reason", reason}});
    object["curves"].push_back(std::move(curve));
  }
}

json matched_json(const StudyResult& result, const Matched& entry) {
  const auto cases = matched_cases(*result.study, result.rows, entry);
  json object{
      {"title", entry.title},        {"quantity", entry.quantity},
      {"time", to_text(entry.time)}, {"levels", entry.levels},
      {"cases", json::array()},      {"sentences", sentences_of(*result.study, entry, cases)}};
  put_text(object, "note", entry.note);
  for (const MatchedCase& one : cases) {
    json line = case_json(result.study->cases[one.case_index]);
    line["at"] = json::array();
    for (const MatchedPoint& point : one.at) line["at"].push_back(matched_point_json(point));
    object["cases"].push_back(std::move(line));
  }
  return object;
}

json heatmap_json(const StudyResult& result, const Heatmap& map) {
  json object{{"title", map.title}, {"columns", json::array()}, {"rows", json::array()}};
  for (const HeatColumn& column : map.columns) {
    json head{{"label", column.label}};
    put(head, column.selector);
    object["columns"].push_back(std::move(head));
  }
  for (const HeatRow& row : map.rows) {
    json line = heat_row_json(row);
    for (const HeatColumn& column : map.columns)
      line["cells"].push_back(cell_json(heat_cell(*result.study, result.rows, column, row)));
    object["rows"].push_back(std::move(line));
  }
  return object;
}

json run_table_json(const StudyResult& result, const RunTable& entry) {
  json object{{"title", entry.title}, {"columns", json::array()}, {"rows", json::array()}};
  put_text(object, "note", entry.note);
  for (const TableColumn& column : entry.columns)
    object["columns"].push_back({{"label", column.label},
                                 {"quantity", column.quantity},
                                 {"unit", column.unit},
                                 {"digits", column.digits},
                                 {"difference", column.difference}});
  for (const TableLine* line : lines_of(result.rows, *result.study, entry)) {
    json row{{"label", line->label}, {"cells", json::array()}};
    put_text(row, "source_value", line->source_value);
    for (const TableColumn& column : entry.columns) {
      const TableCell cell = table_cell(*result.study, result.rows, *line, column);
      json one{{"value", cell.value ? json(*cell.value) : json(nullptr)}, {"runs", cell.runs}};
      put_text(one, "reason", cell.reason);
      put_balance(one, cell.closes);
      row["cells"].push_back(std::move(one));
    }
    object["rows"].push_back(std::move(row));
  }
  return object;
}

}  // namespace concord::studies
