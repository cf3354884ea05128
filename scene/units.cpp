#include "scene/units.hpp"

#include "scene/suggest.hpp"
#include "scene/unit_text.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace concord::scene {
namespace {

struct NamedUnit {
  std::string_view symbol;
  double factor;
  UnitDimension dimension;
  bool prefixes;
};

// SI base and derived units (BIPM SI brochure, 9th edition, tables 2, 4 and 8). The gram
// carries the prefixes of the kilogram. min, h, d are omitted: "h" would be mistaken for a
// spacing.
constexpr NamedUnit units[] = {
    {"m", 1, {1, 0, 0}, true},
    {"g", 1e-3, {0, 1, 0}, true},
    {"s", 1, {0, 0, 1}, true},
    {"N", 1, {1, 1, -2}, true},
    {"Pa", 1, {-1, 1, -2}, true},
    {"J", 1, {2, 1, -2}, true},
    {"W", 1, {2, 1, -3}, true},
    {"Hz", 1, {0, 0, -1}, true},
    {"t", 1e3, {0, 1, 0}, false},
    {"rad", 1, {}, false},
    {"deg", 3.14159265358979323846 / 180, {}, false},
    {"%", 1e-2, {}, false},
    {"1", 1, {}, false},
};

struct Prefix {
  std::string_view symbol;
  double factor;
};
constexpr Prefix prefixes[] = {{"", 1},     {"T", 1e12}, {"G", 1e9},         {"M", 1e6},
                               {"k", 1e3},  {"h", 1e2},  {"d", 1e-1},        {"c", 1e-2},
                               {"m", 1e-3}, {"u", 1e-6}, {"\xC2\xB5", 1e-6}, {"n", 1e-9},
                               {"p", 1e-12}};

/// A unit's own symbol wins over a prefix and another unit ("Pa" is no peta-ampere, "t" no
/// prefix).
std::optional<UnitValue> lookup(std::string_view symbol) {
  for (const NamedUnit& u : units)
    if (symbol == u.symbol) return UnitValue{u.factor, u.dimension};
  for (const NamedUnit& u : units)
    for (const Prefix& p : prefixes)
      if (u.prefixes && symbol.size() == p.symbol.size() + u.symbol.size() &&
          symbol.starts_with(p.symbol) && symbol.ends_with(u.symbol))
        return UnitValue{p.factor * u.factor, u.dimension};
  return std::nullopt;
}

bool is_operator(char c) { return c == '*' || c == '/' || c == '^' || c == ' '; }

/// Reads "kN/mm^2": factors joined by '*', ' ' or '/', each with an optional integer power.
std::optional<UnitValue> read_unit(std::string_view text) {
  UnitValue result{1, {}};
  int sign = 1;
  std::size_t i = 0;
  while (i < text.size()) {
    std::size_t end = i;
    while (end < text.size() && !is_operator(text[end])) ++end;
    const auto factor = lookup(text.substr(i, end - i));
    if (!factor) return std::nullopt;
    int power = 1;
    i = end;
    if (i < text.size() && text[i] == '^') {
      const char* begin = text.data() + i + 1;
      const auto [rest, error] = std::from_chars(begin, text.data() + text.size(), power);
      if (error != std::errc{} || std::abs(power) > 9) return std::nullopt;
      i = static_cast<std::size_t>(rest - text.data());
    }
    power *= sign;
    result.factor *= std::pow(factor->factor, power);
    result.dimension.m += power * factor->dimension.m;
    result.dimension.kg += power * factor->dimension.kg;
    result.dimension.s += power * factor->dimension.s;
    if (i == text.size()) break;
    if (text[i] != '*' && text[i] != '/' && text[i] != ' ') return std::nullopt;
    sign = text[i] == '/' ? -1 : 1;
    if (++i == text.size()) return std::nullopt;
  }
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())))
    text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())))
    text.remove_suffix(1);
  return text;
}

const char* dimension_name(const UnitDimension& d) {
  if (d == unit::none) return "no dimension";
  if (d == unit::length) return "length";
  if (d == unit::time) return "time";
  if (d == unit::mass) return "mass";
  if (d == unit::velocity) return "velocity";
  if (d == unit::acceleration) return "acceleration";
  if (d == unit::density) return "density";
  if (d == unit::pressure) return "stress";
  if (d == unit::force) return "force";
  if (d == unit::force_density) return "force per volume";
  if (d == unit::rate) return "rate";
  if (d == unit::energy_per_area) return "energy per area";
  return "another dimension";
}

}  // namespace

std::string unit_examples(const UnitDimension& d) {
  const std::string text = std::string("a number with a unit of ") + dimension_name(d);
  if (d == unit::none) return "a number without a unit";
  if (d == unit::length) return text + ", e.g. \"10 mm\" or \"1 m\"";
  if (d == unit::time) return text + ", e.g. \"2 ms\" or \"0.5 s\"";
  if (d == unit::mass) return text + ", e.g. \"3 kg\"";
  if (d == unit::velocity) return text + ", e.g. \"10 m/s\"";
  if (d == unit::acceleration) return text + ", e.g. \"-9.81 m/s^2\"";
  if (d == unit::density) return text + ", e.g. \"1100 kg/m^3\"";
  if (d == unit::pressure) return text + ", e.g. \"17 MPa\" or \"2 kN/mm^2\"";
  if (d == unit::force) return text + ", e.g. \"5 kN\"";
  if (d == unit::force_density) return text + ", e.g. \"1 kN/m^3\"";
  if (d == unit::energy_per_area) return text + ", e.g. \"100 J/m^2\"";
  return text + ", e.g. \"100 1/s\"";
}

UnitValue parse_any_quantity(const std::string& text, const SourcePosition& where,
                             const std::string& key, const std::string& allowed) {
  std::string_view rest = trimmed(text);
  if (!rest.empty() && rest.front() == '+') rest.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc{} || !std::isfinite(number))
    throw InputError(where, key, in_quotes(text) + ", which begins with no number", allowed);
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  const std::string_view symbol = trimmed(rest);
  if (symbol.empty()) return {number, unit::none};
  const auto unit = read_unit(symbol);
  if (!unit)
    throw InputError(where, key,
                     in_quotes(text) + ", whose unit " + in_quotes(std::string(symbol)) +
                         " is unknown",
                     allowed);
  // Dividing by 1000 rounds once, as reading "0.007" does; multiplying by 1e-3 rounds twice.
  const double inverse = 1 / unit->factor;
  const bool whole = unit->factor < 1 && inverse == std::round(inverse);
  return {whole ? number / inverse : number * unit->factor, unit->dimension};
}

double parse_quantity(const std::string& text, const UnitDimension& expected,
                      const SourcePosition& where, const std::string& key) {
  const std::string allowed = unit_examples(expected);
  const UnitValue value = parse_any_quantity(text, where, key, allowed);
  if (value.dimension == expected) return value.factor;
  if (value.dimension == unit::none)
    throw InputError(where, key, in_quotes(text) + " without a unit", allowed);
  throw InputError(where, key, in_quotes(text) + ", a " + dimension_name(value.dimension),
                   allowed);
}

}  // namespace concord::scene
