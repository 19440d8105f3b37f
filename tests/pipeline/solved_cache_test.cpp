// Base surfaces and fields that were solved before: found by all that they depend on, the same to the last
// bit, and solved again where the file is not whole.
#include "pipeline/solved_cache.h"

#include <gmock/gmock.h>

#include <chrono>
#include <functional>

#include "pipeline/cached_solves.h"
#include "pipeline/drape.h"
#include "pipeline/drape_examples.h"
#include "pipeline/wrinkle.h"
#include "support/files.h"

namespace plisse {
namespace {

namespace fs = std::filesystem;
using pipeline::SolvedCache;

constexpr int some = 300;  // vertices: tens of milliseconds each

std::vector<fs::path> answers(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

DrapeReport draped(const DrapeScene& scene, const fs::path& output, const fs::path& cache) {
  return drape({scene, "", output, {}, cache});
}

TEST(SolvedCache, ABaseSurfaceIsSolvedOnceAndComesBackBitForBit) {
  const test::TemporaryFolder folder;
  DrapeScene scene = drape_example("twisted-cylinder", some);
  scene.frames = 3;
  draped(scene, folder / "alone.ply", {});
  const DrapeReport first = draped(scene, folder / "first.ply", folder / "cache"),
                    again = draped(scene, folder / "again.ply", folder / "cache");
  EXPECT_EQ(first.from_cache, 0);
  EXPECT_EQ(first.saved_s, 0);
  EXPECT_GE(again.from_cache, 2);  // the first frame has nothing to do
  EXPECT_GT(again.saved_s, 0);
  EXPECT_EQ(test::read_bytes(folder / "again.ply"), test::read_bytes(folder / "first.ply"));
  EXPECT_EQ(test::read_bytes(folder / "again.ply"), test::read_bytes(folder / "alone.ply"));
  const auto &told = first.frames.back().equilibrium, &known = again.frames.back().equilibrium;
  EXPECT_EQ(known.energy, told.energy);
  EXPECT_EQ(known.reason, told.reason);
  EXPECT_EQ(known.iterations, told.iterations);
  ASSERT_EQ(known.trace.size(), told.trace.size());
  EXPECT_EQ(known.trace.back().gradient_inf, told.trace.back().gradient_inf);
}

TEST(SolvedCache, WhateverAnAnswerDependsOnMakesItAnother) {
  const test::TemporaryFolder folder;
  const DrapeScene scene = drape_example("sphere-drape", some);
  const shell::Conditions held = scene.conditions(1);
  const shell::Shell shell = shell_of(scene);
  const SolvedCache cache(folder.path());
  const auto answered = [&](const std::function<void(shell::Shell&, shell::Conditions&, shell::Loads&,
                                                     shell::Positions&, shell::NewtonSettings&)>& change) {
    shell::Shell other = shell;
    shell::Conditions conditions = held;
    shell::Loads loads = scene.loads;
    shell::Positions start = scene.start;
    shell::NewtonSettings settings = scene.newton;
    settings.tolerance = 1e-4;
    change(other, conditions, loads, start, settings);
    pipeline::Reuse reuse;
    pipeline::cached_equilibrium(cache, reuse, other, conditions, loads, start, settings);
    return reuse.answers;
  };
  const auto nothing = [](auto&, auto&, auto&, auto&, auto&) {};
  ASSERT_EQ(answered(nothing), 0);
  ASSERT_EQ(answered(nothing), 1);
  EXPECT_EQ(answered([](auto& s, auto&, auto&, auto&, auto&) { s.material.thickness *= 1.001; }), 0);
  EXPECT_EQ(answered([](auto& s, auto&, auto&, auto&, auto&) { s.residual = 1e-4; }), 0);
  EXPECT_EQ(answered([](auto&, auto&, auto& l, auto&, auto&) { l.gravity *= 1.001; }), 0);
  EXPECT_EQ(answered([](auto&, auto&, auto& l, auto&, auto&) { l.gap *= 1.001; }), 0);
  EXPECT_EQ(answered([](auto&, auto&, auto& l, auto&, auto&) {
              std::get<shell::Sphere>(l.obstacles.front()).radius *= 0.999;
            }),
            0);
  EXPECT_EQ(answered([](auto&, auto&, auto&, auto& p, auto&) { p(1, 7) += 1e-9; }), 0);
  EXPECT_EQ(answered([](auto&, auto&, auto&, auto&, auto& n) { n.tolerance *= 1.001; }), 0);
  EXPECT_EQ(answered(nothing), 1);
  // A place that is not held is not looked at.
  EXPECT_EQ(answered([](auto&, auto& c, auto&, auto&, auto&) {
              for (Eigen::Index v = 0; v < c.held.cols(); ++v)
                if (!c.held.col(v).any()) c.at.col(v).setConstant(3);
            }),
            1);
}

TEST(SolvedCache, AFieldIsSolvedOnceAndComesBackBitForBit) {
  const test::TemporaryFolder folder;
  WrinkleRequest request;
  request.scene = base_of(drape_example("stretched-sheet", some), folder / "cache");
  request.cache = folder / "cache";
  request.output = folder / "first.ply";
  EXPECT_FALSE(wrinkle_field(request).from_cache);
  request.output = folder / "again.ply";
  const WrinkleReport again = wrinkle_field(request);
  EXPECT_TRUE(again.from_cache);
  EXPECT_GT(again.saved_s, 0);
  request.cache.clear();
  request.output = folder / "alone.ply";
  const WrinkleReport alone = wrinkle_field(request);
  EXPECT_EQ(again.max_amplitude, alone.max_amplitude);
  EXPECT_EQ(again.field.waves, alone.field.waves);
  EXPECT_EQ(test::read_bytes(folder / "again.ply"), test::read_bytes(folder / "first.ply"));
  EXPECT_EQ(test::read_bytes(folder / "again.ply"), test::read_bytes(folder / "alone.ply"));

  request.cache = folder / "cache";
  request.curvature_factor = 1.44;
  EXPECT_FALSE(wrinkle_field(request).from_cache);
  request.curvature_factor = 1;
  request.options.frequency = 1.1;
  EXPECT_FALSE(wrinkle_field(request).from_cache);
  request.options.frequency = 1;
  request.pin_held = false;
  EXPECT_FALSE(wrinkle_field(request).from_cache);
}

TEST(SolvedCache, WhatIsNotWholeIsSolvedAgain) {
  const test::TemporaryFolder folder;
  DrapeScene scene = drape_example("twisted-cylinder", some);
  scene.frames = 1;
  draped(scene, folder / "first.ply", folder / "cache");
  const auto files = answers(folder / "cache");
  ASSERT_EQ(files.size(), 1U);
  const auto whole = test::read_bytes(files[0]);
  const auto damaged = [&](const std::function<void(std::vector<std::uint8_t>&)>& damage) {
    auto bytes = whole;
    damage(bytes);
    test::write_text(files[0], std::string(bytes.begin(), bytes.end()));
    const DrapeReport report = draped(scene, folder / "again.ply", folder / "cache");
    EXPECT_EQ(report.from_cache, 0);
    EXPECT_EQ(test::read_bytes(folder / "again.ply"), test::read_bytes(folder / "first.ply"));
  };
  damaged([](auto& bytes) { bytes.clear(); });
  damaged([](auto& bytes) { bytes.resize(40); });
  damaged([](auto& bytes) { bytes.pop_back(); });
  damaged([](auto& bytes) { bytes[bytes.size() / 2] ^= 1; });
  damaged([](auto& bytes) { bytes[0] = 'q'; });
  EXPECT_EQ(draped(scene, folder / "again.ply", folder / "cache").from_cache, 1);
}

TEST(SolvedCache, WhatWasUsedLongestAgoMakesRoom) {
  const test::TemporaryFolder folder;
  const SolvedCache cache(folder.path(),
                          350);  // three answers of a hundred bytes with their headers would be 516
  const std::vector<std::uint8_t> answer(100, 7);
  const auto question = [](int n) { return SolvedCache::question("test").add(n); };
  const auto age = [&](int n, int hours) {
    fs::last_write_time(folder / (question(n).hex() + ".solved"),
                        fs::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  cache.keep(question(1), answer);
  age(1, 3);
  cache.keep(question(2), answer);
  age(2, 2);
  EXPECT_TRUE(cache.find(question(1)));  // now it is the second that was used longest ago
  cache.keep(question(3), answer);
  EXPECT_TRUE(cache.find(question(1)));
  EXPECT_FALSE(cache.find(question(2)));
  EXPECT_EQ(cache.find(question(3)), answer);
}

TEST(SolvedCache, AFolderThatCannotBeWrittenIsNoFailure) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "file", "in the way");
  DrapeScene scene = drape_example("twisted-cylinder", some);
  scene.frames = 1;
  const DrapeReport report = draped(scene, folder / "base.ply", folder / "file");
  EXPECT_TRUE(report.converged);
  EXPECT_TRUE(fs::exists(folder / "base.ply"));
}

}  // namespace
}  // namespace plisse
