// The length of a cosine and its inverse, against quadrature and limits.
#include "paint/carried_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plisse::paint {
namespace {

using std::numbers::pi;

TEST(CarriedField, LengthOfACosine) {
  for (const double slope : {0.0, 1e-4, 0.1, 0.5, 1.0, 3.0, 20.0, 500.0}) {
    double sum = 0;
    constexpr int points = 20000;  // of one period; the rectangle rule converges faster than any power
    for (int i = 0; i < points; ++i) sum += std::hypot(1.0, slope * std::sin(2 * pi * i / points)) / points;
    EXPECT_NEAR(arc_length(slope), sum, 1e-9 * sum) << slope;
  }
  EXPECT_NEAR((arc_length(1e-3) - 1) / 1e-6, 0.25, 1e-6);  // 1 + s²/4
}

TEST(CarriedField, SlopeOfALengthIsItsInverse) {
  EXPECT_EQ(slope_of_length(0.3), 0);
  EXPECT_EQ(slope_of_length(1), 0);
  for (double slope = 1e-4; slope < 70; slope *= 1.07)
    EXPECT_NEAR(slope_of_length(arc_length(slope)), slope, 1e-5 * std::max(slope, 1e-2)) << slope;
  EXPECT_NEAR(slope_of_length(arc_length(500)) / 500, 1, 1e-3);
}

}  // namespace
}  // namespace plisse::paint
