// The real models of ../shared/data: counts against the inventory there, positions against assimp's own
// matrices, sizes against common sense.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "base/error.h"
#include "io/import.h"
#include "scene/animation.h"
#include "support/files.h"

namespace plisse {
namespace {

namespace fs = std::filesystem;

fs::path data() {
  return test::shared_data("");
}

class Models : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(data() / "models")) GTEST_SKIP() << "no ../shared/data/models beside the project";
  }
};

double diagonal(const scene::Animation::Bounds& bounds) {
  return glm::length(bounds.high - bounds.low);
}

scene::Animation::Bounds bounds_of(const std::vector<glm::dvec3>& positions) {
  scene::Animation::Bounds bounds{positions.at(0), positions.at(0)};
  for (const glm::dvec3& p : positions) {
    bounds.low = glm::min(bounds.low, p);
    bounds.high = glm::max(bounds.high, p);
  }
  return bounds;
}

// posed/rest of every edge, ascending.
std::vector<double> edge_ratios(const Surface& surface, const std::vector<glm::dvec3>& positions) {
  std::vector<double> ratios;
  for (std::size_t v = 0; v < surface.vertex_count(); ++v)
    for (std::uint32_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i) {
      const std::uint32_t n = surface.neighbours.items[i];
      const double rest = glm::distance(surface.rest[v], surface.rest[n]);
      if (rest > 0) ratios.push_back(glm::distance(positions[v], positions[n]) / rest);
    }
  std::sort(ratios.begin(), ratios.end());
  return ratios;
}

struct Counts {
  std::size_t meshes = 0, skinned = 0, with_uv = 0, vertices = 0, triangles = 0, morphs = 0, cameras = 0,
              clips = 0;
  int influences = 0;
  bool operator==(const Counts&) const = default;
};

// "164 NAME | mesh 1 (skinned 1, uv 0) v 160 t 188 bones 2 maxinf 2 morph 0 | cam 0 … | anims 1: …"
Counts inventory_of(const std::string& file) {
  std::ifstream stream(data() / "models" / "INVENTORY_assimp-5.2.5.txt");
  static const std::regex form(
      R"(\d+ (\S+) \| mesh (\d+) \(skinned (\d+), uv (\d+)\) v (\d+) t (\d+) bones \d+ maxinf (\d+) morph (\d+) \| cam (\d+) .*\| anims (\d+):.*)");
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, form) || match[1] != file) continue;
    const auto number = [&](std::size_t group) { return static_cast<std::size_t>(std::stoul(match[group])); };
    return {number(2), number(3), number(4),  number(5),          number(6),
            number(8), number(9), number(10), std::stoi(match[7])};
  }
  ADD_FAILURE() << file << " is not in the inventory";
  return {};
}

Counts counts_of(const io::Model& model) {
  Counts counts;
  counts.meshes = model.meshes.size();
  counts.cameras = model.cameras.size();
  counts.clips = model.clips.size();
  for (const io::Mesh& mesh : model.meshes) {
    counts.skinned += mesh.bones.empty() ? 0 : 1;
    counts.with_uv += mesh.uvs.empty() ? 0 : 1;
    counts.vertices += mesh.positions.size();
    counts.triangles += mesh.triangles.size() / 3;
    counts.morphs += mesh.targets.size();
    counts.influences = std::max(counts.influences, mesh.file_max_influences);
  }
  return counts;
}

TEST_F(Models, CountsAgreeWithTheInventory) {
  // Not the BVH, which is a skeleton.
  for (const char* file :
       {"AnimatedMorphCube.glb", "BoxAnimated.glb", "Fox.glb", "Greenman.glb", "KayKit_Knight.glb",
        "RiggedSimple.glb", "SimpleMorph.glb", "SimpleSkin.glb", "quad_skin_10influences.glb",
        "animation_with_skeleton.fbx", "huesitos.fbx", "ufbx_marvelous_quad_7700_binary.fbx",
        "ufbx_max_transformed_skin_7500_ascii.fbx", "ufbx_maya_axes_anim_7700_ascii.fbx",
        "ufbx_maya_game_sausage_7500_binary_combined.fbx", "box_nested_animation.dae",
        "anims_with_full_rotations_between_keys.DAE", "bending_cylinder_anim_test.x"}) {
    SCOPED_TRACE(file);
    const Counts expected = inventory_of(file);
    const Counts found = counts_of(io::import_model(data() / "models" / file));
    EXPECT_EQ(found.meshes, expected.meshes);
    EXPECT_EQ(found.skinned, expected.skinned);
    EXPECT_EQ(found.with_uv, expected.with_uv);
    EXPECT_EQ(found.vertices, expected.vertices);
    EXPECT_EQ(found.triangles, expected.triangles);
    EXPECT_EQ(found.morphs, expected.morphs);
    EXPECT_EQ(found.cameras, expected.cameras);
    EXPECT_EQ(found.clips, expected.clips);
    EXPECT_EQ(found.influences, expected.influences);
  }
}

TEST_F(Models, FramesOfTheContract) {
  const io::Model simple = io::import_model(data() / "models" / "RiggedSimple.glb");
  const scene::Timeline rigged = scene::Animation(simple, {}).timeline();
  // 2.0833 s in single precision falls just short of 50 intervals of 1/24 s.
  EXPECT_LT(rigged.duration * 24, 50);
  EXPECT_EQ(rigged.frame_count, 50 + 1);
  const io::Model fox = io::import_model(data() / "models" / "Fox.glb");
  EXPECT_EQ(scene::Animation(fox, {.clip = "Walk"}).timeline().frame_count, 17 + 1);
  EXPECT_EQ(scene::Animation(fox, {.clip = "1"}).clip_name(), "Walk");
}

TEST_F(Models, PosesAreFiniteAndOfTheRightSize) {
  for (const char* file :
       {"RiggedSimple.glb", "Fox.glb", "Greenman.glb", "KayKit_Knight.glb", "bending_cylinder_anim_test.x",
        "huesitos.fbx", "box_nested_animation.dae", "animation_with_skeleton.fbx",
        "ufbx_max_transformed_skin_7500_ascii.fbx", "ufbx_maya_axes_anim_7700_ascii.fbx"}) {
    SCOPED_TRACE(file);
    scene::Animation animation(io::import_model(data() / "models" / file), {});
    const Surface& surface = animation.surface();
    const double rest_size = diagonal(bounds_of(surface.rest));
    for (const int frame : {1, animation.timeline().frame_count / 2 + 1, animation.timeline().frame_count}) {
      const std::vector<glm::dvec3> positions = scene::posed(surface, animation.pose(frame));
      for (const glm::dvec3& p : positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
      const std::vector<double> ratios = edge_ratios(surface, positions);
      // A body bends but does not grow: the middle edge keeps its length, four in five stay within a half of
      // theirs.
      EXPECT_NEAR(ratios[ratios.size() / 2], 1, 0.02) << frame;
      EXPECT_GT(ratios[ratios.size() / 10], 0.5) << frame;
      EXPECT_LT(ratios[ratios.size() * 9 / 10], 1.5) << frame;
      const double size = diagonal(bounds_of(positions));
      EXPECT_GT(size, rest_size / 3) << frame;
      EXPECT_LT(size, rest_size * 3) << frame;
    }
  }
}

// Bounding boxes in metres, y up, worked out from the files by other means: glTF accessors' min and max, the
// FBX files' node scale of 100 times unit of 1 cm, COLLADA's Z_UP.
TEST_F(Models, StandUprightAndInMetres) {
  const auto box = [](const char* file) {
    scene::Animation animation(io::import_model(data() / "models" / file), {});
    return bounds_of(scene::posed(animation.surface(), animation.pose(1)));
  };
  // Cylinder of radius 1 and length 9.15016 along the file's z, turned upright by its Z_UP node.
  const scene::Animation::Bounds rigged = box("RiggedSimple.glb");
  EXPECT_NEAR(rigged.high.y - rigged.low.y, 9.15016, 1e-4);
  EXPECT_NEAR(rigged.high.x - rigged.low.x, 2, 1e-4);
  // A cylinder 5.36 long in Blender's metres; exported in centimetres.
  const scene::Animation::Bounds bones = box("huesitos.fbx");
  EXPECT_NEAR(bones.high.x - bones.low.x, 5.3577, 1e-3);
  EXPECT_NEAR(bones.high.y - bones.low.y, 5.43835, 1e-3);
  // Marvelous Designer: millimetres (0.1 cm), node scale 10.
  const scene::Animation::Bounds quad = box("ufbx_marvelous_quad_7700_binary.fbx");
  EXPECT_NEAR(quad.high.x - quad.low.x, (31.9251 - 8.18182) * 10 / 1000, 1e-6);
  // Units and up axis given by hand win over the file's own.
  const io::Model turned = io::import_model(data() / "models" / "box_nested_animation.dae", {0.01, "y"});
  const scene::Animation::Bounds small = bounds_of(scene::Animation(turned, {}).surface().rest);
  EXPECT_NEAR(diagonal(small), 0.02 * std::sqrt(3.0), 1e-6);
}

// The same COLLADA file with another unit and up axis in its head.
TEST_F(Models, ColladaUnitsAndUpAxis) {
  std::ifstream stream(data() / "models" / "box_nested_animation.dae");
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const auto replace = [&](const std::string& old, const std::string& by) {
    ASSERT_NE(text.find(old), std::string::npos);
    text.replace(text.find(old), old.size(), by);
  };
  replace(R"(<unit name="meter" meter="1"/>)", R"(<unit meter="0.01" name="centimeter"/>)");
  replace("Z_UP", "Y_UP");
  const test::TemporaryFolder folder;
  const fs::path path = folder / "unit.dae";
  std::ofstream(path) << text;
  const auto rest = [&](const fs::path& file, const io::ImportOptions& options) {
    const io::Model model = io::import_model(file, options);
    return scene::Animation(model, {}).surface().rest;
  };
  const std::vector<glm::dvec3> metres = rest(data() / "models" / "box_nested_animation.dae", {{}, "y"});
  const std::vector<glm::dvec3> centimetres = rest(path, {});
  const std::vector<glm::dvec3> inches = rest(path, {0.0254, ""});
  ASSERT_EQ(metres.size(), centimetres.size());
  for (std::size_t v = 0; v < metres.size(); ++v) {
    // assimp holds the unit in single precision.
    EXPECT_NEAR(glm::distance(centimetres[v], 0.01 * metres[v]), 0, 1e-7);
    EXPECT_NEAR(glm::distance(inches[v], 0.0254 * metres[v]), 0, 1e-7);
  }
}

aiMatrix4x4 world_of(const aiNode* node) {
  aiMatrix4x4 world;
  for (; node != nullptr; node = node->mParent) world = node->mTransformation * world;
  return world;
}

// Without a clip every vertex of a skin must lie where assimp's own matrices put it: Σ weight · world(bone) ·
// offset.
TEST_F(Models, SkinsLieWhereTheFormulaPutsThem) {
  struct Case {
    const char* file;
    double scale;
  };
  for (const Case& item : {Case{"RiggedSimple.glb", 1},
                           {"Fox.glb", 1},
                           {"Greenman.glb", 1},
                           {"SimpleSkin.glb", 1},
                           {"huesitos.fbx", 0.01},
                           {"animation_with_skeleton.fbx", 0.01},
                           {"box_nested_animation.dae", 1}}) {
    SCOPED_TRACE(item.file);
    io::Model model = io::import_model(data() / "models" / item.file);
    model.clips.clear();
    scene::Animation animation(model, {});
    const scene::Animation::Bounds found = bounds_of(scene::posed(animation.surface(), animation.pose(1)));

    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile((data() / "models" / item.file).string(), aiProcess_Triangulate);
    ASSERT_NE(scene, nullptr);
    std::vector<glm::dvec3> expected;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
      const aiMesh& mesh = *scene->mMeshes[m];
      // Homogeneous, so that weights that do not sum to 1 are normalised (FBX files hold such).
      std::vector<glm::dvec4> sums(mesh.mNumVertices, glm::dvec4{0});
      for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiMatrix4x4 matrix =
            world_of(scene->mRootNode->FindNode(mesh.mBones[b]->mName)) * mesh.mBones[b]->mOffsetMatrix;
        for (unsigned w = 0; w < mesh.mBones[b]->mNumWeights; ++w) {
          const aiVertexWeight& weight = mesh.mBones[b]->mWeights[w];
          const aiVector3D p = matrix * mesh.mVertices[weight.mVertexId];
          sums[weight.mVertexId] += static_cast<double>(weight.mWeight) * glm::dvec4(p.x, p.y, p.z, 1);
        }
      }
      for (const glm::dvec4& sum : sums) expected.emplace_back(glm::dvec3(sum) / sum.w);
    }
    const scene::Animation::Bounds formula = bounds_of(expected);
    // Matrices in single precision multiplied through a dozen nodes.
    const double tolerance = 1e-5 * diagonal(found);
    EXPECT_NEAR(glm::distance(found.low, item.scale * formula.low), 0, tolerance);
    EXPECT_NEAR(glm::distance(found.high, item.scale * formula.high), 0, tolerance);
  }
}

// Pivots both ways. assimp collapses a node's pivots into one matrix where it is asked to (and loses the
// geometric transform of skins: the next but one test); we take them apart and put them together. Every FBX
// without such a transform must be posed alike, in the middle of the clip as at its ends.
template <typename Key, typename Mix>
auto sampled(const Key* keys, unsigned count, double time, const Mix& mix) {
  unsigned next = 0;
  while (next < count && keys[next].mTime <= time) ++next;
  if (next == 0) return keys[0].mValue;
  if (next == count) return keys[count - 1].mValue;
  const Key &a = keys[next - 1], &b = keys[next];
  return mix(a.mValue, b.mValue, static_cast<ai_real>((time - a.mTime) / (b.mTime - a.mTime)));
}

// assimp's own matrices of a node at a time in ticks.
aiMatrix4x4 world_at(const aiNode* node, const aiAnimation& clip, double time) {
  aiMatrix4x4 world;
  for (; node != nullptr; node = node->mParent) {
    aiMatrix4x4 local = node->mTransformation;
    for (unsigned c = 0; c < clip.mNumChannels; ++c) {
      const aiNodeAnim& channel = *clip.mChannels[c];
      if (channel.mNodeName != node->mName) continue;
      const auto linear = [](const aiVector3D& a, const aiVector3D& b, ai_real t) { return a + (b - a) * t; };
      const auto turned = [](const aiQuaternion& a, const aiQuaternion& b, ai_real t) {
        aiQuaternion out;
        aiQuaternion::Interpolate(out, a, b, t);
        return out;
      };
      // Not by assimp's constructor from the three, which scales after it has turned.
      aiMatrix4x4 move, scale;
      aiMatrix4x4::Translation(sampled(channel.mPositionKeys, channel.mNumPositionKeys, time, linear), move);
      aiMatrix4x4::Scaling(sampled(channel.mScalingKeys, channel.mNumScalingKeys, time, linear), scale);
      local =
          move *
          aiMatrix4x4(sampled(channel.mRotationKeys, channel.mNumRotationKeys, time, turned).GetMatrix()) *
          scale;
    }
    world = local * world;
  }
  return world;
}

TEST_F(Models, FbxPivotsBothWays) {
  struct Case {
    const char* file;
    double frames_per_second;
  };
  for (const Case& item : {Case{"huesitos.fbx", 25},
                           {"animation_with_skeleton.fbx", 24},
                           {"ufbx_maya_game_sausage_7500_binary_combined.fbx", 24}}) {
    const std::string path = (data() / "models" / item.file).string();
    const io::Model model = io::import_model(path);
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
    ASSERT_NE(scene, nullptr);
    ASSERT_EQ(scene->mNumMeshes, 1U);
    const aiMesh& mesh = *scene->mMeshes[0];
    for (unsigned c = 0; c < scene->mNumAnimations; ++c) {
      const aiAnimation& clip = *scene->mAnimations[c];
      // Its joints change their scale and do not inherit it (Rrs), which assimp does not know.
      if (std::string_view(clip.mName.C_Str()) == "deform") continue;
      scene::Animation animation(model,
                                 {.clip = std::to_string(c), .frames_per_second = item.frames_per_second});
      for (const int frame :
           {1, 1 + animation.timeline().frame_count / 2, animation.timeline().frame_count}) {
        SCOPED_TRACE(fmt::format("{}, clip {}, frame {}", item.file, c, frame));
        const double ticks = animation.timeline().time(frame) * clip.mTicksPerSecond;
        std::vector<glm::dvec4> sums(mesh.mNumVertices, glm::dvec4{0});
        for (unsigned b = 0; b < mesh.mNumBones; ++b) {
          const aiMatrix4x4 matrix =
              world_at(scene->mRootNode->FindNode(mesh.mBones[b]->mName), clip, ticks) *
              mesh.mBones[b]->mOffsetMatrix;
          for (unsigned w = 0; w < mesh.mBones[b]->mNumWeights; ++w) {
            const aiVertexWeight& weight = mesh.mBones[b]->mWeights[w];
            const aiVector3D p = matrix * mesh.mVertices[weight.mVertexId];
            sums[weight.mVertexId] += static_cast<double>(weight.mWeight) * glm::dvec4(p.x, p.y, p.z, 1);
          }
        }
        std::vector<glm::dvec3> expected;
        for (const glm::dvec4& sum : sums) expected.push_back(0.01 * glm::dvec3(sum) / sum.w);
        const scene::Animation::Bounds found =
            bounds_of(scene::posed(animation.surface(), animation.pose(frame)));
        const scene::Animation::Bounds formula = bounds_of(expected);
        // Matrices in single precision multiplied through a dozen nodes.
        EXPECT_NEAR(glm::distance(found.low, formula.low), 0, 1e-5 * diagonal(formula));
        EXPECT_NEAR(glm::distance(found.high, formula.high), 0, 1e-5 * diagonal(formula));
      }
    }
  }
}

// Exported by Maya with its pre-rotations: in the first frame of "spin" all joints stand as they were bound.
TEST_F(Models, FbxPreRotationsCountOnce) {
  scene::Animation animation(
      io::import_model(data() / "models" / "ufbx_maya_game_sausage_7500_binary_combined.fbx"),
      {.clip = "spin"});
  const Surface& surface = animation.surface();
  const std::vector<glm::dvec3> first = scene::posed(surface, animation.pose(1));
  for (std::size_t v = 0; v < first.size(); ++v)
    EXPECT_NEAR(glm::distance(first[v], surface.bind[v]), 0, 1e-7);  // 27 mm long
}

// cluster matrix · vertex, without the geometric transform, would put the box 25 cm away from its bones.
TEST_F(Models, FbxGeometricTransformReachesTheSkin) {
  io::Model model = io::import_model(data() / "models" / "ufbx_max_transformed_skin_7500_ascii.fbx");
  const io::Mesh& mesh = model.meshes.at(0);
  // From the file's text: link·Transform of every cluster is the mesh node's matrix, then the geometric
  // rotation of 135.374985° about z and translation (−9.207813, 23.617180, 0).
  const auto bone1 = std::find_if(mesh.bones.begin(), mesh.bones.end(), [&](const io::Bone& bone) {
    return model.nodes[static_cast<std::size_t>(bone.node)].name == "Bone001";
  });
  ASSERT_NE(bone1, mesh.bones.end());
  // Transform of Bone001's cluster times the geometric translation: x = 0.0043·(−9.2078) + 0.0108·23.6172
  // − 3.6196.
  EXPECT_NEAR(bone1->offset[3].x, -3.404, 2e-3);  // four digits of the matrix by hand
  EXPECT_NEAR(bone1->offset[3].y, 0.7025 * -9.2078 + 0.7117 * 23.6172 - 10.1547, 5e-3);
}

TEST_F(Models, SkeletonsAloneAreRefused) {
  try {
    io::import_model(data() / "models" / "cmu_01_01.bvh");
    FAIL() << "a BVH has no surface";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::bad_input);
    EXPECT_THAT(error.what(), testing::HasSubstr("no triangles"));
  }
}

TEST_F(Models, TexturesAndMaterials) {
  const io::Model fox = io::import_model(data() / "models" / "Fox.glb");
  ASSERT_EQ(fox.textures.size(), 1U);
  const io::Material& fur = fox.materials.at(static_cast<std::size_t>(fox.meshes[0].material));
  EXPECT_EQ(fur.base_colour_texture, 0);
  EXPECT_FALSE(fur.two_sided);
  EXPECT_GT(fox.textures[0].image.width, 0);
  // glTF factors are linear, FBX colours are not.
  const io::Model simple = io::import_model(data() / "models" / "RiggedSimple.glb");
  EXPECT_NEAR(simple.materials[0].base_colour.g, 0.64, 1e-3);
  const io::Model bones = io::import_model(data() / "models" / "huesitos.fbx");
  EXPECT_NEAR(bones.materials[0].base_colour.r, std::pow((0.411205 + 0.055) / 1.055, 2.4), 1e-4);
  EXPECT_TRUE(bones.materials[0].two_sided);
}

TEST_F(Models, StrongestEightOfTenInfluences) {
  const io::Model quad = io::import_model(data() / "models" / "quad_skin_10influences.glb");
  EXPECT_EQ(quad.meshes[0].file_max_influences, 10);
  for (const io::Influences& influences : quad.meshes[0].influences) {
    float sum = 0;
    for (std::size_t i = 0; i < io::max_influences; ++i) {
      sum += influences.weight[i];
      if (i > 0) {
        EXPECT_LE(influences.weight[i], influences.weight[i - 1]);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-6);  // eight floats
  }
}

TEST_F(Models, ClothSequence) {
  const io::Model model = io::import_model(data() / "cloth-drape", {{}, "z"});
  EXPECT_EQ(model.cache.size(), 48U);
  scene::Animation animation(model, {});
  const Surface& surface = animation.surface();
  EXPECT_EQ(surface.vertex_count(), 1369U);  // 37 × 37, nothing to weld
  EXPECT_EQ(surface.triangle_count(), 2592U);
  EXPECT_EQ(animation.timeline().frame_count, 48);
  // The first frame is flat, one metre wide, and horizontal once z is up; later it falls.
  const scene::Animation::Bounds flat = bounds_of(surface.rest);
  EXPECT_NEAR(flat.high.x - flat.low.x, 1, 1e-6);
  EXPECT_NEAR(flat.high.y - flat.low.y, 0, 1e-9);
  const scene::Animation::Bounds fallen = bounds_of(scene::posed(surface, animation.pose(48)));
  EXPECT_LT(fallen.low.y, -0.3);
  // The first frame as a file of its own is the same rest pose.
  scene::Animation named(model, {.rest = (data() / "cloth-drape" / "drape_0001.obj").string()});
  EXPECT_EQ(named.surface().rest, surface.rest);
}

}  // namespace
}  // namespace plisse
