// Evaluation of fields from another program: the faces on which their phases have to be closed.
#include <gtest/gtest.h>

#include <algorithm>

#include "cloth/drape_examples.h"
#include "cloth/wrinkle.h"
#include "support/files.h"
#include "wrinkle/wrinkle_free.h"

namespace plisse {
namespace {

// Phases turn by 1 along one edge, which no face beside it closes over.
TEST(WrinkleEvaluation, CurlCountsWhereItHasToBeZero) {
  const test::TemporaryFolder folder;
  cloth::WrinkleRequest request;
  request.scene = cloth::base_of(cloth::drape_example("sphere-drape", 200));
  request.pin_held = false;
  const shell::Topology& topology = request.scene.surface.topology;
  const auto free = wrinkle::wrinkle_free_faces(wrinkle::face_forms(request.scene.surface, request.curvature),
                                                topology, request.rule);
  // An inner edge whose two faces are wrinkle-free, or not.
  const auto edge_between = [&](bool wanted) {
    const auto found = std::find_if(topology.edges.begin(), topology.edges.end(), [&](const auto& edge) {
      return !edge.boundary() && free[edge.face[0]] == wanted && free[edge.face[1]] == wanted;
    });
    EXPECT_NE(found, topology.edges.end());
    return static_cast<std::size_t>(found - topology.edges.begin());
  };
  const auto curl_of = [&](std::size_t turned, bool relaxed) {
    std::string amplitudes, phases;
    for (std::uint32_t v = 0; v < topology.vertex_count; ++v) amplitudes += "0\n";
    for (std::size_t e = 0; e < topology.edges.size(); ++e) phases += e == turned ? "1\n" : "0\n";
    test::write_text(folder / "amplitude.txt", amplitudes);
    test::write_text(folder / "dphi.txt", phases);
    request.relaxed_integrability = relaxed;
    return cloth::evaluate_field(request, folder / "amplitude.txt", folder / "dphi.txt").curl_max;
  };
  const std::size_t without_waves = edge_between(true), with_waves = edge_between(false);
  EXPECT_EQ(curl_of(without_waves, true), 0);
  EXPECT_EQ(curl_of(without_waves, false), 1);
  EXPECT_EQ(curl_of(with_waves, true), 1);
  EXPECT_EQ(curl_of(with_waves, false), 1);
}

}  // namespace
}  // namespace plisse
