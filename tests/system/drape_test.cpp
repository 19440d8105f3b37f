// plisse drape from outside: what is written, that other commands read it, and how it ends.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <glm/glm.hpp>
#include <map>
#include <numbers>

#include "io/ply.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Drape, WritesABaseSurfaceAndItsReport) {
  const TemporaryFolder folder;
  const std::string base = (folder / "base.ply").string(), report = (folder / "report.json").string();
  const Outcome outcome =
      plisse({"drape", "--example", "strip", "--vertices", "120", "-o", base, "--json", report});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(read_text(report));
  for (const char* key : {"vertices", "faces", "model", "energy_J", "gradient_inf", "iterations", "converged",
                          "reason", "wall_s", "peak_rss_MiB", "measures"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["model"], "tension-field");
  // ½Yh(λ₁/2)²A; the mesher's grid places the ends to some 1e-7 of the length, a tenth of which is the
  // stretch.
  EXPECT_NEAR(json["energy_J"].get<double>() / (0.5 * 1e6 * 1e-4 * 0.105 * 0.105 * 0.025), 1, 2e-6);
  EXPECT_NEAR(json["vertices"].get<double>(), 120, 24);

  const io::Ply ply = io::read_ply(base);
  const auto* faces = ply.find("face");
  ASSERT_TRUE(faces && faces->find("rest"));
  double area = 0;  // of the rest triangles: the strip's
  const auto& rest = faces->find("rest")->values;
  for (std::size_t f = 0; f < faces->count; ++f)
    area += 0.5 * (rest[6 * f + 2] * rest[6 * f + 5] - rest[6 * f + 3] * rest[6 * f + 4]);
  EXPECT_NEAR(area, 0.025, 1e-9);
  EXPECT_EQ(faces->count, json["faces"]);
  const Outcome info = plisse({"info", base});
  EXPECT_EQ(info.code, 0) << info.err;
}

TEST(Drape, FramesBecomeACacheOrASequenceThatRenderReads) {
  const TemporaryFolder folder;
  const std::string base = (folder / "base.ply").string();
  const std::vector<std::string> command = {
      "drape", "--example", "twisted-cylinder", "--vertices", "120", "--frames", "1-24x6", "-q", "-o", base};
  const Outcome outcome = plisse(command);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Outcome info = plisse({"info", base, "--cache", (folder / "base.pc2").string(), "--json", "-"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_EQ(nlohmann::json::parse(info.out)["sequence"]["frames"], 4);
  auto numbered = command;
  numbered.back() = (folder / "twist_####.ply").string();
  ASSERT_EQ(plisse(numbered).code, 0);
  for (const char* name : {"twist_0001.ply", "twist_0007.ply", "twist_0013.ply", "twist_0019.ply"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  // The same surface, whether it came along or alone.
  EXPECT_EQ(read_bytes(folder / "twist_0001.ply"), read_bytes(base));
}

TEST(Drape, StoppingShortIsOneAndMarked) {
  const TemporaryFolder folder;
  const std::string base = (folder / "base.ply").string(), report = (folder / "report.json").string();
  const Outcome outcome = plisse({"drape", "--example", "stretched-sheet", "--vertices", "100",
                                  "--iterations", "1", "-o", base, "--json", report});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  const auto json = nlohmann::json::parse(read_text(report));
  EXPECT_FALSE(json["converged"].get<bool>());
  EXPECT_THAT(json["reason"].get<std::string>(), HasSubstr("limit of 1 iterations"));
  EXPECT_THAT(io::read_ply(base).comments, ::testing::Contains(HasSubstr("not converged")));
}

// Some thousand small steps: the signal comes after the first of them.
TEST(Drape, AnInterruptLeavesTheLastGoodState) {
  const TemporaryFolder folder;
  const std::string base = (folder / "base.ply").string(), report = (folder / "report.json").string();
  const Outcome outcome = interrupt_program_saying(
      program_path(),
      {"drape", "--example", "cantilever", "--vertices", "3000", "-v", "-o", base, "--json", report}, SIGINT,
      "step 1:");
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_THAT(io::read_ply(base).comments,
              ::testing::Contains(HasSubstr("not converged: it was interrupted")));
  const auto json = nlohmann::json::parse(read_text(report));
  EXPECT_TRUE(json["interrupted"].get<bool>());
  EXPECT_FALSE(json["converged"].get<bool>());
}

TEST(Drape, RefusesWhatMakesNoSense) {
  const TemporaryFolder folder;
  const auto refused = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "drape");
    arguments.insert(arguments.end(), {"-o", (folder / "base.ply").string()});
    const Outcome outcome = plisse(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(refused({"--example", "stripp"}), HasSubstr("did you mean 'strip'"));
  EXPECT_THAT(refused({"--example", "strip", "--model", "stvq"}), HasSubstr("did you mean 'stvk'"));
  EXPECT_THAT(refused({"--example", "strip", "--frames", "25"}), HasSubstr("24"));
  EXPECT_THAT(refused({}), HasSubstr("give a SCENE.toml"));
  EXPECT_THAT(refused({"--example", "cantilever", "--residual", "0.1"}), HasSubstr("is for tension fields"));
  EXPECT_THAT(refused({"--example", "strip", "--frames", "1,2,5"}), HasSubstr("evenly spaced"));
  const Outcome unnamed = plisse({"drape", "--example", "strip", "-o", ""});
  EXPECT_EQ(unnamed.code, 2);
  EXPECT_THAT(unnamed.err, HasSubstr("end the name with .ply"));
  write_text(
      folder / "odd.json",
      "{\"youngs_modulus\": 1e6, \"poisson_ratio\": 0.3, \"thickness\": 1e-3, \"rest_mesh\": \"x.obj\", "
      "\"bending_type\": \"qadratic\"}");
  EXPECT_THAT(refused({(folder / "odd.json").string()}), HasSubstr("'qadratic'; allowed: quadratic"));
  write_text(folder / "capsule.toml",
             "[drape]\npanel = [1, 1]\n[[obstacle]]\nkind = \"capsule\"\nradius = 0.1\n");
  EXPECT_THAT(refused({(folder / "capsule.toml").string()}),
              AllOf(HasSubstr("key 'at': missing"), HasSubstr("key 'to': missing")));
  write_text(folder / "bad.toml",
             "[drape]\npanel = [1]\nvertice = 5\n[material]\npoisson = 0.6\n[[hold]]\nturn = "
             "1\n[[obstacle]]\nkind = \"cube\"\n");
  const std::string all = refused({(folder / "bad.toml").string()});
  EXPECT_THAT(all, AllOf(HasSubstr("bad.toml:2"), HasSubstr("did you mean 'vertices'"),
                         HasSubstr("bad.toml:5"), HasSubstr("needs either 'box' or 'vertices'"),
                         HasSubstr("sphere, plane, capsule, cylinder or mesh")));
  write_text(folder / "loose.toml", "[drape]\npanel = [1, 1]\nvertices = 30\n[material]\ndensity = 100\n");
  EXPECT_THAT(refused({(folder / "loose.toml").string()}),
              HasSubstr("held by nothing and gravity pulls at it"));
}

// A square of .3 m, held at its upper corners and lowered onto a plane.
TEST(Drape, SceneFiles) {
  const TemporaryFolder folder;
  write_text(folder / "cloth.toml",
             "[drape]\npanel = [\"30 cm\", 0.3]\nvertices = 200\nplane = \"xz\"\n"
             "[material]\nyoung = 1e5\nthickness = \"0.5 mm\"\ndensity = 400\n[loads]\ngap = \"1 mm\"\n"
             "[[hold]]\nbox = [[-1, -1, -0.001], [1, 1, 0.001]]\nmove = [0, -0.05, 0]\n"
             "[[obstacle]]\nkind = \"plane\"\nat = [0, -0.1, 0]\n");
  const std::string base = (folder / "base.ply").string();
  const Outcome outcome = plisse({"drape", (folder / "cloth.toml").string(), "-o", base});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const io::Ply ply = io::read_ply(base);
  double low = 1, high = -1;
  for (const double y : ply.find("vertex")->find("y")->values) {
    low = std::min(low, y);
    high = std::max(high, y);
  }
  EXPECT_GT(low, -0.1);
  EXPECT_LT(low, -0.099);  // hangs down to the plane and lies on it, within the gap
  EXPECT_NEAR(high, -0.05, 1e-12);
}

// A strip pulled at its end, a metre of which bears 2 N: σ h = 2 N/m, so λ₁/2 (1 + λ₁)^½ · Y h = 2 (the load
// is dead, a rest length).
TEST(Drape, EdgeForces) {
  const TemporaryFolder folder;
  write_text(folder / "strip.toml",
             "[drape]\npanel = [0.2, 0.1]\nvertices = 100\nframes = 3\n"
             "[material]\nyoung = 1e5\nthickness = \"0.2 mm\"\npoisson = 0.3\n"
             "[loads]\ngravity = [0, 0, 0]\n"
             "[[hold]]\nbox = [[-9, -9, -9], [9, 9, 9]]\naxes = \"z\"\n"
             "[[hold]]\nbox = [[-1, -1, -1], [1e-6, 1, 1]]\naxes = \"x\"\n"
             "[[hold]]\nvertices = [0]\naxes = \"y\"\n"
             "[[force]]\nbox = [[0.199999, -1, -1], [1, 1, 1]]\nper_length = [2, 0, 0]\ngrows = true\n");
  const std::string base = (folder / "base.ply").string();
  const Outcome outcome = plisse({"drape", (folder / "strip.toml").string(), "-o", base});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const io::Ply ply = io::read_ply(base);
  const auto& x = ply.find("vertex")->find("x")->values;
  // F; λ₁ = F² − 1, and a rest length bears ½Yh λ₁ F of it.
  const double stretch = *std::max_element(x.begin(), x.end()) / 0.2;
  EXPECT_NEAR(0.5 * 1e5 * 2e-4 * (stretch * stretch - 1) * stretch, 2, 1e-6);
}

// A plate strip clamped at both ends sags under its weight and bends most in its middle. Half of it up to a
// mirror there is the same surface, vertex by vertex; without the mirror it is a strip that ends there, free
// to turn, and sags further.
TEST(Drape, MirrorsBendAndStretchAsTheWhole) {
  const TemporaryFolder folder;
  constexpr int half = 8, rows = 3;  // columns; x from 0 to .2 m in 16
  const auto write_mesh = [&](const char* name, int columns) {
    std::string obj;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) obj += fmt::format("v {} {} 0\n", 0.0125 * i, 0.0125 * j);
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const int a = j * (columns + 1) + i + 1, b = a + 1, c = a + columns + 1, d = c + 1;
        // The diagonals of the second half are the first one's mirror images.
        obj += i < half ? fmt::format("f {0} {1} {3}\nf {0} {3} {2}\n", a, b, c, d)
                        : fmt::format("f {0} {1} {2}\nf {1} {3} {2}\n", a, b, c, d);
      }
    write_text(folder / name, obj);
  };
  write_mesh("whole.obj", 2 * half);
  write_mesh("half.obj", half);
  const auto draped = [&](const std::string& mesh, const std::string& hold) {
    write_text(folder / "plate.toml", "[drape]\nmesh = \"" + mesh +
                                          "\"\nmodel = \"stvk\"\ntolerance = 1e-9\n"
                                          "[material]\nyoung = 1e6\nthickness = \"1 mm\"\ndensity = 3\n"
                                          "[loads]\ngravity = [0, 0, -9.81]\n"
                                          "[[hold]]\nbox = [[-1, -1, -1], [0.013, 1, 1]]\n" +
                                          hold);
    const std::string base = (folder / "base.ply").string();
    const Outcome outcome = plisse({"drape", (folder / "plate.toml").string(), "--perturb", "0", "-o", base});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const io::Ply ply = io::read_ply(base);
    std::vector<glm::dvec3> points;
    const auto* vertex = ply.find("vertex");
    for (std::size_t v = 0; v < vertex->count; ++v)
      points.emplace_back(vertex->find("x")->values[v], vertex->find("y")->values[v],
                          vertex->find("z")->values[v]);
    return points;
  };
  const std::string middle = "[[hold]]\nbox = [[0.0999, -1, -1], [1, 1, 1]]\naxes = \"x\"\n";
  const auto whole = draped("whole.obj", "[[hold]]\nbox = [[0.187, -1, -1], [1, 1, 1]]\n"),
             mirrored = draped("half.obj", middle + "mirror = true\n"), ended = draped("half.obj", middle);
  ASSERT_EQ(whole.size(), std::size_t{(2 * half + 1) * (rows + 1)});
  ASSERT_EQ(mirrored.size(), std::size_t{(half + 1) * (rows + 1)});
  double apart = 0, sag = 0, free_sag = 0;
  for (std::size_t j = 0; j <= rows; ++j)
    for (std::size_t i = 0; i <= half; ++i) {
      const std::size_t v = j * (half + 1) + i;
      apart = std::max(apart, glm::distance(mirrored[v], whole[j * (2 * half + 1) + i]));
      sag = std::max(sag, -mirrored[v].z);
      free_sag = std::max(free_sag, -ended[v].z);
    }
  // Forces balance to 1e-9 of those that meet, which the bending, the softest there is, makes some 1e-7 of
  // the sag of.
  EXPECT_LT(apart, 1e-6 * sag);
  EXPECT_GT(free_sag, 1.2 * sag);
}

// Cloth on a plane that moves in itself by 5 cm: with friction it goes along, without it stays.
TEST(Drape, FrictionTakesClothAlong) {
  const TemporaryFolder folder;
  const auto edge = [&](const std::string& friction) {
    write_text(folder / "carried.toml",
               "[drape]\npanel = [0.3, 0.3]\nvertices = 120\nplane = \"xz\"\nframes = 5\niterations = 400\n"
               "[material]\nyoung = 1e5\nthickness = \"1 mm\"\ndensity = 200\n[loads]\nfriction = " +
                   friction + "\n[[obstacle]]\nkind = \"plane\"\nat = [0, -0.001, 0]\nmove = [0.05, 0, 0]\n");
    const std::string base = (folder / "base.ply").string();
    const Outcome outcome = plisse({"drape", (folder / "carried.toml").string(), "-o", base});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const io::Ply ply = io::read_ply(base);
    const auto& x = ply.find("vertex")->find("x")->values;
    return *std::max_element(x.begin(), x.end());
  };
  EXPECT_NEAR(edge("0.3"), 0.35, 2e-4);  // up to the slip length, a tenth of the gap of 2 mm
  EXPECT_NEAR(edge("0"), 0.3, 1e-3);     // it shrinks a little over what it hovers on
}

// Falling is no sliding, however far.
TEST(Drape, ClothFallsOntoAFloorFarBelow) {
  const TemporaryFolder folder;
  write_text(folder / "fall.toml",
             "[drape]\npanel = [0.1, 0.1]\nvertices = 60\nplane = \"xz\"\n[material]\nyoung = 1e5\nthickness "
             "= \"1 mm\"\n"
             "density = 200\n[[obstacle]]\nkind = \"plane\"\nat = [0, -1.2, 0]\n");
  const std::string base = (folder / "base.ply").string();
  const Outcome outcome = plisse({"drape", (folder / "fall.toml").string(), "-o", base});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const io::Ply ply = io::read_ply(base);
  for (const double y : ply.find("vertex")->find("y")->values) {
    EXPECT_GT(y, -1.2);
    EXPECT_LT(y, -1.2 + 0.002);  // the gap in which the floor pushes
  }
}

// A sheet above a sphere, two sides of which are pulled down past it: it has to stay on top, frame by frame.
TEST(Drape, ClothIsNotCarriedThroughObstacles) {
  const TemporaryFolder folder;
  write_text(folder / "over.toml",
             "[drape]\npanel = [0.4, 0.4]\nvertices = 150\nplane = \"xz\"\nframes = 4\n"
             "[material]\nyoung = 1e5\nthickness = \"1 mm\"\ndensity = 200\n"
             "[[hold]]\nbox = [[-0.001, -1, -1], [0.001, 1, 1]]\nmove = [0.05, -0.35, 0]\n"
             "[[hold]]\nbox = [[0.399, -1, -1], [0.401, 1, 1]]\nmove = [-0.05, -0.35, 0]\n"
             "[[obstacle]]\nkind = \"sphere\"\nat = [0.2, -0.11, -0.2]\nradius = \"10 cm\"\n");
  const std::vector<std::string> command = {"drape", (folder / "over.toml").string(), "--frames", "1-4",
                                            "-o",    (folder / "base_#.ply").string()};
  const Outcome outcome = plisse(command);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* name : {"base_1.ply", "base_2.ply", "base_3.ply", "base_4.ply"}) {
    const io::Ply ply = io::read_ply(folder / name);
    const auto* vertex = ply.find("vertex");
    double high = -1;
    for (std::size_t v = 0; v < vertex->count; ++v) {
      const double x = vertex->find("x")->values[v] - 0.2, y = vertex->find("y")->values[v] + 0.11,
                   z = vertex->find("z")->values[v] + 0.2;
      EXPECT_GT(std::sqrt(x * x + y * y + z * z), 0.1) << name;
      high = std::max(high, y);
    }
    EXPECT_GT(high, 0.09) << name;  // over its top, near the pole
  }
}

// A body of triangles, or a cylinder, comes into a curtain from behind: it is pushed along, no vertex inside.
TEST(Drape, BodiesThatMovePushClothAlong) {
  const TemporaryFolder folder;
  std::string obj;  // a ball of .1 m, 16 rings of 32
  const auto round = [](int k) { return k * std::numbers::pi / 16; };
  for (int ring = 1; ring < 16; ++ring)
    for (int i = 0; i < 32; ++i)
      obj += fmt::format("v {:.9f} {:.9f} {:.9f}\n", 0.25 + 0.1 * std::sin(round(ring)) * std::cos(round(i)),
                         0.2 + 0.1 * std::sin(round(ring)) * std::sin(round(i)),
                         -0.102 + 0.1 * std::cos(round(ring)));
  obj += "v 0.25 0.2 -0.002\nv 0.25 0.2 -0.202\n";
  for (int i = 0; i < 32; ++i) {
    const int next = (i + 1) % 32;
    obj += fmt::format("f 481 {} {}\nf 482 {} {}\n", i + 1, next + 1, 449 + next, 449 + i);
    for (int ring = 0; ring < 14; ++ring)
      obj += fmt::format("f {0} {1} {2} {3}\n", 32 * ring + i + 1, 32 * ring + i + 33, 32 * ring + next + 33,
                         32 * ring + next + 1);
  }
  write_text(folder / "ball.obj", obj);
  const std::string cloth =
      "[drape]\npanel = [0.5, 0.5]\nvertices = 300\nframes = 4\n"
      "[material]\nyoung = 1e5\nthickness = \"1 mm\"\ndensity = 200\n"
      "[[hold]]\nbox = [[-1, 0.499, -1], [1, 1, 1]]\n";
  write_text(folder / "ball.toml", cloth +
                                       "[[obstacle]]\nkind = \"mesh\"\nfile = \"ball.obj\"\nmove = "
                                       "[0, 0, 0.15]\nturn = 10\naxis = [0, 0, 1]\npoint = [0.25, 0.2, 0]\n");
  write_text(folder / "cylinder.toml",
             cloth +
                 "[[obstacle]]\nkind = \"cylinder\"\nat = [-1, 0.2, -0.102]\nto = [2, 0.2, -0.102]\n"
                 "radius = 0.1\nmove = [0, 0, 0.15]\n");
  for (const char* name : {"ball.toml", "cylinder.toml"}) {
    const std::string report = (folder / "report.json").string();
    const Outcome outcome = plisse({"drape", (folder / name).string(), "--frames", "1-4", "-o",
                                    (folder / "base_#.ply").string(), "--json", report});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = nlohmann::json::parse(read_text(report));
    ASSERT_EQ(json["frames"].size(), 4u);
    for (const auto& frame : json["frames"]) {
      EXPECT_EQ(frame["inside"], 0);
      EXPECT_EQ(frame["deepest_m"], 0.0);
      if (frame["frame"] > 1) {
        EXPECT_LT(frame["nearest_m"].get<double>(), 2e-3);  // it touches: within the gap
      }
    }
  }
}

// What is held goes into the ground in the last frame: those before are kept, and said to be all.
TEST(Drape, AFrameThatCannotBeginLeavesThoseBefore) {
  const TemporaryFolder folder;
  write_text(folder / "down.toml",
             "[drape]\npanel = [0.4, 0.4]\nvertices = 60\nframes = 5\n[material]\ndensity = 200\n"
             "[[hold]]\nbox = [[-1, -1, -1], [1, 1, 1]]\nmove = [0, -1, 0]\n"
             "[[obstacle]]\nkind = \"plane\"\nat = [0, -0.6, 0]\n");
  const std::string base = (folder / "base.ply").string(), report = (folder / "report.json").string();
  const Outcome outcome =
      plisse({"drape", (folder / "down.toml").string(), "--frames", "1-5", "-o", base, "--json", report});
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("frame 4"), HasSubstr("held inside obstacle 0")));
  const auto json = nlohmann::json::parse(read_text(report));
  EXPECT_EQ(json["frames"].size(), 3u);  // −.25, −.5; −.75 is below the ground
  EXPECT_THAT(json["failure"].get<std::string>(), HasSubstr("frame 4"));
  const Outcome info = plisse({"info", base, "--cache", (folder / "base.pc2").string(), "--json", "-"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_EQ(nlohmann::json::parse(info.out)["sequence"]["frames"], 3);
}

// The last frame alone is what it is at the end of all of them.
TEST(Drape, TheLastFrameGoesThroughTheLoads) {
  const TemporaryFolder folder;
  const auto last = [&](const std::string& frames, const std::string& name) {
    std::vector<std::string> command = {
        "drape", "--example", "curtain", "--vertices", "120", "-o", (folder / name).string()};
    if (!frames.empty()) command.insert(command.end(), {"--frames", frames});
    const Outcome outcome = plisse(command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  };
  last("", "alone.ply");
  last("1-24", "base_##.ply");
  EXPECT_EQ(read_bytes(folder / "alone.ply"), read_bytes(folder / "base_24.ply"));
}

// Half a cylinder that is its own rest shape, held at two columns of vertices (about one it could turn):
// nothing pulls at it, so nothing moves.
TEST(Drape, ACurvedRestShapeStaysCurved) {
  const TemporaryFolder folder;
  std::string obj;
  for (int j = 0; j <= 4; ++j)
    for (int i = 0; i <= 12; ++i)
      obj += fmt::format("v {:.12f} {:.12f} {:.12f}\n", 0.1 * std::cos(i * std::numbers::pi / 12),
                         0.1 * std::sin(i * std::numbers::pi / 12), 0.05 * j);
  for (int j = 0; j < 4; ++j)
    for (int i = 1; i <= 12; ++i) {
      const int a = 13 * j + i;
      obj += fmt::format("f {0} {2} {1}\nf {1} {2} {3}\n", a, a + 1, a + 13, a + 14);
    }
  write_text(folder / "half.obj", obj);
  for (const char* model : {"tension-field", "stvk"}) {
    write_text(folder / "half.toml",
               fmt::format("[drape]\nmesh = \"half.obj\"\nmodel = \"{}\"\n[material]\nthickness = \"5 mm\"\n"
                           "[[hold]]\nbox = [[0.096, -1, -1], [1, 1, 1]]\n",
                           model));
    const std::string base = (folder / "base.ply").string();
    const Outcome outcome = plisse({"drape", (folder / "half.toml").string(), "-o", base});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const io::Ply ply = io::read_ply(base);
    double high = 0;
    for (const double y : ply.find("vertex")->find("y")->values) high = std::max(high, y);
    EXPECT_NEAR(high, 0.1, 1e-6) << model;  // the start of stvk is shaken, by a tenth of its thickness
  }
}

// Boundary loops of a base surface, by their lengths, m; every edge of it has one triangle or two.
std::vector<double> boundary_loops(const io::Ply& ply) {
  std::map<std::pair<int, int>, int> uses;
  const auto& corners = ply.find("face")->find("vertex_indices")->values;
  for (std::size_t c = 0; c < corners.size(); c += 3)
    for (std::size_t k = 0; k < 3; ++k)
      ++uses[std::minmax(static_cast<int>(corners[c + k]), static_cast<int>(corners[c + (k + 1) % 3]))];
  std::map<int, std::vector<int>> next;
  for (const auto& [edge, count] : uses) {
    EXPECT_LE(count, 2);
    if (count != 1) continue;
    next[edge.first].push_back(edge.second);
    next[edge.second].push_back(edge.first);
  }
  const auto at = [&](int v) {
    const auto* vertex = ply.find("vertex");
    const auto i = static_cast<std::size_t>(v);
    return glm::dvec3(vertex->find("x")->values[i], vertex->find("y")->values[i],
                      vertex->find("z")->values[i]);
  };
  std::vector<double> loops;
  while (!next.empty()) {
    double length = 0;
    for (int v = next.begin()->first; next.contains(v) && !next[v].empty();) {
      const int other = next[v].back();
      next[v].pop_back();
      std::erase(next[other], v);
      length += glm::distance(at(v), at(other));
      v = other;
    }
    std::erase_if(next, [](const auto& item) { return item.second.empty(); });
    loops.push_back(length);
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

// Sewn all round: a waist and a hem are all the boundary there is. The body of 27,000 triangles turns inside.
TEST(Drape, TheSkirtGoesWithItsBody) {
  const TemporaryFolder folder;
  const std::string report = (folder / "report.json").string();
  const Outcome outcome = plisse({"drape", "--example", "skirt", "--vertices", "400", "--frames", "1-3", "-o",
                                  (folder / "skirt_#.ply").string(), "--json", report});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const auto& frame : nlohmann::json::parse(read_text(report))["frames"]) {
    EXPECT_TRUE(frame["converged"].get<bool>());
    EXPECT_EQ(frame["inside"], 0);
    EXPECT_LT(frame["nearest_m"].get<double>(), 4e-3);  // it lies on the hips, within the gap
  }
  const auto loops = boundary_loops(io::read_ply(folder / "skirt_3.ply"));
  ASSERT_EQ(loops.size(), 2U);
  // The waist is held; the hem's rest length is 1.4 · 1.5 of it, and slack where it hangs straight.
  EXPECT_GT(loops[0], 0.65);
  EXPECT_LT(loops[0], 0.8);
  EXPECT_GT(loops[1], 1.2 * loops[0]);
}

TEST(Drape, GarmentsAreSewnAndWrapped) {
  const TemporaryFolder folder;
  const std::string scene =
      "[drape]\ngarment = \"" + source_file("assets/skirt.toml").string() +
      "\"\nvertices = 300\n[material]\nyoung = 2e5\nthickness = \"0.5 mm\"\ndensity = 300\n"
      "[[hold]]\nbox = [[-1, 1.0399, -1], [1, 2, 1]]\n"
      "[[obstacle]]\nkind = \"capsule\"\nat = [0, 0.95, 0]\nto = [0, 0.6, 0]\nradius = \"10 cm\"\n";
  write_text(folder / "skirt.toml", scene);
  const Outcome outcome =
      plisse({"drape", (folder / "skirt.toml").string(), "-o", (folder / "base.ply").string()});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto loops = boundary_loops(io::read_ply(folder / "base.ply"));
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_GT(loops[0], 0.8);  // the waist: two bands of 40 cm, pulled straight between the panels' planes
  write_text(folder / "cube.toml", "[drape]\ngarment = \"skirt.toml\"\npanel = [1, 1]\n");
  EXPECT_THAT(plisse({"drape", (folder / "cube.toml").string()}).err,
              HasSubstr("needs one of 'mesh', 'garment' and 'panel'"));
}

TEST(Drape, CostsArePlotted) {
  const TemporaryFolder folder;
  const std::string plot = (folder / "cost.svg").string(), report = (folder / "cost.json").string();
  const Outcome outcome =
      plisse({"drape", "--example", "stretched-sheet", "--cost", "60,240", "-o", plot, "--json", report});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(read_text(plot), AllOf(HasSubstr("<svg"), HasSubstr("factorisation")));
  const auto json = nlohmann::json::parse(read_text(report));
  ASSERT_EQ(json["costs"].size(), 2U);
  for (const auto& cost : json["costs"]) {
    EXPECT_TRUE(cost["converged"].get<bool>());
    // What is told apart is no more than the whole.
    EXPECT_LE(cost["assembly_s"].get<double>() + cost["factor_s"].get<double>(),
              cost["wall_s"].get<double>());
  }
  const Outcome odd = plisse({"drape", "--example", "strip", "--cost", "60,", "-o", plot});
  EXPECT_EQ(odd.code, 2);
  EXPECT_THAT(odd.err, HasSubstr("--cost"));
}

// What would have no effect is refused, what says how it is solved counts.
TEST(Drape, CostsTakeOptionsThatCount) {
  const TemporaryFolder folder;
  const std::string plot = (folder / "cost.svg").string(), report = (folder / "cost.json").string();
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> command = {"drape", "--example", "strip", "--cost", "60", "-o", plot};
    command.insert(command.end(), more.begin(), more.end());
    return plisse(command);
  };
  for (const auto& [option, value] :
       std::vector<std::pair<std::string, std::string>>{{"--vertices", "100"},
                                                        {"--start", "start.obj"},
                                                        {"--frames", "1-3"},
                                                        {"--steps", "3"},
                                                        {"--cache-dir", (folder / "cache").string()}}) {
    const Outcome refused = run({option, value});
    EXPECT_EQ(refused.code, 2) << option;
    EXPECT_THAT(refused.err, HasSubstr(option + ": has no effect beside --cost"));
  }
  EXPECT_FALSE(std::filesystem::exists(plot));
  // The energy after one step tells where it began and by which law.
  const auto energy = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--iterations", "1", "--json", report});
    EXPECT_EQ(run(more).code, 1) << "one step is too few";
    return nlohmann::json::parse(read_text(report))["costs"][0]["energy_J"].get<double>();
  };
  const double plain = energy({});
  EXPECT_EQ(energy({"--perturb", "0"}), plain);
  EXPECT_NE(energy({"--perturb", "1 cm"}), plain);
  EXPECT_NE(energy({"--seed", "2"}), plain);
  EXPECT_NE(energy({"--model", "stvk"}), plain);
  // A strip that is pulled at has nothing slack until it is shaken.
  EXPECT_NE(energy({"--perturb", "1 cm", "--residual", "0.1"}), energy({"--perturb", "1 cm"}));
}

// Held at one corner from lying flat it is free to turn, which dead loads have a least energy of: it swings
// down and hangs below.
TEST(Drape, AHandkerchiefOnAPegHangs) {
  const TemporaryFolder folder;
  write_text(folder / "peg.toml",
             "[drape]\npanel = [0.3, 0.3]\nvertices = 120\nplane = \"xz\"\n"
             "[material]\nyoung = 1e5\nthickness = \"1 mm\"\ndensity = 200\n"
             "[[hold]]\nbox = [[-1, -1, -1e-6], [1e-6, 1, 1e-6]]\n");
  const std::string base = (folder / "base.ply").string();
  const Outcome outcome = plisse({"drape", (folder / "peg.toml").string(), "-o", base});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  double low = 0;
  for (const double y : io::read_ply(base).find("vertex")->find("y")->values) low = std::min(low, y);
  EXPECT_LT(low, -0.3 * 1.414);  // all of its diagonal, and stretched by its weight
}

TEST(Drape, SmallExamplesAreSewn) {
  const TemporaryFolder folder;
  for (const char* name : {"torus", "teabag", "disk-balloon"}) {
    const Outcome outcome = plisse({"drape", "--example", name, "--vertices", "20", "--iterations", "1", "-o",
                                    (folder / "base.ply").string()});
    EXPECT_LE(outcome.code, 1) << name << ": " << outcome.err;  // one step is too few, but it begins
  }
}

TEST(Drape, AuthorsSetUp) {
  const auto setup = shared_data("tfw-disk/elastic/disk_elastic.json");
  if (!std::filesystem::exists(setup)) GTEST_SKIP() << setup << " is not there";
  const TemporaryFolder folder;
  const std::string report = (folder / "report.json").string();
  const Outcome outcome =
      plisse({"drape", setup.string(), "-o", (folder / "base.ply").string(), "--json", report});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("solving without a guess"), HasSubstr("solving without an obstacle")));
  // What their shipped surface has, by our code; tests/shell compares the two exactly.
  EXPECT_NEAR(nlohmann::json::parse(read_text(report))["energy_J"].get<double>(), -0.3741838, 1e-7);
}

}  // namespace
}  // namespace plisse::test
