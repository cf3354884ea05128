#pragma once
// Which cases of a study are meant.

#include <optional>
#include <string>
#include <string_view>

namespace concord::studies {

/// Scene, method, variant and probe of a case; a part left out matches any. A part is a
/// pattern, see matches_pattern.
struct Selector {
  std::optional<std::string> scene{}, method{}, variant{}, probe{};
};

/// Whether a text is a pattern's: alternatives, a line each, in which "*" stands for any text.
bool matches_pattern(std::string_view pattern, std::string_view text);

}  // namespace concord::studies
