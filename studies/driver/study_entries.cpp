#include "studies/driver/study_entries.hpp"

#include "scene/suggest.hpp"

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace {

Selector read_selector(StrictTable& table) {
  return {table.optional_text("scene"), table.optional_text("method"),
          table.optional_text("variant")};
}

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

template <class T>
T choose(StrictTable& table, const std::string& key,
         const std::vector<std::pair<std::string, T>>& choices, const T* fallback = nullptr) {
  std::vector<std::string> words;
  for (const auto& [name, value] : choices) words.push_back(name);
  const auto word = table.optional_text(key);
  if (!word && fallback) return *fallback;
  if (!word) table.missing(key, scene::allowed_words("", words));
  for (const auto& [name, value] : choices)
    if (name == *word) return value;
  table.reject(*table.node(key), scene::allowed_words(*word, words));
}

void read_other(StrictTable& table, Claim& claim) {
  claim.other = claim.selector;
  claim.other_quantity = claim.quantity;
  claim.other_resolution = claim.resolution;
  if (claim.kind != ClaimKind::ratio) {
    if (const auto* node = table.node("other"))
      table.reject(*node, "only for kind = \"ratio\"");
    return;
  }
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

}  // namespace

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
                                  {"gci", ClaimKind::gci}});
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
  if (!claim.minimum && !claim.maximum) table.missing("max", "a bound: min, max or both");
  claim.full_only = table.flag_or("full_only", false);
  read_other(table, claim);
  table.finish();
  return claim;
}

Plot read_plot(StrictTable table) {
  Plot plot;
  plot.kind = choose<std::string>(table, "kind",
                                  {{"convergence", "convergence"},
                                   {"cost", "cost"},
                                   {"history", "history"},
                                   {"sweep", "sweep"}});
  plot.quantity = table.text("quantity");
  plot.title = table.text_or("title", "");
  if (plot.kind == "sweep") plot.setting = table.text("setting");
  plot.selector = read_selector(table);
  plot.resolution = table.optional_number("resolution");
  plot.slope = table.optional_number("slope");
  table.finish();
  return plot;
}

Picture read_picture(StrictTable table) {
  Picture picture;
  picture.selector = read_selector(table);
  picture.resolution = table.optional_number("resolution");
  picture.color = table.text("color");
  picture.caption = table.text_or("caption", "");
  picture.scale_displacement = table.number_or("scale_displacement", 1);
  table.finish();
  return picture;
}

}  // namespace concord::studies
