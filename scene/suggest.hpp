#pragma once
// Lists of allowed words for messages, with the nearest one named first.

#include <string>
#include <vector>

namespace concord::scene {

/// Least number of insertions, deletions, substitutions and swaps of neighbours that turn a
/// into b.
int edit_distance(const std::string& a, const std::string& b);

/// The allowed words in order, "a | b | c", with "(did you mean b?)" after them when one is
/// near to what was found (distance at most a third of its length, rounded up).
std::string allowed_words(const std::string& found, const std::vector<std::string>& allowed);

/// Text in quotes.
std::string in_quotes(const std::string& text);

}  // namespace concord::scene
