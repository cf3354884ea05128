// Readers of [[plot]] and [[picture]].

#include "studies/driver/study_entries.hpp"

namespace concord::studies {
namespace {

/// [low, high] with low < high.
std::optional<Range> read_range(StrictTable& table, const std::string& key) {
  const auto numbers = table.numbers(key);
  if (numbers.empty()) return std::nullopt;
  if (numbers.size() != 2 || !(numbers[0] < numbers[1]))
    table.reject(*table.node(key), "[low, high], two numbers with low < high");
  return Range{numbers[0], numbers[1]};
}

std::optional<Window> read_window(StrictTable& table, const std::string& key) {
  if (!table.node(key)) return std::nullopt;
  StrictTable inner = table.table(key, "{ x = [0, 1], y = [0, 1] }");
  Window window{read_range(inner, "x"), read_range(inner, "y")};
  inner.finish();
  return window;
}

std::vector<Baseline> read_baseline(StrictTable& table) {
  std::vector<Baseline> baseline;
  for (StrictTable& entry : table.inner_tables("baseline")) {
    Baseline line;
    line.selector = read_selector(entry);
    line.resolution = entry.optional_number("resolution");
    line.quantity = entry.text_or("quantity", "");
    line.label = entry.text_or("label", "");
    entry.finish();
    baseline.push_back(std::move(line));
  }
  return baseline;
}

/// As many x as y, in each entry.
std::vector<Points> read_points(StrictTable& table) {
  std::vector<Points> all;
  for (StrictTable& entry : table.inner_tables("points")) {
    Points points{entry.text("label"), entry.numbers("x"), entry.numbers("y")};
    if (points.x.empty()) entry.missing("x", "numbers, in the units of the plot");
    if (points.x.size() != points.y.size())
      throw InputError(entry.where(), "points.y", std::to_string(points.y.size()) + " values",
                       "as many as there are in x: " + std::to_string(points.x.size()));
    entry.finish();
    all.push_back(std::move(points));
  }
  return all;
}

void read_axes(StrictTable& table, Plot& plot) {
  plot.x_label = table.text_or("x_label", "");
  plot.y_label = table.text_or("y_label", "");
  plot.label = table.text_or("label", "");
  plot.x_scale = table.optional_number("x_scale");
  plot.y_scale = table.optional_number("y_scale");
}

/// One column, or several in one plot.
void read_history(StrictTable& table, Plot& plot) {
  plot.columns = table.texts("columns");
  plot.quantity = plot.columns.empty() ? table.text("quantity") : table.text_or("quantity", "");
  plot.resolutions = table.positive_numbers("resolutions");
  plot.change = table.flag_or("change", false);
  plot.change_from = table.optional_number("change_from");
  plot.norm = table.flag_or("norm", false);
  plot.share_of = table.texts("share_of");
  plot.rate_over = table.optional_number("rate_over");
  if (plot.rate_over && !(*plot.rate_over > 0))
    table.reject(*table.node("rate_over"), "the width of a window [s], above 0");
  if (!plot.share_of.empty() && plot.columns.empty())
    table.missing("columns", "the columns whose sum is drawn");
  if (!plot.share_of.empty() && (plot.rate_over || plot.change || plot.norm))
    table.reject(*table.node("share_of"), "without rate_over, change and norm");
}

/// What histories and curves share.
void read_lines(StrictTable& table, Plot& plot) {
  plot.log = table.flag_or("log", false);
  plot.baseline = read_baseline(table);
  plot.points = read_points(table);
}

Panel read_panel(StrictTable& table) {
  Panel panel;
  panel.color = table.text_or("color", "");
  panel.selector = read_selector(table);
  panel.resolution = table.optional_number("resolution");
  panel.caption = table.text_or("caption", "");
  if (table.node("difference")) panel.difference = table.flag_or("difference", false);
  panel.time = table.optional_number("time");
  if (table.node("draw"))
    panel.draw = choose<std::string>(
        table, "draw", {{"body", "body"}, {"cells", "cells"}, {"spheres", "spheres"}});
  return panel;
}

double positive(StrictTable& table, const std::string& key, double fallback) {
  const double value = table.number_or(key, fallback);
  if (!(value > 0)) table.reject(*table.node(key), "a number above 0");
  return value;
}

std::optional<Animation> read_animation(StrictTable& table) {
  if (!table.node("animate")) return std::nullopt;
  StrictTable inner = table.table("animate", "{ frames = 24, seconds = 4 }");
  Animation animation;
  animation.from = inner.optional_number("from");
  animation.to = inner.optional_number("to");
  animation.frames = positive(inner, "frames", animation.frames);
  animation.seconds = positive(inner, "seconds", animation.seconds);
  inner.finish();
  return animation;
}

void read_color_range(StrictTable& table, Picture& picture) {
  const scene::ConfigNode* node = table.node("range");
  if (node == nullptr) return;
  if (node->kind == scene::ConfigNode::Kind::array) {
    picture.range = read_range(table, "range");
    return;
  }
  const std::string word = table.text("range");
  picture.common_range = word == "common";
  picture.robust_range = word == "robust";
  if (!picture.common_range && !picture.robust_range)
    table.reject(*node, "\"common\", \"robust\" or [low, high]");
}

}  // namespace

Plot read_plot(StrictTable table) {
  Plot plot;
  plot.where = table.where();
  plot.kind = choose<std::string>(table, "kind",
                                  {{"convergence", "convergence"},
                                   {"cost", "cost"},
                                   {"history", "history"},
                                   {"sweep", "sweep"},
                                   {"curve", "curve"},
                                   {"map", "map"},
                                   {"work_precision", "work_precision"}});
  plot.title = table.text_or("title", "");
  plot.note = table.text_or("note", "");
  plot.statement = table.text_or("statement", "");
  plot.source = table.text_or("source", "");
  if (plot.kind == "work_precision") plot.time = read_work_time(table);
  if (plot.kind == "curve") {
    plot.x = table.text("x");
    plot.y = table.text("y");
    plot.resolutions = table.positive_numbers("resolutions");
    plot.inset = read_window(table, "inset");
  } else if (plot.kind == "history") {
    read_history(table, plot);
  } else {
    plot.quantity = table.text("quantity");
  }
  if (plot.kind == "curve" || plot.kind == "history") read_lines(table, plot);
  if (plot.kind == "sweep" || plot.kind == "map") plot.setting = table.text("setting");
  if (plot.kind == "sweep") plot.baseline = read_baseline(table);
  if (plot.kind == "map") plot.setting_y = table.text("setting_y");
  read_axes(table, plot);
  plot.selector = read_selector(table);
  plot.resolution = table.optional_number("resolution");
  plot.slope = table.optional_number("slope");
  table.finish();
  return plot;
}

Picture read_picture(StrictTable table) {
  Picture picture;
  picture.body = read_panel(table);
  if (picture.body.color.empty()) table.missing("color", "a point field of the frames");
  picture.columns = table.optional_number("columns");
  picture.times = table.numbers("times");
  picture.animate = read_animation(table);
  picture.scale_displacement = table.number_or("scale_displacement", 1);
  for (StrictTable& entry : table.inner_tables("panels")) {
    picture.panels.push_back(read_panel(entry));
    entry.finish();
  }
  read_color_range(table, picture);
  picture.crop = read_window(table, "crop");
  table.finish();
  return picture;
}

}  // namespace concord::studies
