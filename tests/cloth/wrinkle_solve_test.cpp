// What is easy to get wrong on draped surfaces: nothing where nothing wrinkles, and few steps for long waves.
#include <gtest/gtest.h>

#include "cloth/drape_examples.h"
#include "cloth/wrinkle.h"

namespace plisse {
namespace {

cloth::WrinkleRequest untwisted_tube(int vertices) {
  cloth::DrapeScene scene = cloth::drape_example("twisted-cylinder", vertices);
  scene.conditions = [all = scene.conditions](double) { return all(0); };
  cloth::WrinkleRequest request;
  request.scene = cloth::base_of(scene);
  return request;
}

// Its facets are shorter than the arcs over them, which looks like compression round it.
TEST(Calm, AnUntwistedTubeHasNoWaves) {
  for (const int vertices : {342, 688}) {
    cloth::WrinkleRequest request = untwisted_tube(vertices);
    const cloth::WrinkleReport calm = cloth::wrinkle_field(request);
    EXPECT_EQ(calm.max_amplitude, 0) << vertices;
    EXPECT_EQ(calm.field.waves, 0) << vertices;
    EXPECT_EQ(calm.field.iterations, 0) << vertices;
    EXPECT_EQ(calm.wrinkle_free_faces, calm.faces) << vertices;
    request.chords = request.noise = false;
    EXPECT_GT(cloth::wrinkle_field(request).max_amplitude, 1e-3) << vertices;  // else this shows nothing
  }
}

// Twisted by ten degrees, ten to forty times as compressed, it is hardly changed.
TEST(Calm, ATwistedTubeKeepsItsWaves) {
  cloth::WrinkleRequest request;
  request.scene = cloth::base_of(cloth::drape_example("twisted-cylinder", 1300));
  const cloth::WrinkleReport with = cloth::wrinkle_field(request);
  request.chords = request.noise = false;
  const cloth::WrinkleReport without = cloth::wrinkle_field(request);
  EXPECT_NEAR(with.field.waves, without.field.waves, 2);
  EXPECT_NEAR(with.field.whole.energy / without.field.whole.energy, 1, 0.01);
}

// Heights make up for frequencies, and many go to 0: what descends by a Hessian that is made positive
// definite crawls here for hundreds of steps (156 after the search, 600 factorisations).
TEST(LongWaves, TakeFewSteps) {
  cloth::WrinkleRequest request;
  request.scene = cloth::base_of(cloth::drape_example("stretched-sheet", 1000));
  const cloth::WrinkleReport report = cloth::wrinkle_field(request);
  EXPECT_TRUE(report.field.real.converged) << report.field.real.reason;
  EXPECT_NEAR(report.field.waves, 5.24, 0.1);
  EXPECT_NEAR(report.field.wavelength, 13.8e-3, 1e-3);  // mid-sheet, at 248 … 2,000 vertices 13.8 … 14.2 mm
  EXPECT_LT(report.field.factorisations, 150);
}

}  // namespace
}  // namespace plisse
