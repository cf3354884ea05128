#include "scene/method.hpp"

#include "scene/suggest.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace concord::scene {
namespace {

const SourcePosition setting_position{"settings", 0, 0};

/// The number that a text is, all of it; NaN if it is none.
double read_number(const std::string& text) {
  double value = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  return error == std::errc{} && end == last ? value : std::nan("");
}

bool is_number(const ParameterInfo& info) {
  return info.choices.empty() && !std::isnan(read_number(info.default_value));
}

void check(const std::string& key, const ParameterInfo& info, const std::string& text) {
  if (!info.choices.empty()) {
    for (const std::string& choice : info.choices)
      if (choice == text) return;
    throw InputError(setting_position, key, in_quotes(text), allowed_words(text, info.choices));
  }
  if (!is_number(info)) return;
  const double value = read_number(text);
  if (!(value >= info.minimum && value <= info.maximum))
    throw InputError(setting_position, key, in_quotes(text),
                     "a number " + (info.range.empty() ? fmt::format("from {} to {}",
                                                                     info.minimum, info.maximum)
                                                       : info.range));
}

bool same(const std::string& a, const std::string& b) {
  return a == b || read_number(a) == read_number(b);
}

}  // namespace

Settings::Settings(std::string method, const std::vector<ParameterInfo>& table,
                   const std::map<std::string, std::string>& given)
    : m_method(std::move(method)) {
  std::vector<std::string> keys;
  for (const ParameterInfo& info : table) {
    m_defaults[info.key] = m_values[info.key] = info.default_value;
    keys.push_back(info.key);
  }
  for (const auto& [key, text] : given) {
    const std::string full = m_method + "." + key;
    if (!m_defaults.contains(key))
      throw InputError(setting_position, full, "an unknown setting", allowed_words(key, keys));
    for (const ParameterInfo& info : table)
      if (info.key == key) check(full, info, text);
    m_values[key] = text;
  }
}

double Settings::number(const std::string& key) const {
  const double value = read_number(word(key));
  if (std::isnan(value))
    throw InputError(setting_position, m_method + "." + key, in_quotes(word(key)), "a number");
  return value;
}

const std::string& Settings::word(const std::string& key) const {
  const auto found = m_values.find(key);
  if (found == m_values.end())
    throw std::logic_error("method " + m_method + " asks for the undeclared setting " + key);
  return found->second;
}

std::string Settings::variant() const {
  std::string text;
  for (const auto& [key, value] : m_values) {
    if (same(value, m_defaults.at(key))) continue;
    if (!text.empty()) text += ' ';
    text += key + "=" + value;
  }
  return text;
}

MethodRegistry& MethodRegistry::instance() {
  static MethodRegistry registry;
  return registry;
}

void MethodRegistry::add(std::unique_ptr<Method> method) {
  const std::string name = method->info().name;
  if (!m_methods.emplace(name, std::move(method)).second)
    throw std::logic_error("two methods are named " + name);
}

const Method& MethodRegistry::find(const std::string& name) const {
  const auto found = m_methods.find(name);
  if (found != m_methods.end()) return *found->second;
  std::vector<std::string> names;
  for (const auto& [known, method] : m_methods) names.push_back(known);
  throw InputError({"command line", 0, 0}, "method", in_quotes(name),
                   allowed_words(name, names));
}

std::vector<const Method*> MethodRegistry::all() const {
  std::vector<const Method*> methods;
  for (const auto& [name, method] : m_methods) methods.push_back(method.get());
  return methods;
}

}  // namespace concord::scene
