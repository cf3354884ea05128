#include "studies/driver/study_entries.hpp"

#include "scene/section.hpp"

#include <cmath>

namespace concord::studies {
namespace {

std::optional<Pool> read_over_resolutions(StrictTable& table) {
  if (!table.node("over_resolutions")) return std::nullopt;
  return read_pool(table, "over_resolutions");
}

/// Whether the claim pools seed by seed, then over the resolutions.
void read_pools(StrictTable& table, Claim& claim) {
  claim.over_seeds = read_pool(table);
  claim.over_resolutions = read_over_resolutions(table);
  if (!claim.over_resolutions) return;
  if (claim.resolution)
    table.reject(*table.node("over_resolutions"), "only without `resolution`");
  if (claim.kind != ClaimKind::value && claim.kind != ClaimKind::ratio &&
      claim.kind != ClaimKind::minimum)
    table.reject(*table.node("over_resolutions"),
                 "only for kind = \"value\", \"ratio\" and \"minimum\"");
}

void read_other(StrictTable& table, Claim& claim) {
  claim.other = claim.selector;
  claim.other_quantity = claim.quantity;
  claim.other_resolution = claim.resolution;
  claim.other_over_seeds = claim.over_seeds;
  claim.other_over_resolutions = claim.over_resolutions;
  const auto* node = table.node("other");
  if (claim.kind == ClaimKind::minimum && node == nullptr) return;
  if (claim.kind != ClaimKind::ratio && claim.kind != ClaimKind::minimum &&
      claim.kind != ClaimKind::matched_ratio) {
    if (node)
      table.reject(*node, "only for kind = \"ratio\", \"minimum\" and \"matched_ratio\"");
    return;
  }
  claim.divided = true;
  StrictTable other =
      table.table("other", "what differs in the denominator, such as { variant = \"xi 0\" }");
  const Selector selector = read_selector(other);
  if (selector.scene) claim.other.scene = selector.scene;
  if (selector.method) claim.other.method = selector.method;
  if (selector.variant) claim.other.variant = selector.variant;
  if (selector.probe) claim.other.probe = selector.probe;
  claim.other_quantity = other.text_or("quantity", claim.quantity);
  if (auto resolution = other.optional_number("resolution"))
    claim.other_resolution = resolution;
  if (other.node("over_seeds")) claim.other_over_seeds = read_pool(other);
  if (auto pool = read_over_resolutions(other)) claim.other_over_resolutions = pool;
  other.finish();
}

/// Which value of a setting the minimum must lie at.
void read_place(StrictTable& table, Claim& claim) {
  if (claim.kind != ClaimKind::minimum) {
    for (const char* key : {"setting", "setting_min", "setting_max"})
      if (const auto* node = table.node(key))
        table.reject(*node, "only for kind = \"minimum\"");
    return;
  }
  claim.setting = table.text_or("setting", "");
  claim.setting_minimum = table.optional_number("setting_min");
  claim.setting_maximum = table.optional_number("setting_max");
  if ((claim.setting_minimum || claim.setting_maximum) && claim.setting.empty())
    table.missing("setting", "the setting that setting_min and setting_max bound");
}

/// The error at which times are compared.
void read_level(StrictTable& table, Claim& claim) {
  if (claim.kind != ClaimKind::matched_ratio) {
    for (const char* key : {"level", "time"})
      if (const auto* node = table.node(key))
        table.reject(*node, "only for kind = \"matched_ratio\"");
    return;
  }
  claim.level = table.number_or("level", 0);
  if (!(claim.level > 0)) table.missing("level", "a relative error above 0, such as 0.01");
  claim.time = read_work_time(table);
}

LeaveOut read_leave_out(StrictTable table) {
  LeaveOut out;
  out.axis = choose<int>(table, "axis", {{"x", 0}, {"y", 1}, {"z", 2}});
  const auto length = [&table](const char* key) {
    const scene::ConfigNode* node = table.node(key);
    if (node == nullptr) table.missing(key, "a length such as \"40 mm\"");
    return scene::read_quantity(*node, scene::unit::length);
  };
  out.low = length("low");
  out.high = length("high");
  out.spacings = table.number_or("spacings", 0);
  if (!(out.spacings > 0)) table.missing("spacings", "how many spacings from there, above 0");
  table.finish();
  return out;
}

}  // namespace

Selector read_selector(StrictTable& table) {
  const auto part = [&table](const char* key) -> std::optional<std::string> {
    const scene::ConfigNode* node = table.node(key);
    if (node == nullptr || node->kind != scene::ConfigNode::Kind::array)
      return table.optional_text(key);
    std::string pattern;
    for (const std::string& text : table.texts(key))
      pattern += (pattern.empty() ? "" : "\n") + text;
    return pattern;
  };
  return {part("scene"), part("method"), part("variant"), part("probe")};
}

Fit read_fit(StrictTable table) {
  Fit fit;
  fit.selector = read_selector(table);
  fit.quantity = table.text("quantity");
  const double finest = table.number_or("finest", 0);
  if (finest != 0 && (finest < 2 || finest != std::floor(finest)))
    table.reject(*table.node("finest"), "a whole number of levels from 2 on");
  fit.finest = static_cast<std::size_t>(finest);
  table.finish();
  return fit;
}

Reference read_reference(StrictTable table) {
  Reference reference;
  reference.where = table.where();
  reference.selector = read_selector(table);
  reference.quantity = table.text("quantity");
  reference.formal_order = table.number_or("formal_order", 2);
  if (reference.formal_order <= 0)
    table.reject(*table.node("formal_order"), "an order above 0");
  table.finish();
  return reference;
}

Comparison read_comparison(StrictTable table) {
  Comparison comparison;
  comparison.where = table.where();
  comparison.name = table.text_or("name", comparison.name);
  if (comparison.name.empty() ||
      comparison.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") !=
          std::string::npos)
    table.reject(*table.node("name"), "small letters, digits and _");
  comparison.fields = table.texts("fields");
  if (comparison.fields.empty())
    table.missing("fields", "scalar point fields of frames, such as [\"plastic_strain\"]");
  StrictTable reference = table.table("reference", "{ method = \"fem\", variant = \"T6\" }");
  comparison.reference = read_selector(reference);
  comparison.reference_resolution = reference.optional_number("resolution");
  reference.finish();
  comparison.selector = read_selector(table);
  if (!comparison.selector.scene) comparison.selector.scene = comparison.reference.scene;
  if (table.node("leave_out"))
    comparison.leave_out = read_leave_out(table.table(
        "leave_out", "{ axis = \"y\", low = \"0 m\", high = \"1 m\", spacings = 4 }"));
  table.finish();
  return comparison;
}

Claim read_claim(StrictTable table) {
  Claim claim;
  claim.where = table.where();
  claim.id = table.text("id");
  claim.statement = table.text("statement");
  claim.source = table.text("source");
  claim.source_value = table.text_or("source_value", "");
  claim.kind = choose<ClaimKind>(table, "kind",
                                 {{"slope", ClaimKind::slope},
                                  {"value", ClaimKind::value},
                                  {"ratio", ClaimKind::ratio},
                                  {"gci", ClaimKind::gci},
                                  {"minimum", ClaimKind::minimum},
                                  {"matched_ratio", ClaimKind::matched_ratio}});
  claim.selector = read_selector(table);
  claim.quantity = table.text("quantity");
  claim.resolution = table.optional_number("resolution");
  read_pools(table, claim);
  claim.unit = table.text_or("unit", "1");
  display_factor(claim.unit, claim.where);
  claim.minimum = table.optional_number("min");
  claim.maximum = table.optional_number("max");
  read_place(table, claim);
  read_level(table, claim);
  if (!claim.minimum && !claim.maximum && !claim.setting_minimum && !claim.setting_maximum)
    table.missing("max", "a bound: min, max or both");
  claim.full_only = table.flag_or("full_only", false);
  read_other(table, claim);
  table.finish();
  return claim;
}

}  // namespace concord::studies
