#pragma once
// A TOML file as a tree in which every value knows where it stands and whether it was read.

#include "scene/errors.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace concord::scene {

/// One value of a TOML file. A table's members keep the order of the file.
struct ConfigNode {
  enum class Kind { text, integer, real, boolean, array, table, other };
  Kind kind = Kind::table;
  std::string key;   ///< dotted, from the top: "boundary.0.kind"
  std::string text;  ///< text of a string; of a number or date as written canonically
  double number = 0;
  bool boolean = false;
  std::vector<std::pair<std::string, ConfigNode>> members;  ///< of a table
  std::vector<ConfigNode> elements;                         ///< of an array
  SourcePosition where;                                     ///< of the value
  SourcePosition key_where;                                 ///< of its key in a table
  mutable bool was_read = false;

  const ConfigNode* find(const std::string& name) const;
  ConfigNode* find(const std::string& name);
  /// "a table", "the text "x"", "the number 3": for messages.
  std::string describe() const;
  /// Canonical text, keys sorted: equal for files that say the same.
  std::string canonical() const;
};

/// Reads a TOML file. Throws InputError with line and column when it cannot be read or parsed.
ConfigNode read_toml(const std::filesystem::path& file);

/// Replaces or adds the value at a dotted key; a number in it is the index in an array (the
/// array's size appends). The text is read as a TOML value, and as plain text where it is none.
/// Throws InputError for a key that leads through a value that is no table or array.
void set_value(ConfigNode& root, const std::string& dotted_key, const std::string& text);

}  // namespace concord::scene
