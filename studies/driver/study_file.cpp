#include "studies/driver/study_file.hpp"

#include "scene/suggest.hpp"
#include "studies/driver/study_entries.hpp"

#include <algorithm>
#include <map>

namespace concord::studies {
namespace {

Study parse_study(const std::filesystem::path& file, bool full) {
  const scene::ConfigNode root = scene::read_toml(file);
  StrictTable table(root);
  Study study;
  study.full = full;
  study.title = table.text("title");
  study.question = table.text("question");
  study.source = table.text("source");
  study.paper_statement = table.text_or("paper_statement", "");
  study.timing = table.flag_or("timing", false);
  study.balance_tolerance = table.optional_number("balance_tolerance");
  if (study.balance_tolerance && !(*study.balance_tolerance > 0))
    table.reject(*table.node("balance_tolerance"), "a number above 0");
  std::vector<Case> all;
  for (const StrictTable& entry : table.tables("case")) {
    CaseEntry read = read_case(entry, full);
    all.insert(all.end(), read.cases.begin(), read.cases.end());
    if (read.in_mode)
      study.cases.insert(study.cases.end(), read.cases.begin(), read.cases.end());
  }
  for (const StrictTable& entry : table.tables("fit")) study.fits.push_back(read_fit(entry));
  for (const StrictTable& entry : table.tables("reference"))
    study.references.push_back(read_reference(entry));
  for (const StrictTable& entry : table.tables("compare"))
    study.comparisons.push_back(read_comparison(entry));
  for (const StrictTable& entry : table.tables("signal"))
    study.signals.push_back(read_signal(entry));
  for (const StrictTable& entry : table.tables("error"))
    study.errors.push_back(read_error(entry));
  for (const StrictTable& entry : table.tables("matched"))
    study.matched.push_back(read_matched(entry));
  for (const StrictTable& entry : table.tables("heatmap"))
    study.heatmaps.push_back(read_heatmap(entry));
  for (const StrictTable& entry : table.tables("table"))
    study.tables.push_back(read_run_table(entry));
  for (const StrictTable& entry : table.tables("claim"))
    study.claims.push_back(read_claim(entry));
  for (const StrictTable& entry : table.tables("plot")) study.plots.push_back(read_plot(entry));
  for (const StrictTable& entry : table.tables("picture"))
    study.pictures.push_back(read_picture(entry));
  table.finish();
  check_study(study, all);
  return study;
}

}  // namespace

bool Case::matches(const Selector& selector) const {
  const auto fits = [](const std::optional<std::string>& pattern, const std::string& text) {
    return !pattern || matches_pattern(*pattern, text);
  };
  return fits(selector.scene, scene) && fits(selector.method, method) &&
         fits(selector.variant, variant) && fits(selector.probe, probe);
}

bool matches_pattern(std::string_view pattern, std::string_view text) {
  if (const std::size_t end = pattern.find('\n'); end != std::string_view::npos)
    return matches_pattern(pattern.substr(0, end), text) ||
           matches_pattern(pattern.substr(end + 1), text);
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  const std::string_view rest = pattern.substr(star + 1);
  for (std::size_t begin = star; begin <= text.size(); ++begin)
    if (matches_pattern(rest, text.substr(begin))) return true;
  return false;
}

std::string Case::title() const {
  return (probe.empty() ? "" : probe + " of ") + method +
         (variant.empty() ? "" : " (" + variant + ")") + " on " + scene;
}

Study read_study(const std::string& name, bool full, const std::filesystem::path& home) {
  const auto file = home / "studies" / name / "study.toml";
  const auto names = study_names(home);
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw InputError({}, "study", scene::in_quotes(name), scene::allowed_words(name, names));
  Study study = parse_study(file, full);
  study.name = name;
  return study;
}

std::vector<std::string> study_names(const std::filesystem::path& home) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(home / "studies", none))
    if (std::filesystem::exists(entry.path() / "study.toml"))
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

const char* to_text(WorkTime time) { return time == WorkTime::wall ? "wall_s" : "total"; }

double display_factor(const std::string& unit, const SourcePosition& where) {
  static const std::map<std::string, double> factors{
      {"1", 1},      {"%", 100},    {"N", 1}, {"m", 1},    {"mm", 1e3}, {"Pa", 1},
      {"kPa", 1e-3}, {"MPa", 1e-6}, {"s", 1}, {"ms", 1e3}, {"us", 1e6}, {"J", 1}};
  const auto found = factors.find(unit);
  if (found != factors.end()) return found->second;
  std::vector<std::string> words;
  for (const auto& [name, factor] : factors) words.push_back(name);
  throw InputError(where, "claim.unit", scene::in_quotes(unit),
                   scene::allowed_words(unit, words));
}

}  // namespace concord::studies
