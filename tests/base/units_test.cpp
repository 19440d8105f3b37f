// Lengths with units, against the definitions of the units.
#include "base/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace plisse {
namespace {

TEST(Units, LengthsAreMetresExactly) {
  // Equal, not near: "9 mm" must hash like 0.009, and 9 · 0.001 is one ulp off.
  EXPECT_EQ(parse_length("12 mm"), 0.012);
  EXPECT_EQ(parse_length("9 mm"), 0.009);
  EXPECT_EQ(parse_length("3cm"), 0.03);
  EXPECT_EQ(parse_length("1.5 m"), 1.5);
  EXPECT_EQ(parse_length("2 in"), 0.0508);
  EXPECT_EQ(parse_length("1 ft"), 0.3048);
  EXPECT_EQ(parse_length(" -1e-3\tm "), -0.001);
  EXPECT_EQ(parse_length("0.25"), 0.25);
  EXPECT_EQ(parse_length("+2"), 2.0);
}

TEST(Units, WhatIsNoLengthIsNone) {
  for (const char* text :
       {"", " ", "mm", "12 furlong", "12 MM", "1,5 m", "12 mm mm", "0x10", "+-2", "1 2 m", "--1"}) {
    EXPECT_FALSE(parse_length(text)) << text;
  }
}

TEST(Units, NumbersTakeUpAllOfTheText) {
  EXPECT_EQ(parse_number(" 30 "), 30.0);
  EXPECT_EQ(parse_number("-1e2"), -100.0);
  EXPECT_TRUE(std::isinf(*parse_number("inf")));
  EXPECT_FALSE(parse_number("30deg"));
  EXPECT_FALSE(parse_number(""));
}

}  // namespace
}  // namespace plisse
