// plisse wrinkle from outside: draped base to field to picture, the authors' set-up, and how it ends.
#include <gmock/gmock.h>

#include "io/wrinkle_field.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::HasSubstr;

class Wrinkle : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  nlohmann::json report() const { return nlohmann::json::parse(read_text(folder_ / "report.json")); }
  TemporaryFolder folder_;
};

TEST_F(Wrinkle, StretchedSheetHasThePapersWaves) {
  ASSERT_EQ(plisse({"drape", "--example", "stretched-sheet", "-o", file("base.ply"), "-q"}).code, 0);
  const Outcome outcome =
      plisse({"wrinkle", file("base.ply"), "-o", file("field.ply"), "--json", file("report.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto json = report();
  for (const char* key :
       {"vertices", "faces", "wrinkle_free_faces", "energy_start_J", "energy_J", "kkt_scaled", "iterations",
        "converged", "reason", "max_amplitude_m", "wrinkled_vertices", "waves", "phase_residual", "solve_s",
        "phase_s", "wall_s", "trace"})
    EXPECT_TRUE(json.contains(key)) << key;
  // Chen et al. 2021, fig. 6: 5 periods, .42 mm; Wang et al. 2018: .35 mm.
  EXPECT_NEAR(json["waves"].get<double>(), 5, 1);
  EXPECT_GT(json["max_amplitude_m"].get<double>(), 0.33e-3);
  EXPECT_LT(json["max_amplitude_m"].get<double>(), 0.45e-3);
  EXPECT_LE(json["kkt_scaled"].get<double>(), 1e-6);
  const auto field = io::read_wrinkle_field(file("field.ply"), {});
  EXPECT_EQ(field.positions.size(), json["vertices"]);
}

// A scene is draped for wrinkle as drape drapes it: loads that grow, obstacles that move, frame after frame.
TEST_F(Wrinkle, ScenesAreDrapedAsDrapeDoes) {
  write_text(file("scene.toml"),
             "[drape]\npanel = [0.25, 0.1]\nvertices = 150\nframes = 3\n"
             "[material]\nyoung = 1e6\npoisson = 0.5\nthickness = \"0.1 mm\"\n[loads]\ngravity = [0, 0, 0]\n"
             "[[hold]]\nbox = [[-0.001, -1, -1], [0.001, 1, 1]]\n"
             "[[force]]\nbox = [[0.249, -1, -1], [0.251, 1, 1]]\nper_length = [8, 0, 0]\ngrows = true\n"
             "[[obstacle]]\nkind = \"sphere\"\nat = [0.12, 0.05, -0.105]\nradius = \"10 cm\"\nmove = [0, 0, "
             "0.02]\n");
  ASSERT_EQ(plisse({"drape", file("scene.toml"), "-o", file("base.ply"), "-q"}).code, 0);
  const auto energy = [&](const std::string& of) {
    const Outcome outcome =
        plisse({"wrinkle", of, "-o", file("field.ply"), "--json", file("report.json"), "-q"});
    EXPECT_LE(outcome.code, 1) << outcome.err;  // whether its waves converge is not asked here
    return report()["energy_start_J"].get<double>();
  };
  const double of_base = energy(file("base.ply")), of_scene = energy(file("scene.toml"));
  EXPECT_GT(of_base, 1e-4);                  // ½ F²L/(Y h w) of the pull alone is 8e-4 J
  EXPECT_NEAR(of_scene / of_base, 1, 1e-6);  // the file has the places in single precision
}

// Paper: 46, 46, 47 waves on irregular meshes of 180, 344 and 688 vertices, over 180 without v₁; an
// independent one-dimensional optimum: 44.
TEST_F(Wrinkle, TwistedCylinderWithoutV1) {
  const Outcome without = plisse({"wrinkle", "--example", "twisted-cylinder", "--without", "v1", "-o",
                                  file("field.ply"), "--json", file("report.json"), "-q"});
  ASSERT_EQ(without.code, 0) << without.err;
  EXPECT_GT(report()["waves"].get<double>(), 150);
}

TEST_F(Wrinkle, CostsArePlotted) {
  const Outcome outcome = plisse({"wrinkle", "--example", "twisted-cylinder", "--cost", "100,250", "-o",
                                  file("cost.svg"), "--json", file("report.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(read_text(file("cost.svg")), AllOf(HasSubstr("<svg"), HasSubstr("solver"), HasSubstr("waves")));
  const auto json = report();
  ASSERT_EQ(json["costs"].size(), 2U);
  for (const auto& cost : json["costs"]) {
    EXPECT_TRUE(cost["converged"].get<bool>());
    EXPECT_GT(cost["solve_s"].get<double>(), 0);
    // Each is a median by itself, so that parts of one run may stand beside the whole of another.
    EXPECT_LE(cost["solve_s"].get<double>() + cost["phase_s"].get<double>(),
              3 * cost["wall_s"].get<double>());
  }
  for (const std::vector<std::string>& odd : {std::vector<std::string>{"--cost", "100,"},
                                              {"--cost", "100", "--vertices", "100"},
                                              {"--cost", "100", "--mesh", file("waves.glb")}}) {
    std::vector<std::string> words{"wrinkle", "--example", "twisted-cylinder", "-o", file("odd.svg")};
    words.insert(words.end(), odd.begin(), odd.end());
    const Outcome refused = plisse(words);
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("--cost"));
    EXPECT_FALSE(std::filesystem::exists(file("odd.svg")));
  }
}

TEST_F(Wrinkle, TheAuthorsSetUpAndTexts) {
  const auto disk = shared_data("tfw-disk");
  if (!std::filesystem::exists(disk)) GTEST_SKIP() << "no ../shared/data/tfw-disk";
  const std::string setup = (disk / "disk_TFW.json").string(), text = file("disk_amplitude_ours.txt");
  const Outcome solved =
      plisse({"wrinkle", setup, "--wrinkle-free", "authors", "-o", text, "--json", file("report.json")});
  ASSERT_EQ(solved.code, 0) << solved.err;
  EXPECT_THAT(solved.err, HasSubstr("disk_clamped_vertices.dat, which is not there"));
  EXPECT_EQ(report()["wrinkle_free_faces"], 136);
  const double whole = report()["energy_whole_periods_J"];
  const auto evaluate = [&](const std::string& amplitude, const std::string& one_form) {
    const Outcome outcome = plisse({"wrinkle", setup, "--wrinkle-free", "authors", "--evaluate", amplitude,
                                    one_form, "--json", file("report.json"), "-q"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return report();
  };
  const auto ours = evaluate(text, file("disk_dphi_ours.txt"));
  EXPECT_NEAR(ours["energy_J"].get<double>() / whole, 1, 1e-9);  // texts carry all digits
  const auto theirs =
      evaluate((disk / "disk_amplitude_simulated.txt").string(), (disk / "disk_dphi_simulated.txt").string());
  EXPECT_LE(whole, theirs["energy_J"].get<double>());
  EXPECT_LT(theirs["curl_max"].get<double>(), 1e-6);
  // Amplitudes that make no sense have no verdict.
  for (const auto& [value, what] : {std::pair("-1\n", "below 0"), std::pair("1e200\n", "not finite")}) {
    std::string wild;
    for (int v = 0; v < 273; ++v) wild += value;
    write_text(folder_ / "wild.txt", wild);
    const Outcome refused = plisse({"wrinkle", setup, "--wrinkle-free", "authors", "--evaluate",
                                    file("wild.txt"), file("disk_dphi_ours.txt"), "-q"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr(what));
  }
  // What stopped short is written and marked so.
  EXPECT_EQ(plisse({"wrinkle", setup, "--iterations", "2", "-o", file("short.ply"), "-q"}).code, 1);
  EXPECT_THAT(read_text(folder_ / "short.ply").substr(0, 400),
              HasSubstr("comment not converged: too many iterations"));
  const auto back = io::read_wrinkle_field(text, disk / "disk_simulated.obj");
  EXPECT_EQ(back.positions.size(), 273U);
}

// The waves as geometry: every form has them, as high as the field says, and what other programs need.
TEST_F(Wrinkle, GeometryOfTheField) {
  for (const char* mesh : {"mesh.ply", "mesh.obj", "mesh.glb"}) {
    const Outcome outcome =
        plisse({"wrinkle", "--example", "stretched-sheet", "--vertices", "200", "-o", file("field.ply"),
                "--mesh", file(mesh), "--levels", "3", "--json", file("report.json"), "-q"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = report();
    EXPECT_EQ(json["outputs"][1]["kind"], "mesh");
    EXPECT_GT(json["upsample_s"].get<double>(), 0);
    ASSERT_EQ(plisse({"info", file(mesh), "--json", file("info.json")}).code, 0);
    const auto info = nlohmann::json::parse(read_text(folder_ / "info.json"));
    EXPECT_EQ(info["triangles"], 64 * json["faces"].get<int>()) << mesh;
    EXPECT_EQ(info["meshes"][0]["uv"], true) << mesh;
    // The sheet lies in the plane of x and y; its waves stand out of it by a, hardly less between vertices.
    const auto low = info["bounds"]["low"], high = info["bounds"]["high"];
    const double height = (high[2].get<double>() - low[2].get<double>()) / 2,
                 a = json["max_amplitude_m"].get<double>();
    EXPECT_GT(height, 0.8 * a) << mesh;
    EXPECT_LE(height, a * (1 + 1e-5)) << mesh;  // Loop's masks are means; single precision
    EXPECT_NEAR(high[0].get<double>() - low[0].get<double>(), 0.275, 1e-5) << mesh;  // corners stay
  }
  EXPECT_EQ(plisse({"wrinkle", "--example", "strip", "--levels", "2", "-o", file("f.ply")}).code, 2);
  const Outcome ending =
      plisse({"wrinkle", "--example", "strip", "--mesh", file("m.stl"), "-o", file("f.ply")});
  EXPECT_EQ(ending.code, 2);
  EXPECT_THAT(ending.err, HasSubstr(".glb"));
}

// A tube that is twisted in six frames, from a file a frame and from a point cache.
TEST_F(Wrinkle, OverTime) {
  const std::vector<std::string> drape = {"drape",   "--example", "twisted-cylinder", "--vertices", "340",
                                          "--steps", "6",         "--frames",         "1-6",        "-q",
                                          "-o"};
  const auto with = [](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return plisse(arguments);
  };
  ASSERT_EQ(with(drape, {file("base_####.ply")}).code, 0);
  ASSERT_EQ(with(drape, {file("base.ply")}).code, 0);
  const Outcome outcome =
      plisse({"wrinkle", file("base_####.ply"), "-o", file("field_####.ply"), "--mesh", file("mesh_####.ply"),
              "--levels", "1", "--frames", "5-6", "--fade", "1", "--json", file("report.json"), "-q"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto files = report();
  ASSERT_EQ(files["frames"].size(), 2U);
  ASSERT_EQ(files["outputs"].size(), 4U);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "field_0004.ply"));
  EXPECT_NEAR(files["frames"][1]["waves"].get<double>(), 40, 5);  // what the mesh has by itself
  EXPECT_EQ(files["frames"][1]["kind"], "anchor");                // twisted most
  EXPECT_EQ(files["keys"].back(), 6);
  EXPECT_TRUE(files["frames"][0]["phase_step_rad"].is_null());
  EXPECT_TRUE(files["frames"][1]["phase_step_rad"].is_number());
  io::read_wrinkle_field(file("field_0006.ply"), {});  // whose corners must agree
  // All frames: those two come out the same.
  const std::string fifth = read_text(file("field_0005.ply"));
  const Outcome all = plisse({"wrinkle", file("base_####.ply"), "-o", file("field_####.ply"), "--fade", "1",
                              "--json", file("report.json"), "-q"});
  ASSERT_EQ(all.code, 0) << all.err;
  EXPECT_EQ(read_text(file("field_0005.ply")), fifth);
  const auto whole = report();
  const Outcome cached =
      plisse({"wrinkle", file("base.ply"), "--cache", file("base.pc2"), "-o", file("cached_####.ply"),
              "--fade", "1", "--json", file("report.json"), "-q"});
  ASSERT_EQ(cached.code, 0) << cached.err;
  const auto cache = report();
  ASSERT_EQ(cache["frames"].size(), 6U);
  for (std::size_t n = 0; n < 6; ++n) {
    // A cache has single precision, at places a metre from the middle and strains of a thousandth: the search
    // from the anchor may end in a minimum beside, of two waves more or less and nearly the same energy.
    EXPECT_NEAR(cache["frames"][n]["waves"].get<double>(), whole["frames"][n]["waves"].get<double>(), 3) << n;
    const double energy = whole["frames"][n]["energy_J"];
    EXPECT_NEAR(cache["frames"][n]["energy_J"].get<double>(), energy, 0.1 * energy) << n;
  }
  const Outcome single = plisse({"wrinkle", file("base_####.ply"), "-o", file("field.ply"), "-q"});
  EXPECT_EQ(single.code, 2);
  EXPECT_THAT(single.err, HasSubstr("field_####.ply"));
  ASSERT_EQ(plisse({"drape", "--example", "twisted-cylinder", "--vertices", "180", "--seed", "2", "-q", "-o",
                    file("base_0004.ply")})
                .code,
            0);
  const Outcome other = plisse({"wrinkle", file("base_####.ply"), "-o", file("field_####.ply"), "-q"});
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("base_0004.ply: has another mesh"));
}

TEST_F(Wrinkle, SaysWhatIsWrong) {
  EXPECT_EQ(plisse({"wrinkle"}).code, 2);
  write_text(folder_ / "x.ply", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n");
  const Outcome no_base = plisse({"wrinkle", file("x.ply")});
  EXPECT_EQ(no_base.code, 2);
  EXPECT_THAT(no_base.err, HasSubstr("'face'"));
  const Outcome name = plisse({"wrinkle", "--example", "strip", "-o", file("field.obj")});
  EXPECT_EQ(name.code, 2);
  EXPECT_THAT(name.err, HasSubstr(".ply"));
  const Outcome rule = plisse({"wrinkle", "--example", "strip", "--wrinkle-free", "papers"});
  EXPECT_EQ(rule.code, 2);
  EXPECT_THAT(rule.err, HasSubstr("did you mean"));
  const Outcome short_of =
      plisse({"wrinkle", "--example", "stretched-sheet", "--iterations", "1", "-o", file("f.ply")});
  EXPECT_EQ(short_of.code, 1);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "f.ply"));
}

}  // namespace
}  // namespace plisse::test
