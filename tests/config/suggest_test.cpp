// The nearest name: distances counted by hand.
#include "config/suggest.h"

#include <gtest/gtest.h>

#include <vector>

namespace plisse {
namespace {

const std::vector<std::string> names = {"wavelength", "strength", "profile", "only", "exclude", "up"};

TEST(Nearest, FindsTypos) {
  EXPECT_EQ(config::nearest("wavelenth", names), "wavelength");    // a letter left out
  EXPECT_EQ(config::nearest("wavelengthh", names), "wavelength");  // one too many
  EXPECT_EQ(config::nearest("prufile", names), "profile");         // another
  EXPECT_EQ(config::nearest("wavelnegth", names), "wavelength");   // two swapped
  EXPECT_EQ(config::nearest("Only", names), "only");               // case
  EXPECT_EQ(config::nearest("olny", names), "only");               // a swap is one step: 1 of 4 letters
}

TEST(Nearest, IsSilentWhereNothingIsNear) {
  EXPECT_EQ(config::nearest("colour", names), "");
  EXPECT_EQ(config::nearest("x", names), "") << "replacing all of a word is no typo";
  EXPECT_EQ(config::nearest("", names), "");
  EXPECT_EQ(config::nearest("wavelength", {}), "");
}

// A third of the longer word's letters may differ, but never all of it; one may in any case.
TEST(Nearest, StopsAtAThirdOfTheLetters) {
  EXPECT_EQ(config::nearest("wavxxxngth", names), "wavelength");  // 3 of 10
  EXPECT_EQ(config::nearest("waxxxxngth", names), "");            // 4 of 10
  EXPECT_EQ(config::nearest("profyyy", names), "");               // 3 of 7
  EXPECT_EQ(config::nearest("profiyy", names), "profile");        // 2 of 7
  EXPECT_EQ(config::nearest("wavelen", names), "wavelength");     // 3 of the longer word's 10
  EXPECT_EQ(config::nearest("wavele", names), "");                // 4 of 10
  EXPECT_EQ(config::nearest("ux", names), "up");                  // 1 of 2
  EXPECT_EQ(config::nearest("xy", names), "");                    // 2 of 2
}

TEST(Nearest, PrefersTheNearerAndOnTiesTheFirst) {
  const std::vector<std::string> rows = {"abcde", "abcdf", "abcxx"};
  EXPECT_EQ(config::nearest("abcdf", rows), "abcdf");
  EXPECT_EQ(config::nearest("abcdz", rows), "abcde");
}

TEST(Nearest, Phrase) {
  EXPECT_EQ(config::did_you_mean("olny", names), " (did you mean 'only'?)");
  EXPECT_EQ(config::did_you_mean("zebra", names), "");
}

}  // namespace
}  // namespace plisse
