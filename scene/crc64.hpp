#pragma once
// A checksum that tells whether bytes are still those that were written.

#include <cstdint>
#include <span>

namespace concord::scene {

/// CRC-64/XZ of bytes, after those whose checksum is `before`: crc64(b, crc64(a)) is that of a
/// and b one after the other. Every change of up to 64 bits in a row changes it; others pass
/// with a probability of 2^-64. Polynomial of ECMA-182 (annex B), bits reflected, all ones
/// before and after (xz file format 1.1.0, section 6).
std::uint64_t crc64(std::span<const char> bytes, std::uint64_t before = 0);

/// The same of the numbers in memory.
template <class Values> std::uint64_t crc64_of(const Values& values, std::uint64_t before = 0) {
  return crc64(
      {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(*values.data())},
      before);
}

}  // namespace concord::scene
