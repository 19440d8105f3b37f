// Scene files: what each key sets, what each kind of mistake is told as and where, and that parser, reference
// and the scene of `init` say the same.
#include "config/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "base/error.h"
#include "config/keys.h"
#include "support/files.h"

namespace plisse {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class SceneFile : public testing::Test {
 protected:
  SceneFile() {
    test::write_text(folder_ / "model.glb", "not read here");
    test::write_text(folder_ / "walk.mdd", "nor this");
  }

  config::SceneSettings parse(const std::string& text) const { return config::parse_scene(text, file()); }
  // A scene with a model and these lines after it; they start in line 3.
  config::SceneSettings parse_after_model(const std::string& lines) const {
    return parse("[model]\npath = \"model.glb\"\n" + lines);
  }
  std::filesystem::path file() const { return folder_ / "scene.toml"; }
  std::filesystem::path in_folder(const std::string& name) const { return folder_ / name; }

  // What is wrong with a text: lines without the name of the file, "4:1: key …".
  std::vector<std::string> complaints(const std::string& text) const {
    try {
      parse(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::bad_input);
      std::vector<std::string> lines;
      std::istringstream stream(error.what());
      const std::string start = file().string() + ":";
      for (std::string line; std::getline(stream, line);) {
        EXPECT_TRUE(line.starts_with(start)) << line;
        lines.push_back(line.substr(std::min(start.size(), line.size())));
      }
      return lines;
    }
    return {"none"};
  }
  std::vector<std::string> complaints_after_model(const std::string& lines) const {
    return complaints("[model]\npath = \"model.glb\"\n" + lines);
  }
  // The one complaint about these lines after the model's.
  std::string complaint(const std::string& lines) const {
    const auto all = complaints_after_model(lines);
    EXPECT_EQ(all.size(), 1U) << testing::PrintToString(all);
    return all.front();
  }

  test::TemporaryFolder folder_;
};

TEST_F(SceneFile, ReadsEveryKindOfValue) {
  test::write_text(folder_ / "wave.txt", "");
  const config::SceneSettings scene = parse_after_model(R"(
clip = "Walk"
fps = 30
frames = "1-48x2,60"
loop = true
units = "1 cm"
up = "z"
rest = "frame:3"
[wrinkles]
wavelength = "12 mm"
strength = 0.5
profile = "wave.txt"
only = ["shirt", "trousers"]
exclude = "face"
seed = 4294967295
[relax]
mode = "descent"
rounds = 5
[camera]
eye = [1, "50 cm", -2.5]
target = [0, 1, 0]
[light]
key_colour = "#ff8000"
fill_colour = [0.25, 0.5, 1]
shadows = true
[shading]
blend = "linear"
gradient = "paper"
[output]
path = "out/img_####.png"
size = "640x512"
samples = 1
background = "transparent"
)");
  EXPECT_EQ(scene.file, file());
  EXPECT_EQ(scene.model.path, in_folder("model.glb"));
  EXPECT_EQ(scene.model.clip, "Walk");
  EXPECT_EQ(scene.model.frames_per_second, 30);
  EXPECT_EQ(scene.model.frames, "1-48x2,60");
  EXPECT_TRUE(scene.model.loop);
  EXPECT_EQ(scene.model.metres_per_unit, 0.01);
  EXPECT_EQ(scene.model.up, "z");
  EXPECT_EQ(scene.model.rest, "frame:3");
  EXPECT_EQ(scene.wrinkles.wavelength, 0.012);
  EXPECT_EQ(scene.wrinkles.strength, 0.5);
  EXPECT_EQ(scene.wrinkles.profile, in_folder("wave.txt").string());
  EXPECT_THAT(scene.wrinkles.only, ElementsAre("shirt", "trousers"));
  EXPECT_THAT(scene.wrinkles.exclude, ElementsAre("face"));
  EXPECT_EQ(scene.wrinkles.seed, 4294967295U);
  EXPECT_EQ(scene.relax.mode, config::RelaxMode::descent);
  EXPECT_EQ(scene.relax.rounds, 5);
  EXPECT_TRUE(scene.camera.explicit_pose);
  EXPECT_EQ(scene.camera.eye, glm::dvec3(1, 0.5, -2.5));
  EXPECT_EQ(scene.camera.target, glm::dvec3(0, 1, 0));
  EXPECT_EQ(scene.light.key_colour, glm::vec3(1, 128.0F / 255, 0));
  EXPECT_EQ(scene.light.fill_colour, glm::vec3(0.25F, 0.5F, 1));
  EXPECT_TRUE(scene.light.shadows);
  EXPECT_EQ(scene.shading.blend, config::Blend::linear);
  EXPECT_EQ(scene.shading.gradient, config::Gradient::paper);
  EXPECT_EQ(scene.output.path, in_folder("out/img_####.png").string());
  EXPECT_EQ(scene.output.width, 640);
  EXPECT_EQ(scene.output.height, 512);
  EXPECT_EQ(scene.output.samples, 1);
  EXPECT_TRUE(scene.output.transparent);
}

TEST_F(SceneFile, NumbersStandForNamesWhereAnIndexMay) {
  const config::SceneSettings scene =
      parse_after_model("clip = 2\nframes = 7\n[camera]\nname = 0\n[output]\nsize = [64, 32]\n");
  EXPECT_EQ(scene.model.clip, "2");
  EXPECT_EQ(scene.model.frames, "7");
  EXPECT_EQ(scene.camera.name, "0");
  EXPECT_EQ(scene.output.width, 64);
  EXPECT_EQ(scene.output.height, 32);
}

// --- mistakes, each with its place
// ------------------------------------------------------------------------------

TEST_F(SceneFile, UnknownKeyNamesTheNearest) {
  EXPECT_THAT(complaint("[wrinkles]\n  wavelenth = 1\n"),
              testing::StartsWith("4:3: key 'wavelenth': unknown in [wrinkles]"));
  EXPECT_THAT(complaint("[wrinkles]\nwavelenth = 1\n"), HasSubstr("did you mean 'wavelength'?"));
  EXPECT_THAT(complaint("[wrinkles]\nzebra = 1\n"),
              HasSubstr("allowed: wavelength, wavelength_map, wavelength_low, fine, fine_share, strength"));
  EXPECT_THAT(complaint("[wrinkles]\nzebra = 1\n"), Not(HasSubstr("did you mean")));
}

TEST_F(SceneFile, KeyInTheWrongTableIsToldItsOwn) {
  EXPECT_EQ(complaint("[wrinkles]\nsamples = 1\n"),
            "4:1: key 'samples': unknown in [wrinkles], it belongs to [output]");
  EXPECT_THAT(complaint("[wrinkles]\nsample = 1\n"), HasSubstr("did you mean 'samples' of [output]?"));
}

TEST_F(SceneFile, UnknownTableNamesTheNearest) {
  EXPECT_THAT(complaint("[wrinkle]\nstrength = 1\n"), testing::StartsWith("3:2: table [wrinkle]: unknown"));
  EXPECT_THAT(complaint("[wrinkle]\n"), HasSubstr("did you mean 'wrinkles'?"));
}

TEST_F(SceneFile, KeysOutsideTables) {
  EXPECT_THAT(complaints("samples = 1\n[model]\npath = \"model.glb\"\n"),
              ElementsAre("1:1: key 'samples': stands outside a table, 'samples' belongs under [output]"));
  EXPECT_THAT(complaints("sampels = 1\n[model]\npath = \"model.glb\"\n"),
              ElementsAre(HasSubstr("did you mean 'samples'?")));
  EXPECT_THAT(complaints("camera = 1\n[model]\npath = \"model.glb\"\n"),
              ElementsAre("1:1: key 'camera': is a table; write [camera] and its keys below"));
}

TEST_F(SceneFile, WrongTypes) {
  EXPECT_EQ(complaint("[output]\nsamples = \"four\"\n"),
            "4:1: key 'samples': 'four' is a text, not a whole number; allowed: 1 or 4");
  EXPECT_THAT(complaint("[output]\nsamples = 4.0\n"), HasSubstr("is a number, not a whole number"));
  EXPECT_THAT(complaint("loop = 1\n"),
              testing::StartsWith("3:1: key 'loop': 1 is a whole number, not a truth value"));
  EXPECT_THAT(complaint("[wrinkles]\nstrength = \"1\"\n"), HasSubstr("'1' is a text, not a number"));
  EXPECT_THAT(complaint("[wrinkles]\nonly = [1]\n"), HasSubstr("1 is a whole number, not a text"));
  EXPECT_THAT(complaint("[relax]\nmode = 1979-05-27\n"), HasSubstr("this is a date or time, not a text"));
  EXPECT_THAT(complaint("[wrinkles]\nwavelength = [1]\n"), HasSubstr("this is an array, not a length"));
}

TEST_F(SceneFile, OutOfRange) {
  EXPECT_EQ(complaint("[wrinkles]\nstrength = 10.5\n"),
            "4:1: key 'strength': 10.5 is out of range; allowed: 0 … 10");
  EXPECT_THAT(complaint("[wrinkles]\nstrength = -1e-300\n"), HasSubstr("out of range"));
  EXPECT_THAT(complaint("[wrinkles]\ndead_zone = 0\n"), HasSubstr("out of range"));
  EXPECT_THAT(complaint("[wrinkles]\nwavelength = \"-3 mm\"\n"), HasSubstr("-0.003 is out of range"));
  EXPECT_THAT(complaint("[wrinkles]\nseed = -1\n"), HasSubstr("-1 is out of range"));
  EXPECT_THAT(complaint("[wrinkles]\nseed = 4294967296\n"), HasSubstr("out of range"));
  EXPECT_THAT(complaint("[relax]\nrounds = 4294967297\n"), HasSubstr("out of range")) << "no wrapping to 1";
  EXPECT_THAT(complaint("[output]\nsamples = 2\n"), HasSubstr("allowed: 1 or 4"));
  EXPECT_THAT(complaint("[output]\nsize = \"0x5\"\n"), HasSubstr("0 is out of range"));
  EXPECT_THAT(complaint("[output]\nsize = [16385, 5]\n"), HasSubstr("16385 is out of range"));
  EXPECT_THAT(complaint("[camera]\nelevation = 89.5\n"), HasSubstr("-89 … 89"));
  EXPECT_THAT(complaint("[light]\nkey_colour = [0, 0, 1.5]\n"), HasSubstr("1.5 is out of range"));
  EXPECT_NO_THROW(
      parse_after_model("[wrinkles]\nwavelength = 0\nstrength = 0\n[output]\nsize = \"16384x1\"\n"));
}

TEST_F(SceneFile, NonFiniteNumbers) {
  EXPECT_THAT(complaint("[wrinkles]\nstrength = nan\n"),
              testing::StartsWith("4:1: key 'strength': nan is not finite"));
  EXPECT_THAT(complaint("[wrinkles]\nwavelength = inf\n"), HasSubstr("inf is not finite"));
  EXPECT_THAT(complaint("[wrinkles]\nwavelength = \"inf m\"\n"), HasSubstr("inf is not finite"));
  EXPECT_THAT(complaint("[camera]\neye = [0, -inf, 0]\ntarget = [1, 1, 1]\n"),
              HasSubstr("-inf is not finite"));
  EXPECT_THAT(complaint("[light]\nkey_colour = [nan, 0, 0]\n"), HasSubstr("nan is not finite"));
}

TEST_F(SceneFile, UnknownWordsAndShapes) {
  EXPECT_EQ(complaint("[relax]\nmode = \"smoth\"\n"),
            "4:1: key 'mode': 'smoth' is unknown; allowed: smooth or descent (did you mean 'smooth'?)");
  EXPECT_THAT(complaint("up = \"w\"\n"), HasSubstr("allowed: x, y or z"));
  EXPECT_THAT(complaint("rest = \"frame:0\"\n"), HasSubstr("'frame:0' names no frame"));
  EXPECT_THAT(complaint("rest = \"bnid\"\n"), HasSubstr("did you mean 'bind'?"));
  EXPECT_THAT(complaint("frames = \"3-1\"\n"), HasSubstr("the range ends before it starts"));
  EXPECT_THAT(complaint("[wrinkles]\nprofile = \"acordion\"\n"), HasSubstr("did you mean 'accordion'?"));
  EXPECT_THAT(complaint("[wrinkles]\nwavelength = \"12 furlongs\"\n"),
              HasSubstr("units: mm, cm, m, in or ft"));
  EXPECT_THAT(complaint("[light]\nkey_colour = \"#12345g\"\n"), HasSubstr("'#12345g' is not a colour"));
  EXPECT_THAT(complaint("[light]\nkey_colour = \"#1234567\"\n"), HasSubstr("is not a colour"));
  EXPECT_THAT(complaint("[light]\nkey_colour = [1, 2]\n"), HasSubstr("2 numbers are no colour"));
  EXPECT_THAT(complaint("[output]\nsize = \"640 x 512\"\n"), HasSubstr("is not a size like"));
  EXPECT_THAT(complaint("[output]\npath = \"a_####.jpg\"\n"), HasSubstr("end the name in .png"));
  EXPECT_THAT(complaint("[output]\npath = \"a.jpg\"\n"), HasSubstr("end the name in .png"));
}

TEST_F(SceneFile, ModelMustBeThere) {
  EXPECT_THAT(complaints("[model]\n  path = \"nope.glb\"\n"),
              ElementsAre(testing::StartsWith("2:3: key 'path': there is no '")));
  EXPECT_THAT(complaints("[model]\nclip = \"a\"\n"),
              ElementsAre(testing::StartsWith("1:2: key 'path': missing in [model]")));
  EXPECT_THAT(complaints(""), ElementsAre(testing::StartsWith("1:1: key 'path': missing in [model]")));
  EXPECT_NO_THROW(parse("[model]\npath = \"drape_####.obj\"\n")) << "a pattern: its folder is there";
  EXPECT_THAT(complaints("[model]\npath = \"no/drape_####.obj\"\n"), ElementsAre(HasSubstr("there is no")));
  EXPECT_NO_THROW(parse("[model]\npath = \".\"\n")) << "a folder";
}

TEST_F(SceneFile, CameraKeysThatTakeEachOthersPlace) {
  EXPECT_THAT(complaint("[camera]\neye = [1, 2, 3]\n"),
              testing::StartsWith("4:1: key 'eye': needs 'target'"));
  EXPECT_THAT(complaint("[camera]\ntarget = [1, 2, 3]\n"), HasSubstr("needs 'eye'"));
  EXPECT_THAT(complaint("[camera]\neye = [1, 2, 3]\ntarget = [1, 2, 3]\n"),
              testing::StartsWith("5:1: key 'target'"));
  EXPECT_THAT(complaint("[camera]\nname = \"main\"\nazimuth = 3\n"),
              "5:1: key 'azimuth': has no effect beside 'name'; take one of them out");
  EXPECT_THAT(complaint("[camera]\neye = [1, 2, 3]\ntarget = [0, 0, 0]\nmargin = 2\n"),
              HasSubstr("beside 'eye' and 'target'"));
}

TEST_F(SceneFile, BiasComesFromOnePlace) {
  EXPECT_EQ(parse_after_model("[bias]\nfile = \"model.glb\"\n").bias.file, in_folder("model.glb"));
  EXPECT_THAT(complaint("[bias]\nfile = \"model.glb\"\npaint = \"model.glb\"\n"),
              HasSubstr("key 'file': stands beside 'paint'"));
  EXPECT_THAT(complaint("[bias]\nfile = \"no.ply\"\n"), HasSubstr("there is no file"));
}

TEST_F(SceneFile, SyntaxErrorsHaveAPlace) {
  // toml++ points at the value it cannot read: line 2, after "path = ".
  EXPECT_THAT(complaints("[model]\npath = model.glb\n"),
              ElementsAre(testing::MatchesRegex("2:[0-9]+: not TOML: .*")));
  EXPECT_THAT(complaints("[model]\npath = \"model.glb\"\npath = \"model.glb\"\n"),
              ElementsAre(testing::MatchesRegex("3:[0-9]+: not TOML: .*")));
  EXPECT_THAT(complaints("[model\n"), ElementsAre(testing::MatchesRegex("1:[0-9]+: not TOML: .*")));
  EXPECT_THAT(complaints("[model]\npath = \"\xff\xfe\"\n"), ElementsAre(HasSubstr("not TOML: ")));
}

TEST_F(SceneFile, TellsAllMistakesInTheFilesOrder) {
  const auto all = complaints_after_model(R"([output]
samples = 3
sizee = "1x1"
[wrinkles]
strength = nan
only = 5
[nonsense]
[camera]
eye = [0, 0, 0]
)");
  EXPECT_THAT(all, ElementsAre(HasSubstr("4:1: key 'samples'"), HasSubstr("5:1: key 'sizee'"),
                               HasSubstr("7:1: key 'strength'"), HasSubstr("8:1: key 'only'"),
                               HasSubstr("9:2: table [nonsense]"), HasSubstr("11:1: key 'eye'")));
}

TEST_F(SceneFile, MissingSceneIsBadInput) {
  try {
    config::load_scene(in_folder("nope.toml"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::bad_input);
    EXPECT_THAT(error.what(), HasSubstr("nope.toml"));
  }
}

// --- one table for all
// ------------------------------------------------------------------------------------------

// Every value of the settings, as text, in the order of the table.
std::vector<std::string> values(const config::SceneSettings& scene) {
  std::vector<std::string> all;
  for (const config::SceneKey& key : config::keys()) {
    if (key.table != "model" || key.name != "path")
      all.push_back(key.table + "." + key.name + "=" + key.show(scene));
  }
  return all;
}

// Field by field and by hand, so that a key whose `show` and `set` reach a wrong member together is found
// too.
void expect_defaults(const config::SceneSettings& scene) {
  const config::SceneSettings fresh;
  EXPECT_EQ(scene.model.clip, fresh.model.clip);
  EXPECT_EQ(scene.model.frames_per_second, fresh.model.frames_per_second);
  EXPECT_EQ(scene.model.frames, fresh.model.frames);
  EXPECT_EQ(scene.model.loop, fresh.model.loop);
  EXPECT_EQ(scene.model.metres_per_unit, fresh.model.metres_per_unit);
  EXPECT_EQ(scene.model.up, fresh.model.up);
  EXPECT_EQ(scene.model.rest, fresh.model.rest);
  EXPECT_EQ(scene.wrinkles.wavelength, fresh.wrinkles.wavelength);
  EXPECT_EQ(scene.wrinkles.strength, fresh.wrinkles.strength);
  EXPECT_EQ(scene.wrinkles.profile, fresh.wrinkles.profile);
  EXPECT_EQ(scene.wrinkles.only, fresh.wrinkles.only);
  EXPECT_EQ(scene.wrinkles.exclude, fresh.wrinkles.exclude);
  EXPECT_EQ(scene.wrinkles.dead_zone, fresh.wrinkles.dead_zone);
  EXPECT_EQ(scene.wrinkles.irregularity, fresh.wrinkles.irregularity);
  EXPECT_EQ(scene.wrinkles.seed, fresh.wrinkles.seed);
  EXPECT_EQ(scene.bias.paint, fresh.bias.paint);
  EXPECT_EQ(scene.bias.file, fresh.bias.file);
  EXPECT_EQ(scene.bias.field, fresh.bias.field);
  EXPECT_EQ(scene.bias.use, fresh.bias.use);
  EXPECT_EQ(scene.relax.mode, fresh.relax.mode);
  EXPECT_EQ(scene.relax.rounds, fresh.relax.rounds);
  EXPECT_EQ(scene.relax.epsilon, fresh.relax.epsilon);
  EXPECT_EQ(scene.relax.interval, fresh.relax.interval);
  EXPECT_EQ(scene.relax.onset_rounds, fresh.relax.onset_rounds);
  EXPECT_EQ(scene.relax.smoothing_rounds, fresh.relax.smoothing_rounds);
  EXPECT_EQ(scene.camera.name, fresh.camera.name);
  EXPECT_EQ(scene.camera.focal_length, fresh.camera.focal_length);
  EXPECT_EQ(scene.camera.azimuth, fresh.camera.azimuth);
  EXPECT_EQ(scene.camera.elevation, fresh.camera.elevation);
  EXPECT_EQ(scene.camera.distance, fresh.camera.distance);
  EXPECT_EQ(scene.camera.margin, fresh.camera.margin);
  EXPECT_EQ(scene.camera.explicit_pose, fresh.camera.explicit_pose);
  EXPECT_EQ(scene.camera.eye, fresh.camera.eye);
  EXPECT_EQ(scene.camera.target, fresh.camera.target);
  EXPECT_EQ(scene.light.key_azimuth, fresh.light.key_azimuth);
  EXPECT_EQ(scene.light.key_elevation, fresh.light.key_elevation);
  EXPECT_EQ(scene.light.key_intensity, fresh.light.key_intensity);
  EXPECT_EQ(scene.light.key_colour, fresh.light.key_colour);
  EXPECT_EQ(scene.light.fill_azimuth, fresh.light.fill_azimuth);
  EXPECT_EQ(scene.light.fill_elevation, fresh.light.fill_elevation);
  EXPECT_EQ(scene.light.fill_ratio, fresh.light.fill_ratio);
  EXPECT_EQ(scene.light.fill_colour, fresh.light.fill_colour);
  EXPECT_EQ(scene.light.rim_azimuth, fresh.light.rim_azimuth);
  EXPECT_EQ(scene.light.rim_elevation, fresh.light.rim_elevation);
  EXPECT_EQ(scene.light.rim_intensity, fresh.light.rim_intensity);
  EXPECT_EQ(scene.light.ambient, fresh.light.ambient);
  EXPECT_EQ(scene.light.shadows, fresh.light.shadows);
  EXPECT_EQ(scene.shading.blend, fresh.shading.blend);
  EXPECT_EQ(scene.shading.gradient, fresh.shading.gradient);
  EXPECT_EQ(scene.shading.roughness, fresh.shading.roughness);
  EXPECT_EQ(scene.shading.sheen, fresh.shading.sheen);
  EXPECT_EQ(scene.shading.cavity, fresh.shading.cavity);
  EXPECT_EQ(scene.shading.parallax, fresh.shading.parallax);
  EXPECT_EQ(scene.shading.wireframe, fresh.shading.wireframe);
  EXPECT_EQ(scene.shading.colour, fresh.shading.colour);
  EXPECT_EQ(scene.output.width, fresh.output.width);
  EXPECT_EQ(scene.output.height, fresh.output.height);
  EXPECT_EQ(scene.output.samples, fresh.output.samples);
  EXPECT_EQ(scene.output.transparent, fresh.output.transparent);
  EXPECT_EQ(scene.output.background, fresh.output.background);
  EXPECT_EQ(scene.output.ground, fresh.output.ground);
}

TEST_F(SceneFile, SceneOfInitMeansTheBareModel) {
  const config::SceneSettings scene =
      parse(config::scene_text("model.glb", {{"wrinkles.only", "Meshes here: \"a\", \"b\"."}}));
  EXPECT_EQ(scene.model.path, in_folder("model.glb"));
  EXPECT_EQ(scene.output.path, in_folder("frames").string()) << "beside the scene";
  expect_defaults(scene);
}

TEST_F(SceneFile, UncommentingAKeyOfInitChangesNothing) {
  std::string text = config::scene_text("model.glb");
  // "#key = value" is a key, "# words" a comment.
  text = std::regex_replace(text, std::regex("(^|\n)#([a-z_]+ = |\\[solve\\])"), "$1$2");
  for (const config::SceneKey& key : config::keys()) {
    EXPECT_THAT(text, HasSubstr("\n" + key.name + " = ")) << key.table;
  }
  config::SceneSettings scene = parse(text);
  EXPECT_TRUE(scene.solve.on);  // the one table that has a meaning by itself
  scene.solve.on = false;
  expect_defaults(scene);
}

TEST_F(SceneFile, ShowAndSetAreInverse) {
  // Values that are no defaults, written by `show` and read back.
  config::SceneSettings scene;
  scene.model.clip = "a \"quoted\" \\ name\twith a tab";
  scene.model.frames_per_second = 29.97;
  scene.model.frames = "1-9x2";
  scene.wrinkles.only = {"a", "ü"};
  scene.wrinkles.strength = 0.1;
  scene.wrinkles.seed = 4000000000U;
  scene.relax.mode = config::RelaxMode::descent;
  scene.camera.focal_length = 1.0 / 3 + 50;
  scene.light.key_colour = {0.1F, 0.2F, 0.3F};
  scene.shading.gradient = config::Gradient::paper;
  scene.output.width = 17;
  scene.output.transparent = true;
  std::string text, table;
  for (const config::SceneKey& key : config::keys()) {
    const bool path = key.name == "path";
    if (std::exchange(table, key.table) != key.table) text += "[" + key.table + "]\n";
    if (!path) text += key.name + " = " + key.show(scene) + "\n";
    if (path && key.table == "model") text += "path = \"model.glb\"\n";
  }
  config::SceneSettings back = parse(text);
  back.output.path = scene.output.path;
  EXPECT_EQ(values(back), values(scene));
}

TEST_F(SceneFile, GarmentsStandInPlaceOfAPath) {
  test::write_text(folder_ / "p.toml", "whatever is in it");
  const config::SceneSettings scene =
      parse("[model]\ngarment = \"p.toml\"\npieces = [\"a\", \"b\"]\nfabric = \"2e-6,3e5\"\n");
  EXPECT_EQ(scene.model.garment, in_folder("p.toml"));
  EXPECT_TRUE(scene.model.path.empty());
  EXPECT_THAT(scene.model.pieces, ElementsAre("a", "b"));
  EXPECT_EQ(scene.model.fabric, "2e-6,3e5");
  EXPECT_THAT(complaints("[model]\ngarment = \"p.toml\"\npath = \"model.glb\"\n"),
              ElementsAre(HasSubstr("2:1: key 'garment': stands beside 'path'")));
  EXPECT_THAT(complaints("[model]\npath = \"model.glb\"\npieces = \"a\"\nfabric = \"khaki\"\n"),
              ElementsAre(HasSubstr("3:1: key 'pieces': has no effect without 'garment'"),
                          HasSubstr("4:1: key 'fabric': has no effect without 'garment'")));
  EXPECT_THAT(complaints("[model]\ngarment = \"model.glb\"\n"), ElementsAre(HasSubstr("2:1: key 'garment'")));
}

TEST_F(SceneFile, EveryKeySetsSomethingOfItsOwn) {
  // A table whose rows reach the same member twice has a key without effect of its own.
  const std::map<std::string, std::string> others = {{"clip", "\"x\""},
                                                     {"frames", "\"2\""},
                                                     {"units", "2"},
                                                     {"up", "\"x\""},
                                                     {"rest", "\"bind\""},
                                                     {"fps", "12"},
                                                     {"profile", "\"pencil\""},
                                                     {"only", "[\"x\"]"},
                                                     {"exclude", "[\"x\"]"},
                                                     {"bodies", "[\"x\"]"},
                                                     {"mode", "\"descent\""},
                                                     {"method", "\"passes\""},
                                                     {"quality", "\"draft\""},
                                                     {"name", "\"x\""},
                                                     {"blend", "\"linear\""},
                                                     {"gradient", "\"paper\""},
                                                     {"size", "\"3x4\""},
                                                     {"samples", "1"},
                                                     {"background", "\"#010203\""},
                                                     {"dead_zone", "0.25"},
                                                     {"paint", "\"model.glb\""},
                                                     {"file", "\"model.glb\""},
                                                     {"field", "\"model.glb\""},
                                                     {"wavelength_map", "\"model.glb\""},
                                                     {"use", "\"direct\""},
                                                     {"cache", "\"walk.mdd\""},
                                                     {"memory_mib", "100"},
                                                     {"path", "\"x\""}};
  for (const config::SceneKey& key : config::keys()) {
    if (key.table == "model" && key.name == "path") continue;
    if (key.name == "eye" || key.name == "target") continue;  // only together: ReadsEveryKindOfValue
    // Not beside a path: GarmentsStandInPlaceOfAPath.
    if (key.name == "garment" || key.name == "pieces" || key.name == "fabric") continue;
    std::string value = "0.375";  // the default of none
    if (key.type == "whole number") value = "7";
    if (key.type == "colour") value = "[0, 0.5, 0]";
    if (key.type == "truth value") value = "true";
    if (key.type.starts_with("number, ")) value = "11";
    if (const auto other = others.find(key.name); other != others.end()) value = other->second;
    const std::string table = key.table == "model" ? "" : "[" + key.table + "]\n";
    const auto before = values(parse_after_model("")),
               after = values(parse_after_model(table + key.name + " = " + value + "\n"));
    std::vector<std::string> changed;
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (before[i] != after[i]) changed.push_back(after[i].substr(0, after[i].find('=')));
    }
    EXPECT_THAT(changed, ElementsAre(key.table + "." + key.name));
  }
}

TEST_F(SceneFile, ReferenceIsWhatTheTableSays) {
  const std::string file = test::read_text(test::source_file("docs/scene.md"));
  EXPECT_EQ(file, config::scene_reference_markdown())
      << "make it anew: plisse init --keys-markdown > docs/scene.md";
}

TEST_F(SceneFile, ReferenceHasEveryKey) {
  const std::string file = test::read_text(test::source_file("docs/scene.md"));
  for (const config::SceneKey& key : config::keys()) {
    const auto section = file.find("## [" + key.table + "]");
    ASSERT_NE(section, std::string::npos) << key.table;
    const auto next = file.find("\n## ", section);
    EXPECT_THAT(file.substr(section, next - section), HasSubstr("| `" + key.name + "` |")) << key.table;
  }
}

}  // namespace
}  // namespace plisse
