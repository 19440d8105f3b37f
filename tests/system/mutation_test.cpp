// Verify must be able to fail: with one number of a shader altered, it has to notice and name the pass.
#include <gmock/gmock.h>

#include "support/gltf.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

struct Mutation {
  std::string name, file, from, to, pass;
  std::string part = pass;  // of the pass: what has to notice
};
void PrintTo(const Mutation& mutation, std::ostream* out) {
  *out << mutation.name;
}

// The sleeve with a shoulder that lets light through and a cuff that its mask cuts away.
std::string sleeve_with_holes(const TemporaryFolder& folder) {
  altered_glb(asset("sleeve.glb"), folder / "sleeve.glb", [](nlohmann::json& gltf) {
    auto& seam = gltf["materials"][0];
    seam["alphaMode"] = "BLEND";
    seam["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.4;
    auto& cuff = gltf["materials"][2];
    cuff["alphaMode"] = "MASK";
    cuff["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.3;
  });
  std::filesystem::copy(asset("sleeve.toml"), folder / "sleeve.toml");
  return (folder / "sleeve.toml").string();
}

// The shaders with one line altered, as folder/shaders.
void write_altered_shaders(const Mutation& mutation, const TemporaryFolder& folder) {
  std::filesystem::copy(test::source_file("shaders"), folder / "shaders",
                        std::filesystem::copy_options::recursive);
  if (mutation.file.empty()) return;
  const auto path = folder / ("shaders/" + mutation.file);
  std::string text = read_text(path);
  const std::size_t at = text.find(mutation.from);
  ASSERT_NE(at, std::string::npos) << mutation.file << " has no '" << mutation.from
                                   << "' any more: mend this test";
  text.replace(at, mutation.from.size(), mutation.to);
  write_text(path, text);
}

class Mutations : public Program, public ::testing::WithParamInterface<Mutation> {};

TEST_P(Mutations, AreNoticed) {
  const Mutation& mutation = GetParam();
  const TemporaryFolder folder;
  write_altered_shaders(mutation, folder);
  const std::string report = (folder / "report.json").string();
  const Outcome outcome = plisse({"verify", sleeve_with_holes(folder), "--size", "96x80", "--frames",
                                  "10,40,60", "--shaders", (folder / "shaders").string(), "--json", report});
  const auto json = nlohmann::json::parse(read_text(report));
  if (mutation.file.empty()) {
    EXPECT_EQ(outcome.code, 0) << outcome.out;
    return;
  }
  EXPECT_EQ(outcome.code, 1) << outcome.out << outcome.err;
  EXPECT_EQ(json["ok"], false);
  EXPECT_GE(json["failures"].size(), 1U);
  // Each pass is fed the shader's own inputs, so the others stand.
  for (const std::string pass : {"skin", "crush", "relax", "displacement", "render"}) {
    EXPECT_EQ(json["passes"][pass]["ok"], pass != mutation.pass) << pass;
  }
  EXPECT_EQ(json["passes"][mutation.part]["ok"], false);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Mutations,
    ::testing::Values(
        Mutation{"Nothing", "", "", "", ""},
        Mutation{"SkinWeight", "skin.comp", "weights[i] * texelFetch(palette, entry);",
                 "1.0001 * weights[i] * texelFetch(palette, entry);", "skin"},
        Mutation{"CrushHeight", "crush.comp", "0.25 * sqrt", "0.2501 * sqrt", "crush"},
        Mutation{"CrushDirection", "crush.comp", "vec2 v2 = vec2(-v1.y, v1.x);",
                 "vec2 v2 = vec2(-v1.y, 1.01 * v1.x);", "crush"},
        Mutation{"CrushSignOfEachFrame", "crush.comp", "k = normalize(", "k = -normalize(", "crush"},
        Mutation{"CrushWeight", "crush.comp", "- 0.0125) / 0.0625", "- 0.0125) / 0.0645", "crush"},
        Mutation{"CrushStatus", "crush.comp", "s > dead_zone)", "s > 1.1 * dead_zone)", "crush"},
        Mutation{"RelaxLead", "relax.comp", "phases_out[v] = vec2(2.0 * pi * wrap_turns(turns), set);", "",
                 "relax"},
        Mutation{"RelaxLeadsShare", "relax.comp", "turns += fraction", "turns += 1.1 * fraction", "relax"},
        Mutation{"RelaxMiddle", "relax.comp", "0.5 * (position(n)", "0.51 * (position(n)", "relax"},
        Mutation{"RelaxSign", "relax.comp", "? -1.0 : 1.0;", "? 1.0 : 1.0;", "relax"},
        Mutation{"DisplacementPhase", "displacement.comp", "(0.5 / pi)", "(0.502 / pi)", "displacement",
                 "displacement.relief"},
        Mutation{"DisplacementBend", "displacement.comp", "height * (bend", "0.5 * height * (bend",
                 "displacement", "displacement.normal"},
        Mutation{"DisplacementMean", "displacement_mean.comp", "share * place.xyz",
                 "1.001 * share * place.xyz", "displacement"},
        Mutation{"RenderSlope", "render.vert", "(2.0 * pi) * h", "(2.2 * pi) * h", "render"},
        Mutation{"RenderPhase", "render.vert", "(0.5 / pi)", "(0.55 / pi)", "render"},
        Mutation{"RenderLight", "common/shading.glsl", "0.6 + 0.4 *", "0.6 + 0.6 *", "render"},
        Mutation{"RenderShoulder", "common/shading.glsl", "0.04 + 0.96", "0.24 + 0.96", "render"},
        Mutation{"RenderMask", "render.frag", "if (albedo.a < alpha_cutoff) discard;", "", "render"},
        Mutation{"RenderBlending", "render.frag", "if (has_alpha) alpha = albedo.a;", "", "render"},
        Mutation{"DepthMap", "depth.vert", "to_clip * vec4(", "to_clip * vec4(0.99 * ", "render",
                 "render.shadow_map"},
        Mutation{"GroundLight", "ground.comp", "vec4(1.0 - lit", "vec4(0.9 - 0.9 * lit", "render",
                 "render.ground_map"},
        Mutation{"GroundContact", "ground.comp", "exp(-height", "exp(-1.2 * height", "render",
                 "render.ground_map"},
        Mutation{"GroundBlur", "ground.comp", "exp(-0.5", "exp(-0.6", "render", "render.ground_map"},
        Mutation{"BackdropVignette", "backdrop.frag", "1.06 - 0.45", "1.06 - 0.65", "render",
                 "render.backdrop"},
        Mutation{"BackdropShadow", "backdrop.frag", "1.0 - 0.5 * taken.x", "1.0 - 0.8 * taken.x", "render",
                 "render.backdrop"},
        Mutation{"BackdropPlace", "backdrop.vert", "/ map_origin.w,", "/ map_origin.w + 0.05,", "render",
                 "render.backdrop"}),
    [](const auto& mutation) { return mutation.param.name; });

// A tube that is untwisted and twisted again, under a solved field: as bias, and carried.
class FieldMutations : public Program, public ::testing::WithParamInterface<Mutation> {
 protected:
  static const TemporaryFolder& tube() {
    static const TemporaryFolder folder;
    static const bool made = [] {
      const auto path = [](const std::string& name) { return (folder / name).string(); };
      EXPECT_EQ(plisse({"drape", "--example", "twisted-cylinder", "--steps", "4", "--frames", "1-4", "-o",
                        path("tube_####.ply")})
                    .code,
                0);
      EXPECT_EQ(plisse({"wrinkle", path("tube_0004.ply"), "-o", path("field.ply")}).code, 0);
      for (const auto& [frame, from] : {std::pair(1, 4), {2, 1}, {3, 4}})
        std::filesystem::copy(path("tube_000" + std::to_string(from) + ".ply"),
                              path("model_" + std::to_string(frame) + ".ply"));
      for (const std::string use : {"bias", "direct"})
        write_text(folder / (use + ".toml"),
                   "[model]\npath = \"model_#.ply\"\n[wrinkles]\ndead_zone = 0.025\n[bias]\nfield = "
                   "\"field.ply\"\nuse = \"" +
                       use + "\"\n");
      return true;
    }();
    EXPECT_TRUE(made);
    return folder;
  }
};

TEST_P(FieldMutations, AreNoticed) {
  const Mutation& mutation = GetParam();
  const TemporaryFolder& folder = tube();
  const TemporaryFolder own;
  write_altered_shaders(mutation, own);
  // The pass is the scene here; waves fade below four pixels.
  const std::string report = (own / "report.json").string();
  const Outcome outcome =
      plisse({"verify", (folder / (mutation.pass + ".toml")).string(), "--size", "280x350", "--frames", "1-3",
              "--shaders", (own / "shaders").string(), "--json", report});
  EXPECT_EQ(outcome.code, mutation.file.empty() ? 0 : 1) << outcome.out << outcome.err;
  const auto json = nlohmann::json::parse(read_text(report));
  EXPECT_EQ(json["passes"][mutation.file.empty() ? "crush" : mutation.part]["ok"], mutation.file.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Of, FieldMutations,
    ::testing::Values(Mutation{"NothingAsBias", "", "", "", "bias"},
                      Mutation{"NothingCarried", "", "", "", "direct"},
                      Mutation{"PhaseComesBack", "crush.comp", "along < 0.0 ? -bias.z : bias.z",
                               "bias.z + 0.1", "bias", "crush.phase"},
                      Mutation{"ComesBackAsFresh", "crush.comp", "bias.w > 0.0 && along", "false && along",
                               "bias", "crush.status"},
                      Mutation{"StretchAlongCarried", "crush.comp", "(1.0 / max(", "(1.01 / max(", "direct",
                               "crush.r"},
                      Mutation{"CarriedPlace", "displacement.comp", "dot(b, field_amplitude)",
                               "1.01 * dot(b, field_amplitude)", "direct", "displacement.relief"},
                      Mutation{"CarriedSlope", "displacement.comp", "c * swell - 2.0 * pi",
                               "c * swell - 1.98 * pi", "direct", "displacement.normal"},
                      Mutation{"CarriedTurns", "render.frag", "2.0 * pi * (turns", "1.9 * pi * (turns",
                               "direct", "render"}),
    [](const auto& mutation) { return mutation.param.name; });

}  // namespace
}  // namespace plisse::test
