// What scripts rely on (docs/contract.md): exit codes, messages, the keys of reports, and files that are
// whole or not there.
#include <gmock/gmock.h>

#include <csignal>

#include "system/plisse.h"

namespace plisse::test {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string square = asset("square.glb").string();
const std::vector<std::string> tiny{"--size", "32x32", "--samples", "1"};

std::vector<std::string> with_tiny(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), tiny.begin(), tiny.end());
  return arguments;
}

void expect_failure(const Outcome& outcome, int code, const std::string& part) {
  EXPECT_EQ(outcome.code, code) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("error: "), HasSubstr(part)));
  EXPECT_EQ(outcome.out, "");
}

std::vector<std::string> keys_of(const json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

void expect_keys(const json& object, const std::vector<std::string>& keys) {
  for (const auto& key : keys)
    EXPECT_TRUE(object.contains(key)) << key << " in " << object.dump().substr(0, 300);
}

// --- usage
// --------------------------------------------------------------------------------------------------------------

TEST(Usage, HelpAndVersionAreFine) {
  for (const std::string command : {"render", "info", "init", "verify", "size"}) {
    const Outcome help = plisse({command, "--help"});
    EXPECT_EQ(help.code, 0) << command;
    EXPECT_THAT(help.out, HasSubstr("--"));
  }
  EXPECT_EQ(plisse({"--help"}).code, 0);
  const Outcome version = plisse({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, ::testing::MatchesRegex("plisse [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(Usage, MistakesAreTwoAndNameWhatWasMeant) {
  expect_failure(plisse({"render", square, "--wavelenth", "3"}), 2, "--wavelength");
  expect_failure(plisse({"rendr"}), 2, "render");
  expect_failure(plisse({}), 2, "render");
  expect_failure(plisse({"render"}), 2, "MODEL");
  expect_failure(plisse({"render", square, square}), 2, "too many");
  expect_failure(plisse({"render", square, "--size", "large"}), 2, "--size");
  expect_failure(plisse({"render", square, "--samples", "3"}), 2, "--samples");
  expect_failure(plisse({"render", square, "--frames", "5-"}), 2, "--frames");
  expect_failure(plisse({"render", square, "--frames", "999"}), 2, "73");
  expect_failure(plisse({"render", square, "--profile", "sinusoidal"}), 2, "sinusoid");
  expect_failure(plisse({"render", square, "--aov", "heigth"}), 2, "height");
  expect_failure(plisse({"render", square, "--only", "sqare"}), 2, "square");
  expect_failure(plisse({"render", square, "--clip", "none such"}), 2, "square");
  expect_failure(plisse({"render", square, "--skip-existing", "--overwrite"}), 2, "--overwrite");
  expect_failure(plisse({"render", square, "--threads", "none"}), 2, "--threads");
}

TEST(Usage, BadModelsAreTwoAndNamed) {
  const TemporaryFolder folder;
  write_text(folder / "text.glb", "this is no model");
  write_text(folder / "empty.obj", "# nothing\n");
  write_text(folder / "nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
  write_text(folder / "far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n");
  const std::string whole = read_text(square);
  write_text(folder / "cut.glb", whole.substr(0, whole.size() / 2));
  for (const std::string name : {"text.glb", "empty.obj", "nan.obj", "far.obj", "cut.glb", "absent.glb"}) {
    for (const std::string command : {"render", "info", "verify"}) {
      expect_failure(plisse({command, (folder / name).string()}), 2, name);
    }
  }
  EXPECT_EQ(names_in(folder.path()).size(), 5U);
}

TEST(Usage, ScenesSayWhereTheyAreWrong) {
  const TemporaryFolder folder;
  write_text(folder / "scene.toml",
             "[model]\npath = \"" + square + "\"\n[wrinkles]\nwavelenth = 0.1\nprofile = \"sine\"\n");
  const Outcome outcome = plisse({"render", (folder / "scene.toml").string()});
  expect_failure(outcome, 2, "scene.toml:4:1");
  EXPECT_THAT(outcome.err, HasSubstr("wavelength"));
  EXPECT_THAT(outcome.err, HasSubstr("scene.toml:5:"));  // all of a file's errors in one go
}

// --- no OpenGL
// ------------------------------------------------------------------------------------------------------------

TEST(NoOpenGl, IsFourAndSaysWhatHelps) {
  const TemporaryFolder folder;
  const auto render = with_tiny({"render", square, "--frames", "1", "-o", (folder / "f").string()});
  for (const auto& arguments : {render, with_tiny({"verify", square, "--frames", "1"})}) {
    const Outcome outcome = plisse(arguments, {{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json"}});
    expect_failure(outcome, 4, "tried:");
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("EGL"), HasSubstr("libgl1-mesa-dri")));
  }
  EXPECT_EQ(
      plisse({"render", "--list-devices"}, {{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json"}}).code,
      4);
  EXPECT_TRUE(names_in(folder.path()).empty());
  // What needs none works.
  EXPECT_EQ(plisse({"info", square}, {{"__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json"}}).code, 0);
}

TEST_F(Program, WithoutMesasDriverItNamesEachPath) {
  const Outcome good = plisse(
      with_tiny({"render", square, "--frames", "1", "-o", TemporaryFolder().path().string(), "--json", "-"}));
  ASSERT_EQ(good.code, 0) << good.err;
  if (good.out.find("llvmpipe") == std::string::npos) GTEST_SKIP() << "needs llvmpipe";
  const Outcome outcome =
      plisse(with_tiny({"render", square, "--frames", "1"}), {{"LIBGL_DRIVERS_PATH", "/nonexistent"}});
  expect_failure(outcome, 4, "EGL device 0");
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("surfaceless"), HasSubstr("EGL_NOT_INITIALIZED"),
                                 HasSubstr("libgl1-mesa-dri")));
}

// --- drawing
// ----------------------------------------------------------------------------------------------------------------

TEST_F(Program, ListsDevices) {
  const Outcome outcome = plisse({"render", "--list-devices"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, ::testing::StartsWith("0: "));
  expect_failure(plisse(with_tiny({"render", square, "--frames", "1", "--device", "99"})), 2, "--device 99");
}

TEST_F(Program, BadShadersAreTold) {
  const TemporaryFolder folder;
  const auto verify = with_tiny({"verify", square, "--frames", "1", "--shaders", folder.path().string()});
  expect_failure(plisse(verify), 2, (folder / "skin.comp").string());
}

TEST_F(Program, OutputThatCannotBeWrittenIsFive) {
  const TemporaryFolder folder;
  write_text(folder / "file", "in the way");
  const auto to = [&](const std::string& path) {
    return plisse(with_tiny({"render", square, "--frames", "40-44", "-o", path}));
  };
  const Outcome under_a_file = to((folder / "file/frames").string());
  EXPECT_EQ(under_a_file.code, 5) << under_a_file.err;
  EXPECT_THAT(under_a_file.err, HasSubstr("file"));
  std::filesystem::create_directory(folder / "frame_0041.png");  // a folder where a frame should stand
  const Outcome blocked = to(folder.path().string());
  EXPECT_EQ(blocked.code, 5) << blocked.err;
  EXPECT_THAT(blocked.err, HasSubstr("frame_0041.png"));
  for (const auto& name : names_in(folder.path())) {  // whole frames or none, and nothing temporary
    if (name == "file" || name == "frame_0041.png") continue;
    EXPECT_THAT(name, ::testing::MatchesRegex("frame_00[0-9]+\\.png"));
    EXPECT_NO_THROW(io::load_image(folder / name));
  }
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_EQ(plisse(with_tiny({"render", square, "--frames", "1", "-o", (folder / "f").string(), "--json",
                                "/dev/full"}))
                  .code,
              5);
  }
}

// Each frame wants 1.6 GB for its picture alone, and may have 1 GB.
TEST_F(Program, MemoryThatIsTooSmallIsSeventyFiveAndReported) {
  const TemporaryFolder folder;
  const std::string report = (folder / "report.json").string();
  const Outcome outcome =
      run_program("/bin/sh", {"-c", "ulimit -v 1500000; exec " + program_path() + " render " + square +
                                        " --frames 1-2 --samples 1 --size 16000x16000 -o " +
                                        (folder / "f").string() + " --json " + report});
  EXPECT_EQ(outcome.code, 75) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("error: "));
}

TEST_F(Program, TheHistoryIsInterruptedToo) {
  const TemporaryFolder folder;
  // A thousand steps of six thousand vertices between the two: seconds.
  const Outcome outcome =
      interrupt_program(program_path(),
                        with_tiny({"render", asset("model_b.glb").string(), "--fps", "1000", "--frames",
                                   "1,1000", "-o", folder.path().string()}),
                        SIGINT, folder / "frame_0001.png");
  EXPECT_EQ(outcome.code, 130) << outcome.err;
}

TEST_F(Program, ASignalEndsItBetweenFrames) {
  for (const auto& [signal, code] : {std::pair(SIGTERM, 143), std::pair(SIGINT, 130)}) {
    const TemporaryFolder folder;
    const Outcome outcome = interrupt_program(
        program_path(),
        {"render", asset("sleeve.toml").string(), "--size", "320x256", "-o", folder.path().string()}, signal,
        folder / "frame_0002.png");
    EXPECT_EQ(outcome.code, code) << outcome.err;
    const auto names = names_in(folder.path());
    EXPECT_GE(names.size(), 2U);
    EXPECT_LT(names.size(), 72U);
    for (const auto& name : names) {
      EXPECT_THAT(name, ::testing::MatchesRegex("frame_00[0-9]+\\.png"));
      EXPECT_NO_THROW(io::load_image(folder / name)) << name;
    }
  }
}

TEST_F(Program, AnInterruptedVerifyGivesNoVerdict) {
  const TemporaryFolder folder;
  const std::string report = (folder / "report.json").string();
  const Outcome outcome = interrupt_program_saying(
      program_path(),
      {"verify", asset("sleeve.toml").string(), "--size", "160x128", "--frames", "1-72", "--json", report},
      SIGINT, "\n");  // the first frame's line
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("interrupted"), Not(HasSubstr("\nok\n"))));
  const json written = json::parse(read_text(report));
  EXPECT_EQ(written["interrupted"], true);
  EXPECT_TRUE(written["ok"].is_null());
  // As many frames as were compared: each has its line.
  const auto lines = std::count(outcome.err.begin(), outcome.err.end(), '\n');
  EXPECT_EQ(written["frames"].size(), static_cast<std::size_t>(lines));
  EXPECT_LT(written["frames"].size(), 72U);
}

TEST_F(Program, LogsGoToStandardErrorAndQuietIsQuiet) {
  const TemporaryFolder folder;
  const auto render = with_tiny({"render", square, "--frames", "1-2", "-o", folder.path().string()});
  const Outcome normal = plisse(render);
  EXPECT_EQ(normal.code, 0);
  EXPECT_EQ(normal.out, "");
  EXPECT_THAT(normal.err, HasSubstr("frame_0002.png"));
  EXPECT_THAT(normal.err, Not(HasSubstr("\r")));  // a plain line a frame where there is no terminal
  auto quiet = render;
  quiet.push_back("-q");
  EXPECT_EQ(plisse(quiet).err, "");
}

// --- reports
// -----------------------------------------------------------------------------------------------------------------

TEST_F(Program, RenderReports) {
  const TemporaryFolder folder;
  const Outcome outcome =
      plisse(with_tiny({"render", square, "--frames", "30-31", "-o", folder.path().string(), "--json", "-"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  expect_keys(report, {"gl", "vertices", "triangles", "timer", "frames", "fps", "wall_s", "skipped"});
  expect_keys(report["gl"], {"vendor", "renderer", "version"});
  expect_keys(report["vertices"], {"render", "welded"});
  EXPECT_EQ(report["vertices"]["welded"], 91);  // assets/README.md
  EXPECT_EQ(report["triangles"], 148);
  EXPECT_THAT(report["timer"], ::testing::AnyOf("cpu", "gpu"));
  ASSERT_EQ(report["frames"].size(), 2U);
  const json& frame = report["frames"][0];
  expect_keys(frame, {"frame", "time_s", "path", "ms"});
  EXPECT_EQ(frame["frame"], 30);
  EXPECT_NEAR(frame["time_s"].get<double>(), 29 / 24.0, 1e-9);
  EXPECT_TRUE(std::filesystem::exists(frame["path"].get<std::string>()));
  expect_keys(frame["ms"], {"skin", "crush", "relax", "render", "readback", "encode", "write"});
  for (const auto& [stage, ms] : frame["ms"].items()) EXPECT_GE(ms.get<double>(), 0) << stage;
}

TEST_F(Program, VerifyReports) {
  const TemporaryFolder folder;
  const std::string file = (folder / "report.json").string();
  const Outcome outcome = plisse(with_tiny({"verify", square, "--frames", "40", "--json", file}));
  ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("ok"));
  const json report = json::parse(read_text(file));
  expect_keys(report, {"ok", "interrupted", "frames", "passes", "chain"});
  EXPECT_EQ(report["ok"], true);
  EXPECT_EQ(report["frames"], json::array({40}));
  for (const std::string pass : {"skin", "crush", "relax", "render"}) {
    ASSERT_TRUE(report["passes"].contains(pass)) << pass;
    expect_keys(report["passes"][pass], {"max_abs", "rms", "tolerance", "ok", "unit", "compared"});
    EXPECT_EQ(report["passes"][pass]["ok"], true) << pass;
  }
  expect_keys(report["passes"]["render"], {"fraction_within_4", "mean_flip", "silhouette_fraction"});
  expect_keys(report["chain"], {"phase_rms", "phase_tolerance", "image_flip", "flip_tolerance", "ok"});
  EXPECT_EQ(report["interrupted"], false);
}

// A check that compared nothing does not hold.
TEST_F(Program, VerifyNeedsSomethingToCompare) {
  const Outcome away =
      plisse(with_tiny({"verify", square, "--frames", "40", "--camera", "eye=0,0.5,3;target=0,0.5,9"}));
  EXPECT_EQ(away.code, 1) << away.out;
  EXPECT_THAT(away.out, HasSubstr("nothing in view to compare"));
  const Outcome dots = plisse({"verify", square, "--frames", "40", "--size", "4x4"});
  EXPECT_EQ(dots.code, 1) << dots.out;
  EXPECT_THAT(dots.out, AllOf(HasSubstr("silhouettes"), HasSubstr("--size")));
}

TEST(Reports, Info) {
  const Outcome outcome = plisse({"info", square, "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  expect_keys(report, {"meshes", "clips", "cameras", "textures", "bounds", "units_m", "up"});
  ASSERT_EQ(report["meshes"].size(), 1U);
  const json& mesh = report["meshes"][0];
  expect_keys(mesh, {"name", "vertices", "welded", "triangles", "bones", "max_influences", "morphs", "uv"});
  EXPECT_EQ(mesh["welded"], 91);
  EXPECT_EQ(mesh["bones"], 1);
  EXPECT_EQ(mesh["uv"], true);
  ASSERT_EQ(report["clips"].size(), 1U);
  expect_keys(report["clips"][0], {"name", "duration_s", "channels"});
  EXPECT_NEAR(report["clips"][0]["duration_s"].get<double>(), 3, 1e-6);
  EXPECT_EQ(report["units_m"], 1.0);
  EXPECT_EQ(report["up"], "y");
}

TEST(Reports, Init) {
  const TemporaryFolder folder;
  const std::string scene = (folder / "s.toml").string();
  const Outcome outcome = plisse({"init", square, "-o", scene, "--json", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json report = json::parse(outcome.out);
  expect_keys(report, {"outputs", "wall_s"});
  ASSERT_EQ(report["outputs"].size(), 1U);
  EXPECT_EQ(keys_of(report["outputs"][0]), (std::vector<std::string>{"kind", "path"}));
  const std::string text = read_text(scene);
  EXPECT_THAT(text, HasSubstr("#"));
  EXPECT_EQ(plisse({"init", square, "-o", scene}).code, 5);  // keeps what stands there
  // A folder that is not there yet: the way to the model is relative all the same.
  ASSERT_EQ(plisse({"init", square, "-o", "new/folder/s.toml"}, {}, folder.path()).code, 0);
  EXPECT_THAT(read_text(folder / "new/folder/s.toml"), Not(HasSubstr("path = \"/")));
  EXPECT_EQ(read_text(scene), text);
}

}  // namespace
}  // namespace plisse::test
