// FBX files through their own tree: curves between keys, weights of shapes, inherit types, visibility, in
// small ASCII and binary files written here, against values worked out by hand.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libdeflate.h>

#include <cstring>

#include "base/log.h"
#include "io/fbx/fbx_tree.h"
#include "io/import.h"
#include "scene/animation.h"
#include "support/files.h"

namespace plisse::io {
namespace {

constexpr const char* cube =
    "Vertices: *24 {\n a: -1,-1,-1,-1,-1,1,-1,1,-1,-1,1,1,1,-1,-1,1,-1,1,1,1,-1,1,1,1\n}\n"
    "PolygonVertexIndex: *24 {\n a: 0,1,3,-3,4,6,7,-6,0,4,5,-2,2,3,7,-7,0,2,6,-5,1,5,7,-4\n}\n"
    "GeometryVersion: 124\n";

// Units are metres, so that numbers of a file are those of the model.
std::string file(const std::string& objects, const std::string& connections) {
  return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n FBXHeaderVersion: 1003\n FBXVersion: 7400\n}\n"
         "GlobalSettings:  {\n Version: 1000\n Properties70:  {\n"
         " P: \"UpAxis\", \"int\", \"Integer\", \"\",1\n"
         " P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n }\n}\nObjects:  {\n" +
         objects + "}\nConnections:  {\n" + connections + "}\n";
}

std::string node(int id, const std::string& name, const std::string& properties) {
  return fmt::format(
      "Model: {0}, \"Model::{1}\", \"Mesh\" {{\n Version: 232\n Properties70:  {{\n{2} }}\n}}\n"
      "Geometry: {3}, \"Geometry::{1}\", \"Mesh\" {{\n{4}}}\n",
      id, name, properties, id + 1000, cube);
}

std::string number(const std::string& name, const std::string& values) {
  return fmt::format("P: \"{}\", \"Number\", \"\", \"A\",{}\n", name, values);
}

// One curve with keys at 0, 1 and 2 s.
std::string take(const std::string& values, const std::string& flags, const std::string& data) {
  return fmt::format(
      "AnimationStack: 4000, \"AnimStack::Take\", \"\" {{\n Properties70:  {{\n"
      " P: \"LocalStart\", \"KTime\", \"Time\", \"\",0\n"
      " P: \"LocalStop\", \"KTime\", \"Time\", \"\",92372316000\n }}\n}}\n"
      "AnimationLayer: 4100, \"AnimLayer::L\", \"\" {{\n}}\n"
      "AnimationCurveNode: 5000, \"AnimCurveNode::N\", \"\" {{\n Properties70:  {{\n }}\n}}\n"
      "AnimationCurve: 6000, \"AnimCurve::\", \"\" {{\n Default: 0\n KeyVer: 4008\n"
      " KeyTime: *3 {{\n a: 0,46186158000,92372316000\n }}\n KeyValueFloat: *3 {{\n a: {}\n }}\n"
      " KeyAttrFlags: *1 {{\n a: {}\n }}\n KeyAttrDataFloat: *4 {{\n a: {}\n }}\n"
      " KeyAttrRefCount: *1 {{\n a: 3\n }}\n}}\n",
      values, flags, data);
}
const std::string take_links = "C: \"OO\",4000,0\nC: \"OO\",4100,4000\nC: \"OO\",5000,4100\n";

class Fbx : public testing::Test {
 protected:
  scene::Animation animation(const std::string& text) const {
    test::write_text(folder_ / "m.fbx", text);
    return scene::Animation(import_model(folder_ / "m.fbx"), {.frames_per_second = 100});
  }
  // Highest corner at a time.
  static glm::dvec3 high(scene::Animation& of, double time) {
    glm::dvec3 result{-1e9};
    for (const glm::dvec3& p :
         scene::posed(of.surface(), of.pose(1 + static_cast<int>(std::lround(100 * time)))))
      result = glm::max(result, p);
    return result;
  }
  scene::Animation moved(const std::string& property, const std::string& values, const std::string& flags,
                         const std::string& data, const std::string& axis = "d|X") const {
    return animation(
        file(node(1000, "A", "") + take(values, flags, data),
             "C: \"OO\",1000,0\nC: \"OO\",2000,1000\n" + take_links +
                 fmt::format("C: \"OP\",5000,1000, \"{}\"\nC: \"OP\",6000,5000, \"{}\"\n", property, axis)));
  }
  test::TemporaryFolder folder_;
};

constexpr double tolerance = 2e-6;  // of some metres

TEST_F(Fbx, CubicOfTheUser) {
  // Slopes of 2 out of every key and of −1 into the next: a Hermite curve.
  scene::Animation user = moved("Lcl Translation", "0,1,0", "1032", "2,-1,0,0");
  for (const double s : {0.1, 0.25, 0.5, 0.9}) {
    const double s2 = s * s, s3 = s2 * s;
    const double tangents = 2 * (s3 - 2 * s2 + s) - (s3 - s2);
    EXPECT_NEAR(high(user, s).x - 1, 3 * s2 - 2 * s3 + tangents, tolerance) << s;
    EXPECT_NEAR(high(user, 1 + s).x - 1, 1 - 3 * s2 + 2 * s3 + tangents, tolerance) << s;
  }
}

TEST_F(Fbx, WeightedHandles) {
  // Flat handles of half the way: time 1.5 v² u + 1.5 v u² + u³, value 3 v u² + u³. At u = ½ both are ½;
  // 25 · 10⁻⁴ in both halves of the packed number would be other handles.
  const std::string packed = std::to_string(5000 + 5000 * 65536);
  scene::Animation weighted =
      moved("Lcl Translation", "0,1,0", std::to_string(0x3000408), "0,0," + packed + ",0");
  EXPECT_NEAR(high(weighted, 0.5).x - 1, 0.5, tolerance);
  double low = 0, top = 1;
  for (int step = 0; step < 60; ++step) {
    const double u = (low + top) / 2, v = 1 - u;
    (1.5 * v * v * u + 1.5 * v * u * u + u * u * u > 0.25 ? top : low) = u;
  }
  EXPECT_NEAR(high(weighted, 0.25).x - 1, 3 * (1 - low) * low * low + low * low * low, tolerance);
}

TEST_F(Fbx, StepsAndLines) {
  scene::Animation step = moved("Lcl Translation", "0,1,0", "2", "0,0,0,0");
  EXPECT_NEAR(high(step, 0.99).x, 1, tolerance);
  EXPECT_NEAR(high(step, 1).x, 2, tolerance);
  EXPECT_NEAR(high(step, 1.99).x, 2, tolerance);
  EXPECT_NEAR(high(step, 2).x, 1, tolerance);
  scene::Animation line = moved("Lcl Translation", "0,1,0", "4", "0,0,0,0");
  EXPECT_NEAR(high(line, 0.25).x, 1.25, tolerance);
}

TEST_F(Fbx, AutomaticTangents) {
  // The middle key's slope is that from the first to the third, 1 a second; the ends are flat.
  scene::Animation automatic = moved("Lcl Translation", "0,.5,2", std::to_string(0x2108), "0,0,0,0");
  EXPECT_NEAR(high(automatic, 0.5).x - 1, 0.25 - 0.125, tolerance);
  // Clamped: no handle of a third of a second reaches beyond a neighbour, at 0 and at .1.
  scene::Animation clamped = moved("Lcl Translation", "0,.1,5", std::to_string(0x6108), "0,0,0,0");
  EXPECT_NEAR(high(clamped, 0.5).x - 1, 0.05 - 0.3 / 8, tolerance);
}

// Tension 0, continuity 0 and bias 0 are Catmull and Rom's tangents: the mean of both secants. With tension 1
// they are flat.
TEST_F(Fbx, TangentsOfTensionContinuityAndBias) {
  scene::Animation plain = moved("Lcl Translation", "0,1,4", std::to_string(0x208), "0,0,0,0");
  // From 0 to 1 with the slopes 1 (there is one secant) and (1 + 3)/2; from 1 to 4 with 2 and 3.
  EXPECT_NEAR(high(plain, 0.5).x - 1, 0.5 + (1 - 2) / 8.0, tolerance);
  EXPECT_NEAR(high(plain, 1.5).x - 1, 2.5 + (2 - 3) / 8.0, tolerance);
  scene::Animation tense = moved("Lcl Translation", "0,1,4", std::to_string(0x208), "1,0,0,0");
  EXPECT_NEAR(high(tense, 0.25).x - 1, 3 * 0.0625 - 2 * 0.015625, tolerance);
}

// What is not read is told once, by its name.
TEST_F(Fbx, TellsWhatItLeavesOut) {
  const auto told = [&](const char* what) {
    EXPECT_THAT(log::warnings(),
                testing::Contains(testing::AllOf(testing::HasSubstr((folder_ / "m.fbx").string()),
                                                 testing::HasSubstr(what))));
  };
  // A second layer that moves what the first one moves, and a curve that repeats.
  const std::string more =
      "AnimationLayer: 4101, \"AnimLayer::M\", \"\" {\n}\n"
      "AnimationCurveNode: 5001, \"AnimCurveNode::O\", \"\" {\n Properties70:  {\n }\n}\n"
      "AnimationCurve: 6001, \"AnimCurve::\", \"\" {\n KeyTime: *2 {\n a: 0,46186158000\n }\n"
      " KeyValueFloat: *2 {\n a: 5,5\n }\n}\n"
      "Deformer: 7000, \"Deformer::S\", \"Skin\" {\n SkinningType: \"DualQuaternion\"\n}\n"
      "Cache: 7100, \"Cache::C\", \"\" {\n}\n";
  std::string repeating = take("0,1,0", "4", "0,0,0,0");
  repeating.insert(repeating.find(" KeyTime"),
                   " Post-Extrapolation:  {\n Type: \"R\"\n Repetition: -1\n }\n");
  scene::Animation first = animation(
      file(node(1000, "A", "") + repeating + more,
           "C: \"OO\",1000,0\nC: \"OO\",2000,1000\n" + take_links +
               "C: \"OO\",4101,4000\nC: \"OO\",5001,4101\nC: \"OP\",5000,1000, \"Lcl Translation\"\n"
               "C: \"OP\",6000,5000, \"d|X\"\nC: \"OP\",5001,1000, \"Lcl Translation\"\n"
               "C: \"OP\",6001,5001, \"d|X\"\n"));
  EXPECT_NEAR(high(first, 0.5).x - 1, 0.5, tolerance);  // the first layer's
  told("2 animation layers");
  told("extrapolation");
  told("dual quaternions");
  told("geometry caches");
}

TEST_F(Fbx, TurnsPastHalf) {
  // 0 to 720 degrees about z in a second: an eighth of it is a quarter turn.
  scene::Animation turning = moved("Lcl Rotation", "0,720,0", "4", "0,0,0,0", "d|Z");
  const double angle = glm::radians(72.0);
  EXPECT_NEAR(high(turning, 0.1).x, std::cos(angle) + std::sin(angle), tolerance);
}

TEST_F(Fbx, InheritTypes) {
  const auto top = [&](int type) {
    scene::Animation of =
        animation(file(node(1000, "P", number("Lcl Scaling", "3,1,1")) +
                           node(1001, "C",
                                number("Lcl Translation", "5,0,0") + number("Lcl Rotation", "0,0,45") +
                                    number("InheritType", std::to_string(type))),
                       "C: \"OO\",1000,0\nC: \"OO\",2000,1000\nC: \"OO\",1001,1000\nC: \"OO\",2001,1001\n"));
    return high(of, 0).x;
  };
  const double root = std::sqrt(0.5);
  EXPECT_NEAR(top(0), 15 + 4 * root, tolerance);  // scaled, then turned
  EXPECT_NEAR(top(1), 15 + 6 * root, tolerance);  // turned, then scaled
  EXPECT_NEAR(top(2), 15 + 2 * root, tolerance);  // turned only
}

// A channel of one or two shapes that pull the four corners of x = 1.
std::string shapes(const std::string& percent, const std::string& full) {
  std::string text =
      node(1000, "A", "") + "Deformer: 3000, \"Deformer::b\", \"BlendShape\" {\n Version: 100\n}\n";
  const bool two = full.find(',') != std::string::npos;
  text += fmt::format(
      "Deformer: 3100, \"SubDeformer::c\", \"BlendShapeChannel\" {{\n Version: 100\n DeformPercent: {0}\n"
      " FullWeights: *{1} {{\n a: {2}\n }}\n}}\n",
      percent, two ? 2 : 1, full);
  for (int shape = 0; shape < (two ? 2 : 1); ++shape)
    text += fmt::format(
        "Geometry: {0}, \"Geometry::t{0}\", \"Shape\" {{\n Version: 100\n Indexes: *4 {{\n a: 4,5,6,7\n }}\n"
        " Vertices: *12 {{\n a: {1},0,0,{1},0,0,{1},0,0,{1},0,0\n }}\n"
        " Normals: *12 {{\n a: 0,0,0,0,0,0,0,0,0,0,0,0\n }}\n}}\n",
        3200 + shape, 2 + 3 * shape);
  return text;
}
std::string shape_links(bool two) {
  return std::string(
             "C: \"OO\",1000,0\nC: \"OO\",2000,1000\nC: \"OO\",3000,2000\nC: \"OO\",3100,3000\n"
             "C: \"OO\",3200,3100\n") +
         (two ? "C: \"OO\",3201,3100\n" : "");
}

TEST_F(Fbx, ShapesAtRest) {
  scene::Animation half = animation(file(shapes("50", "100"), shape_links(false)));
  EXPECT_NEAR(high(half, 0).x, 2, tolerance);
  // Full at 50 already.
  scene::Animation full = animation(file(shapes("25", "50"), shape_links(false)));
  EXPECT_NEAR(high(full, 0).x, 2, tolerance);
  // In-betweens: at 75 half of the first, full at 50, and half of the second, full at 100.
  scene::Animation between = animation(file(shapes("75", "50,100"), shape_links(true)));
  EXPECT_NEAR(high(between, 0).x, 1 + (2 + 5) / 2.0, tolerance);
}

TEST_F(Fbx, ShapesThatMove) {
  scene::Animation moving = animation(
      file(shapes("0", "50,100") + take("0,100,0", "4", "0,0,0,0"),
           shape_links(true) + take_links +
               "C: \"OP\",5000,3100, \"DeformPercent\"\nC: \"OP\",6000,5000, \"d|DeformPercent\"\n"));
  EXPECT_NEAR(high(moving, 0.25).x, 1 + 1, tolerance);
  EXPECT_NEAR(high(moving, 0.5).x, 1 + 2, tolerance);
  EXPECT_NEAR(high(moving, 0.75).x, 1 + 3.5, tolerance);
  EXPECT_NEAR(high(moving, 1).x, 1 + 5, tolerance);
}

// As Maya writes them; assimp loses the whole shape.
TEST_F(Fbx, ShapesWithoutNormals) {
  std::string text = shapes("50", "100");
  const std::size_t normals = text.find(" Normals:");
  text.erase(normals, text.find("}", normals) + 2 - normals);
  scene::Animation half = animation(file(text, shape_links(false)));
  EXPECT_NEAR(high(half, 0).x, 2, tolerance);
}

TEST_F(Fbx, HiddenNodes) {
  const auto triangles = [&](const std::string& properties) {
    scene::Animation of =
        animation(file(node(1000, "A", "") + node(1001, "B", properties),
                       "C: \"OO\",1000,0\nC: \"OO\",2000,1000\nC: \"OO\",1001,0\nC: \"OO\",2001,1001\n"));
    return of.surface().triangle_count();
  };
  EXPECT_EQ(triangles(""), 24U);
  EXPECT_EQ(triangles(number("Visibility", "0")), 12U);
  EXPECT_EQ(triangles(number("Show", "0")), 12U);
}

// A binary file, element by element.
template <typename Number>
void put(std::string& out, Number number) {
  out.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string element(bool wide, std::size_t at, const std::string& name, std::uint32_t count,
                    const std::string& values) {
  std::string out;
  const std::size_t head = (wide ? 24 : 12) + 1 + name.size();
  for (const std::uint64_t word : {static_cast<std::uint64_t>(at + head + values.size()),
                                   std::uint64_t{count}, std::uint64_t{values.size()}})
    wide ? put(out, word) : put(out, static_cast<std::uint32_t>(word));
  put(out, static_cast<std::uint8_t>(name.size()));
  return out + name + values;
}

std::string binary(bool wide, bool deflated) {
  std::string text("Kaydara FBX Binary  \0\x1a\0", 23);
  put(text, std::uint32_t{wide ? 7500U : 7400U});
  std::string numbers;
  for (const double x : {0.5, -2.0, 1e10}) put(numbers, x);
  if (deflated) {
    std::string packed(200, '\0');
    libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
    packed.resize(
        libdeflate_zlib_compress(compressor, numbers.data(), numbers.size(), packed.data(), packed.size()));
    libdeflate_free_compressor(compressor);
    numbers = packed;
  }
  std::string values = "L";
  put(values, std::int64_t{1} << 40);
  values += 'd';
  put(values, std::uint32_t{3});
  put(values, std::uint32_t{deflated ? 1U : 0U});
  put(values, static_cast<std::uint32_t>(numbers.size()));
  values += numbers + 'S';
  put(values, std::uint32_t{2});
  values += "ab";
  text += element(wide, text.size(), "One", 3, values);
  return text + std::string(wide ? 25 : 13, '\0');
}

TEST(FbxTree, BinaryOfBothWordSizes) {
  for (const bool wide : {false, true})
    for (const bool deflated : {false, true}) {
      SCOPED_TRACE(fmt::format("wide {}, deflated {}", wide, deflated));
      const FbxTree tree(binary(wide, deflated));
      const FbxElement* one = tree.root().child("One");
      ASSERT_NE(one, nullptr);
      EXPECT_EQ(one->integer(0), std::int64_t{1} << 40);
      EXPECT_EQ(one->text(2), "ab");
      FbxElement list;
      list.values.push_back(one->values[1]);
      EXPECT_THAT(list.numbers(), testing::ElementsAre(0.5, -2.0, 1e10));
    }
}

TEST(FbxTree, DamageIsTold) {
  const std::string whole = binary(true, false);
  for (std::size_t size = 0; size + 25 < whole.size(); ++size)
    EXPECT_THROW(FbxTree{whole.substr(0, size)}, std::runtime_error) << size;
  // Any byte may be any other: an error, or a tree.
  for (std::size_t at = 27; at < whole.size(); ++at)
    for (const int flip : {1, 0x80, 0xFF}) {
      std::string mutant = whole;
      mutant[at] = static_cast<char>(mutant[at] ^ flip);
      try {
        const FbxTree tree(mutant);
        for (const FbxElement& one : tree.root().children) (void)one.numbers();
      } catch (const std::runtime_error&) {
      }
    }
  EXPECT_THROW(FbxTree{std::string(100000, '{')}, std::runtime_error);
  std::string deep = "FBXHeaderExtension: {\n FBXVersion: 7400\n}\n";
  for (int level = 0; level < 100000; ++level) deep += "a: {\n";
  EXPECT_THROW(FbxTree{deep}, std::runtime_error);
}

// Blender's and Maya's files, with what those programs made of them.
TEST(FbxFiles, AsTheirProgramsShowThem) {
  const auto folder = test::shared_data("reports") / "readers" / "fbx_dcc";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no ../shared/data/reports beside the project";
  struct Case {
    const char* model;
    const char* shape;
    int frame;
    double unit;
  };
  for (const Case& item :
       {Case{"blender_331_static_blend_shape_7400_binary.fbx", "blender_331_static_blend_shape.obj", 1, 1},
        Case{"maya_pivot_offset_7700_ascii.fbx", "maya_pivot_offset_8.obj", 8, 0.01}}) {
    SCOPED_TRACE(item.model);
    scene::Animation found(import_model(folder / item.model), {});
    scene::Animation right(import_model(folder / item.shape, {item.unit, "y"}), {});
    const std::vector<glm::dvec3> expected = right.surface().bind;
    const auto positions = scene::posed(found.surface(), found.pose(item.frame));
    for (const glm::dvec3& p : positions) {
      double nearest = 1e9;
      for (const glm::dvec3& q : expected) nearest = std::min(nearest, glm::distance(p, q));
      EXPECT_LT(nearest, 1e-5 * item.unit * 30);
    }
  }
}

}  // namespace
}  // namespace plisse::io
