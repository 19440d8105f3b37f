// Base surfaces and fields that were solved before: found by all that they depend on, the same to the last
// bit, and solved again where the file is not whole.
#include "cloth/solved_cache.h"

#include <gmock/gmock.h>

#include <chrono>
#include <functional>

#include "cloth/cached_solves.h"
#include "cloth/drape.h"
#include "cloth/drape_examples.h"
#include "cloth/wrinkle.h"
#include "support/files.h"

namespace plisse {
namespace {

namespace fs = std::filesystem;
using cloth::SolvedCache;

constexpr int some = 300;  // vertices: tens of milliseconds each

std::vector<fs::path> answers(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

cloth::DrapeReport draped(const cloth::DrapeScene& scene, const fs::path& output, const fs::path& cache) {
  return cloth::drape({scene, "", output, {}, cache});
}

TEST(SolvedCache, ABaseSurfaceIsSolvedOnceAndComesBackBitForBit) {
  const test::TemporaryFolder folder;
  cloth::DrapeScene scene = cloth::drape_example("twisted-cylinder", some);
  scene.frames = 3;
  draped(scene, folder / "alone.ply", {});
  const cloth::DrapeReport first = draped(scene, folder / "first.ply", folder / "cache"),
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

TEST(SolvedCache, WhateverAnAnswerDependsOnMakesItAnotherSlow) {
  const test::TemporaryFolder folder;
  const cloth::DrapeScene scene = cloth::drape_example("sphere-drape", 120);
  const cloth::SolvedCache cache(folder.path());
  struct Question {
    shell::Shell shell;
    shell::Conditions conditions;
    shell::Loads loads;
    shell::Positions start;
    shell::NewtonSettings settings;
  };
  Question usual{cloth::shell_of(scene), scene.conditions(1), scene.loads, scene.start, scene.newton};
  usual.settings.tolerance = 1e-4;
  const auto answered = [&](const std::function<void(Question&)>& change) {
    Question q = usual;
    change(q);
    cloth::Reuse reuse;
    cloth::cached_equilibrium(cache, reuse, q.shell, q.conditions, q.loads, q.start, q.settings);
    return reuse.answers;
  };
  const auto nothing = [](Question&) {};
  ASSERT_EQ(answered(nothing), 0);
  ASSERT_EQ(answered(nothing), 1);
  const Eigen::Index count = scene.start.cols();
  // Not one of these solves what was solved before, the usual or another of them.
  const std::pair<const char*, std::function<void(Question&)>> others[] = {
      {"young", [](Question& q) { q.shell.material.young *= 1.001; }},
      {"poisson", [](Question& q) { q.shell.material.poisson *= 1.001; }},
      {"thickness", [](Question& q) { q.shell.material.thickness *= 1.001; }},
      {"density", [](Question& q) { q.shell.material.density *= 1.001; }},
      {"residual", [](Question& q) { q.shell.residual = 1e-4; }},
      {"stretching", [](Question& q) { q.shell.stretching = shell::Stretching::stvk; }},
      {"kind of obstacle",
       [](Question& q) {
         q.loads.obstacles.front() = shell::Plane{{0, -1, 0}, {0, 1, 0}};
       }},
      {"bending", [](Question& q) { q.shell.bending = shell::Bending::midedge; }},
      {"rest", [](Question& q) { q.shell.rest[3].area *= 1.001; }},
      {"held where", [](Question& q) { q.conditions.hold(7, 1, q.start(1, 7) + 1e-9); }},
      {"held elsewhere", [](Question& q) { q.conditions.hold(7, 1, q.start(1, 7)); }},
      {"mirrors",
       [](Question& q) {
         q.conditions.mirrors = {{0, 0}};
       }},
      {"where a mirror is",
       [](Question& q) {
         q.conditions.mirrors = {{0, 1e-9}};
       }},
      {"its axis",
       [](Question& q) {
         q.conditions.mirrors = {{2, 0}};
       }},
      {"gravity", [](Question& q) { q.loads.gravity *= 1.001; }},
      {"forces",
       [=](Question& q) {
         q.loads.forces = shell::Positions::Zero(3, count);
         q.loads.forces(1, 5) = -1e-9;
       }},
      {"gap", [](Question& q) { q.loads.gap *= 1.001; }},
      {"contact stiffness", [](Question& q) { q.loads.contact_stiffness = 1e6; }},
      {"radius", [](Question& q) { std::get<shell::Sphere>(q.loads.obstacles.front()).radius *= 0.999; }},
      {"friction", [](Question& q) { q.loads.friction = 0.3; }},
      {"more friction", [](Question& q) { q.loads.friction = 0.301; }},
      {"slip",
       [](Question& q) {
         q.loads.friction = 0.3;
         q.loads.slip = 0.11 * q.loads.gap;
       }},
      {"anchors",
       [](Question& q) {
         q.loads.friction = 0.3;
         q.loads.anchors = {q.start};
       }},
      {"where an anchor is",
       [](Question& q) {
         q.loads.friction = 0.3;
         q.loads.anchors = {q.start};
         q.loads.anchors[0](2, 7) += 1e-9;
       }},
      {"start", [](Question& q) { q.start(1, 7) += 1e-9; }},
      {"tolerance", [](Question& q) { q.settings.tolerance *= 1.001; }},
      {"iterations", [](Question& q) { ++q.settings.max_iterations; }},
      {"seconds", [](Question& q) { q.settings.max_seconds = 1e4; }},
  };
  for (const auto& [what, change] : others) EXPECT_EQ(answered(change), 0) << what;
  EXPECT_EQ(answered(nothing), 1);
  // A place that is not held is not looked at.
  EXPECT_EQ(answered([](Question& q) {
              for (Eigen::Index v = 0; v < q.conditions.held.cols(); ++v)
                if (!q.conditions.held.col(v).any()) q.conditions.at.col(v).setConstant(3);
            }),
            1);
}

TEST(SolvedCache, AFieldIsSolvedOnceAndComesBackBitForBit) {
  const test::TemporaryFolder folder;
  cloth::WrinkleRequest request;
  request.scene = cloth::base_of(cloth::drape_example("stretched-sheet", some), folder / "cache");
  request.cache = folder / "cache";
  request.output = folder / "first.ply";
  EXPECT_FALSE(cloth::wrinkle_field(request).from_cache);
  request.output = folder / "again.ply";
  const cloth::WrinkleReport again = cloth::wrinkle_field(request);
  EXPECT_TRUE(again.from_cache);
  EXPECT_GT(again.saved_s, 0);
  request.cache.clear();
  request.output = folder / "alone.ply";
  const cloth::WrinkleReport alone = cloth::wrinkle_field(request);
  EXPECT_EQ(again.max_amplitude, alone.max_amplitude);
  EXPECT_EQ(again.field.waves, alone.field.waves);
  EXPECT_EQ(test::read_bytes(folder / "again.ply"), test::read_bytes(folder / "first.ply"));
  EXPECT_EQ(test::read_bytes(folder / "again.ply"), test::read_bytes(folder / "alone.ply"));
}

TEST(SolvedCache, WhateverAFieldDependsOnMakesItAnotherSlow) {
  const test::TemporaryFolder folder;
  cloth::WrinkleRequest request;
  request.scene = cloth::base_of(cloth::drape_example("stretched-sheet", some), folder / "cache");
  request.cache = folder / "cache";
  ASSERT_FALSE(cloth::wrinkle_field(request).from_cache);
  const std::pair<const char*, std::function<void(cloth::WrinkleRequest&)>> others[] = {
      {"curvature factor", [](cloth::WrinkleRequest& r) { r.curvature_factor = 1.44; }},
      {"v1", [](cloth::WrinkleRequest& r) { r.v1 = false; }},
      {"v2", [](cloth::WrinkleRequest& r) { r.v2 = false; }},
      {"relaxed integrability", [](cloth::WrinkleRequest& r) { r.relaxed_integrability = false; }},
      {"crest compression", [](cloth::WrinkleRequest& r) { r.crest_compression = true; }},
      {"frequency", [](cloth::WrinkleRequest& r) { r.options.frequency = 1.1; }},
      {"local law", [](cloth::WrinkleRequest& r) { r.options.local_law = true; }},
      {"all starts", [](cloth::WrinkleRequest& r) { r.options.all_starts = true; }},
      {"iterations", [](cloth::WrinkleRequest& r) { ++r.options.solve.max_iterations; }},
      {"held", [](cloth::WrinkleRequest& r) { r.pin_held = false; }},
      {"thickness", [](cloth::WrinkleRequest& r) { r.scene.material.thickness *= 1.001; }},
  };
  for (const auto& [what, change] : others) {
    cloth::WrinkleRequest other = request;
    change(other);
    EXPECT_FALSE(cloth::wrinkle_field(other).from_cache) << what;
  }
  EXPECT_TRUE(cloth::wrinkle_field(request).from_cache);
}

TEST(SolvedCache, WhatIsNotWholeIsSolvedAgain) {
  const test::TemporaryFolder folder;
  cloth::DrapeScene scene = cloth::drape_example("twisted-cylinder", some);
  scene.frames = 1;
  draped(scene, folder / "first.ply", folder / "cache");
  const auto files = answers(folder / "cache");
  ASSERT_EQ(files.size(), 1U);
  const auto whole = test::read_bytes(files[0]);
  const auto damaged = [&](const std::function<void(std::vector<std::uint8_t>&)>& damage) {
    auto bytes = whole;
    damage(bytes);
    test::write_text(files[0], std::string(bytes.begin(), bytes.end()));
    const cloth::DrapeReport report = draped(scene, folder / "again.ply", folder / "cache");
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
  const cloth::SolvedCache cache(folder.path(),
                                 350);  // three answers of a hundred bytes with their headers would be 516
  const std::vector<std::uint8_t> answer(100, 7);
  const auto question = [](int n) { return cloth::SolvedCache::question("test").add(n); };
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
  cloth::DrapeScene scene = cloth::drape_example("twisted-cylinder", some);
  scene.frames = 1;
  const cloth::DrapeReport report = draped(scene, folder / "base.ply", folder / "file");
  EXPECT_TRUE(report.converged);
  EXPECT_TRUE(fs::exists(folder / "base.ply"));
}

}  // namespace
}  // namespace plisse
