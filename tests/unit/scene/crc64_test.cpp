// Checksums against their definition.

#include "scene/crc64.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

using concord::scene::crc64;

namespace {

/// Division of polynomials bit by bit, bits reflected: ECMA-182, annex B.
std::uint64_t bit_by_bit(const std::string& bytes) {
  std::uint64_t rest = ~std::uint64_t{0};
  for (const char byte : bytes) {
    rest ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit)
      rest = (rest & 1) != 0 ? (rest >> 1) ^ 0xc96c5795d7870f42 : rest >> 1;
  }
  return ~rest;
}

std::string random_bytes(std::size_t size) {
  std::mt19937 random(static_cast<unsigned>(size));
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

}  // namespace

/// The check value that catalogues of CRCs give for CRC-64/XZ.
TEST(Crc64, OfNineDigits) { EXPECT_EQ(crc64(std::string("123456789")), 0x995dc9bbdf1939fa); }

TEST(Crc64, OfAnyLengthAndInPieces) {
  for (std::size_t size = 0; size < 70; ++size) {
    const std::string bytes = random_bytes(size);
    EXPECT_EQ(crc64(bytes), bit_by_bit(bytes)) << size;
    for (std::size_t cut = 0; cut <= size; cut += 3) {
      const std::string a = bytes.substr(0, cut), b = bytes.substr(cut);
      EXPECT_EQ(crc64(b, crc64(a)), crc64(bytes));
    }
  }
}

/// Sums of products would pass that: the signs of two numbers.
TEST(Crc64, TwoChangedSignsAreSeen) {
  std::vector<double> numbers(100, 1.5);
  const std::uint64_t before = concord::scene::crc64_of(numbers);
  for (std::size_t k = 1; k < numbers.size(); ++k) {
    std::vector<double> other = numbers;
    other[0] = other[k] = -1.5;
    EXPECT_NE(concord::scene::crc64_of(other), before) << k;
  }
}
