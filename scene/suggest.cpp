#include "scene/suggest.hpp"

#include <algorithm>

namespace concord::scene {

int edit_distance(const std::string& a, const std::string& b) {
  // Restricted Damerau-Levenshtein distance, three rows of the table.
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int change = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::string allowed_words(const std::string& found, const std::vector<std::string>& allowed) {
  std::string text;
  const std::string* nearest = nullptr;
  int least = static_cast<int>((found.size() + 2) / 3) + 1;
  for (const std::string& word : allowed) {
    if (!text.empty()) text += " | ";
    text += word;
    const int distance = edit_distance(found, word);
    if (distance < least) {
      least = distance;
      nearest = &word;
    }
  }
  if (text.empty()) text = "nothing here";
  if (nearest != nullptr) text += " (did you mean " + *nearest + "?)";
  return text;
}

std::string in_quotes(const std::string& text) { return '"' + text + '"'; }

}  // namespace concord::scene
