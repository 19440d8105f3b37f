// Scenes that say panels and a fabric in place of a mesh, from pattern to picture.
#include <gmock/gmock.h>

#include "io/picture/image.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::HasSubstr;

// A square of 24 cm, hung by two sides that come nearer by 5 cm.
class Garments : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write_text(folder_ / "p.toml",
               "units = \"cm\"\nfabric = \"dark-blue\"\n[[panel]]\nname = \"cloth\"\n"
               "outline = [[0, 0], [24, 0], [24, 24], [0, 24]]\n");
    write_text(folder_ / "hang.toml",
               "[drape]\ngarment = \"p.toml\"\nframes = 3\n"
               "[[hold]]\nbox = [[-0.001, -1, -1], [0.001, 1, 1]]\n"
               "[[hold]]\nbox = [[0.239, -1, -1], [0.241, 1, 1]]\nmove = [-0.05, 0, 0]\n");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string scene(const std::string& name, const std::string& model) const {
    write_text(folder_ / (name + ".toml"),
               "[model]\n" + model + "[output]\nsize = \"160x128\"\npath = \"" + name + "_####.png\"\n");
    return path(name + ".toml");
  }
  TemporaryFolder folder_;
};

TEST_F(Garments, PanelAndFabricGoThroughDrapeWrinkleAndRender) {
  const Outcome draped = plisse(
      {"drape", path("hang.toml"), "--frames", "1-3", "-o", path("cloth.ply"), "--json", path("d.json")});
  ASSERT_EQ(draped.code, 0) << draped.err;
  EXPECT_THAT(draped.err, HasSubstr("fabric 'dark-blue' tells no more"));
  const auto report = nlohmann::json::parse(read_text(folder_ / "d.json"));

  // The same mesh without a file of it; flat, so that what the drape squeezes wrinkles.
  const std::string garment = scene("garment", "garment = \"p.toml\"\ncache = \"cloth.pc2\"\n");
  const Outcome info = plisse({"info", garment, "--json", "-"});
  ASSERT_EQ(info.code, 0) << info.err;
  const auto model = nlohmann::json::parse(info.out);
  EXPECT_EQ(model["vertices"]["welded"], report["vertices"]);
  EXPECT_EQ(model["sequence"]["frames"], 3);
  ASSERT_EQ(plisse({"verify", garment, "-q"}).code, 0);
  const Outcome rendered = plisse({"render", garment, "-q"});
  ASSERT_EQ(rendered.code, 0) << rendered.err;

  // What `size` writes of it is that mesh, so it gives that picture; OBJ has nine digits.
  ASSERT_EQ(plisse({"size", path("p.toml"), "-o", folder_.path().string()}).code, 0);
  const std::string file = scene("file", "path = \"cloth.obj\"\ncache = \"cloth.pc2\"\n");
  ASSERT_EQ(plisse({"render", file, "-q"}).code, 0);
  const io::Image ours = io::load_image(folder_ / "garment_0003.png"),
                  theirs = io::load_image(folder_ / "file_0003.png");
  ASSERT_EQ(ours.rgba.size(), theirs.rgba.size());
  std::size_t apart = 0;
  for (std::size_t i = 0; i < ours.rgba.size(); ++i)
    apart += std::abs(int(ours.rgba[i]) - int(theirs.rgba[i])) > 2 ? 1 : 0;
  EXPECT_LT(apart, ours.rgba.size() / 1000);  // pixels on a silhouette
  EXPECT_NE(io::load_image(folder_ / "garment_0001.png").rgba, ours.rgba);

  const Outcome wrinkled = plisse({"wrinkle", path("hang.toml"), "-o", path("field.ply"), "-q"});
  EXPECT_EQ(wrinkled.code, 0) << wrinkled.err;

  // Another fabric is another mesh, which the cache does not go over.
  const std::string other =
      scene("other", "garment = \"p.toml\"\nfabric = \"khaki\"\ncache = \"cloth.pc2\"\n");
  const Outcome refused = plisse({"render", other, "-q"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("vertices"));
}

TEST_F(Garments, PanelsAreRenderedAsTheyAre) {
  const Outcome bare =
      plisse({"render", asset("skirt.toml").string(), "-o", path("skirt_####.png"), "--size", "96x80", "-q"});
  ASSERT_EQ(bare.code, 0) << bare.err;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "skirt_0001.png"));

  const auto refused = [&](const std::string& model) {
    const Outcome outcome = plisse({"info", scene("bad", model)});
    EXPECT_EQ(outcome.code, 2) << model;
    return outcome.err;
  };
  EXPECT_THAT(refused("garment = \"p.toml\"\nfabric = \"kaki\"\n"), HasSubstr("did you mean 'khaki'?"));
  EXPECT_THAT(refused("garment = \"p.toml\"\npieces = \"cloht\"\n"),
              HasSubstr("bad.toml:2:1: there is no panel 'cloht'; allowed: cloth"));
  EXPECT_THAT(refused("garment = \"p.toml\"\npath = \"p.toml\"\n"), HasSubstr("'garment'"));
  EXPECT_THAT(refused("garment = \"p.toml\"\nunits = 2\n"), HasSubstr("says its own unit"));
  EXPECT_THAT(refused("pieces = \"cloth\"\n"), HasSubstr("has no effect without 'garment'"));
}

}  // namespace
}  // namespace plisse::test
