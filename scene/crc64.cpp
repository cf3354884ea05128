#include "scene/crc64.hpp"

#include <array>
#include <bit>
#include <cstring>

namespace concord::scene {
namespace {

static_assert(std::endian::native == std::endian::little, "words are read as they stand");

constexpr std::uint64_t polynomial = 0xc96c5795d7870f42;  ///< of ECMA-182, reflected
constexpr int width = 8;                                  ///< bytes at once

/// table[k][b]: what the byte b does to the checksum when k more bytes follow it.
using Tables = std::array<std::array<std::uint64_t, 256>, width>;

constexpr Tables make_tables() {
  Tables table{};
  for (std::uint64_t b = 0; b < 256; ++b) {
    std::uint64_t value = b;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) * polynomial);
    table[0][b] = value;
  }
  for (int k = 1; k < width; ++k) {
    for (std::size_t b = 0; b < 256; ++b)
      table[k][b] = (table[k - 1][b] >> 8) ^ table[0][table[k - 1][b] & 0xff];
  }
  return table;
}

constexpr Tables table = make_tables();

}  // namespace

std::uint64_t crc64(std::span<const char> bytes, std::uint64_t before) {
  std::uint64_t crc = ~before;
  const char* at = bytes.data();
  const char* const end = at + bytes.size();
  for (; end - at >= width; at += width) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, width);
    word ^= crc;
    crc = 0;
    for (int k = 0; k < width; ++k) crc ^= table[width - 1 - k][(word >> (8 * k)) & 0xff];
  }
  for (; at != end; ++at)
    crc = (crc >> 8) ^ table[0][(crc ^ static_cast<unsigned char>(*at)) & 0xff];
  return ~crc;
}

}  // namespace concord::scene
