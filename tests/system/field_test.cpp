// Scenes with a solved wrinkle field: the TFW authors' disk, both ways.
#include <gmock/gmock.h>

#include "io/picture/image.h"
#include "system/plisse.h"

namespace plisse::test {
namespace {

using ::testing::HasSubstr;

class Fields : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    if (!std::filesystem::exists(shared_data("tfw-disk"))) GTEST_SKIP() << "no ../shared/data/tfw-disk";
  }
  std::string scene(const std::string& name, const std::string& mesh, const std::string& bias) const {
    const std::string path = (folder_ / name).string();
    write_text(path, "[model]\npath = \"" + (shared_data("tfw-disk") / mesh).string() +
                         "\"\nup = \"z\"\n[camera]\nelevation = 60\n[bias]\nfield = \"" +
                         (shared_data("tfw-disk") / "disk_amplitude_simulated.txt").string() + "\"\n" + bias +
                         "[output]\nsize = \"160x128\"\npath = \"" + name + ".png\"\n");
    return path;
  }
  TemporaryFolder folder_;
};

TEST_F(Fields, TheAuthorsDiskRendersAndVerifiesBothWays) {
  for (const std::string use : {"bias", "direct"}) {
    const std::string path = scene(use + ".toml", "disk_simulated.obj", "use = \"" + use + "\"\n");
    const Outcome rendered = plisse({"render", path, "-q"});
    ASSERT_EQ(rendered.code, 0) << rendered.err;
    const Outcome verified = plisse({"verify", path, "-q"});
    EXPECT_EQ(verified.code, 0) << use << verified.out << verified.err;
  }
  EXPECT_NE(io::load_image(folder_ / "bias.toml.png").rgba, io::load_image(folder_ / "direct.toml.png").rgba);
}

TEST_F(Fields, AnotherMeshThanItsBaseIsRefused) {
  write_text(folder_ / "small.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_text(folder_ / "b.toml", "[model]\npath = \"small.obj\"\n[bias]\nfield = \"" +
                                     (shared_data("tfw-disk") / "disk_amplitude_simulated.txt").string() +
                                     "\"\n");
  const Outcome refused = plisse({"render", (folder_ / "b.toml").string(), "-q"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("the base surface has 3 vertices"));
}

}  // namespace
}  // namespace plisse::test
