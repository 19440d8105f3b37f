// Edges and flaps against Euler's formula and meshes small enough to list by hand.
#include "shell/topology.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shell/meshes.h"
#include "support/errors.h"

namespace plisse::shell {
namespace {

using testing::HasSubstr;

TEST(ShellTopology, TwoTriangles) {
  const Topology t = build_topology({{0, 1, 2}, {2, 1, 3}}, 4);
  ASSERT_EQ(t.edges.size(), 5u);
  const std::vector<std::array<std::uint32_t, 2>> expected = {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}};
  for (std::size_t e = 0; e < 5; ++e) EXPECT_EQ(t.edges[e].vertex, expected[e]);
  EXPECT_EQ(t.edges[2].face, (std::array<std::uint32_t, 2>{0, 1}));
  EXPECT_EQ(t.edges[2].opposite, (std::array<std::uint32_t, 2>{0, 3}));
  EXPECT_TRUE(t.edges[0].boundary());
  EXPECT_EQ(t.face_edges[0], (std::array<std::uint32_t, 3>{2, 1, 0}));
  EXPECT_EQ(t.flaps[0], (std::array<std::uint32_t, 3>{3, none, none}));
  EXPECT_EQ(t.flaps[1], (std::array<std::uint32_t, 3>{none, none, 0}));
}

TEST(ShellTopology, EulerAndComponents) {
  auto mesh = test::grid(7, 5, 1, 1, test::Diagonal::alternating);
  const auto first = static_cast<std::uint32_t>(mesh.positions.cols());
  mesh.faces.push_back({first, first + 1, first + 2});  // a triangle apart; vertex first + 3 has no face
  const Topology t = build_topology(mesh.faces, first + 4);
  // Two discs and an unused point: V − E + F = 2.
  EXPECT_EQ(
      static_cast<long>(first) + 3 - static_cast<long>(t.edges.size()) + static_cast<long>(t.faces.size()),
      2);
  EXPECT_EQ(t.component_count, 2u);
  EXPECT_EQ(t.component[first], 1u);
  EXPECT_EQ(t.component[first + 3], none);
  std::size_t boundary = 0;
  for (const Edge& edge : t.edges) boundary += edge.boundary() ? 1 : 0;
  EXPECT_EQ(boundary, 2u * (7 + 5) + 3);
}

TEST(ShellTopology, RefusesWhatIsNoShell) {
  const auto refused = [](std::vector<Face> faces) {
    return plisse::test::error_of([&] { build_topology(std::move(faces), 5); });
  };
  EXPECT_THAT(refused({{0, 1, 2}, {2, 1, 3}, {1, 2, 4}}), HasSubstr("edge 1-2 has 3 faces"));
  EXPECT_THAT(refused({{0, 1, 2}, {1, 2, 3}}), HasSubstr("faces 0 and 1 run along edge 1-2 the same way"));
  EXPECT_THAT(refused({{0, 1, 7}}), HasSubstr("face 0 names vertex 7, and there are 5"));
  EXPECT_THAT(refused({{0, 1, 1}, {0, 1, 9}}), HasSubstr("face 0 names a vertex twice"));
}

}  // namespace
}  // namespace plisse::shell
