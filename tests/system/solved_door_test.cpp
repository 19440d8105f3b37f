// Solved wrinkles of a user's model, handed on: rest shapes of its uv, the look of its base surfaces, the TFW
// authors' set-ups, maps, and what is told before the long part.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>

#include "base/colour.h"
#include "io/import.h"
#include "io/picture/png.h"
#include "io/ply.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

class SolvedDoor : public Program {
 protected:
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  nlohmann::json report() const { return nlohmann::json::parse(read_text(folder_ / "report.json")); }
  void run(const std::vector<std::string>& arguments) const {
    const Outcome outcome = plisse(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  std::string refused(const std::vector<std::string>& arguments) const {
    const Outcome outcome = plisse(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    return outcome.err;
  }

  // A tube of `round` flat panels round, `length` long; its uv unroll it, 1 for 2 m, u times `skew`.
  void write_tube(const std::string& name, double length, double skew = 1, int round = 16) const {
    constexpr int along = 20;
    constexpr double radius = 0.1, rest = 0.4;
    const double side = 2 * radius * std::sin(pi / round);
    std::string obj;
    for (int j = 0; j <= along; ++j)
      for (int i = 0; i < round; ++i)
        obj += fmt::format("v {:.12f} {:.12f} {:.12f}\n", radius * std::cos(2 * pi * i / round),
                           length * j / along, radius * std::sin(2 * pi * i / round));
    for (int j = 0; j <= along; ++j)
      for (int i = 0; i <= round; ++i)
        obj += fmt::format("vt {:.9f} {:.9f}\n", skew * side * i / 2, rest * j / along / 2);
    for (int j = 0; j < along; ++j)
      for (int i = 0; i < round; ++i) {
        const auto corner = [&](int di, int dj) {
          return fmt::format("{}/{}", (j + dj) * round + (i + di) % round + 1,
                             (j + dj) * (round + 1) + i + di + 1);
        };
        obj += fmt::format("f {} {} {}\nf {} {} {}\n", corner(0, 0), corner(0, 1), corner(1, 1), corner(0, 0),
                           corner(1, 1), corner(1, 0));
      }
    write_text(folder_ / name, obj);
  }

  // A sheet of 1 m in 20 × 20 cells, in frame 1 flat, then pressed together by a tenth with the zigzags of a
  // coarse simulation; two materials, each with a half of it.
  void write_sheets(int frames) const {
    constexpr int n = 20;
    for (int frame = 1; frame <= frames; ++frame) {
      const double pressed = frames > 1 ? 0.1 * (frame - 1) / (frames - 1) : 0;
      std::string obj = "mtllib sheet.mtl\n";
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
          obj += fmt::format("v {:.12f} {:.12f} {:.12f}\nvt {} {}\n", (1 - pressed) * i / n, double(j) / n,
                             (i % 2 == 0 ? 1 : -1) * 0.5 / n * std::sqrt(1 - (1 - pressed) * (1 - pressed)),
                             double(i) / n, double(j) / n);
      for (int j = 0; j < n; ++j) {
        if (j == 0) obj += "usemtl checked\n";
        if (j == n / 2) obj += "usemtl red\n";
        for (int i = 0; i < n; ++i) {
          const int a = j * (n + 1) + i + 1;
          obj += fmt::format("f {0}/{0} {1}/{1} {2}/{2} {3}/{3}\n", a, a + 1, a + n + 2, a + n + 1);
        }
      }
      write_text(folder_ / fmt::format("sheet_000{}.obj", frame), obj);
    }
    write_text(folder_ / "sheet.mtl",
               "newmtl checked\nKd 1 1 1\nmap_Kd checks.png\nnewmtl red\nKd 1 0.25 0.25\n");
    io::Image checks{2, 2, {}};
    for (const int grey : {255, 40, 40, 255})
      for (const int value : {grey, grey / 2, 90, 255})
        checks.rgba.push_back(static_cast<std::uint8_t>(value));
    io::write_png(folder_ / "checks.png", checks);
  }
  double relit_difference(const std::string& scene, int frame, const std::string& camera) const;
  TemporaryFolder folder_;
};

// Frame 1 is pressed, so that it would be the rest shape otherwise. At rest a tube sewn from flat panels
// keeps its radius within 3 % and has no waves.
TEST_F(SolvedDoor, UvAreARestShape) {
  write_tube("tube_0001.obj", 0.37);
  write_tube("tube_0002.obj", 0.4);
  run({"wrinkle", file("tube_####.obj"), "--rest", "uv:2m", "-o", file("waves"), "--json",
       file("report.json"), "-q"});
  const auto frames = report()["frames"];
  EXPECT_GT(frames[0]["max_amplitude_m"].get<double>(), 1e-3);
  EXPECT_NEAR(frames[0]["length_kept"].get<double>(), 0.95, 0.04);  // up .925, round it 1
  EXPECT_EQ(frames[1]["max_amplitude_m"], 0);
  EXPECT_LT(frames[1]["moved_most_m"].get<double>(), 0.03 * 0.1);
  EXPECT_NEAR(frames[1]["length_kept"].get<double>(), 1, 0.03);
  for (const int round : {12, 24}) {
    const std::string name = fmt::format("round_{}.obj", round);
    write_tube(name, 0.4, 1, round);
    run({"wrinkle", file(name), "--rest", "uv:2m", "-o", file("rest"), "--json", file("report.json"), "-q"});
    EXPECT_EQ(report()["frames"][0]["max_amplitude_m"], 0) << round;
    EXPECT_LT(report()["frames"][0]["moved_most_m"].get<double>(), 0.03 * 0.1) << round;
  }
  // Without a length, that of the model: pressed in frame 1, so smaller by the root of that.
  const Outcome told = plisse({"wrinkle", file("tube_####.obj"), "--rest", "uv", "-o", file("own")});
  EXPECT_THAT(told.err, HasSubstr(fmt::format("a unit of uv is {:.4g} m", 2 * std::sqrt(0.37 / 0.4))));
}

TEST_F(SolvedDoor, UvThatAreNoPatternAreRefused) {
  write_tube("tube_0001.obj", 0.4);
  write_tube("tube_0002.obj", 0.38);
  const auto error = [&](const std::string& model, const std::string& rest) {
    return refused({"wrinkle", file(model), "--rest", rest, "-o", file("waves"), "-q"});
  };
  EXPECT_THAT(error("tube_####.obj", "uv:2mm"), HasSubstr("uv:2m would fit"));
  EXPECT_THAT(error("tube_####.obj", "uv:two"), HasSubstr("how long a unit of uv is"));
  write_tube("skewed_0001.obj", 0.4, 1.5);
  EXPECT_THAT(error("skewed_0001.obj", "uv"), HasSubstr("no flat pattern of the model"));
  write_text(folder_ / "bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(error("bare.obj", "uv"), HasSubstr("has no texture coordinates"));
  write_text(folder_ / "flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/2 3/2\n");
  EXPECT_THAT(error("flat.obj", "uv"), HasSubstr("1 of 1 triangles have no area"));
  EXPECT_THAT(refused({"render", file("tube_####.obj"), "--rest", "uv:2m", "-o", file("frames")}),
              HasSubstr("add --solve"));
  EXPECT_THAT(refused({"render", file("tube_####.obj"), "--rest", "uv:2m", "--solve", "--method", "passes",
                       "-o", file("frames")}),
              HasSubstr("add --solve"));
}

TEST_F(SolvedDoor, BasesAndMeshesKeepUvColoursAndPictures) {
  write_sheets(3);
  run({"wrinkle", file("sheet_####.obj"), "-o", file("waves"), "--mesh", file("mesh_####.obj"), "--levels",
       "1", "-q"});
  const io::Model base = io::import_model(folder_ / "waves/base_0003.ply", {});
  ASSERT_EQ(base.meshes.size(), 2U);
  std::size_t pictured = 0;
  for (const io::Mesh& mesh : base.meshes) {
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    for (std::size_t v = 0; v < mesh.uvs.size(); ++v) {
      // Rows of the sheet, which are pressed along x and stay where they are along y; followed, so nearly.
      EXPECT_NEAR(mesh.uvs[v].y, mesh.positions[v].y, 0.01);
      EXPECT_NEAR(mesh.uvs[v].x, mesh.positions[v].x / 0.9, 0.03);
    }
    if (mesh.material >= 0) {
      ++pictured;
      const io::Material& material = base.materials[static_cast<std::size_t>(mesh.material)];
      ASSERT_GE(material.base_colour_texture, 0);
      EXPECT_EQ(base.textures[static_cast<std::size_t>(material.base_colour_texture)].image.rgba,
                io::load_image(folder_ / "checks.png").rgba);
    } else {
      ASSERT_FALSE(mesh.colours.empty());
      EXPECT_NEAR(mesh.colours[0].g, srgb_to_linear(0.25), 0.002);  // of eight bits
    }
  }
  EXPECT_EQ(pictured, 1U);
  const std::string mesh = read_text(folder_ / "mesh_0003.obj");
  EXPECT_THAT(mesh, HasSubstr("usemtl checked"));
  EXPECT_THAT(mesh, HasSubstr("usemtl red"));
  double farthest = 0;
  std::istringstream lines(mesh);
  for (std::string line; std::getline(lines, line);) {
    double u = 0, v = 0;
    if (std::sscanf(line.c_str(), "vt %lf %lf", &u, &v) == 2) farthest = std::max({farthest, u, v});
  }
  EXPECT_NEAR(farthest, 1, 1e-6);
}

// The same surface as a set-up of the TFW authors: rest mesh and base mesh as OBJ, faces without waves by
// their rule, no limit of tension.
TEST_F(SolvedDoor, TheAuthorsSetUpsGiveTheSameEnergy) {
  write_sheets(2);
  run({"wrinkle", file("sheet_####.obj"), "--tension-limit", "0", "--wrinkle-free", "authors", "-o",
       file("waves"), "--json", file("report.json"), "-q"});
  const double energy = report()["frames"][1]["energy_J"];
  ASSERT_GT(energy, 0);
  const io::Ply base = io::read_ply(folder_ / "waves/base_0002.ply"),
                rest = io::read_ply(folder_ / "waves/base_0001.ply");  // flat, and followed within 1e-9
  for (const auto& [ply, name] : {std::pair{&base, "base.obj"}, {&rest, "rest.obj"}}) {
    std::string obj;
    for (const glm::dvec3& x : ply->vectors("vertex"))
      obj += fmt::format("v {:.15g} {:.15g} {:.15g}\n", x.x, x.y, x.z);
    for (const auto& f : ply->triangles(io::Ply::Polygons::refused))
      obj += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
    write_text(folder_ / name, obj);
  }
  nlohmann::json setup = {{"rest_mesh", "rest.obj"}, {"base_mesh", "base.obj"}, {"rest_flat", true}};
  for (const std::string& comment : base.comments)
    for (const auto& [theirs, ours] :
         {std::pair{"youngs_modulus", "young "}, {"poisson_ratio", "poisson "}, {"thickness", "thickness "}})
      if (comment.starts_with(ours)) setup[theirs] = std::stod(comment.substr(std::strlen(ours)));
  write_text(folder_ / "setup.json", setup.dump());
  run({"wrinkle", file("setup.json"), "--wrinkle-free", "authors", "-o", file("field.ply"), "--json",
       file("report.json"), "-q"});
  // The solver ends where steps of 1e-6 of a wave lower nothing; its energy is flat there to far less.
  EXPECT_NEAR(report()["energy_whole_periods_J"].get<double>() / energy, 1, 1e-6);
}

// The coarse base surface with the baked normal map, lit, is the frame that is drawn directly. Parallax and
// the valleys' darkness are no matter of normals. Of 255, the mean over the cloth's pixels.
double SolvedDoor::relit_difference(const std::string& scene, int frame, const std::string& camera) const {
  const std::vector<std::string> view = {"--camera",    camera,        "--size", "320x256",
                                         "--cache-dir", file("cache"), "-q"};
  const std::string number = std::to_string(frame), four = fmt::format("{:04}", frame);
  const auto with_view = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), view.begin(), view.end());
    return arguments;
  };
  run(with_view({"render", scene, "--frames", number, "-o", file("drawn")}));
  run(with_view({"render", scene, "--frames", number, "-o", file("mask"), "--background", "transparent"}));
  run({"bake", scene, "--frames", number, "--maps", "normal", "--texture-size", "1024", "-o", file("maps"),
       "--cache-dir", file("cache"), "-q"});
  run({"export", scene, "--frames", number, "--levels", "0", "--strength", "0", "-o", file("base.obj"),
       "--cache-dir", file("cache"), "-q"});
  std::filesystem::copy(folder_ / ("maps/normal_" + four + ".png"), folder_ / "normal.png");

  // The base as glTF, whose materials have normal maps.
  const io::Model base = io::import_model(folder_ / "base.obj", {});
  std::string bytes;
  std::size_t count = 0;
  glm::vec3 low(1e9F), high(-1e9F);
  const auto add = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const int part : {0, 1, 2})  // places, normals, uv
    for (const io::Mesh& mesh : base.meshes)
      for (const std::uint32_t v : mesh.triangles) {
        const glm::vec3 place(mesh.positions[v]);
        if (part == 0) {
          ++count;
          add(place);
          low = glm::min(low, place);
          high = glm::max(high, place);
        }
        if (part == 1) add(mesh.normals[v]);
        if (part == 2) add(glm::vec2(mesh.uvs[v].x, 1 - mesh.uvs[v].y));
      }
  write_text(folder_ / "base.bin", bytes);
  const auto view_of = [&](std::size_t begin, std::size_t size) {
    return nlohmann::json{{"buffer", 0}, {"byteOffset", begin * count}, {"byteLength", size * count}};
  };
  const auto accessor = [&](int view_index, const char* type) {
    return nlohmann::json{
        {"bufferView", view_index}, {"componentType", 5126}, {"count", count}, {"type", type}};
  };
  nlohmann::json places = accessor(0, "VEC3");
  places["min"] = {low.x, low.y, low.z};
  places["max"] = {high.x, high.y, high.z};
  const nlohmann::json gltf = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes",
       {{{"primitives",
          {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"material", 0}}}}}}},
      {"materials", {{{"doubleSided", true}, {"normalTexture", {{"index", 0}}}}}},
      {"textures", {{{"source", 0}}}},
      {"images", {{{"uri", "normal.png"}}}},
      {"buffers", {{{"uri", "base.bin"}, {"byteLength", bytes.size()}}}},
      {"bufferViews", {view_of(0, 12), view_of(12, 12), view_of(24, 8)}},
      {"accessors", {places, accessor(1, "VEC3"), accessor(2, "VEC2")}}};
  write_text(folder_ / "base.gltf", gltf.dump());
  run(with_view({"render", file("base.gltf"), "--strength", "0", "-o", file("relit")}));

  const io::Image drawn = io::load_image(folder_ / ("drawn/frame_" + four + ".png")),
                  relit = io::load_image(folder_ / "relit/frame_0001.png"),
                  mask = io::load_image(folder_ / ("mask/frame_" + four + ".png"));
  double sum = 0, varied = 0;
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < drawn.rgba.size(); i += 4) {
    if (mask.rgba[i + 3] < 255) continue;
    ++pixels;
    for (std::size_t c = 0; c < 3; ++c) {
      sum += std::abs(int{drawn.rgba[i + c]} - int{relit.rgba[i + c]}) / 3.0;
      varied += std::abs(int{drawn.rgba[i + c]} - 130) / 3.0;
    }
  }
  EXPECT_GT(pixels, 10000U);
  EXPECT_GT(varied / static_cast<double>(pixels), 10);  // there is something to see
  return sum / static_cast<double>(pixels);
}

constexpr const char* only_normals = "[shading]\nparallax = 0\ncavity = 0\n";

TEST_F(SolvedDoor, BakedWavesRelightTheBaseAsTheFrame) {
  write_sheets(3);
  write_text(folder_ / "sheet.mtl", "newmtl checked\nnewmtl red\n");
  write_text(
      folder_ / "scene.toml",
      std::string("[model]\npath = \"sheet_####.obj\"\n[wrinkles]\nwavelength = \"25 cm\"\n[solve]\n") +
          only_normals);
  EXPECT_LT(relit_difference(file("scene.toml"), 3, "eye=0.1,-0.6,1.5;target=0.45,0.5,0"), 1);
}

// Waves that fan out, over broad folds: from a map that is linear in each triangle it would be 5.
TEST_F(SolvedDoor, BakedWavesOfASimulationSlow) {
  const std::filesystem::path drape = shared_data("cloth-drape");
  if (!std::filesystem::exists(drape)) GTEST_SKIP() << "no shared/data beside the project";
  int number = 0;
  for (const int frame : {1, 42, 43, 44, 45, 46, 47, 48})
    std::filesystem::copy(drape / fmt::format("drape_{:04}.obj", frame),
                          folder_ / fmt::format("drape_{:04}.obj", ++number));
  write_text(
      folder_ / "scene.toml",
      std::string("[model]\npath = \"drape_####.obj\"\nup = \"z\"\n[wrinkles]\nwavelength = \"10 cm\"\n"
                  "[solve]\nfollow = \"24 cm\"\n") +
          only_normals);
  EXPECT_LT(relit_difference(file("scene.toml"), 8, "eye=1.2,0.6,1.4;target=0,-0.3,0"), 3);
}

// A pressed sheet just above a box: its waves, 40 mm high, would cut into it by half of that.
TEST_F(SolvedDoor, ClothStaysOutsideABody) {
  write_sheets(3);
  constexpr double top = -0.006;  // zigzags reach 11 mm down: they begin in it
  std::string box;
  for (const double z : {-1.0, top})
    for (const double y : {-1, 2})
      for (const double x : {-1, 2}) box += fmt::format("v {} {} {}\n", x, y, z);
  write_text(folder_ / "box.obj", box + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n");
  const auto lowest = [&](const std::string& name) {
    double least = 1;
    std::istringstream obj(read_text(folder_ / name));
    for (std::string line; std::getline(obj, line);) {
      double x = 0, y = 0, z = 0;
      if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) least = std::min(least, z);
    }
    return least;
  };
  const std::vector<std::string> common = {
      "--solve", "--frames",          "3",  "--levels",    "3",
      "--json",  file("report.json"), "-q", "--cache-dir", file("cache")};
  const auto exported = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"export", file("sheet_####.obj")});
    arguments.insert(arguments.end(), common.begin(), common.end());
    run(arguments);
  };
  exported({"-o", file("free.obj")});
  EXPECT_LT(lowest("free.obj"), top - 5e-3);
  const double untaken = report()["solve"]["frames"][2]["untaken"];
  exported({"-o", file("kept.obj"), "--body", file("box.obj")});
  EXPECT_GT(lowest("kept.obj"), top);
  const auto last = report()["solve"]["frames"][2];
  EXPECT_GT(last["nearest_body_m"].get<double>(), 0);
  EXPECT_TRUE(last["converged"]);
  // Lifted, so that it waves as before.
  EXPECT_LT(last["untaken"].get<double>(), untaken + 0.1);
  // The same from files, by a scene, and from the base surfaces alone.
  run({"wrinkle", file("sheet_####.obj"), "--body", file("box.obj"), "-o", file("waves"), "--mesh",
       file("mesh_####.obj"), "-q"});
  EXPECT_GT(lowest("mesh_0003.obj"), top);
  run({"wrinkle", file("waves/base_####.ply"), "-o", file("field_####.ply"), "--mesh", file("again_####.obj"),
       "-q"});
  EXPECT_GT(lowest("again_0003.obj"), top);
  write_text(folder_ / "scene.toml", "[model]\npath = \"sheet_####.obj\"\n[solve]\nbodies = \"box.obj\"\n");
  run({"export", file("scene.toml"), "--frames", "3", "--levels", "3", "-o", file("scene.obj"), "-q",
       "--cache-dir", file("cache")});
  EXPECT_TRUE(read_text(folder_ / "scene.obj") == read_text(folder_ / "kept.obj"));

  const auto error = [&](const std::string& body) {
    return refused({"render", file("sheet_####.obj"), "--solve", "--body", body, "-o", file("frames")});
  };
  EXPECT_THAT(error("bax"), HasSubstr("--body bax: there is no such file"));
  write_text(folder_ / "open.obj", box + "f 1 3 4 2\n");
  EXPECT_THAT(error(file("open.obj")), HasSubstr("open.obj"));
  EXPECT_THAT(error("red"), HasSubstr("--body red"));  // a part of the sheet, which is open
}

// What solved waves have no use for is told by name; nothing is where there is none.
TEST_F(SolvedDoor, SettingsOfThePassesAreTold) {
  write_sheets(2);
  const auto told = [&](const std::string& wrinkles) {
    write_text(folder_ / "scene.toml",
               "[model]\npath = \"sheet_####.obj\"\n[wrinkles]\n" + wrinkles + "[solve]\n");
    const Outcome outcome = plisse({"render", file("scene.toml"), "--size", "32x32", "-o", file("frames"),
                                    "--cache-dir", file("cache"), "--json", file("report.json")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return report()["warnings"].dump();
  };
  EXPECT_THAT(told("profile = \"accordion\"\nfine = 3\nirregularity = 0.5\n"),
              HasSubstr("profile, fine, irregularity of [wrinkles] have no part in solved waves"));
  EXPECT_EQ(told("strength = 0.5\n"), "[]");
}

// What is wrong with the outputs is told before anything is solved.
TEST_F(SolvedDoor, WhatIsWrongIsToldBeforeTheLongPart) {
  write_sheets(2);
  write_text(folder_ / "bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::vector<std::string> solve = {"--solve", "--cache-dir", file("cache"), "-q"};
  const auto error = [&](std::vector<std::string> arguments, int code = 2) {
    arguments.insert(arguments.end(), solve.begin(), solve.end());
    const Outcome outcome = plisse(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "cache"));
    return outcome.err;
  };
  EXPECT_THAT(error({"bake", file("bare.obj"), "-o", file("maps")}), HasSubstr("has no uv"));
  EXPECT_THAT(error({"bake", file("sheet_####.obj"), "--frames", "9", "-o", file("maps")}), HasSubstr("9"));
  EXPECT_THAT(error({"export", file("sheet_####.obj"), "-o", file("mesh.stl")}),
              HasSubstr("point caches as"));
  EXPECT_THAT(error({"export", file("sheet_####.obj"), "-o", file("mesh.obj")}), HasSubstr("mesh_####.obj"));
  write_text(folder_ / "wall", "");
  for (const char* command : {"render", "bake", "export"}) {
    const std::string output = command == std::string("export") ? file("wall/m_####.obj") : file("wall");
    error({command, file("sheet_####.obj"), "-o", output}, 5);
  }
  error({"verify", file("sheet_####.obj"), "--json", file("wall/report.json")}, 5);
  // Answers that cannot be kept are told once, and the run goes on.
  const Outcome outcome = plisse({"render", file("sheet_####.obj"), "--solve", "--cache-dir", file("wall/c"),
                                  "--size", "32x32", "-o", file("frames"), "--json", file("report.json")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("solved answers are not kept"));
  EXPECT_THAT(report()["warnings"].dump(), HasSubstr("solved answers are not kept"));
}

}  // namespace
}  // namespace plisse::test
