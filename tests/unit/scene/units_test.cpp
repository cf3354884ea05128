#include "scene/units.hpp"

#include <gtest/gtest.h>

using namespace concord;
using namespace concord::scene;

namespace {
double read(const std::string& text, const UnitDimension& d) {
  return parse_quantity(text, d, {"f", 3, 7}, "key");
}
}  // namespace

TEST(Units, PrefixesAndPowers) {
  EXPECT_DOUBLE_EQ(read("17 MPa", unit::pressure), 17e6);
  EXPECT_DOUBLE_EQ(read("2 kN/mm^2", unit::pressure), 2e9);
  EXPECT_DOUBLE_EQ(read("1100 kg/m^3", unit::density), 1100);
  EXPECT_DOUBLE_EQ(read("1.1 g/cm^3", unit::density), 1100);
  EXPECT_DOUBLE_EQ(read("1 t/m^3", unit::density), 1000);
  EXPECT_DOUBLE_EQ(read("-9.81 m/s^2", unit::acceleration), -9.81);
  EXPECT_DOUBLE_EQ(read("3 kg m s^-2", unit::force), 3);
  EXPECT_DOUBLE_EQ(read("5 1/s", unit::rate), 5);
  EXPECT_DOUBLE_EQ(read("2 kHz", unit::rate), 2000);
  EXPECT_DOUBLE_EQ(read("1e-3um", unit::length), 1e-9);
  EXPECT_DOUBLE_EQ(read("+4 \xC2\xB5s", unit::time), 4e-6);
}

// Text in millimetres and text in metres must give the same double: 7/1000, not 7 * 0.001.
TEST(Units, DecimalUnitsRoundOnce) {
  for (int i = 1; i < 2000; ++i) {
    const std::string digits = std::to_string(i);
    EXPECT_EQ(read(digits + " mm", unit::length), i / 1000.0) << i;
    EXPECT_EQ(read(digits + " um", unit::length), i / 1000000.0) << i;
  }
}

TEST(Units, RefusesWhatIsNoQuantityOfTheDimension) {
  for (const char* text : {"17", "17 m", "MPa", "", "17 MPas", "17 Mpa", "17 MPa/", "17 MPa^x",
                           "17 N//m^2", "nan Pa", "inf Pa", "17 Pa^99"})
    EXPECT_THROW(read(text, unit::pressure), InputError) << text;
}

TEST(Units, MessageTellsPlaceKeyAndExample) {
  try {
    read("17 m", unit::pressure);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.where().line, 3);
    EXPECT_EQ(e.where().column, 7);
    EXPECT_EQ(std::string(e.what()),
              "f:3:7: key: found \"17 m\", a length; allowed: a number with a unit of stress, "
              "e.g. \"17 MPa\" or \"2 kN/mm^2\"");
  }
}
