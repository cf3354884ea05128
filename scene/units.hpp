#pragma once
// Quantities with units, written as text: "17 MPa", "0.5 ms", "1100 kg/m^3".

#include "scene/errors.hpp"

#include <array>
#include <string>

namespace concord::scene {

/// Exponents of metre, kilogram, second.
struct UnitDimension {
  int m = 0, kg = 0, s = 0;
  friend bool operator==(const UnitDimension&, const UnitDimension&) = default;
};

namespace unit {
inline constexpr UnitDimension none{}, length{1, 0, 0}, time{0, 0, 1}, mass{0, 1, 0},
    velocity{1, 0, -1}, acceleration{1, 0, -2}, density{-3, 1, 0}, pressure{-1, 1, -2},
    force{1, 1, -2}, force_density{-2, 1, -2}, rate{0, 0, -1}, energy_per_area{0, 1, -2};
}

/// Value in SI units of text "number unit", where unit is a product or quotient of SI units
/// with prefixes and integer powers ("kg/m^3", "kN/mm^2", "m/s^2"). Throws InputError when the
/// number or the unit is unreadable, when the unit is missing, or when its dimension is not
/// `expected` (the message names examples that fit).
double parse_quantity(const std::string& text, const UnitDimension& expected,
                      const SourcePosition& where, const std::string& key);

}  // namespace concord::scene
