// Reader of [[case]].

#include "studies/driver/study_entries.hpp"

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace {

constexpr std::string_view option_prefix = "options.";  ///< of swept keys
constexpr double max_repeats = 1000;

std::vector<std::uint64_t> read_seeds(StrictTable& table) {
  std::vector<std::uint64_t> seeds;
  for (const double seed : table.positive_numbers("seeds")) {
    if (seed != std::floor(seed)) table.reject(*table.node("seeds"), "whole numbers above 0");
    seeds.push_back(static_cast<std::uint64_t>(seed));
  }
  return seeds;
}

std::optional<int> read_repeats(StrictTable& table) {
  const auto repeats = table.optional_number("repeats");
  if (!repeats) return std::nullopt;
  if (!(*repeats >= 1) || *repeats > max_repeats || *repeats != std::floor(*repeats))
    table.reject(*table.node("repeats"), "a whole number of timed runs, 1 to 1000");
  return static_cast<int>(*repeats);
}

/// Replaces ladders by those of `quick`; false when quick reports leave the case out.
bool apply_quick(StrictTable& table, Case& entry, bool full) {
  const scene::ConfigNode* quick = table.node("quick");
  if (!quick) return true;
  if (quick->kind == scene::ConfigNode::Kind::boolean) return full || quick->boolean;
  StrictTable inner = table.table("quick", "false, or { resolutions = [...], seeds = [...] }");
  auto resolutions = inner.positive_numbers("resolutions");
  auto seeds = read_seeds(inner);
  const auto options = inner.scalars("options");
  const auto repeats = read_repeats(inner);
  inner.finish();
  // Checked in both modes: a full report must not pass a file that a quick one refuses.
  if (!options.empty() && entry.probe.empty())
    inner.reject(*inner.node("options"), "only in cases with a probe");
  if (repeats && !entry.probe.empty())
    inner.reject(*inner.node("repeats"), "only in cases without a probe");
  if (full) return true;
  for (const auto& [key, value] : options) entry.options[key] = value;
  if (repeats) entry.repeats = *repeats;
  if (!resolutions.empty()) entry.resolutions = std::move(resolutions);
  if (!seeds.empty()) entry.seeds = std::move(seeds);
  return true;
}

/// One case for every combination of swept values.
std::vector<Case> expand(const Case& base,
                         const std::map<std::string, std::vector<std::string>>& lists) {
  std::vector<Case> cases{base};
  for (const auto& [key, values] : lists) {
    const bool of_probe = key.starts_with(option_prefix);
    const bool of_scene = !of_probe && key.find('.') != std::string::npos;
    const std::string name = key.substr(key.rfind('.') + 1);  // npos + 1 = 0
    std::vector<Case> next;
    for (const Case& one : cases)
      for (const std::string& value : values) {
        Case swept = one;
        auto& settings = of_probe ? swept.options : of_scene ? swept.scene_set : swept.set;
        settings[of_probe ? name : key] = value;
        swept.variant += (swept.variant.empty() ? "" : ", ") + name + " " + value;
        next.push_back(std::move(swept));
      }
    cases = std::move(next);
  }
  return cases;
}

void read_probe(StrictTable& table, Case& entry) {
  entry.probe = table.text_or("probe", "");
  entry.options = table.scalars("options");
  entry.repeats = read_repeats(table).value_or(0);
}

/// What a probe and a run exclude of each other.
void check_probe(StrictTable& table, const Case& entry,
                 const std::map<std::string, std::vector<std::string>>& lists) {
  const auto only_with = [&table](const char* key, const char* allowed) {
    if (const auto* node = table.node(key)) table.reject(*node, allowed);
  };
  if (!entry.probe.empty()) {
    only_with("repeats", "only in cases without a probe");
    if (entry.frames) only_with("frames", "false: a probe leaves no frames");
    if (!entry.frames_at.empty()) only_with("frames_at", "nothing: a probe leaves no frames");
    return;
  }
  only_with("options", "only in cases with a probe");
  for (const auto& [key, values] : lists)
    if (key.starts_with(option_prefix)) only_with("sweep", "options only with a probe");
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
  entry.frames_at = table.positive_numbers("frames_at");
  read_probe(table, entry);
  const bool in_mode = apply_quick(table, entry, full);
  table.finish();
  check_probe(table, entry, lists);
  std::sort(entry.resolutions.begin(), entry.resolutions.end());
  return {expand(entry, lists), in_mode};
}

}  // namespace concord::studies
