#pragma once
// One table of a scene file, read by key with type, unit and range.

#include "scene/keys.hpp"
#include "scene/units.hpp"

#include <optional>

namespace concord::scene {

/// Reads keys of one table and marks them as read. Every message names the key's file, line and
/// column and what the table of keys allows.
class Section {
 public:
  explicit Section(const ConfigNode& table);

  const ConfigNode& node() const { return *m_table; }
  bool has(const std::string& name) const { return m_table->find(name) != nullptr; }
  /// The value, marked as read, or nullptr.
  const ConfigNode* find(const std::string& name) const;
  /// The value; throws InputError at the table if it is missing.
  const ConfigNode& require(const std::string& name) const;
  /// A table within, or nullptr. Throws InputError if it is something else.
  const ConfigNode* table(const std::string& name) const;
  /// The tables of [[name]]. Throws InputError if it is something else.
  std::vector<const ConfigNode*> tables(const std::string& name) const;

  std::string text(const std::string& name) const;
  std::string text(const std::string& name, const std::string& otherwise) const;
  /// One of the words that the key's range lists.
  std::string word(const std::string& name) const;
  std::string word(const std::string& name, const std::string& otherwise) const;
  bool boolean(const std::string& name, bool otherwise) const;
  int integer(const std::string& name, int otherwise, int least) const;
  double number(const std::string& name) const;
  double quantity(const std::string& name, const UnitDimension& unit) const;
  /// A quantity that must be above 0.
  double positive(const std::string& name, const UnitDimension& unit) const;

  /// What the table of keys says is allowed for a key of this section.
  std::string allowed(const std::string& name) const;

 private:
  const ConfigNode* m_table;
};

/// InputError at a value: its position, key and description.
InputError bad_value(const ConfigNode& node, const std::string& allowed);

/// SI value of a text with a unit of this dimension; a bare number is refused.
double read_quantity(const ConfigNode& node, const UnitDimension& unit);

/// The words of a range "a | b | c".
std::vector<std::string> words_of(const std::string& range);

}  // namespace concord::scene
