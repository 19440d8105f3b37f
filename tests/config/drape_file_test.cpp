// Scene files of plisse drape: what they set, and that the documentation says so.
#include "config/drape_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/errors.h"
#include "support/files.h"

namespace plisse {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(DrapeFile, ReadsWhatItSays) {
  const config::DrapeSettings s = config::parse_drape(
      "[drape]\npanel = [\"60 cm\", 0.4]\nvertices = 800\nplane = \"xz\"\nmodel = \"stvk\"\nframes = 3\n"
      "[material]\nthickness = \"0.5 mm\"\n[loads]\ngravity = [0, 0, -1]\n"
      "[[hold]]\nbox = [[1, 0, 2], [0, 1, 0]]\naxes = \"xz\"\nturn = 90\n"
      "[[hold]]\nvertices = [3, 4]\n"
      "[[obstacle]]\nkind = \"plane\"\nat = [0, 0, 0]\nnormal = [0, 0, 2]\nmove = [0, 1, 0]\n",
      "cloth.toml");
  EXPECT_DOUBLE_EQ(s.panel[0], 0.6);
  EXPECT_EQ(s.vertices, 800);
  EXPECT_FALSE(s.upright);
  EXPECT_TRUE(s.stvk);
  EXPECT_DOUBLE_EQ(s.thickness, 0.5e-3);
  EXPECT_EQ(s.loads.gravity, Eigen::Vector3d(0, 0, -1));
  ASSERT_EQ(s.holds.size(), 2U);
  EXPECT_EQ((*s.holds[0].box)[0], glm::dvec3(0, 0, 0));  // corners in any order
  EXPECT_EQ((*s.holds[0].box)[1], glm::dvec3(1, 1, 2));
  EXPECT_EQ(s.holds[0].axes, (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(s.holds[1].vertices, (std::vector<std::uint32_t>{3, 4}));
  EXPECT_EQ(s.holds[1].place, "cloth.toml:15:1");
  ASSERT_EQ(s.obstacles.size(), 1U);
  EXPECT_EQ(s.obstacles[0].shape.normal, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(s.obstacles[0].motion.move, glm::dvec3(0, 1, 0));
  EXPECT_EQ(s.holds[0].motion.turn, 90);
}

TEST(DrapeFile, FabricsAreThoseOfPanelFiles) {
  const config::DrapeSettings named = config::parse_drape(
      "[drape]\npanel = [1, 1]\n[material]\nfabric = \"khaki\"\ndensity = \"120 g/m²\"\n", "cloth.toml");
  ASSERT_TRUE(named.fabric);
  EXPECT_EQ(named.fabric->weft.modulus, 5e5);
  EXPECT_DOUBLE_EQ(named.weight.value_or(0), 0.12);
  EXPECT_FALSE(named.density);
  EXPECT_EQ(named.vertices, 0);
  const config::DrapeSettings numbers = config::parse_drape(
      "[drape]\npanel = [1, 1]\n[material]\nfabric = { thickness = \"0.4 mm\", E = \"0.3 MPa\", density = "
      "\"200 g/m²\" }\ndensity = 300\n",
      "cloth.toml");
  ASSERT_TRUE(numbers.fabric);
  EXPECT_DOUBLE_EQ(numbers.fabric->thickness.value_or(0), 0.4e-3);
  EXPECT_EQ(numbers.density, 300);
  EXPECT_THAT(
      test::error_of([] {
        config::parse_drape(
            "[drape]\npanel = [1, 1]\n[material]\nfabric = \"kaki\"\nyoung = 3\ndensity = \"3 m\"\n",
            "c.toml");
      }),
      AllOf(HasSubstr("c.toml:4:10: key 'fabric': 'kaki' is unknown"), HasSubstr("did you mean 'khaki'?"),
            HasSubstr("key 'young': follows from 'fabric'"), HasSubstr("'3 m' is no weight")));
}

TEST(DrapeFile, ForcesFrictionAndMirrors) {
  const config::DrapeSettings s = config::parse_drape(
      "[drape]\npanel = [1, 1]\n[loads]\nfriction = 0.4\n"
      "[[hold]]\nbox = [[0, 0, 0], [0, 1, 0]]\naxes = \"x\"\nmirror = true\n"
      "[[force]]\nvertices = [7]\ntotal = [0, 0, 2]\n"
      "[[force]]\nbox = [[1, 0, 0], [1, 1, 0]]\nper_length = [3, 0, 0]\ngrows = true\n",
      "cloth.toml");
  EXPECT_EQ(s.loads.friction, 0.4);
  EXPECT_TRUE(s.holds.at(0).mirror);
  ASSERT_EQ(s.forces.size(), 2U);
  EXPECT_EQ(s.forces[0].total, glm::dvec3(0, 0, 2));
  EXPECT_FALSE(s.forces[0].grows);
  EXPECT_EQ(s.forces[1].per_length, glm::dvec3(3, 0, 0));
  EXPECT_TRUE(s.forces[1].grows);
  const std::string all = test::error_of([] {
    config::parse_drape(
        "[drape]\npanel = [1, 1]\n[[force]]\nvertices = [1]\n[[hold]]\nvertices = [1]\nmirror = true\n"
        "[[force]]\nvertices = [1]\ntotal = [1, 1, 1]\ngrows = 1\n",
        "bad.toml");
  });
  EXPECT_THAT(all, AllOf(HasSubstr("bad.toml:3:1: [[force]] needs either 'total' or 'per_length'"),
                         HasSubstr("a mirror is the plane across one axis"),
                         HasSubstr("key 'grows': 1 is a whole number, not a truth value")));
}

TEST(DrapeFile, AllMistakesAtOnce) {
  const std::string all = test::error_of([] {
    config::parse_drape(
        "[drape]\nvertices = 5\n[materials]\nyoung = 1\n[loads]\ngravity = [0, 1]\n[hold]\nturn = 1\n",
        "bad.toml");
  });
  EXPECT_THAT(all, AllOf(HasSubstr("bad.toml:1:1: [drape] needs one of 'mesh', 'garment' and 'panel'"),
                         HasSubstr("bad.toml:2"), HasSubstr("did you mean 'material'"),
                         HasSubstr("bad.toml:6"), HasSubstr("write [[hold]]")));
}

TEST(DrapeFile, KeysThatWouldHaveNoEffectAreRefused) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "m.obj", "v 0 0 0\n");
  test::write_text(folder / "p.toml", "");
  const auto complaints = [&](const std::string& keys) {
    return test::error_of([&] { config::parse_drape("[drape]\n" + keys, folder / "c.toml"); });
  };
  EXPECT_THAT(complaints("mesh = \"m.obj\"\nseed = 1\nvertices = 100\nplane = \"xy\"\n"),
              AllOf(HasSubstr("c.toml:3:8: key 'seed': has no effect on a 'mesh'"),
                    HasSubstr("c.toml:4:12: key 'vertices': has no effect on a 'mesh'"),
                    HasSubstr("c.toml:5:9: key 'plane': has no effect without 'panel'")));
  EXPECT_THAT(complaints("panel = [1, 1]\nwrap = 0.1\npieces = \"a\"\n"),
              AllOf(HasSubstr("c.toml:3:8: key 'wrap': has no effect without 'garment'"),
                    HasSubstr("c.toml:4:10: key 'pieces': has no effect without 'garment'")));
  EXPECT_THAT(complaints("garment = \"p.toml\"\nplane = \"xz\"\n"), HasSubstr("c.toml:3:9: key 'plane'"));
  EXPECT_THAT(complaints("panel = [1, 1]\nmodel = \"stvk\"\nresidual = 0.1\n"),
              HasSubstr("c.toml:4:12: key 'residual': has no effect on a stvk shell"));
  EXPECT_EQ(complaints("garment = \"p.toml\"\nwrap = 1\npieces = \"a\"\nvertices = 100\nseed = 3\n"), "");
  EXPECT_EQ(complaints("panel = [1, 1]\nvertices = 100\nseed = 3\nplane = \"xz\"\n"), "");
}

TEST(DrapeFile, ReferenceIsWhatTheParserSays) {
  EXPECT_THAT(test::read_text(test::source_file("docs/drape.md")),
              HasSubstr(config::drape_reference_markdown()))
      << "docs/drape.md has another table:\n"
      << config::drape_reference_markdown();
}

}  // namespace
}  // namespace plisse
