#pragma once
// Readers of the entries of a study file, one function an entry.

#include "scene/suggest.hpp"
#include "studies/driver/strict_table.hpp"
#include "studies/driver/study_file.hpp"

#include <vector>

namespace concord::studies {

/// A [[case]] with its sweep expanded; `in_mode` is false when quick reports leave it out and
/// `full` is false.
struct CaseEntry {
  std::vector<Case> cases;
  bool in_mode = true;
};
CaseEntry read_case(StrictTable table, bool full);
Fit read_fit(StrictTable table);
Reference read_reference(StrictTable table);
Comparison read_comparison(StrictTable table);
Claim read_claim(StrictTable table);
Signal read_signal(StrictTable table);
ErrorEntry read_error(StrictTable table);
Matched read_matched(StrictTable table);
Heatmap read_heatmap(StrictTable table);
RunTable read_run_table(StrictTable table);
Plot read_plot(StrictTable table);
Picture read_picture(StrictTable table);

/// Throws InputError where entries of a study contradict each other or select no case. `all`:
/// the cases of both modes.
void check_study(const Study& study, const std::vector<Case>& all);

/// Keys scene, method, variant, probe of any of them.
Selector read_selector(StrictTable& table);
/// Key time: "wall_s" (default) or "total".
WorkTime read_work_time(StrictTable& table);
/// Key over_seeds, or another one: "max" (default), "min", "mean" or "range".
Pool read_pool(StrictTable& table, const std::string& key = "over_seeds");

/// One of `choices` by its name; `fallback` where the key is absent. Throws InputError for
/// another word, or for none where there is no fallback.
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

}  // namespace concord::studies
