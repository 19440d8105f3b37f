// Every malformed or odd file of ../shared/data/bad-models through the finished program: a message with the
// file's name and exit 2, or a picture that shows something; never a signal, never exit 0 without a picture.
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "system/plisse.h"

namespace plisse::test {
namespace {

namespace fs = std::filesystem;

class BadModels : public Program {};

// Odd but sound: each was looked at. All others must be refused.
const std::set<std::string>& sound() {
  static const std::set<std::string> files = {
      "close_to_identity_transforms.fbx",    // pivots of almost nothing
      "cubes_nonames.fbx",                   // objects without names
      "cubes_with_mirroring_and_pivot.fbx",  // negative scales
      "cubes_with_outofrange_float.fbx",     // a number that no float can hold, in a light
      "BoxBadNormals.glb",                   // normals that are not of unit length
      "Cube.gltf",                           // arrays of a vertex too many or too few for whole triangles
      "texcoord_crash.gltf",                 // meshes with and without uv that share materials
      "badString.gltf",                      // a number where a name should be
  };
  return files;
}

TEST_F(BadModels, AreRefusedOrDrawn) {
  const fs::path folder = shared_data("bad-models");
  if (!fs::exists(folder)) GTEST_SKIP() << "no ../shared/data/bad-models beside the project";
  const TemporaryFolder output;
  int files = 0, drawn = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string ending = entry.path().extension().string();
    if (!entry.is_regular_file() || ending == ".txt" || ending == ".bin" || ending == ".png") continue;
    SCOPED_TRACE(entry.path().string());
    ++files;
    const std::string picture = (output / (std::to_string(files) + "_#.png")).string();
    const Outcome outcome =
        plisse({"render", entry.path().string(), "-o", picture, "--frames", "1", "--size", "64x64"});
    if (outcome.code == 2) {
      EXPECT_FALSE(sound().contains(entry.path().filename().string())) << outcome.err;
      EXPECT_THAT(outcome.err, testing::HasSubstr(entry.path().filename().string()));
      EXPECT_THAT(outcome.err, testing::HasSubstr("error: "));
      continue;
    }
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(sound().contains(entry.path().filename().string())) << "drawn, but is it sound?";
    ++drawn;
    const io::Image image = io::load_image(output / (std::to_string(files) + "_1.png"));
    // The backdrop shades smoothly from row to row; a surface in front of it does not. A model that is fitted
    // into the picture differs from its left border on more than a twentieth of the pixels.
    int different = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const auto at = [&](int column, int channel) {
          return static_cast<int>(
              image.rgba[static_cast<std::size_t>(4 * (y * image.width + column) + channel)]);
        };
        different += std::abs(at(x, 0) - at(0, 0)) + std::abs(at(x, 1) - at(0, 1)) > 24 ? 1 : 0;
      }
    EXPECT_GT(different, image.width * image.height / 20) << "a blank picture";
  }
  EXPECT_GE(files, 40);  // the folder holds 44
  EXPECT_EQ(drawn, static_cast<int>(sound().size()));
}

TEST_F(BadModels, SkeletonsAloneAreRefused) {
  const fs::path file = shared_data("models/cmu_01_01.bvh");
  if (!fs::exists(file)) GTEST_SKIP() << "no ../shared/data/models beside the project";
  const TemporaryFolder output;
  const Outcome outcome = plisse({"render", file.string(), "-o", output.path().string()});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, testing::HasSubstr("no triangles"));
  EXPECT_TRUE(names_in(output.path()).empty());
}

// First and last frame, --fps other than the file's and --frames past the end, of a clip of 3 s: 73 frames
// at 24.
TEST_F(BadModels, FramesOfAClip) {
  const TemporaryFolder output;
  const std::string model = asset("sleeve.glb").string(), report = (output / "r.json").string();
  const auto times = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"render", model,   "-o",     output.path().string(),
                                          "--size", "32x32", "--json", report};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = plisse(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::vector<std::pair<int, double>> result;
    const auto parsed = nlohmann::json::parse(read_text(report));
    for (const auto& frame : parsed["frames"])
      result.emplace_back(frame["frame"].get<int>(), frame["time_s"].get<double>());
    return result;
  };
  const Outcome info = plisse({"info", model, "--json", report, "-q"});
  ASSERT_EQ(info.code, 0) << info.err;
  const auto clip = nlohmann::json::parse(read_text(report))["clips"][0];
  const double duration = clip["duration_s"];
  const int last = clip["frames"];
  EXPECT_EQ(last, static_cast<int>(std::floor(duration * 24 + 1e-3)) + 1);
  using Frames = std::vector<std::pair<int, double>>;
  EXPECT_EQ(times({"--frames", "1"}), (Frames{{1, 0.0}}));
  EXPECT_EQ(times({"--frames", std::to_string(last)}), (Frames{{last, (last - 1) / 24.0}}));
  // At another rate the clip is as long, so it has other frames: at 2 a second, one every half second.
  const int slow = static_cast<int>(std::floor(duration * 2 + 1e-3)) + 1;
  const Frames halves = times({"--fps", "2"});
  ASSERT_EQ(halves.size(), static_cast<std::size_t>(slow));
  for (int n = 1; n <= slow; ++n)
    EXPECT_EQ(halves[static_cast<std::size_t>(n - 1)], std::pair(n, (n - 1) / 2.0));
  // A range that goes past the end is an error that says where the end is.
  const Outcome past =
      plisse({"render", model, "-o", output.path().string(), "--frames", "1-" + std::to_string(last + 1)});
  EXPECT_EQ(past.code, 2);
  EXPECT_THAT(past.err, testing::HasSubstr(std::to_string(last)));
}

}  // namespace
}  // namespace plisse::test
