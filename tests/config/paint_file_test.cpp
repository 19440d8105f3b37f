// Paint files: what a file may say, and that every mistake is told with its line and what is allowed.
#include "config/paint_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class PaintFile : public ::testing::Test {
 protected:
  PaintFile() { test::write_text(folder_ / "scene.toml", ""); }
  config::PaintSettings parse(const std::string& text) const {
    return config::parse_paint(text, folder_ / "paint.toml");
  }
  std::string complaint(const std::string& text) const {
    return test::error_of([&] { parse(text); });
  }
  std::string stroke_complaint(const std::string& lines) const { return complaint("[[stroke]]\n" + lines); }
  test::TemporaryFolder folder_;
};

TEST_F(PaintFile, ReadsEveryKindOfStroke) {
  const config::PaintSettings settings = parse(
      "scene = \"scene.toml\"\ntexture_size = 512\npreview_frame = 3\n"
      "[[stroke]]\nkind = \"screen\"\npoints = [[10, 20.5], [30, 40]]\nradius = 12\nframe = 5\nsize = "
      "\"640x480\"\n"
      "camera = \"10,20\"\n"
      "[[stroke]]\nkind = \"surface\"\npoints = [[0, \"12 mm\", 1]]\nradius = \"3 cm\"\nstrength = "
      "0.9\ndirection = [0, 1, 0]\n"
      "falloff = \"flat\"\n"
      "[[stroke]]\nkind = \"random\"\nseed = 9\ndensity = 40\nlength = 0.2\nradius = 0.03\nonly = \"cloth\"\n"
      "[[stroke]]\nkind = \"fill\"\nmode = \"erase\"\nexclude = [\"a\", \"b\"]\n");
  EXPECT_EQ(settings.texture_size, 512);
  EXPECT_EQ(settings.preview_frame, 3);
  EXPECT_EQ(settings.scene, folder_ / "scene.toml");
  ASSERT_EQ(settings.strokes.size(), 4U);
  const auto& screen = settings.strokes[0];
  EXPECT_EQ(screen.points[0], glm::dvec3(10, 20.5, 0));
  EXPECT_EQ(screen.width, 640);
  EXPECT_EQ(screen.frame, 5);
  EXPECT_THAT(screen.place, HasSubstr("paint.toml:4:"));
  const auto& surface = settings.strokes[1];
  EXPECT_NEAR(surface.points[0].y, 0.012, 1e-15);
  EXPECT_NEAR(surface.radius, 0.03, 1e-15);
  EXPECT_EQ(surface.direction.kind, config::PaintDirection::Kind::vector);
  EXPECT_EQ(surface.falloff, config::PaintStroke::Falloff::flat);
  EXPECT_EQ(settings.strokes[2].direction.kind, config::PaintDirection::Kind::random);
  EXPECT_THAT(settings.strokes[2].only, ElementsAre("cloth"));
  EXPECT_EQ(settings.strokes[3].strength, 1);  // an eraser takes all
}

TEST_F(PaintFile, TellsEachMistakeWithItsLine) {
  EXPECT_THAT(stroke_complaint("kind = \"fill\"\ndirection = 0\nstrength = 1.0\n"),
              HasSubstr("paint.toml:4:1: key 'strength': 1 is out of range; allowed: 0 … 0.99"));
  EXPECT_THAT(stroke_complaint("kind = \"fil\"\n"), HasSubstr("did you mean 'fill'?"));
  EXPECT_THAT(stroke_complaint("strength = 0.5\n"), HasSubstr("key 'kind': missing"));
  EXPECT_THAT(stroke_complaint("kind = \"surface\"\nradius = 1\n"),
              HasSubstr("either 'points' or 'vertices'"));
  EXPECT_THAT(stroke_complaint("kind = \"surface\"\nradius = nan\nvertices = [1, 2]\n"),
              HasSubstr("not finite"));
  EXPECT_THAT(stroke_complaint("kind = \"surface\"\nradius = 0\nvertices = [1, 2]\n"),
              HasSubstr("out of range"));
  EXPECT_THAT(stroke_complaint("kind = \"surface\"\nradius = 1\nvertices = [1]\n"),
              HasSubstr("one point is no line"));
  EXPECT_THAT(stroke_complaint("kind = \"uv\"\nradius = 1\npoints = [[1, 2, 3]]\n"),
              HasSubstr("a point of 3 numbers, not of 2"));
  EXPECT_THAT(stroke_complaint("kind = \"uv\"\npoints = [[1, 2], [3, inf]]\nradius = 1\n"),
              HasSubstr("not finite"));
  EXPECT_THAT(stroke_complaint("kind = \"uv\"\npoints = [[1, 2], [3, 4]]\n"), HasSubstr("'radius': missing"));
  EXPECT_THAT(stroke_complaint("kind = \"uv\"\npoints = [[1, 2], [3, 4]]\nradius = 1\ndensity = 3\n"),
              HasSubstr("key 'density': unknown in a stroke of kind uv"));
  EXPECT_THAT(stroke_complaint("kind = \"fill\"\n"), HasSubstr("needs an angle or a vector"));
  EXPECT_THAT(stroke_complaint("kind = \"fill\"\ndirection = [0, 0, 0]\n"), HasSubstr("no length"));
  EXPECT_THAT(stroke_complaint("kind = \"image\"\ndirection = 0\nfile = \"no.png\"\n"),
              HasSubstr("there is no file"));
  EXPECT_THAT(stroke_complaint("kind = \"fill\"\nmode = \"erase\"\ndirection = 0\n"),
              HasSubstr("has no effect"));
  EXPECT_THAT(complaint("scene = \"scene.toml\"\n"), HasSubstr("no [[stroke]]"));
  EXPECT_THAT(complaint("scnee = 1\n[[stroke]]\nkind = \"fill\"\ndirection = 1\n"),
              HasSubstr("did you mean 'scene'?"));
  EXPECT_THAT(complaint("[stroke]\nkind = \"fill\"\n"), HasSubstr("write [[stroke]]"));
  EXPECT_THAT(complaint("scene = \n"), HasSubstr("not TOML"));
  const std::string all = complaint("texture_size = 1\n[[stroke]]\nkind = \"random\"\n");
  for (const char* part : {"texture_size", "'density': missing", "'length': missing", "'radius': missing"})
    EXPECT_THAT(all, HasSubstr(part));
}

TEST_F(PaintFile, ReferenceIsWhatTheParserSays) {
  const std::string file = test::read_text(test::source_file("docs/paint.md"));
  EXPECT_THAT(file, HasSubstr(config::paint_reference_markdown())) << "docs/paint.md has other tables:\n"
                                                                   << config::paint_reference_markdown();
}

}  // namespace
}  // namespace plisse
