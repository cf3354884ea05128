#include "studies/driver/study_entries.hpp"

#include "scene/section.hpp"

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace {

std::vector<std::uint64_t> read_seeds(StrictTable& table) {
  std::vector<std::uint64_t> seeds;
  for (const double seed : table.positive_numbers("seeds")) {
    if (seed != std::floor(seed)) table.reject(*table.node("seeds"), "whole numbers above 0");
    seeds.push_back(static_cast<std::uint64_t>(seed));
  }
  return seeds;
}

/// Replaces ladders by those of `quick`; false when quick reports leave the case out.
bool apply_quick(StrictTable& table, Case& entry, bool full) {
  const scene::ConfigNode* quick = table.node("quick");
  if (!quick) return true;
  if (quick->kind == scene::ConfigNode::Kind::boolean) return full || quick->boolean;
  StrictTable inner = table.table("quick", "false, or { resolutions = [...], seeds = [...] }");
  auto resolutions = inner.positive_numbers("resolutions");
  auto seeds = read_seeds(inner);
  inner.finish();
  if (full) return true;
  if (!resolutions.empty()) entry.resolutions = std::move(resolutions);
  if (!seeds.empty()) entry.seeds = std::move(seeds);
  return true;
}

/// One case for every combination of swept values.
std::vector<Case> expand(const Case& base,
                         const std::map<std::string, std::vector<std::string>>& lists) {
  std::vector<Case> cases{base};
  for (const auto& [key, values] : lists) {
    const bool of_scene = key.find('.') != std::string::npos;
    const std::string name = of_scene ? key.substr(key.rfind('.') + 1) : key;
    std::vector<Case> next;
    for (const Case& one : cases)
      for (const std::string& value : values) {
        Case swept = one;
        (of_scene ? swept.scene_set : swept.set)[key] = value;
        swept.variant += (swept.variant.empty() ? "" : ", ") + name + " " + value;
        next.push_back(std::move(swept));
      }
    cases = std::move(next);
  }
  return cases;
}

void read_other(StrictTable& table, Claim& claim) {
  claim.other = claim.selector;
  claim.other_quantity = claim.quantity;
  claim.other_resolution = claim.resolution;
  const auto* node = table.node("other");
  if (claim.kind == ClaimKind::minimum && node == nullptr) return;
  if (claim.kind != ClaimKind::ratio && claim.kind != ClaimKind::minimum) {
    if (node) table.reject(*node, "only for kind = \"ratio\" and \"minimum\"");
    return;
  }
  claim.divided = true;
  StrictTable other =
      table.table("other", "what differs in the denominator, such as { variant = \"xi 0\" }");
  const Selector selector = read_selector(other);
  if (selector.scene) claim.other.scene = selector.scene;
  if (selector.method) claim.other.method = selector.method;
  if (selector.variant) claim.other.variant = selector.variant;
  claim.other_quantity = other.text_or("quantity", claim.quantity);
  if (auto resolution = other.optional_number("resolution"))
    claim.other_resolution = resolution;
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
  return {part("scene"), part("method"), part("variant")};
}

CaseEntry read_case(StrictTable table, bool full) {
  Case entry;
  entry.where = table.where();
  entry.scene = table.text("scene");
  entry.method = table.text("method");
  entry.variant = table.text_or("variant", "");
  entry.set = table.scalars("set");
  entry.scene_set = table.scalars("scene_set");
  const auto lists = table.scalar_lists("sweep");
  entry.perturb = table.number_or("perturb", 0);
  if (entry.perturb < 0 || entry.perturb > max_perturb)
    table.reject(*table.node("perturb"), "a fraction of the spacing from 0 to 0.45");
  entry.resolutions = table.positive_numbers("resolutions");
  if (entry.resolutions.empty()) table.missing("resolutions", "a list such as [4, 8, 16]");
  if (auto seeds = read_seeds(table); !seeds.empty()) entry.seeds = seeds;
  entry.frames = table.flag_or("frames", false);
  const bool in_mode = apply_quick(table, entry, full);
  table.finish();
  std::sort(entry.resolutions.begin(), entry.resolutions.end());
  return {expand(entry, lists), in_mode};
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
                                  {"minimum", ClaimKind::minimum}});
  claim.selector = read_selector(table);
  claim.quantity = table.text("quantity");
  claim.resolution = table.optional_number("resolution");
  const Pool by_default = Pool::max;
  claim.over_seeds =
      choose<Pool>(table, "over_seeds",
                   {{"max", Pool::max}, {"min", Pool::min}, {"mean", Pool::mean}}, &by_default);
  claim.unit = table.text_or("unit", "1");
  display_factor(claim.unit, claim.where);
  claim.minimum = table.optional_number("min");
  claim.maximum = table.optional_number("max");
  read_place(table, claim);
  if (!claim.minimum && !claim.maximum && !claim.setting_minimum && !claim.setting_maximum)
    table.missing("max", "a bound: min, max or both");
  claim.full_only = table.flag_or("full_only", false);
  read_other(table, claim);
  table.finish();
  return claim;
}

}  // namespace concord::studies
