#pragma once
// A table of a study file whose every key must be read: what nobody asked for is an error.

#include "scene/config.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace concord::studies {

/// Reads keys of one table by name and type; `finish` rejects the keys that were not read.
/// Every function throws InputError with file, line, column and the dotted key.
class StrictTable {
 public:
  explicit StrictTable(const scene::ConfigNode& table) : m_table(&table) {}

  /// The value of a key, nothing when it is absent.
  const scene::ConfigNode* node(const std::string& key);
  std::string text(const std::string& key);
  std::string text_or(const std::string& key, const std::string& fallback);
  std::optional<std::string> optional_text(const std::string& key);
  std::optional<double> optional_number(const std::string& key);
  double number_or(const std::string& key, double fallback);
  bool flag_or(const std::string& key, bool fallback);
  /// A non-empty array of numbers; empty when the key is absent.
  std::vector<double> numbers(const std::string& key);
  /// A non-empty array of positive numbers; empty when the key is absent.
  std::vector<double> positive_numbers(const std::string& key);
  /// Table of scalars as text, numbers as written, booleans as on/off.
  std::map<std::string, std::string> scalars(const std::string& key);
  /// Table of non-empty arrays of scalars as text.
  std::map<std::string, std::vector<std::string>> scalar_lists(const std::string& key);
  /// A table within this one. Throws when it is absent.
  StrictTable table(const std::string& key, const std::string& allowed);
  /// Array of tables; empty when the key is absent.
  std::vector<StrictTable> tables(const std::string& key);
  /// The same, written within the entry: [{ ... }, { ... }].
  std::vector<StrictTable> inner_tables(const std::string& key);
  /// A non-empty array of texts; empty when the key is absent.
  std::vector<std::string> texts(const std::string& key);

  void finish() const;
  const SourcePosition& where() const { return m_table->where; }
  [[noreturn]] void reject(const scene::ConfigNode& node, const std::string& allowed) const;
  /// For a key that is needed but absent.
  [[noreturn]] void missing(const std::string& key, const std::string& allowed) const;

 private:
  std::vector<StrictTable> tables_of(const std::string& key, const std::string& allowed);
  const scene::ConfigNode* m_table;
  std::vector<std::string> m_known;
};

}  // namespace concord::studies
