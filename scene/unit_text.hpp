#pragma once
// What the reader needs of units beside parse_quantity: quantities of any dimension, and words
// for messages.

#include "scene/units.hpp"

namespace concord::scene {

/// A number in SI units and its dimension.
struct UnitValue {
  double factor = 1;
  UnitDimension dimension;
};

/// SI value and dimension of "number unit"; a missing unit gives the dimension none. Throws
/// InputError with `allowed` when number or unit are unreadable.
UnitValue parse_any_quantity(const std::string& text, const SourcePosition& where,
                             const std::string& key, const std::string& allowed);

/// "a number with a unit of stress, e.g. ..." for messages.
std::string unit_examples(const UnitDimension& dimension);

}  // namespace concord::scene
