#include "studies/driver/strict_table.hpp"

#include "scene/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace concord::studies {
namespace {

using scene::ConfigNode;
using Kind = ConfigNode::Kind;

bool is_number(const ConfigNode& node) {
  return (node.kind == Kind::integer || node.kind == Kind::real) && std::isfinite(node.number);
}

std::optional<std::string> scalar_text(const ConfigNode& node) {
  if (node.kind == Kind::text || is_number(node)) return node.text;
  if (node.kind == Kind::boolean) return node.boolean ? "on" : "off";
  return std::nullopt;
}

}  // namespace

void StrictTable::reject(const ConfigNode& node, const std::string& allowed) const {
  throw InputError(node.where, node.key, node.describe(), allowed);
}

void StrictTable::missing(const std::string& key, const std::string& allowed) const {
  throw InputError(m_table->where, m_table->key.empty() ? key : m_table->key + "." + key,
                   "nothing", allowed);
}

const ConfigNode* StrictTable::node(const std::string& key) {
  if (std::find(m_known.begin(), m_known.end(), key) == m_known.end()) m_known.push_back(key);
  return m_table->find(key);
}

std::optional<std::string> StrictTable::optional_text(const std::string& key) {
  const ConfigNode* found = node(key);
  if (!found) return std::nullopt;
  if (found->kind != Kind::text) reject(*found, "text in quotes");
  return found->text;
}

std::string StrictTable::text(const std::string& key) {
  auto value = optional_text(key);
  if (!value) missing(key, "text in quotes: this key is needed");
  return *value;
}

std::string StrictTable::text_or(const std::string& key, const std::string& fallback) {
  return optional_text(key).value_or(fallback);
}

std::optional<double> StrictTable::optional_number(const std::string& key) {
  const ConfigNode* found = node(key);
  if (!found) return std::nullopt;
  if (!is_number(*found)) reject(*found, "a number");
  return found->number;
}

double StrictTable::number_or(const std::string& key, double fallback) {
  return optional_number(key).value_or(fallback);
}

bool StrictTable::flag_or(const std::string& key, bool fallback) {
  const ConfigNode* found = node(key);
  if (!found) return fallback;
  if (found->kind != Kind::boolean) reject(*found, "true or false");
  return found->boolean;
}

std::vector<double> StrictTable::numbers(const std::string& key) {
  const ConfigNode* found = node(key);
  if (!found) return {};
  const char* allowed = "a list of numbers, such as [0, 0.5]";
  if (found->kind != Kind::array || found->elements.empty()) reject(*found, allowed);
  std::vector<double> values;
  for (const ConfigNode& element : found->elements) {
    if (!is_number(element)) reject(element, allowed);
    values.push_back(element.number);
  }
  return values;
}

std::vector<double> StrictTable::positive_numbers(const std::string& key) {
  const ConfigNode* found = node(key);
  if (!found) return {};
  const char* allowed = "a list of numbers above 0, such as [4, 8, 16]";
  if (found->kind != Kind::array || found->elements.empty()) reject(*found, allowed);
  std::vector<double> numbers;
  for (const ConfigNode& element : found->elements) {
    if (!is_number(element) || !(element.number > 0)) reject(element, allowed);
    numbers.push_back(element.number);
  }
  return numbers;
}

std::map<std::string, std::string> StrictTable::scalars(const std::string& key) {
  std::map<std::string, std::string> values;
  const ConfigNode* found = node(key);
  if (!found) return values;
  if (found->kind != Kind::table) reject(*found, "a table such as { xi_n = 1 }");
  for (const auto& [name, value] : found->members) {
    const auto text = scalar_text(value);
    if (!text) reject(value, "a number, text, true or false");
    values.emplace(name, *text);
  }
  return values;
}

std::map<std::string, std::vector<std::string>>
StrictTable::scalar_lists(const std::string& key) {
  std::map<std::string, std::vector<std::string>> lists;
  const ConfigNode* found = node(key);
  if (!found) return lists;
  const char* allowed = "a table of lists such as { psi = [0, 0.1] }";
  if (found->kind != Kind::table) reject(*found, allowed);
  for (const auto& [name, value] : found->members) {
    if (value.kind != Kind::array || value.elements.empty()) reject(value, allowed);
    for (const ConfigNode& element : value.elements) {
      const auto text = scalar_text(element);
      if (!text) reject(element, allowed);
      lists[name].push_back(*text);
    }
  }
  return lists;
}

StrictTable StrictTable::table(const std::string& key, const std::string& allowed) {
  const ConfigNode* found = node(key);
  if (!found) missing(key, allowed);
  if (found->kind != Kind::table) reject(*found, allowed);
  return StrictTable(*found);
}

std::vector<StrictTable> StrictTable::tables_of(const std::string& key,
                                                const std::string& allowed) {
  std::vector<StrictTable> entries;
  const ConfigNode* found = node(key);
  if (!found) return entries;
  if (found->kind != Kind::array) reject(*found, allowed);
  for (const ConfigNode& element : found->elements) {
    if (element.kind != Kind::table) reject(element, allowed);
    entries.emplace_back(element);
  }
  return entries;
}

std::vector<StrictTable> StrictTable::tables(const std::string& key) {
  return tables_of(key, fmt::format("entries that begin with [[{}]]", key));
}

std::vector<StrictTable> StrictTable::inner_tables(const std::string& key) {
  return tables_of(key, "a list of tables such as [{ method = \"fem\" }]");
}

std::vector<std::string> StrictTable::texts(const std::string& key) {
  std::vector<std::string> values;
  const ConfigNode* found = node(key);
  if (!found) return values;
  const char* allowed = "a list of texts in quotes";
  if (found->kind != Kind::array || found->elements.empty()) reject(*found, allowed);
  for (const ConfigNode& element : found->elements) {
    if (element.kind != Kind::text) reject(element, allowed);
    values.push_back(element.text);
  }
  return values;
}

void StrictTable::finish() const {
  for (const auto& [name, value] : m_table->members)
    if (std::find(m_known.begin(), m_known.end(), name) == m_known.end())
      throw InputError(value.key_where, value.key, "an unknown key",
                       scene::allowed_words(name, m_known));
}

}  // namespace concord::studies
