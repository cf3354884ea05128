#include "scene/section.hpp"

#include "scene/suggest.hpp"
#include "scene/unit_text.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace concord::scene {

using Kind = ConfigNode::Kind;

InputError bad_value(const ConfigNode& node, const std::string& allowed) {
  return InputError(node.where, node.key, node.describe(), allowed);
}

double read_quantity(const ConfigNode& node, const UnitDimension& unit) {
  if (node.kind == Kind::text) return parse_quantity(node.text, unit, node.where, node.key);
  if (node.kind == Kind::integer || node.kind == Kind::real)
    throw InputError(node.where, node.key, node.describe() + " without a unit",
                     unit_examples(unit));
  throw bad_value(node, unit_examples(unit));
}

std::vector<std::string> words_of(const std::string& range) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < range.size();) {
    const std::size_t end = std::min(range.find(" | ", begin), range.size());
    words.push_back(range.substr(begin, end - begin));
    begin = end + 3;
  }
  return words;
}

Section::Section(const ConfigNode& table) : m_table(&table) { table.was_read = true; }

const ConfigNode* Section::find(const std::string& name) const {
  const ConfigNode* found = m_table->find(name);
  if (found != nullptr) found->was_read = true;
  return found;
}

std::string Section::allowed(const std::string& name) const {
  const std::string dotted = m_table->key.empty() ? name : m_table->key + "." + name;
  const KeyInfo& info = key_info(key_pattern(dotted));
  std::string text = info.range.empty() ? "text" : info.range;
  if (info.unit != "text" && info.unit != "any" && info.unit != "1" && info.unit != info.range)
    text += " [" + info.unit + "]";
  return text + " (" + info.meaning + ")";
}

const ConfigNode& Section::require(const std::string& name) const {
  const ConfigNode* found = find(name);
  if (found != nullptr) return *found;
  const std::string dotted = m_table->key.empty() ? name : m_table->key + "." + name;
  throw InputError(m_table->where, dotted, "nothing", allowed(name));
}

const ConfigNode* Section::table(const std::string& name) const {
  const ConfigNode* found = find(name);
  if (found != nullptr && found->kind != Kind::table)
    throw bad_value(*found, "a table: [" + found->key + "]");
  return found;
}

std::vector<const ConfigNode*> Section::tables(const std::string& name) const {
  std::vector<const ConfigNode*> found;
  const ConfigNode* array = find(name);
  if (array == nullptr) return found;
  if (array->kind != Kind::array) throw bad_value(*array, "a list of tables: [[" + name + "]]");
  for (const ConfigNode& element : array->elements) {
    if (element.kind != Kind::table) throw bad_value(element, "a table: [[" + name + "]]");
    found.push_back(&element);
  }
  return found;
}

std::string Section::text(const std::string& name) const {
  const ConfigNode& node = require(name);
  if (node.kind != Kind::text || node.text.empty())
    throw bad_value(node, "text in double quotes: " + allowed(name));
  return node.text;
}

std::string Section::text(const std::string& name, const std::string& otherwise) const {
  return has(name) ? text(name) : otherwise;
}

std::string Section::word(const std::string& name) const {
  const std::string found = text(name);
  const std::vector<std::string> words =
      words_of(key_info(key_pattern(require(name).key)).range);
  if (std::find(words.begin(), words.end(), found) == words.end())
    throw bad_value(require(name), allowed_words(found, words));
  return found;
}

std::string Section::word(const std::string& name, const std::string& otherwise) const {
  return has(name) ? word(name) : otherwise;
}

bool Section::boolean(const std::string& name, bool otherwise) const {
  const ConfigNode* node = find(name);
  if (node == nullptr) return otherwise;
  if (node->kind != Kind::boolean) throw bad_value(*node, "true | false");
  return node->boolean;
}

int Section::integer(const std::string& name, int otherwise, int least) const {
  constexpr int most = 1000000000;
  const ConfigNode* node = find(name);
  if (node == nullptr) return otherwise;
  if (node->kind != Kind::integer || node->number < least || node->number > most)
    throw bad_value(*node, fmt::format("a whole number from {} to {}", least, most));
  return static_cast<int>(node->number);
}

double Section::number(const std::string& name) const {
  const ConfigNode& node = require(name);
  const bool is_number = node.kind == Kind::integer || node.kind == Kind::real;
  if (!is_number || !std::isfinite(node.number))
    throw bad_value(node, "a number without quotes: " + allowed(name));
  return node.number;
}

double Section::quantity(const std::string& name, const UnitDimension& unit) const {
  return read_quantity(require(name), unit);
}

double Section::positive(const std::string& name, const UnitDimension& unit) const {
  const double value = quantity(name, unit);
  if (!(value > 0)) throw bad_value(require(name), allowed(name));
  return value;
}

}  // namespace concord::scene
