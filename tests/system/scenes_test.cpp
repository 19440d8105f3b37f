// Every scene of the project and the models of other people, rendered and verified small; and what must not
// change a picture.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>

#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::HasSubstr;

struct Subject {
  std::string name;
  std::filesystem::path path;
  std::vector<std::string> options = {};
};
void PrintTo(const Subject& subject, std::ostream* out) {
  *out << subject.name;
}

class Scenes : public Program, public ::testing::WithParamInterface<Subject> {
 protected:
  std::vector<std::string> command(const std::string& name, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{name, GetParam().path.string()};
    arguments.insert(arguments.end(), GetParam().options.begin(), GetParam().options.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void SetUp() override {
    if (!std::filesystem::exists(GetParam().path)) GTEST_SKIP() << GetParam().path << " is not here";
    Program::SetUp();
  }
};

TEST_P(Scenes, AreVerified) {
  const TemporaryFolder folder;
  const std::string report = (folder / "report.json").string();
  const Outcome outcome = plisse(command("verify", {"--size", "64x64", "--json", report}));
  EXPECT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  const auto json = nlohmann::json::parse(read_text(report));
  EXPECT_EQ(json["failures"].size(), 0U) << json["failures"].dump();
}

TEST_P(Scenes, AreSeen) {
  const TemporaryFolder folder;
  const Outcome outcome =
      plisse(command("render", {"--size", "64x64", "--samples", "1", "--background", "transparent", "-o",
                                folder.path().string(), "--json", (folder / "report.json").string()}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(read_text(folder / "report.json"));
  ASSERT_GE(report["frames"].size(), 1U);
  double least = 1, most = 0;
  for (const auto& frame : report["frames"]) {
    const io::Image image = io::load_image(frame["path"].get<std::string>());
    ASSERT_EQ(image.width, 64);
    double covered = 0, sum = 0, squares = 0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      if (image.rgba[i + 3] == 0) continue;
      covered += 1;
      sum += image.rgba[i + 1];
      squares += std::pow(image.rgba[i + 1], 2);
    }
    const double share = covered / (64 * 64);
    least = std::min(least, share);
    most = std::max(most, share);
    // The model is in the picture, lit, and shaded: neither black, nor white, nor one flat colour.
    ASSERT_GT(covered, 0) << frame["path"];
    const double mean = sum / covered;
    EXPECT_GT(mean, 10) << frame["path"];
    EXPECT_LT(mean, 245) << frame["path"];
    EXPECT_GT(std::sqrt(squares / covered - mean * mean), 1) << frame["path"];
  }
  EXPECT_GT(least, 0.005);  // a model's small or thin moment, 20 pixels
  EXPECT_GT(most, 0.02);
  EXPECT_LT(most, 0.98);
}

std::vector<Subject> subjects() {
  std::vector<Subject> all;
  for (const std::string name : {"square", "sleeve", "shirt", "zeppelin", "curtain", "model_a", "model_b"}) {
    all.push_back({name, asset(name + ".toml")});
  }
  for (const std::string name :
       {"RiggedSimple.glb", "Fox.glb", "Greenman.glb", "KayKit_Knight.glb", "bending_cylinder_anim_test.x",
        "huesitos.fbx", "box_nested_animation.dae"}) {
    all.push_back({name.substr(0, name.find('.')), shared_data("models/" + name)});
  }
  all.push_back({"cloth_drape", shared_data("cloth-drape"), {"--up", "z"}});
  return all;
}
INSTANTIATE_TEST_SUITE_P(Of, Scenes, ::testing::ValuesIn(subjects()),
                         [](const auto& subject) { return subject.param.name; });

// --- what must not change a picture
// ----------------------------------------------------------------------------------------

io::Image picture(const std::vector<std::string>& arguments, const TemporaryFolder& folder, int frame) {
  auto all = arguments;
  all.insert(all.end(),
             {"--size", "96x80", "--frames", std::to_string(frame), "-o", (folder / "f_####.png").string()});
  const Outcome outcome = plisse(all);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  char name[32];
  std::snprintf(name, sizeof name, "f_%04d.png", frame);
  return io::load_image(folder / name);
}

TEST_F(Program, InitsSceneIsTheBareModel) {
  std::vector<std::filesystem::path> models{asset("square.glb"), asset("sleeve.glb"), asset("zeppelin.glb")};
  for (const auto& model : {shared_data("models/Fox.glb"), shared_data("models/RiggedSimple.glb")}) {
    if (std::filesystem::exists(model)) models.push_back(model);
  }
  for (const auto& model : models) {
    const TemporaryFolder folder;
    const auto scene = folder / "scene.toml";
    ASSERT_EQ(plisse({"init", model.string(), "-o", scene.string()}).code, 0) << model;
    const auto render = [&](const std::string& input, const std::string& to) {
      const Outcome outcome =
          plisse({"render", input, "--size", "96x80", "--frames", "5-15x5", "-o", (folder / to).string()});
      EXPECT_EQ(outcome.code, 0) << outcome.err;
    };
    render(model.string(), "bare");
    render(scene.string(), "scene");
    for (const std::string name : {"frame_0005.png", "frame_0010.png", "frame_0015.png"}) {
      const auto bare = read_bytes(folder / ("bare/" + name));
      EXPECT_GT(bare.size(), 100U);
      EXPECT_EQ(bare, read_bytes(folder / ("scene/" + name))) << model << " " << name;
    }
  }
}

// A metre or a thousand kilometres: with the wavelength in proportion, the same picture to the pixel.
TEST_F(Program, ScaleDoesNotChangeThePicture) {
  const std::string model = asset("sleeve.glb").string();
  const auto at_scale = [&](double scale, const TemporaryFolder& folder) {
    char units[40], wavelength[40];
    std::snprintf(units, sizeof units, "%.17g", scale);
    std::snprintf(wavelength, sizeof wavelength, "%.17g", 0.025 * scale);
    return picture({"render", model, "--units", units, "--wavelength", wavelength}, folder, 30).rgba;
  };
  const TemporaryFolder folder;
  const auto expected = at_scale(1, folder);
  for (const double scale : {std::exp2(-20), std::exp2(20)})
    EXPECT_EQ(at_scale(scale, folder), expected) << scale;
  // Where the scale is no power of two, its rounding may move a value by a step.
  const auto odd = at_scale(1e-3, folder);
  std::size_t apart = 0;
  for (std::size_t i = 0; i < odd.size(); ++i) apart += std::abs(odd[i] - expected[i]) > 1 ? 1 : 0;
  EXPECT_LE(apart, odd.size() / 1000);
}

// The same for coordinates of the file itself, in a sequence without bones.
TEST_F(Program, ScaleOfASequenceDoesNotChangeThePicture) {
  const auto sequence = [](const std::filesystem::path& folder, double scale) {
    for (int frame = 1; frame <= 4; ++frame) {
      std::string text;
      char line[120];
      for (int j = 0; j <= 8; ++j) {
        for (int i = 0; i <= 8; ++i) {
          const double x = (i / 8.0 - 0.5) * (1 - 0.05 * (frame - 1)), y = j / 8.0,
                       z = 0.1 * std::sin(3 * x) * frame;
          std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", scale * x, scale * y, scale * z);
          text += line;
        }
      }
      for (int j = 0; j < 8; ++j) {
        for (int i = 0; i < 8; ++i) {
          const int a = 9 * j + i + 1;
          std::snprintf(line, sizeof line, "f %d %d %d %d\n", a, a + 1, a + 10, a + 9);
          text += line;
        }
      }
      write_text(folder / ("sheet_000" + std::to_string(frame) + ".obj"), text);
    }
  };
  std::vector<std::uint8_t> expected;
  for (const double scale : {1.0, std::exp2(-20), std::exp2(20)}) {
    const TemporaryFolder models, frames;
    sequence(models.path(), scale);
    const auto now = picture({"render", (models / "sheet_####.obj").string()}, frames, 4).rgba;
    if (expected.empty()) expected = now;
    EXPECT_EQ(now, expected) << scale;
  }
}

TEST_F(Program, ThreadsDoNotChangeThePicture) {
  const TemporaryFolder folder;
  const std::string scene = asset("shirt.toml").string();
  const auto one = picture({"render", scene, "--threads", "1"}, folder, 9).rgba;
  EXPECT_EQ(picture({"render", scene, "--threads", "2"}, folder, 9).rgba, one);
}

TEST_F(Program, StrengthZeroAndExclusionGiveTheBareSurface) {
  const TemporaryFolder folder;
  const std::string model = asset("square.glb").string();
  const auto flat = picture({"render", model, "--strength", "0"}, folder, 73).rgba;
  EXPECT_EQ(picture({"render", model, "--exclude", "cloth"}, folder, 73).rgba, flat);
  EXPECT_NE(picture({"render", model}, folder, 73).rgba, flat);
}

}  // namespace
}  // namespace plisse::test
