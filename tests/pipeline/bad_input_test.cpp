// Everything that a scene takes in beside its model, with one mistake each: what is said, and where.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "config/paint_file.h"
#include "config/scene_file.h"
#include "io/picture/png.h"
#include "pipeline/loaded_scene.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::pipeline {
namespace {

using ::testing::HasSubstr;
using Files = std::map<std::string, std::string>;

// A square of four vertices and two triangles with uv, and a good file of each kind for it.
Files good_files() {
  const std::string places[] = {"0 0 0", "1 0 0", "1 1 0", "0 1 0"};
  const std::string uvs[] = {"0 0", "1 0", "1 1", "0 1"};
  Files files;
  for (const auto& x : places) files["q.obj"] += "v " + x + "\n";
  for (const auto& x : uvs) files["q.obj"] += "vt " + x + "\n";
  files["q.obj"] += "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
  files["bare.obj"] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
  const std::string axes = "property double x\nproperty double y\nproperty double z\n";
  const auto ply = [&](const std::string& properties, const std::string& values) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 4\n" + axes + properties + "end_header\n";
    for (const auto& x : places) text += x + values + "\n";
    return text;
  };
  files["bias.ply"] =
      ply("property double bias_x\nproperty double bias_y\nproperty double bias_z\n", " .5 0 0");
  files["waves.ply"] = ply("property double wavelength\n", " 0.25");
  files["colours.ply"] = ply("property uchar red\nproperty uchar green\nproperty uchar blue\n", " 9 8 7");
  std::string field = "ply\nformat ascii 1.0\nelement vertex 4\n" + axes +
                      "property double amplitude\nelement face 2\nproperty list uchar int vertex_indices\n"
                      "property list uchar double phase\nend_header\n";
  for (const auto& x : places) field += x + " .1\n";
  files["field.ply"] = field + "3 0 1 2 3 0 1 2\n3 0 2 3 3 0 2 3\n";
  files["q_amplitude_s.txt"] = ".1\n.2\n.3\n.1\n";
  files["q_phi_s.txt"] = "0\n1\n2\n3\n";
  files["q_dphi_s.txt"] = "1\n2\n3\n1\n1\n";
  files["profile.txt"] = "1 0 -1 0\n";
  files["paint.toml"] =
      "[[stroke]]\nkind = \"surface\"\npoints = [[0, 0, 0], [1, 0, 0]]\nradius = 0.5\nstrength = 0.5\n";
  return files;
}

std::string scene_of(const std::string& model, const std::string& more) {
  return "[model]\npath = \"" + model + "\"\n" + more;
}
std::string stroke_of(const std::string& lines) {
  return "[[stroke]]\n" + lines;
}

class BadInput : public ::testing::Test {
 protected:
  // Writes the files and loads scene.toml, as every command does first.
  std::string load(const Files& files) {
    for (const auto& [name, text] : files) test::write_text(folder_ / name, text);
    return test::error_of([&] { pipeline::LoadedScene scene(config::load_scene(folder_ / "scene.toml")); });
  }
  test::TemporaryFolder folder_;
};

const std::string by_file = "[bias]\nfile = \"bias.ply\"\n";
const std::string by_picture = "[bias]\nfile = \"bias.png\"\n";
const std::string by_field = "[bias]\nfield = \"field.ply\"\n";
const std::string by_texts = "[bias]\nfield = \"q_amplitude_s.txt\"\n";
const std::string by_paint = "[bias]\npaint = \"paint.toml\"\n";
const std::string waves_by_vertex = "[wrinkles]\nwavelength_map = \"waves.ply\"\n";
const std::string waves_by_picture = "[wrinkles]\nwavelength_map = \"grey.png\"\n";
const std::string own_profile = "[wrinkles]\nprofile = \"profile.txt\"\n";

struct Row {
  std::string name;
  std::string model, scene;    // q.obj or bare.obj; the scene's text after [model]
  std::string file, from, to;  // the mistake: in this file this text becomes that one ("": the whole file)
  std::string said;            // what the message has in it
};

const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      // what plisse paint writes
      {"BiasOfAnotherModel", "q.obj", by_file, "bias.ply", "element vertex 4", "element vertex 3",
       "scene.toml:4:1: {}bias.ply: has 3 vertices, the model has 4 welded ones"},
      {"BiasOfAnotherPose", "q.obj", by_file, "bias.ply", "1 1 0 .5", "1 1 1 .5",
       "vertex 2 is 1 m from the model's"},
      {"BiasTooLong", "q.obj", by_file, "bias.ply", "0 1 0 .5 0 0", "0 1 0 .8 .6 0",
       "vertex 3: bias has a length of 1; it has to be less than 1"},
      {"BiasNotFinite", "q.obj", by_file, "bias.ply", "0 1 0 .5 0 0", "0 1 0 nan 0 0", "not finite"},
      {"BiasWithoutVectors", "q.obj", by_file, "bias.ply", "bias_z", "bias_w", "has no property 'bias_z'"},
      {"BiasCutShort", "q.obj", by_file, "bias.ply", "0 1 0 .5 0 0\n", "", "bias.ply:"},
      {"BiasNoPly", "q.obj", by_file, "bias.ply", "", "hello", "bias.ply"},
      {"BiasOblongPicture", "q.obj", "[bias]\nfile = \"oblong.png\"\n", "", "", "",
       "scene.toml:4:1: {}oblong.png: is 4x2 pixels; a texture of painted wrinkles is square"},
      {"BiasPictureWithoutUv", "bare.obj", by_picture, "", "", "",
       "is a picture in uv, but the model has no uv"},
      {"BiasNoPicture", "q.obj", "[bias]\nfile = \"profile.txt\"\n", "", "", "", "profile.txt"},
      {"BiasMissing", "q.obj", "[bias]\nfile = \"bais.ply\"\n", "", "", "",
       "scene.toml:4:1: key 'file': there is no file '{}bais.ply'"},
      {"BiasTwice", "q.obj", by_file + "field = \"field.ply\"\n", "", "", "",
       "scene.toml:5:1: key 'field': stands beside 'file'"},
      // solved fields
      {"FieldOfAnotherSurface", "q.obj", by_field, "field.ply", "1 1 0 .1", "1 1 .5 .1",
       "scene.toml:4:1: {}field.ply: its vertex 2 is not on the model; the model's rest pose has to be the "
       "base"},
      {"FieldNegative", "q.obj", by_field, "field.ply", "1 1 0 .1", "1 1 0 -.1",
       "vertex 2: the amplitude is -0.1; it has to be 0 or more"},
      {"FieldNotFinite", "q.obj", by_field, "field.ply", "3 0 1 2\n3", "3 0 inf 2\n3", "not finite"},
      {"FieldTorn", "q.obj", by_field, "field.ply", "3 0 2 3 3 0 2 3", "3 0 2 3 3 0.5 2 3",
       "the phase of vertex 0 differs by 0.5 from that of another face, which is no multiple of 2π"},
      {"FieldWithoutPhase", "q.obj", by_field, "field.ply", "double phase", "double fase",
       "has no list 'phase'"},
      {"FieldOfQuads", "q.obj", by_field, "field.ply", "3 0 1 2 3 0 1 2", "3 0 1 2 2 0 1",
       "face 0: 'phase' has to have 3 values"},
      {"FieldOfNoVertex", "q.obj", by_field, "field.ply", "3 0 1 2 3", "3 0 1 7 3", "there is no vertex 7"},
      {"FieldUsedWrongly", "q.obj", by_field + "use = \"directly\"\n", "", "", "",
       "scene.toml:5:1: key 'use': 'directly' is unknown; allowed: bias or direct (did you mean "
       "'direct'?)"},
      {"FieldsForAFrameAsBias", "q.obj", "[bias]\nfield = \"f_##.ply\"\n", "", "", "",
       "scene.toml:4:1: key 'field': one field a frame"},
      {"FieldsThatAreNotThere", "q.obj", "[bias]\nuse = \"direct\"\nfield = \"f_##.ply\"\n", "", "", "",
       "f_##.ply: no file fits this pattern"},
      {"TextsTooFew", "q.obj", by_texts, "q_phi_s.txt", "3\n", "",
       "q_phi_s.txt: has 3 numbers, the base surface has 4"},
      {"TextsOfWords", "q.obj", by_texts, "q_dphi_s.txt", "3\n", "three\n",
       "q_dphi_s.txt:3: 'three' is no finite number"},
      {"TextsNotFinite", "q.obj", by_texts, "q_amplitude_s.txt", ".3\n", "nan\n",
       "q_amplitude_s.txt:3: 'nan' is no finite number"},
      // maps
      {"WavelengthNone", "q.obj", waves_by_vertex, "waves.ply", "1 1 0 0.25", "1 1 0 0",
       "scene.toml:4:1: {}waves.ply: vertex 2: the wavelength is 0; it has to be more than 0"},
      {"WavelengthElsewhere", "q.obj", waves_by_vertex, "waves.ply", "1 1 0 0.25", "1 1 3 0.25",
       "1 of the model's 4 welded vertices are not among its 4"},
      {"WavelengthUnnamed", "q.obj", waves_by_vertex, "waves.ply", "double wavelength", "double length",
       "has no property 'wavelength'"},
      {"WavelengthPictureWithoutUv", "bare.obj", waves_by_picture, "", "", "",
       "scene.toml:4:1: {}grey.png: is a picture in uv, but the model has no uv"},
      {"WavelengthLowOutOfRange", "q.obj", waves_by_picture + "wavelength_low = -1\n", "", "", "",
       "scene.toml:5:1: key 'wavelength_low': -1 is out of range"},
      {"ProfileUneven", "q.obj", own_profile, "profile.txt", "1 0 -1 0", "1 0 -1 1", "profile.txt: not even"},
      {"ProfileOfWords", "q.obj", own_profile, "profile.txt", "-1", "x",
       "profile.txt:1:5: not a finite number"},
      {"FineHalf", "q.obj", "[wrinkles]\nfine = 2.5\n", "", "", "", "scene.toml:4:1: key 'fine'"},
      // strokes
      {"StrokeOffTheMesh", "q.obj", by_paint, "paint.toml", "[1, 0, 0]", "[1, 0, 4]",
       "paint.toml:1:1: the point [1, 0, 4] is off the mesh: the nearest vertex is 4 m away"},
      {"StrokeTooStrong", "q.obj", by_paint, "paint.toml", "strength = 0.5", "strength = 1",
       "paint.toml:5:1: key 'strength': 1 is out of range; allowed: 0 … 0.99"},
      {"StrokeOfNoVertex", "q.obj", by_paint, "paint.toml", "points = [[0, 0, 0], [1, 0, 0]]",
       "vertices = [0, 4]", "paint.toml:1:1: there is no vertex 4; the model has 4"},
      {"StrokeInUvWithoutUv", "bare.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"uv\"\npoints = [[0, 0], [1, 1]]\nradius = 1\n"),
       "paint.toml:1:1: the stroke is given in uv, but the model has none"},
      {"StrokeAngleWithoutUv", "bare.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"fill\"\ndirection = 30\n"), "paint.toml:1:1: an angle is counted from growing u"},
      {"StrokeOfAnotherPart", "q.obj", by_paint, "paint.toml", "radius = 0.5",
       "radius = 0.5\nonly = \"cuff\"", "paint.toml:1:1: 'cuff' is neither a mesh nor a material"},
      {"StrokeOffThePicture", "q.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"screen\"\npoints = [[-9, -9], [-5, -5]]\nradius = 2\n"),
       "paint.toml:1:1: the line misses the mesh in the picture of 1280x1024 pixels of frame 1"},
      {"StrokeInNoFrame", "q.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"screen\"\npoints = [[5, 5], [9, 9]]\nradius = 2\nframe = 2\n"),
       "paint.toml:1:1: there is no frame 2; the clip has 1"},
      {"StrokeThroughNoCamera", "q.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"screen\"\npoints = [[5, 5], [9, 9]]\nradius = 2\ncamera = \"Eve\"\n"),
       "paint.toml:1:1: "},
      {"StrokesTooFew", "q.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"random\"\ndensity = 0.1\nlength = 1\nradius = 0.1\n"),
       "paint.toml:1:1: density 0.1 on 1 m² is less than one wrinkle"},
      {"StrokeOfColoursElsewhere", "q.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"colours\"\nfile = \"colours.ply\"\nup = \"x\"\ndirection = 0\n"),
       "paint.toml:1:1: 2 of the model's 4 welded vertices are not among the 4"},
      {"StrokeOfNoColours", "q.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"colours\"\nfile = \"waves.ply\"\ndirection = 0\n"),
       "paint.toml:1:1: {}waves.ply: element 'vertex' has no property 'red'"},
      {"StrokeOfNoPicture", "q.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"image\"\nfile = \"profile.txt\"\ndirection = 0\n"),
       "paint.toml:1:1: {}profile.txt"},
      {"StrokePaintedOblong", "q.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"painted\"\nfile = \"oblong.png\"\n"),
       "paint.toml:1:1: {}oblong.png: is 4x2 pixels"},
      {"StrokeThatDoesNothing", "q.obj", by_paint, "paint.toml", "",
       stroke_of("kind = \"uv\"\npoints = [[5, 5], [6, 6]]\nradius = 0.1\n"),
       "paint.toml:1:1: this stroke touches no vertex"},
  };
  return all;
}

class OneMistake : public BadInput, public ::testing::WithParamInterface<Row> {};

TEST_P(OneMistake, IsToldWithItsPlace) {
  const Row& row = GetParam();
  const auto picture = [&](const char* name, int width, int height) {
    const auto bytes = static_cast<std::size_t>(4 * width * height);
    io::write_png(folder_ / name, {width, height, std::vector<std::uint8_t>(bytes, 128)});
  };
  picture("oblong.png", 4, 2);
  picture("bias.png", 4, 4);
  picture("grey.png", 4, 4);
  Files files = good_files();
  files["scene.toml"] = scene_of(row.model, row.scene);
  if (!row.file.empty()) {
    EXPECT_EQ(load(files), "") << "the good file";
    std::string& text = files.at(row.file);
    if (row.from.empty()) {
      text = row.to;
    } else {
      ASSERT_NE(text.find(row.from), std::string::npos);
      text.replace(text.find(row.from), row.from.size(), row.to);
    }
  }
  const std::string folder = folder_.path().string() + "/";
  const std::string said = load(files);
  std::string wanted = row.said;
  if (const auto at = wanted.find("{}"); at != std::string::npos) wanted.replace(at, 2, folder);
  EXPECT_THAT(said, HasSubstr(wanted));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << "one mistake, one line: " << said;
}

INSTANTIATE_TEST_SUITE_P(Rows, OneMistake, ::testing::ValuesIn(rows()),
                         [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace plisse::pipeline
