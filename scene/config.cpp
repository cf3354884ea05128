#include "scene/config.hpp"

#include "scene/suggest.hpp"

#define TOML_ENABLE_FORMATTERS 1
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace concord::scene {
namespace {

SourcePosition position(const std::string& file, const toml::source_region& region) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

std::string joined(const std::string& parent, const std::string& name) {
  return parent.empty() ? name : parent + "." + name;
}

ConfigNode convert(const toml::node& node, const std::string& file, const std::string& key);

void convert_table(const toml::table& table, const std::string& file, ConfigNode& out) {
  for (const auto& [name, value] : table) {
    ConfigNode child = convert(value, file, joined(out.key, std::string(name.str())));
    child.key_where = position(file, name.source());
    out.members.emplace_back(std::string(name.str()), std::move(child));
  }
  std::stable_sort(out.members.begin(), out.members.end(), [](const auto& a, const auto& b) {
    const SourcePosition &p = a.second.key_where, &q = b.second.key_where;
    return std::pair(p.line, p.column) < std::pair(q.line, q.column);
  });
}

ConfigNode convert(const toml::node& node, const std::string& file, const std::string& key) {
  ConfigNode out;
  out.key = key;
  out.where = position(file, node.source());
  if (const auto* table = node.as_table()) {
    convert_table(*table, file, out);
  } else if (const auto* array = node.as_array()) {
    out.kind = ConfigNode::Kind::array;
    for (const toml::node& element : *array)
      out.elements.push_back(
          convert(element, file, joined(key, std::to_string(out.elements.size()))));
  } else if (const auto* text = node.as_string()) {
    out.kind = ConfigNode::Kind::text;
    out.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    out.kind = ConfigNode::Kind::integer;
    out.number = static_cast<double>(integer->get());
    out.text = std::to_string(integer->get());
  } else if (const auto* real = node.as_floating_point()) {
    out.kind = ConfigNode::Kind::real;
    out.number = real->get();
    out.text = fmt::format("{}", real->get());
  } else if (const auto* boolean = node.as_boolean()) {
    out.kind = ConfigNode::Kind::boolean;
    out.boolean = boolean->get();
    out.text = boolean->get() ? "true" : "false";
  } else {
    out.kind = ConfigNode::Kind::other;
    std::ostringstream stream;
    node.visit([&](const auto& n) {
      if constexpr (!toml::is_container<decltype(n)>) stream << n;
    });
    out.text = stream.str();
  }
  return out;
}

void append_canonical(const ConfigNode& node, std::string& out) {
  using Kind = ConfigNode::Kind;
  if (node.kind == Kind::table) {
    std::vector<const std::pair<std::string, ConfigNode>*> sorted;
    for (const auto& member : node.members) sorted.push_back(&member);
    std::sort(sorted.begin(), sorted.end(),
              [](const auto* a, const auto* b) { return a->first < b->first; });
    out += '{';
    for (const auto* member : sorted) {
      out += fmt::format("{}:{}=", member->first.size(), member->first);
      append_canonical(member->second, out);
      out += '\n';
    }
    out += '}';
  } else if (node.kind == Kind::array) {
    out += '[';
    for (const ConfigNode& element : node.elements) {
      append_canonical(element, out);
      out += ',';
    }
    out += ']';
  } else if (node.kind == Kind::integer || node.kind == Kind::real) {
    out += fmt::format("{}", node.number);  // 1 and 1.0 say the same
  } else if (node.kind == Kind::text) {
    out += fmt::format("{}:\"{}\"", node.text.size(), node.text);
  } else {
    out += node.text;
  }
}

const std::string command_line = "command line";

void set_position(ConfigNode& node) {
  node.where = node.key_where = {command_line, 0, 0};
  for (auto& [name, member] : node.members) set_position(member);
  for (ConfigNode& element : node.elements) set_position(element);
}

ConfigNode value_from_text(const std::string& text, const std::string& key) {
  ConfigNode node;
  try {
    const toml::table table = toml::parse("x = " + text + "\n");
    if (table.size() == 1 && !table.contains("x")) throw std::runtime_error("no value");
    node = convert(*table.get("x"), command_line, key);
  } catch (const std::exception&) {
    node.kind = ConfigNode::Kind::other;  // not TOML: "2 MPa", plane strain, 1+X
  }
  if (node.kind == ConfigNode::Kind::other || text.find('\n') != std::string::npos) {
    node = ConfigNode{};
    node.kind = ConfigNode::Kind::text;
    node.key = key;
    node.text = text;
  }
  set_position(node);
  return node;
}

/// The place in an array that a part of a dotted key names; the array's size is the next one.
ConfigNode& element_at(ConfigNode& array, const std::string& part, const std::string& key) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc{} || end != part.data() + part.size() || index > array.elements.size())
    throw InputError({command_line, 0, 0}, key, in_quotes(part),
                     fmt::format("an index from 0 to {}", array.elements.size()));
  if (index == array.elements.size()) array.elements.emplace_back();
  return array.elements[index];
}

}  // namespace

const ConfigNode* ConfigNode::find(const std::string& name) const {
  for (const auto& [key_name, member] : members)
    if (key_name == name) return &member;
  return nullptr;
}

ConfigNode* ConfigNode::find(const std::string& name) {
  return const_cast<ConfigNode*>(std::as_const(*this).find(name));
}

std::string ConfigNode::describe() const {
  switch (kind) {
    case Kind::text:
      return in_quotes(text);
    case Kind::integer:
    case Kind::real:
      return "the number " + text;
    case Kind::boolean:
      return text;
    case Kind::array:
      return fmt::format("an array of {}", elements.size());
    case Kind::table:
      return "a table";
    default:
      return text;
  }
}

std::string ConfigNode::canonical() const {
  std::string out;
  append_canonical(*this, out);
  return out;
}

ConfigNode read_toml(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf()))
    throw InputError({name, 0, 0}, "file", "nothing that can be read", "a readable TOML file");
  try {
    const toml::table table = toml::parse(text.str(), name);
    ConfigNode root = convert(table, name, "");
    root.where = {name, 1, 1};
    return root;
  } catch (const toml::parse_error& error) {
    throw InputError(position(name, error.source()), "syntax", std::string(error.description()),
                     "TOML: key = value, text in double quotes, [table], [[list of tables]]");
  }
}

void set_value(ConfigNode& root, const std::string& dotted_key, const std::string& text) {
  ConfigNode* node = &root;
  std::string key;
  std::istringstream parts(dotted_key);
  for (std::string part; std::getline(parts, part, '.');) {
    key = joined(key, part);
    if (part.empty())
      throw InputError({command_line, 0, 0}, dotted_key, "an empty part", "dotted keys");
    if (node->kind == ConfigNode::Kind::array) {
      node = &element_at(*node, part, dotted_key);
    } else if (node->kind == ConfigNode::Kind::table) {
      ConfigNode* child = node->find(part);
      if (child == nullptr) {
        child = &node->members.emplace_back(part, ConfigNode{}).second;
        const int next = parts.peek();  // "boundary.0.kind" makes a list of tables
        if (next >= '0' && next <= '9') child->kind = ConfigNode::Kind::array;
      }
      node = child;
    } else {
      throw InputError({command_line, 0, 0}, dotted_key,
                       in_quotes(node->key) + ", which is " + node->describe(),
                       "a key within a table or an index in an array");
    }
    node->key = key;
    if (node->where.file.empty()) node->where = node->key_where = {command_line, 0, 0};
  }
  if (key.empty())
    throw InputError({command_line, 0, 0}, "--set", "no key", "KEY=VALUE with a dotted key");
  *node = value_from_text(text, dotted_key);
}

}  // namespace concord::scene
