#include "base/weighted_median.h"

#include <gtest/gtest.h>

namespace plisse {
namespace {

TEST(WeightedMedian, HalfOfTheWeightIsBelow) {
  EXPECT_EQ(weighted_median({}), 0);
  EXPECT_EQ(weighted_median({{3, 1}}), 3);
  EXPECT_EQ(weighted_median({{3, 1}, {1, 1}, {2, 1}}), 2);
  EXPECT_EQ(weighted_median({{3, 5}, {1, 1}, {2, 1}}), 3);  // not the middle one by number
  EXPECT_EQ(weighted_median({{3, 1}, {1, 5}, {2, 1}}), 1);
  EXPECT_EQ(weighted_median({{-1, 0}, {4, 2}}), 4);  // what weighs nothing is not there
}

}  // namespace
}  // namespace plisse
