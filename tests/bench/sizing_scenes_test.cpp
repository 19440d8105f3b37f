// The experiments of the suite `sizing`: answers that are known without them.
#include "bench/sizing_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cloth/drape.h"
#include "sizing/rules.h"

namespace plisse::bench {
namespace {

shell::Equilibrium solved(const cloth::DrapeScene& scene) {
  return shell::find_equilibrium(cloth::shell_of(scene), scene.conditions(1), scene.loads, scene.start,
                                 scene.newton);
}

// wL³/B = 5 lets the tip drop by .495905 L (docs/drape.md); 20,000 steps of fourth order leave 1e-9.
TEST(SizingScenes, TheBeamIsTheHeavyElastica) {
  Strip strip;
  strip.length = std::cbrt(5 * strip.bending / (strip.weight * 9.81));
  EXPECT_NEAR(sag_of_beam(strip) / strip.length, 0.495905, 1e-6);
}

// Clamped half an edge back, squares converge as their edge squared.
TEST(SizingScenes, TheStripSettlesOnTheBeam) {
  const Strip strip;
  const double truth = sag_of_beam(strip);
  const auto off = [&](double edge) {
    const auto strip_at = solved(strip_scene(strip, edge, StripMesh::regular, shell::Bending::midedge));
    EXPECT_TRUE(strip_at.converged);
    return std::abs(sag_of(strip_at.positions) - truth);
  };
  const double coarse = off(8e-3), fine = off(4e-3);
  EXPECT_LT(coarse, 0.03 * strip.length);
  EXPECT_GT(coarse / fine, 3);  // 4 in the limit
}

TEST(SizingScenes, TheSheetIsMeshedWithTheEdgesAskedFor) {
  for (const double edge : {8e-3, 4e-3}) {
    const cloth::DrapeScene scene = sheet_scene(edge, false);
    // (2/√3) A/r² + P/2r + 1, and the mesher keeps 15 % (docs/sizing.md).
    const double expected = 2 / std::sqrt(3.0) * 0.025 / (edge * edge) + 0.35 / edge + 1;
    EXPECT_NEAR(static_cast<double>(scene.start.cols()) / expected, 1, 0.15);
  }
  EXPECT_EQ(sheet_scene(5e-3, true).start.cols(), 51 * 21);
}

// The equilibrium does not remember where the start changed from one wave to the other; and it is where
// Vandeparre et al.'s law for light sheets gives it, with a prefactor of order 1 that is not published.
TEST(SizingScenesSlow, TheCurtainFindsItsOwnTransition) {
  Curtain curtain;
  curtain.height = 0.1;
  Transition found[2];
  for (const int i : {0, 1}) {
    const cloth::DrapeScene scene = curtain_scene(curtain, 1.2e-3, i == 0 ? 0.02 : 0.04);
    const auto drape = solved(scene);
    EXPECT_TRUE(drape.converged);
    found[i] = transition_of(curtain, scene, drape.positions);
  }
  EXPECT_NEAR(found[0].most, found[1].most, 1e-3);
  EXPECT_LT(found[0].half, found[0].most);
  const double law =
      sizing::compression_transition(curtain.wavelength, curtain.compression,
                                     sizing::effective_thickness({curtain.bending, curtain.modulus}, 0.3));
  EXPECT_NEAR(found[0].most / law, 1, 0.3);
}

}  // namespace
}  // namespace plisse::bench
