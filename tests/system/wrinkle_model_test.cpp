// plisse wrinkle of a moving mesh: base surfaces that follow it, fields, and the scene that draws them.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "io/wrinkle_field.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::HasSubstr;

class WrinkleModel : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  nlohmann::json report() const { return nlohmann::json::parse(read_text(folder_ / "report.json")); }
  // A sheet of 1 m, flat in frame 1, then pressed together with the zigzags of a simulation whose mesh is too
  // coarse.
  void write_sheets(int frames, double pressed) const {
    constexpr int n = 20;
    for (int frame = 1; frame <= frames; ++frame) {
      std::ofstream obj(folder_ / ("sheet_000" + std::to_string(frame) + ".obj"));
      const double share = frames > 1 ? pressed * (frame - 1) / (frames - 1) : pressed;
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
          obj << "v " << (1 - share) * i / n << ' ' << double(j) / n << ' '
              << ((i % 2 == 0) ? 1 : -1) * 0.5 / n * std::sqrt(1 - (1 - share) * (1 - share)) << '\n';
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const int a = j * (n + 1) + i + 1;
          obj << "f " << a << ' ' << a + 1 << ' ' << a + n + 2 << ' ' << a + n + 1 << '\n';
        }
    }
  }
  TemporaryFolder folder_;
};

TEST_F(WrinkleModel, ACoarseSimulationBecomesCloth) {
  write_sheets(4, 0.1);
  const Outcome outcome =
      plisse({"wrinkle", file("sheet_####.obj"), "-o", file("waves"), "--json", file("report.json"), "-q"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = report();
  ASSERT_EQ(json["frames"].size(), 4U);
  EXPECT_EQ(json["shells"], 1);
  EXPECT_NEAR(json["follow_m"].get<double>(), 0.4, 0.1);  // eight edges of 50 to 71 mm
  // Flat at first: exactly calm.
  EXPECT_EQ(json["frames"][0]["max_amplitude_m"], 0);
  EXPECT_LT(json["frames"][0]["moved_most_m"].get<double>(), 1e-9);
  // Pressed by a tenth: the zigzags are gone from the base, whose lines up the sheet are a tenth shorter than
  // at rest, and go to waves.
  const auto& last = json["frames"][3];
  EXPECT_TRUE(last["follow_converged"]);
  EXPECT_LT(last["length_kept"].get<double>(), 1);
  EXPECT_GT(last["moved_rms_m"].get<double>(), 5e-3);  // zigzags of 11 mm either way
  io::read_wrinkle_field(file("waves/field_0004.ply"), {});
  ASSERT_EQ(plisse({"render", file("waves/scene.toml"), "--frames", "4", "--size", "64x64", "-o",
                    file("frames"), "-q"})
                .code,
            0);
  // The base surfaces are some as any other. Alone, not fading in: the waves take up what is lacking, ½(aω)²
  // = 1 − .9².
  ASSERT_EQ(plisse({"wrinkle", file("waves/base_0004.ply"), "-o", file("field.ply"), "--json",
                    file("report.json"), "-q"})
                .code,
            0);
  const double slope = report()["max_amplitude_m"].get<double>() * 2 * M_PI * report()["waves"].get<double>();
  EXPECT_NEAR(slope * slope / 2, 1 - 0.9 * 0.9, 0.03);  // highest in the middle, lower at the free sides
  // Waves twice as long are those of a cloth four times as thick.
  ASSERT_EQ(plisse({"wrinkle", file("sheet_####.obj"), "--wavelength", "40 cm", "-o", file("long"), "--json",
                    file("report.json"), "-q"})
                .code,
            0);
  const double thick = report()["thickness_m"].get<double>();
  ASSERT_EQ(plisse({"wrinkle", file("sheet_####.obj"), "--wavelength", "20 cm", "-o", file("short"), "--json",
                    file("report.json"), "-q"})
                .code,
            0);
  EXPECT_NEAR(thick / report()["thickness_m"].get<double>(), 4, 1);
}

TEST_F(WrinkleModel, FacesThatAreNoShellArePartedOrLeftOut) {
  write_sheets(1, 0);
  {
    std::ofstream obj(folder_ / "sheet_0001.obj", std::ios::app);
    obj << "v 0.5 0.5 0.3\nf 221 222 442\nf 1 1 2\n";  // a fin on an inner edge, and no triangle at all
  }
  const Outcome outcome =
      plisse({"wrinkle", file("sheet_0001.obj"), "-o", file("waves"), "--json", file("report.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("parted at 1 edges where faces"));
  EXPECT_EQ(report()["shells"], 2);
  EXPECT_FALSE(report()["warnings"].empty());
}

// One command: base, field and picture; what is not selected stays as it is.
TEST_F(WrinkleModel, RenderSolvesInOneRun) {
  write_sheets(4, 0.1);
  for (int frame = 1; frame <= 4; ++frame) {  // a stiff plate above, that turns
    std::ofstream obj(folder_ / ("sheet_000" + std::to_string(frame) + ".obj"), std::ios::app);
    obj << "o plate\nv 0 0 " << 0.3 + 0.05 * frame << "\nv 0.5 0 0.4\nv 0 0.5 0.4\nf 442 443 444\n";
  }
  const auto run = [&](std::vector<std::string> arguments) {
    for (const char* more : {"--solve", "--exclude", "plate", "--json"}) arguments.emplace_back(more);
    arguments.push_back(file("report.json"));
    arguments.insert(arguments.begin() + 1, file("sheet_####.obj"));
    arguments.emplace_back("--cache-dir");
    arguments.push_back(file("cache"));
    return plisse(arguments);
  };
  Outcome outcome = run({"render", "--size", "96x80", "-o", file("whole")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto solve = report()["solve"];
  ASSERT_EQ(solve["frames"].size(), 4U);
  EXPECT_EQ(solve["vertices"], 441);
  EXPECT_EQ(solve["frames"][0]["max_amplitude_m"], 0);
  EXPECT_GT(solve["frames"][3]["max_amplitude_m"].get<double>(), 1e-3);
  EXPECT_LT(solve["frames"][3]["untaken"].get<double>(), solve["frames"][1]["untaken"].get<double>());
  EXPECT_FALSE(solve["skipped"].contains("solved before"));

  // A frame alone has the same bytes, whether it was solved before or not.
  ASSERT_EQ(run({"render", "--size", "96x80", "--frames", "3", "-o", file("known")}).code, 0);
  EXPECT_TRUE(read_text(folder_ / "known/frame_0003.png") == read_text(folder_ / "whole/frame_0003.png"));
  EXPECT_GT(report()["solve"]["skipped"]["solved before"].get<int>(), 0);
  std::filesystem::remove_all(folder_ / "cache");
  ASSERT_EQ(run({"render", "--size", "96x80", "--frames", "3", "-o", file("alone")}).code, 0);
  EXPECT_TRUE(read_text(folder_ / "alone/frame_0003.png") == read_text(folder_ / "whole/frame_0003.png"));

  // The base surface, without its waves; the plate's vertices are those of the file.
  ASSERT_EQ(
      run({"export", "--strength", "0", "--levels", "0", "--frames", "4", "-o", file("base_####.obj")}).code,
      0);
  const std::string base = read_text(folder_ / "base_0004.obj");
  EXPECT_NE(base.find("v 0.5 0 0.4"), std::string::npos);
  ASSERT_EQ(run({"verify", "--frames", "2,4", "--size", "96x80"}).code, 0);

  // The field as bias of the passes: shaders and reference over all frames, and any frame alone.
  ASSERT_EQ(run({"verify", "--frames", "2,4", "--size", "96x80", "--method", "bias"}).code, 0);
  ASSERT_EQ(run({"render", "--size", "96x80", "--method", "bias", "-o", file("bias")}).code, 0);
  ASSERT_EQ(
      run({"render", "--size", "96x80", "--frames", "4", "--method", "bias", "-o", file("bias_alone")}).code,
      0);
  EXPECT_TRUE(read_text(folder_ / "bias_alone/frame_0004.png") == read_text(folder_ / "bias/frame_0004.png"));
  EXPECT_FALSE(read_text(folder_ / "bias/frame_0004.png") == read_text(folder_ / "whole/frame_0004.png"));

  // Passes in place of the field, and the same in a scene.
  ASSERT_EQ(
      run({"render", "--size", "96x80", "--frames", "4", "--method", "passes", "-o", file("passes")}).code,
      0);
  EXPECT_EQ(report()["solve"]["frames"][3]["max_amplitude_m"], 0);
  EXPECT_FALSE(read_text(folder_ / "passes/frame_0004.png") == read_text(folder_ / "whole/frame_0004.png"));
  std::ofstream(folder_ / "scene.toml")
      << "[model]\npath = \"sheet_####.obj\"\n[wrinkles]\nexclude = \"plate\"\n[solve]\n[output]\nsize = "
         "[96, 80]\n";
  ASSERT_EQ(plisse({"render", file("scene.toml"), "--frames", "3", "-o", file("scene"), "-q"}).code, 0);
  EXPECT_TRUE(read_text(folder_ / "scene/frame_0003.png") == read_text(folder_ / "whole/frame_0003.png"));
}

// Triangles that are not selected keep their shape also where they share vertices with the cloth.
TEST_F(WrinkleModel, WhatIsNotSelectedStaysToItsBorder) {
  write_sheets(3, 0.1);
  std::vector<double> z;  // of the row between, as the file has it
  for (int frame = 1; frame <= 3; ++frame) {
    const auto path = folder_ / ("sheet_000" + std::to_string(frame) + ".obj");
    std::istringstream all(read_text(path));
    std::ofstream obj(path);
    int faces = 0, vertices = 0;
    for (std::string line; std::getline(all, line);) {
      if (line.starts_with("v ") && ++vertices > 210 && vertices <= 231 && frame == 3)
        z.push_back(std::stod(line.substr(line.rfind(' '))));
      if (line.starts_with("f ") && faces++ % 200 == 0) obj << (faces == 1 ? "o cloth\n" : "o hard\n");
      obj << line << '\n';
    }
  }
  ASSERT_EQ(
      plisse({"export", file("sheet_####.obj"), "--solve", "--exclude", "hard", "--strength", "0", "--levels",
              "0", "--frames", "3", "-o", file("base.obj"), "-q", "--json", file("report.json")})
          .code,
      0);
  EXPECT_GT(report()["solve"]["frames"][2]["moved_rms_m"].get<double>(), 1e-3);  // the cloth itself moved
  std::istringstream base(read_text(folder_ / "base.obj"));
  std::vector<double> found;
  for (std::string line; std::getline(base, line);) {
    double x = 0, y = 0, height = 0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &height) == 3 && std::abs(y - 0.5) < 1e-6)
      found.push_back(height);
  }
  ASSERT_EQ(z.size(), 21U);
  ASSERT_GE(found.size(), 21U);
  for (const double height : found)
    EXPECT_NEAR(std::abs(height), std::abs(z[0]), 1e-6);  // a zigzag of one height
}

// A node that shrinks its whole mesh strains no cloth.
TEST_F(WrinkleModel, ScaledAsAWholeIsNoStrain) {
  for (int frame = 1; frame <= 2; ++frame) {
    std::ofstream obj(folder_ / ("ball_000" + std::to_string(frame) + ".obj"));
    const double s = frame == 1 ? 1 : 0.7;
    for (const auto& [x, y, z] :
         {std::array{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
      obj << "v " << s * x + frame << ' ' << s * y << ' ' << s * z << '\n';
    for (const char* face : {"1 3 5", "3 2 5", "2 4 5", "4 1 5", "3 1 6", "2 3 6", "4 2 6", "1 4 6"})
      obj << "f " << face << '\n';
  }
  const Outcome outcome = plisse({"render", file("ball_####.obj"), "--solve", "--size", "64x64", "-o",
                                  file("frames"), "--json", file("report.json"), "-q"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto last = report()["solve"]["frames"][1];
  EXPECT_LT(last["compression"].get<double>(), 1e-5);  // of files with six digits
  EXPECT_EQ(last["max_amplitude_m"], 0);
  EXPECT_NEAR(last["length_kept"].get<double>(), 1, 1e-5);
  EXPECT_EQ(report()["solve"]["skipped"]["moved as a whole"], 2);  // the rest pose is moved by nothing
}

TEST_F(WrinkleModel, SolveSaysWhatIsWrong) {
  write_sheets(2, 0.1);
  const auto error = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", file("sheet_####.obj"), "-o", file("frames")});
    const Outcome outcome = plisse(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(error({"--follow", "1 m"}), HasSubstr("--follow: goes with --solve"));
  EXPECT_THAT(error({"--solve", "--fabric", "1e-6,1e5", "--wavelength", "1 cm"}), HasSubstr("give one"));
  EXPECT_THAT(error({"--solve", "--fabric", "paper lanterns"}), HasSubstr("--fabric"));
  EXPECT_THAT(error({"--solve", "--only", "nothing"}), HasSubstr("nothing"));
  EXPECT_THAT(error({"--solve", "--exclude", "sheet_0001"}), HasSubstr("no triangle is selected"));
  // A rest shape in another unit.
  std::ofstream other(folder_ / "small.obj");
  std::ifstream first(folder_ / "sheet_0001.obj");
  for (std::string kind; first >> kind;) {
    if (kind == "v") {
      double x = 0, y = 0, z = 0;
      first >> x >> y >> z;
      other << "v " << 1e-3 * x << ' ' << 1e-3 * y << ' ' << 1e-3 * z << '\n';
    } else {
      std::string rest;
      std::getline(first, rest);
      other << kind << rest << '\n';
    }
  }
  other.close();
  EXPECT_THAT(error({"--solve", "--rest", file("small.obj")}), HasSubstr("times as large as its rest shape"));
  // One that has other vertices, and a frame with other faces.
  std::ofstream(folder_ / "other.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_THAT(error({"--solve", "--rest", file("other.obj")}), HasSubstr("they must be the same mesh"));
  std::filesystem::copy(folder_ / "other.obj", folder_ / "sheet_0003.obj");
  EXPECT_THAT(error({"--solve"}), HasSubstr("sheet_0003.obj"));
  std::filesystem::remove(folder_ / "sheet_0003.obj");
  std::ofstream(folder_ / "bias.toml") << "[model]\npath = \"sheet_####.obj\"\n[bias]\nfield = "
                                          "\"field_####.ply\"\nuse = \"direct\"\n[solve]\n";
  EXPECT_THAT(plisse({"render", file("bias.toml")}).err, HasSubstr("stands beside [solve]"));
}

TEST_F(WrinkleModel, SaysWhatIsWrong) {
  write_sheets(3, 0.1);
  const auto error = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "wrinkle");
    const Outcome outcome = plisse(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(error({file("sheet_####.obj"), "-o", file("field.ply")}), HasSubstr("a folder"));
  EXPECT_THAT(error({file("sheet_####.obj")}), HasSubstr("-o is missing"));
  EXPECT_THAT(
      error({file("sheet_####.obj"), "-o", file("waves"), "--fabric", "1e-6,1e5", "--wavelength", "1 cm"}),
      HasSubstr("give one"));
  EXPECT_THAT(error({file("sheet_####.obj"), "-o", file("waves"), "--follow", "long"}),
              HasSubstr("--follow: 'long'"));
  EXPECT_THAT(error({file("sheet_####.obj"), "-o", file("waves"), "--only", "nothing"}),
              HasSubstr("nothing"));
  EXPECT_THAT(error({file("sheet_####.obj"), "-o", file("waves"), "--frames", "4"}), HasSubstr("4"));
  EXPECT_THAT(error({"--example", "stretched-sheet", "--follow", "1 m", "-o", file("field.ply")}),
              HasSubstr("--follow"));
  EXPECT_THAT(error({file("sheet_####.obj"), "-o", file("waves"), "--wavelength", "-1"}),
              HasSubstr("--wavelength: -1"));
  EXPECT_THAT(error({file("sheet_####.obj"), "-o", file("waves"), "--fade", "slow"}), HasSubstr("--fade"));
  EXPECT_THAT(error({file("sheet_####.obj"), "-o", file("waves"), "--mesh", file("m.ply")}),
              HasSubstr("m_####.ply"));
  EXPECT_THAT(error({file("sheet_####.obj"), "-o", file("waves"), "--local-law"}), HasSubstr("--local-law"));
  EXPECT_THAT(error({file("sheet_####.obj"), "-o", file("sheet_0001.obj")}), HasSubstr("a file"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "waves/base_0001.ply"));
  // A folder with a dot in its name is one, and frames with a gap can be played.
  EXPECT_EQ(plisse({"wrinkle", file("sheet_####.obj"), "-o", file("walk.v2"), "--frames", "1,3", "-q"}).code,
            0);
  EXPECT_EQ(
      plisse({"render", file("walk.v2/scene.toml"), "--size", "32x32", "-o", file("frames"), "-q"}).code, 0);
}

}  // namespace
}  // namespace plisse::test
