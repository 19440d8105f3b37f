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
