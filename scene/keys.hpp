#pragma once
// The table of keys behind `describe`, and how the reader uses it.

#include "scene/config.hpp"
#include "scene/reader.hpp"

namespace concord::scene {

/// A dotted key as it stands in the table: indices become "[]", names of parameters "*":
/// boundary.0.kind -> boundary[].kind, parameters.U -> parameters.*.
std::string key_pattern(const std::string& dotted);

/// The entry of a pattern; throws std::logic_error if the table lacks it, so that the reader
/// can ask for no key that `describe` does not tell of.
const KeyInfo& key_info(const std::string& pattern);

/// Throws InputError at the first key that the table lacks, naming those allowed there.
void check_keys_known(const ConfigNode& root);

/// Throws InputError at the first key that nothing has read: it has no meaning beside the
/// scene's other statements.
void check_keys_read(const ConfigNode& root);

}  // namespace concord::scene
