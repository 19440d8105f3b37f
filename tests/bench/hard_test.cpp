// The hard cases of `plisse bench hard`, a test each.
#include "bench/hard.h"

#include <gtest/gtest.h>

#include <cctype>
#include <ostream>

#include "support/opengl.h"

namespace plisse::bench {

// Else GoogleTest prints its bytes.
void PrintTo(const HardCase& hard, std::ostream* out) {
  *out << hard.must;
}

namespace {

std::string test_name(const HardCase& hard) {
  std::string name;
  for (const char c : hard.area + " " + hard.name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  return name;
}

class Hard : public ::testing::TestWithParam<HardCase> {};

TEST_P(Hard, Holds) {
  if (GetParam().draws && !test::opengl_works()) GTEST_SKIP() << "no OpenGL driver";
  const HardRow row = judge(GetParam());
  RecordProperty("found", row.verdict.found);
  EXPECT_TRUE(row.verdict.holds) << row.must << " is wanted, found: " << row.verdict.found;
}

INSTANTIATE_TEST_SUITE_P(Cases, Hard, ::testing::ValuesIn(hard_cases()),
                         [](const auto& parameter) { return test_name(parameter.param); });

TEST(HardCases, AreNamedApartAndSayWhatTheyMust) {
  for (const HardCase& a : hard_cases()) {
    EXPECT_FALSE(a.must.empty()) << a.name;
    int same = 0;
    for (const HardCase& b : hard_cases()) same += test_name(a) == test_name(b) ? 1 : 0;
    EXPECT_EQ(same, 1) << a.name;
  }
}

TEST(HardCases, WhatThrowsDoesNotHold) {
  const HardRow row =
      judge({"passes", "throws", "nothing", false, []() -> Verdict { throw std::runtime_error("why"); }});
  EXPECT_FALSE(row.verdict.holds);
  EXPECT_NE(row.verdict.found.find("why"), std::string::npos);
}

}  // namespace
}  // namespace plisse::bench
