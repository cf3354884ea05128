#include "scene/keys.hpp"

#include "scene/suggest.hpp"

#include <algorithm>
#include <stdexcept>

namespace concord::scene {
namespace {

bool is_index(const std::string& part) {
  return !part.empty() && part.find_first_not_of("0123456789") == std::string::npos;
}

/// Names that the table allows right below a pattern ("" for the top).
std::vector<std::string> names_below(const std::string& pattern) {
  std::vector<std::string> names;
  const std::string prefix = pattern.empty() ? "" : pattern + ".";
  for (const KeyInfo& info : scene_keys()) {
    if (!info.key.starts_with(prefix)) continue;
    std::string name = info.key.substr(prefix.size());
    name = name.substr(0, std::min(name.find('.'), name.find('[')));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

bool known(const std::string& pattern) {
  for (const KeyInfo& info : scene_keys())
    if (info.key == pattern || info.key.starts_with(pattern + ".") ||
        info.key.starts_with(pattern + "[]."))
      return true;
  return false;
}

void check_table(const ConfigNode& table) {
  const std::string above = key_pattern(table.key);
  for (const auto& [name, member] : table.members) {
    const std::string pattern = key_pattern(member.key);
    if (!known(pattern))
      throw InputError(member.key_where, member.key, "an unknown key",
                       allowed_words(name, names_below(above)));
    // Members of a parameter's own table ({expr = ...}) are read with the parameter.
    if (pattern.starts_with("parameters.")) continue;
    if (member.kind == ConfigNode::Kind::table) check_table(member);
    for (const ConfigNode& element : member.elements)
      if (element.kind == ConfigNode::Kind::table) check_table(element);
  }
}

}  // namespace

std::string key_pattern(const std::string& dotted) {
  std::string pattern;
  std::size_t begin = 0;
  while (begin <= dotted.size() && !dotted.empty()) {
    const std::size_t end = std::min(dotted.find('.', begin), dotted.size());
    const std::string part = dotted.substr(begin, end - begin);
    if (pattern == "parameters") return "parameters.*";
    if (is_index(part))
      pattern += "[]";
    else
      pattern += (pattern.empty() ? "" : ".") + part;
    begin = end + 1;
  }
  return pattern;
}

const KeyInfo& key_info(const std::string& pattern) {
  for (const KeyInfo& info : scene_keys())
    if (info.key == pattern) return info;
  throw std::logic_error("the table of scene keys lacks " + pattern);
}

void check_keys_known(const ConfigNode& root) { check_table(root); }

void check_keys_read(const ConfigNode& root) {
  for (const auto& [name, member] : root.members) {
    if (!member.was_read)
      throw InputError(member.key_where, member.key,
                       "a key that has no meaning beside the scene's other statements",
                       "this scene without it");
    if (member.kind == ConfigNode::Kind::table) check_keys_read(member);
    for (const ConfigNode& element : member.elements)
      if (element.kind == ConfigNode::Kind::table) check_keys_read(element);
  }
}

}  // namespace concord::scene
