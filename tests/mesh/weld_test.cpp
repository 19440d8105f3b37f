// Welding: what is one vertex and what only looks like one.
#include "mesh/weld.h"

#include <gtest/gtest.h>

#include <random>

namespace plisse {
namespace {

PaletteInfluences bound_to(std::uint32_t entry) {
  PaletteInfluences influences;
  influences.entry[0] = entry;
  influences.weight[0] = 1;
  return influences;
}

WeldInput input_of(const std::vector<glm::dvec3>& positions) {
  WeldInput input;
  input.positions = positions;
  input.influences.assign(positions.size(), bound_to(0));
  return input;
}

TEST(Weld, JoinsCopiesOfAVertexInOrderOfFirstAppearance) {
  const Weld result = weld(input_of({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), 1e-6);
  EXPECT_EQ(result.welded, (std::vector<std::uint32_t>{0, 1, 0, 1, 2}));
  EXPECT_EQ(result.representative, (std::vector<std::uint32_t>{0, 1, 4}));
}

TEST(Weld, KeepsApartWhatDifferentBonesMove) {
  WeldInput input = input_of({{0, 0, 0}, {0, 0, 0}});
  input.influences[1] = bound_to(1);
  EXPECT_EQ(weld(input, 1e-6).representative.size(), 2U);
}

TEST(Weld, TakesEqualWeightsInAnyOrder) {
  WeldInput input = input_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  input.influences[0].entry = {3, 7};
  input.influences[1].entry = {7, 3};
  input.influences[2].entry = {3, 7};
  input.influences[0].weight = input.influences[1].weight = {0.5F, 0.5F};
  input.influences[2].weight = {0.6F, 0.4F};
  EXPECT_EQ(weld(input, 1e-6).welded, (std::vector<std::uint32_t>{0, 0, 1}));
}

TEST(Weld, RespectsMorphDeltas) {
  WeldInput input = input_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  input.target_count = 2;
  input.target_deltas.assign(6, glm::vec3{0});
  input.target_deltas[1 * 3 + 2] = {0, 0.1F, 0};  // second target, third vertex
  EXPECT_EQ(weld(input, 1e-6).welded, (std::vector<std::uint32_t>{0, 0, 1}));
}

TEST(Weld, AsksThePredicateToo) {
  const WeldInput input = input_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const Weld result = weld(input, 1e-6, [](std::uint32_t a, std::uint32_t b) { return (a + b) % 2 == 0; });
  EXPECT_EQ(result.welded, (std::vector<std::uint32_t>{0, 1, 0}));
}

// Wherever the cells' walls run: every pair nearer than the tolerance is joined, every pair farther is not.
TEST(Weld, DoesNotDependOnWhereTheGridLies) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-1, 1);
  constexpr double tolerance = 1e-3;
  for (int trial = 0; trial < 2000; ++trial) {
    const glm::dvec3 origin{place(random), place(random), place(random)};
    const glm::dvec3 p{place(random), place(random), place(random)};
    const glm::dvec3 direction = glm::normalize(glm::dvec3{place(random), place(random), place(random)});
    const Weld near = weld(input_of({origin, p, p + 0.99 * tolerance * direction}), tolerance);
    const Weld far = weld(input_of({origin, p, p + 1.01 * tolerance * direction}), tolerance);
    ASSERT_EQ(near.welded[1], near.welded[2]);
    ASSERT_NE(far.welded[1], far.welded[2]);
  }
}

TEST(Weld, DoesNotLetARowOfPointsRunTogether) {
  std::vector<glm::dvec3> row;
  for (int i = 0; i < 10; ++i) row.push_back({0.6 * i, 0, 0});
  // Each representative takes the one neighbour within 1 after it: 0.6 away, but not the next at 1.2.
  EXPECT_EQ(weld(input_of(row), 1).representative.size(), 5U);
}

TEST(Weld, ToleranceIsAMillionthOfTheDiagonal) {
  EXPECT_DOUBLE_EQ(weld_tolerance({{0, 0, 0}, {3, 4, 12}}), 13e-6);
}

}  // namespace
}  // namespace plisse
