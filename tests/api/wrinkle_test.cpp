// <plisse/wrinkle.h> against the files of `plisse wrinkle`.
#include "plisse/wrinkle.h"

#include <gmock/gmock.h>

#include <cmath>

#include "cloth/drape_examples.h"
#include "cloth/wrinkle.h"
#include "io/mesh_file.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse {
namespace {

using ::testing::HasSubstr;

BaseSurface draped() {
  BaseSurface result;
  DrapeRequest request;
  request.example = "twisted-cylinder";
  request.vertices = 200;
  request.on_frame = [&](const DrapeFrame&, const BaseSurface& base) { result = base; };
  drape(request);
  return result;
}

TEST(PublicWrinkle, TheFieldIsThatOfTheFile) {
  const test::TemporaryFolder folder;
  cloth::WrinkleRequest of_file;
  of_file.scene = cloth::base_of(cloth::drape_example("twisted-cylinder", 200));
  of_file.output = folder / "field.ply";
  of_file.mesh = folder / "waves.ply";
  of_file.levels = 2;
  const cloth::WrinkleReport report = cloth::wrinkle_field(of_file);

  WrinkleRequest request;
  request.base = draped();
  request.mesh = true;
  request.levels = 2;
  const WrinkleResult found = solve_wrinkles(request);
  EXPECT_EQ(found.energy, report.field.real.energy);
  EXPECT_EQ(found.waves, report.field.waves);
  EXPECT_EQ(found.iterations, report.field.iterations);
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.levels, 2);

  const WrinkleField file = load_field(folder / "field.ply");
  EXPECT_EQ(found.field.positions, file.positions);
  EXPECT_EQ(found.field.triangles, file.triangles);
  EXPECT_EQ(found.field.amplitude, file.amplitude);
  EXPECT_EQ(found.field.phase, file.phase);
  // The geometry, by the writer of meshes: the same bytes.
  save_mesh(folder / "ours.ply", found.mesh);
  const Mesh theirs = load_mesh(folder / "waves.ply"), ours = load_mesh(folder / "ours.ply");
  EXPECT_EQ(ours.positions, theirs.positions);
  EXPECT_EQ(ours.triangles, theirs.triangles);

  // A difference of phase is that of the corners, up to whole turns where the surface closes round.
  ASSERT_EQ(found.phase_difference.size(), found.edges.size());
  for (std::size_t e = 0; e < found.edges.size(); ++e) EXPECT_LT(found.edges[e][0], found.edges[e][1]);

  request.free_held = true;
  EXPECT_NE(solve_wrinkles(request).field.amplitude, found.field.amplitude);
}

TEST(PublicWrinkle, FieldsComeBackFromFiles) {
  const test::TemporaryFolder folder;
  WrinkleField field;
  field.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  field.triangles = {{0, 1, 2}};
  field.amplitude = {0.1, 0.2, 1.0 / 3};
  field.phase = {{0, 7, 1.0 / 3}};
  save_field(folder / "field.ply", field);
  const WrinkleField read = load_field(folder / "field.ply");
  EXPECT_EQ(read.positions, field.positions);
  EXPECT_EQ(read.triangles, field.triangles);
  EXPECT_EQ(read.amplitude, field.amplitude);
  EXPECT_EQ(read.phase, field.phase);

  const auto complaint = [&] { return test::error_of([&] { save_field(folder / "no.ply", field); }); };
  field.amplitude[1] = -0.2;
  EXPECT_THAT(complaint(), HasSubstr("vertex 1: the amplitude is -0.2"));
  field.amplitude[1] = INFINITY;
  EXPECT_THAT(complaint(), HasSubstr("vertex 1: the amplitude is inf"));
  field.amplitude.pop_back();
  EXPECT_THAT(complaint(), HasSubstr("2 amplitudes; there have to be 3"));
  field.amplitude = {0.1, 0.2, 0.3};
  field.phase[0][2] = NAN;
  EXPECT_THAT(complaint(), HasSubstr("the phase of vertex 2 is not finite"));
  EXPECT_FALSE(std::filesystem::exists(folder / "no.ply"));
}

TEST(PublicWrinkle, RefusesASurfaceThatDoesNotHoldTogether) {
  WrinkleRequest request;
  request.base.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  request.base.triangles = {{0, 1, 2}};
  const auto complaint = [&] { return test::error_of([&] { solve_wrinkles(request); }); };
  EXPECT_THAT(complaint(), HasSubstr("base: 0 rest triangles; there have to be 1"));
  request.base.rest = {{{{0, 0}, {1, 0}, {2, 0}}}};
  EXPECT_THAT(complaint(), HasSubstr("Young's modulus"));
  request.base.material = {1e5, 0.3, 1e-3, 0};
  EXPECT_NE(complaint(), "");  // a rest triangle without area
  request.levels = 9;
  EXPECT_THAT(complaint(), HasSubstr("9 levels; allowed: 0 … 8"));
}

}  // namespace
}  // namespace plisse
