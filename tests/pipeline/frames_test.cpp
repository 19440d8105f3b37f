// A frame is the same bytes however it was come by: alone, in chunks, in a whole run, from a state file, or
// anew because its file had come to harm.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "base/error.h"
#include "config/scene_file.h"
#include "pipeline/render.h"
#include "support/files.h"
#include "support/gltf.h"
#include "support/opengl.h"

namespace plisse {
namespace {

using test::TemporaryFolder;

class Frames : public test::DriverTest {};

// The sleeve, small.
pipeline::RenderRequest small_sleeve(const std::filesystem::path& folder, const std::string& frames) {
  pipeline::RenderRequest request;
  request.scene = config::load_scene(test::asset("sleeve.toml"));
  request.scene.output.width = 64;
  request.scene.output.height = 48;
  request.scene.output.path = folder.string();
  request.scene.model.frames = frames;
  return request;
}

std::filesystem::path frame(const std::filesystem::path& folder, int number) {
  const std::string digits = std::to_string(number);
  return folder / ("frame_" + std::string(4 - digits.size(), '0') + digits + ".png");
}

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& folder, int number) {
  auto bytes = test::read_bytes(frame(folder, number));
  EXPECT_GT(bytes.size(), 100U) << frame(folder, number);
  return bytes;
}

pipeline::RenderReport run(const pipeline::RenderRequest& request) {
  return pipeline::render(request, {});
}

// The sleeve with another texture.
std::string other_print(const std::filesystem::path& file) {
  return test::altered_glb(test::asset("sleeve.glb"), file,
                           [](nlohmann::json& gltf) { gltf["textures"][1]["source"] = 0; })
      .string();
}

struct Variant {
  bool loop;
  int interval;
};
std::string name_of(const Variant& variant) {
  return (variant.loop ? "LoopInterval" : "OnceInterval") + std::to_string(variant.interval);
}
void PrintTo(const Variant& variant, std::ostream* out) {
  *out << name_of(variant);
}
class FrameIdentity : public Frames, public ::testing::WithParamInterface<Variant> {};

TEST_P(FrameIdentity, AloneInChunksAndInAWholeRun) {
  const TemporaryFolder whole, alone, chunks;
  const auto request = [&](const TemporaryFolder& folder, const std::string& frames) {
    pipeline::RenderRequest result = small_sleeve(folder.path(), frames);
    result.scene.model.loop = GetParam().loop;
    result.scene.relax.interval = GetParam().interval;
    return result;
  };
  run(request(whole, "1-24"));
  run(request(alone, "20"));
  EXPECT_EQ(bytes_of(alone.path(), 20), bytes_of(whole.path(), 20));
  for (const std::string chunk : {"13-16", "17-20", "21-24"}) run(request(chunks, chunk));
  for (int n = 13; n <= 24; ++n) EXPECT_EQ(bytes_of(chunks.path(), n), bytes_of(whole.path(), n)) << n;
  // And they are no still life.
  EXPECT_NE(bytes_of(whole.path(), 19), bytes_of(whole.path(), 20));
}
INSTANTIATE_TEST_SUITE_P(Sleeve, FrameIdentity,
                         ::testing::Values(Variant{false, 1}, Variant{false, 3}, Variant{true, 1},
                                           Variant{true, 3}),
                         [](const auto& variant) { return name_of(variant.param); });

TEST_F(Frames, AStateFileGoesOnWhereItStoppedSlow) {
  const TemporaryFolder whole, parts;
  run(small_sleeve(whole.path(), "1-24"));
  const auto go_on = [&](const std::string& frames) {
    pipeline::RenderRequest request = small_sleeve(parts.path(), frames);
    request.state_file = (parts / "sleeve.state").string();
    return run(request);
  };
  go_on("1-8");
  ASSERT_TRUE(std::filesystem::exists(parts / "sleeve.state"));
  go_on("9-16");
  go_on("17-24");
  for (int n = 1; n <= 24; ++n) EXPECT_EQ(bytes_of(parts.path(), n), bytes_of(whole.path(), n)) << n;
  go_on("12");  // behind the state: steps from the start
  EXPECT_EQ(bytes_of(parts.path(), 12), bytes_of(whole.path(), 12));

  // A state that is damaged, cut short, made by other settings or no state at all changes nothing.
  go_on("1-8");
  const std::string good = test::read_text(parts / "sleeve.state");
  std::string damaged = good;
  damaged[good.size() / 2] = static_cast<char>(damaged[good.size() / 2] ^ 1);
  pipeline::RenderRequest other = small_sleeve(parts.path(), "1-8");
  other.scene.wrinkles.seed = 99;
  other.state_file = (parts / "other.state").string();
  run(other);
  for (const std::string& content : {damaged, good.substr(0, good.size() / 2),
                                     test::read_text(parts / "other.state"), std::string("nonsense")}) {
    test::write_text(parts / "sleeve.state", content);
    testing::internal::CaptureStderr();
    go_on("20");
    EXPECT_THAT(testing::internal::GetCapturedStderr(), ::testing::HasSubstr("sleeve.state"));
    EXPECT_EQ(bytes_of(parts.path(), 20), bytes_of(whole.path(), 20));
  }
}

TEST_F(Frames, SkipExistingTrustsOnlyWholeFramesOfTheSameScene) {
  const TemporaryFolder folder;
  pipeline::RenderRequest request = small_sleeve(folder.path(), "1-6");
  request.scene.model.loop = false;
  run(request);
  std::vector<std::vector<std::uint8_t>> good;
  for (int n = 1; n <= 6; ++n) good.push_back(bytes_of(folder.path(), n));
  request.skip_existing = true;
  const auto rendered_again = [&](const pipeline::RenderRequest& with) {
    std::vector<int> frames;
    for (const pipeline::FrameReport& report : run(with).frames) {
      if (!report.skipped) frames.push_back(report.frame);
    }
    return frames;
  };
  EXPECT_TRUE(rendered_again(request).empty());

  const auto spoil = [&](int n, const std::vector<std::uint8_t>& bytes) {
    test::write_text(frame(folder.path(), n), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  auto cut = good[1];
  cut.resize(cut.size() - 20);
  spoil(2, cut);
  auto flipped = good[3];
  flipped[flipped.size() / 2] ^= 0x40;
  spoil(4, flipped);
  spoil(5, {});
  std::filesystem::remove(frame(folder.path(), 6));
  EXPECT_EQ(rendered_again(request), (std::vector<int>{2, 4, 5, 6}));
  for (int n = 1; n <= 6; ++n)
    EXPECT_EQ(bytes_of(folder.path(), n), good[static_cast<std::size_t>(n - 1)]) << n;

  // One frame of another look among them.
  pipeline::RenderRequest other = small_sleeve(folder.path(), "3");
  other.scene.model.loop = false;
  other.scene.shading.roughness = 0.4;
  run(other);
  EXPECT_NE(bytes_of(folder.path(), 3), good[2]);
  EXPECT_EQ(rendered_again(request), std::vector<int>{3});
  EXPECT_EQ(bytes_of(folder.path(), 3), good[2]);
}

// Whatever decides a pixel counts: a frame of another scene is never taken for one of this. Each alteration
// meets a frame that is trusted until then.
TEST_F(Frames, SkipExistingKnowsWhateverDecidesAPixelSlow) {
  const TemporaryFolder folder;
  pipeline::RenderRequest request = small_sleeve(folder.path(), "2");
  request.scene.model.loop = false;
  request.skip_existing = true;
  const auto rendered_again = [&](const pipeline::RenderRequest& with) {
    int count = 0;
    for (const pipeline::FrameReport& report : run(with).frames) count += report.skipped ? 0 : 1;
    return count;
  };
  using Alteration = std::function<void(pipeline::RenderRequest&)>;
  const std::vector<std::pair<std::string, Alteration>> alterations = {
      {"strength", [](pipeline::RenderRequest& r) { r.scene.wrinkles.strength = 0.5; }},
      {"seed", [](pipeline::RenderRequest& r) { r.scene.wrinkles.seed = 5; }},
      {"profile", [](pipeline::RenderRequest& r) { r.scene.wrinkles.profile = "accordion"; }},
      {"wavelength", [](pipeline::RenderRequest& r) { r.scene.wrinkles.wavelength *= 1.01; }},
      {"rounds", [](pipeline::RenderRequest& r) { r.scene.relax.rounds = 2; }},
      {"loop", [](pipeline::RenderRequest& r) { r.scene.model.loop = true; }},
      {"samples", [](pipeline::RenderRequest& r) { r.scene.output.samples = 1; }},
      {"background", [](pipeline::RenderRequest& r) { r.scene.output.background.x *= 0.9F; }},
      {"ground", [](pipeline::RenderRequest& r) { r.scene.output.ground = !r.scene.output.ground; }},
      {"key light", [](pipeline::RenderRequest& r) { r.scene.light.key_intensity = 1; }},
      {"focal length", [](pipeline::RenderRequest& r) { r.scene.camera.focal_length = 80; }},
      {"roughness", [](pipeline::RenderRequest& r) { r.scene.shading.roughness = 0.4; }},
      {"texture",
       [&](pipeline::RenderRequest& r) { r.scene.model.path = other_print(folder.path() / "print.glb"); }},
  };
  rendered_again(request);
  for (const auto& [name, alter] : alterations) {
    ASSERT_EQ(rendered_again(request), 0) << "before " << name;
    pipeline::RenderRequest altered = request;
    alter(altered);
    EXPECT_EQ(rendered_again(altered), 1) << name;
    EXPECT_EQ(rendered_again(request), 1) << "after " << name;
  }
}

TEST_F(Frames, SkipExistingTrustsDataPicturesAndShadersToo) {
  const TemporaryFolder folder, shaders;
  pipeline::RenderRequest request = small_sleeve(folder.path(), "2");
  request.scene.model.loop = false;
  request.aovs = {"height"};
  run(request);
  request.skip_existing = true;
  const auto is_skipped = [&] { return run(request).frames.at(0).skipped; };
  EXPECT_TRUE(is_skipped());
  std::filesystem::remove(folder / "frame_0002.height.exr");
  EXPECT_FALSE(is_skipped());
  EXPECT_TRUE(is_skipped());
  request.aovs = {"height", "depth"};
  EXPECT_FALSE(is_skipped());

  std::filesystem::copy(
      test::source_file("shaders"), shaders.path(),
      std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  request.shader_folder = shaders.path().string();
  EXPECT_TRUE(is_skipped()) << "the same shaders from a folder";
  const auto shading = shaders / "common" / "shading.glsl";
  test::write_text(shading, test::read_text(shading) + "// another\n");
  EXPECT_FALSE(is_skipped());
}

TEST_F(Frames, NothingElseIsLeftInTheFolder) {
  const TemporaryFolder folder;
  pipeline::RenderRequest request = small_sleeve(folder.path() / "deep" / "er", "1-3");
  request.scene.model.loop = false;
  request.aovs = {"height", "normal"};
  run(request);
  EXPECT_EQ(test::names_in(folder.path() / "deep" / "er").size(), 3U * (1 + 2 * 2));
  for (const auto& name : test::names_in(folder.path() / "deep" / "er"))
    EXPECT_THAT(name, ::testing::StartsWith("frame_000"));
}

TEST_F(Frames, AFolderThatCannotBeMadeIsNoOutput) {
  const TemporaryFolder folder;
  test::write_text(folder / "file", "in the way");
  pipeline::RenderRequest request = small_sleeve(folder / "file" / "frames", "1");
  request.scene.model.loop = false;
  const pipeline::RenderReport report = run(request);
  EXPECT_EQ(report.outcome, ExitCode::no_output);
  EXPECT_THAT(report.failure, ::testing::HasSubstr("file"));
  ASSERT_EQ(report.frames.size(), 1U);
  EXPECT_EQ(report.frames[0].error, report.failure);
  EXPECT_EQ(test::read_text(folder / "file"), "in the way");
  EXPECT_EQ(test::names_in(folder.path()), std::vector<std::string>{"file"});
}

TEST_F(Frames, TheReportCountsThem) {
  const TemporaryFolder folder;
  pipeline::RenderRequest request = small_sleeve(folder.path(), "1-9x4");
  int calls = 0;
  const pipeline::RenderReport report =
      pipeline::render(request, [&](int done, int total, const pipeline::FrameReport& entry) {
        EXPECT_EQ(done, ++calls);
        EXPECT_EQ(total, 3);
        EXPECT_EQ(entry.error, "");
      });
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(report.welded_vertices, 450U);  // assets/README.md
  EXPECT_EQ(report.triangles, 864U);
  ASSERT_EQ(report.frames.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const pipeline::FrameReport& entry = report.frames[i];
    EXPECT_EQ(entry.frame, 1 + 4 * static_cast<int>(i));
    EXPECT_NEAR(entry.time_s, (entry.frame - 1) / 24.0, 1e-12);
    EXPECT_EQ(entry.path, frame(folder.path(), entry.frame).string());
    for (const std::string stage : {"skin", "crush", "relax", "render", "readback", "encode", "write"}) {
      EXPECT_EQ(entry.ms.count(stage), 1U) << stage;
    }
  }
}

}  // namespace
}  // namespace plisse
