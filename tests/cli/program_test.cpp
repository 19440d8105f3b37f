// The finished program from outside: what it says, where, and the exit codes of docs/contract.md. None of
// these tests needs a driver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program.h"

namespace plisse {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

// A square of two triangles.
constexpr const char* square =
    "o cloth\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

class Program : public test::Program {
 protected:
  std::string model() const {
    test::write_text(folder_ / "cloth.obj", square);
    return path("cloth.obj");
  }
};

TEST_F(Program, VersionAndHelp) {
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, testing::MatchesRegex("plisse [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  const Outcome help = run({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* command : {"render", "info", "init", "verify", "size"}) {
    EXPECT_THAT(help.out, HasSubstr(command));
    const Outcome of_command = run({command, "--help"});
    EXPECT_EQ(of_command.code, 0) << command;
    EXPECT_THAT(of_command.out, HasSubstr("--threads")) << command;
    EXPECT_THAT(of_command.out, HasSubstr("--json")) << command;
    EXPECT_EQ(of_command.err, "") << command;
  }
}

TEST_F(Program, HelpOfRenderHasTheContractsOptions) {
  const std::string help = run({"render", "--help"}).out;
  for (const char* option :
       {"-o,--output",    "--frames",   "--fps",      "--clip",          "--size",      "--samples",
        "--wavelength",   "--profile",  "--relax",    "--rounds",        "--interval",  "--camera",
        "--background",   "--only",     "--exclude",  "--strength",      "--rest",      "--state",
        "--up",           "--units",    "--aov",      "--skip-existing", "--overwrite", "--device",
        "--list-devices", "--threads",  "-q,--quiet", "-v,--verbose",    "--json",      "--displace",
        "--budget",       "--max-error"}) {
    EXPECT_THAT(help, HasSubstr(std::string("\n  ") + option)) << option;
  }
}

TEST_F(Program, UnknownCommandsAndOptionsNameTheNearest) {
  const auto expect = [&](const std::vector<std::string>& arguments, const char* text) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << text;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr(text));
  };
  expect({"rendr", "a.glb"}, "unknown command 'rendr' (did you mean 'render'?)");
  expect({"render", "--wavelenth", "3", "a.glb"},
         "unknown option '--wavelenth' (did you mean '--wavelength'?)");
  expect({"render", "--wavelenth=3", "a.glb"}, "unknown option '--wavelenth' (did you mean '--wavelength'?)");
  expect({"verify", "a.glb", "--output", "x"}, "unknown option '--output'");
  expect({"--bogus", "info", "a.glb"}, "unknown option '--bogus'");
  expect({"--json", "-", "info", "a.glb"}, "unknown option '--json'");
  expect({"--verison"}, "unknown option '--verison' (did you mean '--version'?)");
  expect({}, "give a command: render, info, init, verify, size");
  expect({"render"}, "give a SCENE.toml or a MODEL");
  expect({"init"}, "give a MODEL");
  expect({"render", "a.glb", "b.glb"}, "'b.glb' is one argument too many");
  expect({"render", "a.glb", "--size"}, "--size");
  expect({"render", "a.glb", "-q", "-v"}, "exclude each other");
  expect({"render", "a.glb", "--skip-existing", "--overwrite"}, "exclude each other");
  expect({"render", "a.glb", "--threads", "0"}, "--threads: '0' is no whole number; allowed: 1 … 1024");
  expect({"render", "a.glb", "--device", "x"}, "--device: 'x' is no whole number");
}

TEST_F(Program, OptionsAreCheckedByTheScenesTable) {
  const Outcome outcome =
      run({"render", "a.glb", "--samples", "3", "--camera", "-30,99", "--size", "8x8", "--size", "9x9"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--samples: 3 is not among them; allowed: 1 or 4"));
  EXPECT_THAT(outcome.err, HasSubstr("--camera: elevation: 99 is out of range"));
  EXPECT_THAT(outcome.err, HasSubstr("--size: given 2 times"));
}

TEST_F(Program, OnlyTakesOneNameEachTime) {
  // If "--only cloth" swallowed the model's name too, the model would be missing.
  EXPECT_EQ(run({"info", model()}).code, 0);
  EXPECT_THAT(run({"render", "--only", "cloth", path("none.obj")}).err, HasSubstr("none.obj"));
}

TEST_F(Program, MissingAndBrokenModelsAreBadInput) {
  const Outcome missing = run({"info", path("none.glb")});
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("none.glb"));
  test::write_text(folder_ / "bad.glb", "glTF, not really");
  EXPECT_EQ(run({"info", path("bad.glb")}).code, 2);
  EXPECT_EQ(run({"render", path("none.toml")}).code, 2);
  test::write_text(folder_ / "bad.toml", "[model]\npath = \"none.glb\"\n[output]\nsamples = 3\n");
  const Outcome scene = run({"render", path("bad.toml")});
  EXPECT_EQ(scene.code, 2);
  EXPECT_THAT(scene.err, HasSubstr(path("bad.toml") + ":2:1: key 'path'"));
  EXPECT_THAT(scene.err, HasSubstr(path("bad.toml") + ":4:1: key 'samples'"));
}

TEST_F(Program, InfoTellsWhatTheModelHas) {
  const Outcome table = run({"info", model()});
  EXPECT_EQ(table.code, 0);
  EXPECT_THAT(table.out, HasSubstr("2 triangles, 4 vertices, 4 welded"));
  EXPECT_THAT(table.out, HasSubstr("cloth"));

  const Outcome outcome = run({"info", model(), "--json", "-", "--units", "1 cm"});
  EXPECT_EQ(outcome.code, 0);
  const json report = json::parse(outcome.out);  // nothing but the report on standard output
  // The keys of docs/contract.md.
  ASSERT_EQ(report["meshes"].size(), 1U);
  const json& mesh = report["meshes"][0];
  EXPECT_EQ(mesh["welded"], 4);
  EXPECT_EQ(mesh["triangles"], 2);
  EXPECT_EQ(mesh["bones"], 0);
  EXPECT_EQ(mesh["morphs"], 0);
  EXPECT_EQ(mesh["uv"], true);
  for (const char* key : {"name", "vertices", "max_influences"}) EXPECT_TRUE(mesh.contains(key)) << key;
  EXPECT_EQ(report["clips"].size(), 0U);
  for (const char* key : {"cameras", "textures", "up", "wavelength_m", "materials"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  EXPECT_EQ(report["units_m"], 0.01);
  // A unit square in centimetres; single precision on the way.
  EXPECT_NEAR(report["bounds"]["high"][0].get<double>() - report["bounds"]["low"][0].get<double>(), 0.01,
              1e-8);
}

TEST_F(Program, ReportsAreWrittenWholeBesideTheTable) {
  const Outcome outcome = run({"info", model(), "--json", path("reports/info.json")});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out, "");
  EXPECT_EQ(json::parse(test::read_text(folder_ / "reports/info.json"))["triangles"], 2);
  EXPECT_EQ(run({"info", model(), "-q"}).out, "");
  EXPECT_EQ(run({"info", model(), "--json", path("cloth.obj/x.json")}).code, 5);
}

TEST_F(Program, FullDisksAndClosedErrorsHaveTheirCodes) {
  EXPECT_EQ(run({"info", model()}, "/dev/full").code, 5);
  EXPECT_EQ(run({"--help"}, "/dev/full").code, 5);
  EXPECT_EQ(run({"info", path("none.glb")}, "", true).code, 2);
}

TEST_F(Program, InitWritesASceneThatNamesTheModelFromItsOwnFolder) {
  std::filesystem::create_directories(folder_ / "scenes");
  const std::string scene = path("scenes/cloth.toml");
  const Outcome outcome = run({"init", model(), "-o", scene, "--json", path("init.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const json report = json::parse(test::read_text(folder_ / "init.json"));
  EXPECT_EQ(report["outputs"][0]["path"], scene);
  EXPECT_EQ(report["outputs"][0]["kind"], "scene");
  EXPECT_TRUE(report["wall_s"].is_number());
  const std::string text = test::read_text(scene);
  EXPECT_THAT(text, HasSubstr("\npath = \"../cloth.obj\"\n"));
  EXPECT_THAT(text, HasSubstr("Meshes here: \"cloth\"."));
  // The scene is a way to the same model.
  EXPECT_EQ(json::parse(run({"info", scene, "--json", "-"}).out)["meshes"],
            json::parse(run({"info", model(), "--json", "-"}).out)["meshes"]);
}

TEST_F(Program, InitDoesNotReplaceAScene) {
  const std::string scene = path("mine.toml");
  test::write_text(scene, "# mine\n");
  const Outcome refused = run({"init", model(), "-o", scene});
  EXPECT_EQ(refused.code, 5);
  EXPECT_THAT(refused.err, HasSubstr("--overwrite"));
  EXPECT_EQ(test::read_text(scene), "# mine\n");
  EXPECT_EQ(run({"init", model(), "-o", scene, "--overwrite"}).code, 0);
  EXPECT_THAT(test::read_text(scene), HasSubstr("[model]"));
  EXPECT_EQ(run({"init", model(), "-o", path("mine.txt")}).code, 2);
  EXPECT_EQ(run({"init", path("none.obj"), "-o", path("none.toml")}).code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.toml"));
  EXPECT_EQ(run({"init", model(), "-o", path("cloth.obj/x.toml")}).code, 5);
}

TEST_F(Program, InitMakesTheReference) {
  const Outcome outcome = run({"init", "--keys-markdown"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, test::read_text(test::source_file("docs/scene.md")));
}

}  // namespace
}  // namespace plisse
