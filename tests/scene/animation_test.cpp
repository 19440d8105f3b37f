// Posing and welding of models made by hand, whose right answers are known.
#include "scene/animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "io/import.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse {
namespace {

constexpr double pi = std::numbers::pi;
// Positions near 1 through a few matrix products in doubles; weights are floats but ½ or 1 here.
constexpr double rounding = 1e-12;

glm::dquat about(const glm::dvec3& axis, double angle) {
  return {std::cos(angle / 2), axis * std::sin(angle / 2)};
}

// A strip of n squares of side 1 along y in the xy-plane.
io::Mesh strip(int n) {
  io::Mesh mesh;
  mesh.name = "strip";
  for (int i = 0; i <= n; ++i)
    for (const double x : {0.0, 1.0}) mesh.positions.emplace_back(x, i, 0);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i)
    for (const std::uint32_t corner : {0, 1, 3, 0, 3, 2}) mesh.triangles.push_back(2 * i + corner);
  mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
  return mesh;
}

io::Model model_of(io::Mesh mesh) {
  io::Model model;
  model.path = "made by hand";
  model.nodes.resize(1);
  model.nodes[0].name = "root";
  model.nodes[0].meshes = {0};
  model.nodes[0].morph_weights.assign(mesh.targets.size(), 0);
  model.meshes.push_back(std::move(mesh));
  return model;
}

io::Clip clip_of(double duration, std::vector<io::Channel> channels) {
  return {"clip", duration, std::move(channels)};
}

io::Channel turning(int node, const glm::dvec3& axis, double from, double to, double duration) {
  io::Channel channel;
  channel.node = node;
  channel.rotation.times = {0, duration};
  channel.rotation.values = {about(axis, from), about(axis, to)};
  return channel;
}

// The strip on two bones, the upper one at y = 2; vertices at y = 2 hang on both. The armature is `armature`
// of everything, and the bind pose is how the nodes stand.
io::Model sleeve(const glm::dmat4& armature = glm::dmat4{1}) {
  io::Model model = model_of(strip(4));
  io::Mesh& mesh = model.meshes[0];
  model.nodes.resize(4);
  model.nodes[1] = {"armature", 0, armature, {}, {}};
  model.nodes[2] = {"lower", 1, glm::dmat4{1}, {}, {}};
  model.nodes[3] = {"upper", 2, glm::translate(glm::dmat4{1}, {0, 2, 0}), {}, {}};
  mesh.bones = {{2, glm::dmat4{1}}, {3, glm::translate(glm::dmat4{1}, {0, -2, 0})}};
  for (const glm::dvec3& p : mesh.positions) {
    io::Influences influences;
    if (p.y == 2) {
      influences.bone = {0, 1};
      influences.weight = {0.5F, 0.5F};
    } else {
      influences.bone[0] = p.y > 2 ? 1 : 0;
      influences.weight[0] = 1;
    }
    mesh.influences.push_back(influences);
  }
  return model;
}

std::vector<double> edge_lengths(const Surface& surface, const std::vector<glm::dvec3>& positions) {
  std::vector<double> lengths;
  for (std::size_t v = 0; v < surface.vertex_count(); ++v)
    for (std::uint32_t i = surface.neighbours.offsets[v]; i < surface.neighbours.offsets[v + 1]; ++i)
      lengths.push_back(glm::distance(positions[v], positions[surface.neighbours.items[i]]));
  return lengths;
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << i;
}

TEST(Animation, CountsFramesAsTheContractSays) {
  io::Model model = model_of(strip(1));
  // ⌊T·fps + 1e-3⌋ + 1, with durations that single precision leaves short of a whole frame.
  for (const auto& [duration, fps, frames] : {std::tuple{1.0, 24.0, 25},
                                              {2.0833299, 24.0, 51},
                                              {0.70833, 24.0, 18},
                                              {0.99, 24.0, 24},
                                              {0.0, 24.0, 1},
                                              {1.0, 30.0, 31}}) {
    model.clips = {clip_of(duration, {})};
    EXPECT_EQ(scene::Animation(model, {.frames_per_second = fps}).timeline().frame_count, frames) << duration;
  }
  model.clips.clear();
  EXPECT_EQ(scene::Animation(model, {}).timeline().frame_count, 1);
}

TEST(Animation, BendsASkinAsByHand) {
  io::Model model = sleeve();
  model.clips = {clip_of(1, {turning(3, {0, 0, 1}, 0, pi / 2, 1)})};
  scene::Animation animation(model, {});
  const Surface& surface = animation.surface();
  ASSERT_EQ(surface.vertex_count(), 10U);
  EXPECT_EQ(scene::posed(surface, animation.pose(1)), surface.bind);
  // A quarter turn about (0, 2): (x, y) goes to (2 − y, 2 + x); half of it on the row at y = 2.
  const std::vector<glm::dvec3> bent = scene::posed(surface, animation.pose(25));
  for (std::size_t v = 0; v < 10; ++v) {
    const glm::dvec3 p = surface.bind[v];
    const glm::dvec3 turned{2 - p.y, 2 + p.x, 0};
    const glm::dvec3 expected = p.y < 2 ? p : p.y > 2 ? turned : 0.5 * (p + turned);
    EXPECT_NEAR(glm::distance(bent[v], expected), 0, rounding) << v;
  }
}

TEST(Animation, RigidMotionOfASkinKeepsDistances) {
  io::Model model = sleeve(glm::scale(glm::dmat4{1}, glm::dvec3{0.01}));
  io::Channel channel = turning(0, glm::normalize(glm::dvec3{1, 2, 3}), 0, 2.5, 1);
  channel.translation.times = {0, 1};
  channel.translation.values = {{0, 0, 0}, {5, -3, 8}};
  model.clips = {clip_of(1, {channel})};
  scene::Animation animation(model, {});
  const Surface& surface = animation.surface();
  const std::vector<double> rest = edge_lengths(surface, surface.rest);
  EXPECT_NEAR(rest[0], 0.01, rounding);  // metres of the world, not of the file's mesh
  for (const int frame : {1, 7, 25})
    expect_same(edge_lengths(surface, scene::posed(surface, animation.pose(frame))), rest, rounding);
}

// An armature scaled along one axis, or by 100, or mirrored, as exporters write them: the rest is what the
// default pose shows, so nothing reads as compressed.
TEST(Animation, ScaledArmaturesRestUncompressed) {
  for (const glm::dvec3& scale : {glm::dvec3{100}, glm::dvec3{0.01}, glm::dvec3{1, 1.23, 1},
                                  glm::dvec3{-1, 1, 1}, glm::dvec3{-2, 0.5, 3}}) {
    scene::Animation animation(sleeve(glm::scale(glm::dmat4{1}, scale)), {});
    const Surface& surface = animation.surface();
    const std::vector<glm::dvec3> shown = scene::posed(surface, animation.pose(1));
    expect_same(edge_lengths(surface, shown), edge_lengths(surface, surface.rest),
                rounding * glm::length(scale));
    for (std::size_t v = 0; v < shown.size(); ++v) {
      bool found = false;
      for (const glm::dvec3& p : strip(4).positions)
        found |= glm::distance(shown[v], scale * p) < rounding * glm::length(scale);
      EXPECT_TRUE(found) << v;
    }
    // Area normals agree with the file's, mirrors included.
    const RestFrames frames = rest_frames(surface);
    for (const RenderVertex& vertex : surface.render_vertices)
      EXPECT_NEAR(glm::dot(glm::dvec3(vertex.normal), frames.normal[vertex.welded]), 1, 1e-6);  // floats
  }
}

// Where the nodes stand bent although the skin was bound straight, the size still comes out right.
TEST(Animation, BindPoseNeedNotBeTheDefaultPose) {
  io::Model model = sleeve(glm::scale(glm::dmat4{1}, glm::dvec3{0.01}));
  model.nodes[3].local = model.nodes[3].local * glm::mat4_cast(about({1, 0, 0}, 1));
  scene::Animation animation(model, {});
  const std::vector<double> rest = edge_lengths(animation.surface(), animation.surface().rest);
  for (const double length : rest)
    EXPECT_TRUE(std::abs(length - 0.01) < rounding || std::abs(length - 0.01 * std::sqrt(2)) < rounding);
}

TEST(Animation, WeldsAcrossMeshesOfOneSkinButNotAcrossBones) {
  io::Model model = sleeve();
  // The upper half in another mesh of another material; its lowest row repeats the first mesh's highest.
  io::Mesh upper = model.meshes[0];
  upper.name = "upper half";
  model.meshes[0].triangles.resize(12);
  upper.triangles.erase(upper.triangles.begin(), upper.triangles.begin() + 12);
  model.meshes.push_back(upper);
  model.nodes[0].meshes = {0, 1};
  scene::Animation joined(model, {});
  EXPECT_EQ(joined.surface().vertex_count(), 10U);
  ASSERT_EQ(joined.surface().parts.size(), 2U);
  EXPECT_EQ(joined.surface().parts[1].mesh, "upper half");
  EXPECT_EQ(joined.surface().parts[1].first_triangle, 4U);

  // The repeated row bound to the upper bone alone: the two copies part when it bends.
  for (const std::size_t v : {4, 5}) {
    model.meshes[1].influences[v].bone = {1};
    model.meshes[1].influences[v].weight = {1};
  }
  EXPECT_EQ(scene::Animation(model, {}).surface().vertex_count(), 12U);
}

TEST(Animation, WeldsStillNodesButNotMovingOnes) {
  io::Model model = model_of(strip(1));
  model.nodes.resize(3);
  model.nodes[1] = {"left", 0, glm::translate(glm::dmat4{1}, {1, 0, 0}), {0}, {}};
  model.nodes[2] = {"above", 0, glm::translate(glm::dmat4{1}, {0, 1, 0}), {0}, {}};
  // Three squares in an L: 8 corners.
  EXPECT_EQ(scene::Animation(model, {}).surface().vertex_count(), 8U);
  model.clips = {clip_of(1, {turning(2, {0, 1, 0}, 0, 1, 1)})};
  EXPECT_EQ(scene::Animation(model, {}).surface().vertex_count(), 10U);
}

TEST(Animation, MorphTargetsMoveInTheWorldsSpace) {
  io::Mesh mesh = strip(1);
  mesh.targets = {{"up", std::vector<glm::vec3>(4, {0, 0, 1})},
                  {"side", std::vector<glm::vec3>(4, {1, 0, 0})}};
  io::Model model = model_of(mesh);
  model.nodes[0].local =
      glm::rotate(glm::scale(glm::dmat4{1}, glm::dvec3{2}), pi / 2, {0, 1, 0});  // z → x, x → −z
  io::Channel channel;
  channel.node = 0;
  channel.morph_weights.times = {0, 1};
  channel.morph_weights.values = {{0, 0}, {1, 0.5}};
  model.clips = {clip_of(1, {channel})};
  scene::Animation animation(model, {});
  const std::vector<glm::dvec3> first = scene::posed(animation.surface(), animation.pose(1));
  const std::vector<glm::dvec3> last = scene::posed(animation.surface(), animation.pose(25));
  for (std::size_t v = 0; v < 4; ++v)
    EXPECT_NEAR(glm::distance(last[v] - first[v], {2, 0, -1}), 0, 1e-6);  // deltas are floats
}

TEST(Animation, CacheKeepsVerticesThatPartLater) {
  io::Model model = model_of(strip(1));
  io::Mesh second = strip(1);  // lies on the first
  model.meshes.push_back(second);
  model.nodes[0].meshes = {0, 1};
  std::vector<glm::dvec3> frame = model.meshes[0].positions;
  frame.insert(frame.end(), second.positions.begin(), second.positions.end());
  model.cache = io::VertexCache({frame, frame}, 24);
  EXPECT_EQ(scene::Animation(model, {}).surface().vertex_count(), 4U);
  std::vector<glm::dvec3> parted = frame;
  parted[7].z += 0.5;
  model.cache = io::VertexCache({frame, parted}, 24);
  scene::Animation animation(model, {});
  EXPECT_EQ(animation.surface().vertex_count(), 5U);
  EXPECT_EQ(animation.timeline().frame_count, 2);
  EXPECT_NEAR(scene::posed(animation.surface(), animation.pose(2))[4].z, 0.5, 0);
}

TEST(Animation, RestPoses) {
  io::Model model = sleeve();
  model.clips = {clip_of(1, {turning(3, {1, 0, 0}, 1, 2, 1)})};
  EXPECT_EQ(scene::Animation(model, {}).surface().rest, scene::Animation(model, {}).surface().bind);
  scene::Animation framed(model, {.rest = "frame:13"});
  EXPECT_EQ(framed.surface().rest, scene::posed(framed.surface(), framed.pose(13)));
  // The upper end turned with its bone, 1.5 rad about x, and the file normals with it.
  for (const RenderVertex& vertex : framed.surface().render_vertices) {
    if (framed.surface().bind[vertex.welded].y < 4) continue;
    const glm::dvec3 expected{0, -std::sin(1.5), std::cos(1.5)};
    EXPECT_NEAR(glm::distance(glm::dvec3(vertex.normal), expected), 0, 1e-6);  // floats
  }
  EXPECT_THAT(test::error_of([&] { scene::Animation(model, {.rest = "frame:26"}); }),
              testing::HasSubstr("1 to 25"));
  EXPECT_THAT(test::error_of([&] { scene::Animation(model, {.rest = "frame:x"}); }),
              testing::HasSubstr("frame:N"));
  EXPECT_THAT(test::error_of([&] { scene::Animation(model, {.rest = "gone.obj"}); }),
              testing::HasSubstr("gone.obj"));
}

TEST(Animation, ChoosesClips) {
  io::Model model = sleeve();
  model.clips = {clip_of(1, {}), clip_of(2, {}), clip_of(3, {})};
  model.clips[0].name = "Survey";
  model.clips[1].name = "Walk";
  model.clips[2].name = "Run";
  EXPECT_EQ(scene::Animation(model, {}).clip_name(), "Survey");
  EXPECT_EQ(scene::Animation(model, {.clip = "Walk"}).clip_name(), "Walk");
  EXPECT_EQ(scene::Animation(model, {.clip = "2"}).clip_name(), "Run");
  EXPECT_THAT(
      test::error_of([&] { scene::Animation(model, {.clip = "wolk"}); }),
      testing::HasSubstr("did you mean 'Walk'?); it has, by index or name: 0 'Survey', 1 'Walk', 2 'Run'"));
  EXPECT_THAT(test::error_of([&] { scene::Animation(model, {.clip = "3"}); }),
              testing::HasSubstr("0 'Survey', 1 'Walk', 2 'Run'"));
}

TEST(Animation, HoldsTheLastGoodPose) {
  io::Model model = sleeve();
  model.clips = {clip_of(1, {turning(3, {0, 0, 1}, 0, 1, 1)})};
  io::Keys<glm::dquat>& track = model.clips[0].channels[0].rotation;
  const double bad = std::numeric_limits<double>::quiet_NaN();
  track.times = {0, 0.25, 0.5, 1};
  track.values = {about({0, 0, 1}, 0), about({0, 0, 1}, 1), {bad, 0, 0, 0}, about({0, 0, 1}, 2)};
  scene::Animation animation(model, {});
  const scene::Pose good = animation.pose(7);  // 0.25 s
  EXPECT_EQ(animation.pose(10), good);
  EXPECT_EQ(animation.pose(13), good);
  EXPECT_NE(animation.pose(25), good);
  const scene::Animation::Bounds bounds = animation.bounds();
  EXPECT_TRUE(std::isfinite(glm::length(bounds.high - bounds.low)));
}

TEST(Animation, EqualTimesGiveEqualBits) {
  io::Model model = sleeve();
  model.clips = {clip_of(1, {turning(3, {0, 0, 1}, 0, 1, 0.5)})};
  scene::Animation animation(model, {});
  EXPECT_EQ(animation.pose(13), animation.pose(25));
  EXPECT_NE(animation.pose(12), animation.pose(13));
}

TEST(Animation, BoundsHoldEveryFrame) {
  io::Model model = sleeve();
  model.clips = {clip_of(1, {turning(3, {0, 0, 1}, 0, pi / 2, 1)})};
  scene::Animation animation(model, {});
  const scene::Animation::Bounds bounds = animation.bounds();
  // Bent, the far corner (0, 4) comes to (−2, 2); on the way (1, 4) swings through y = 2 + √5.
  EXPECT_NEAR(bounds.low.x, -2, rounding);
  EXPECT_NEAR(bounds.high.y, 2 + std::sqrt(5.0), 1e-2);  // between two of 25 frames
  EXPECT_NEAR(bounds.low.y, 0, rounding);
}

// Two groups whose faces use the vertices backwards and in turn; the last vertex falls together with another.
TEST(Animation, KeepsTheOrderOfTheFile) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "a.obj",
                   "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 1 0 0\nvt 0 0\nvt 1 0\n"
                   "g right\nf 6/1 5/2 3/1\nf 3/1 5/1 7/1\ng left\nf 5/1 4/1 1/1\nf 2/1 5/2 1/2\n");
  const io::Model model = io::import_model(folder / "a.obj");
  const scene::Animation animation(model, {});
  const std::vector<glm::dvec3> expected{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
  EXPECT_EQ(animation.surface().bind, expected);
  // What is drawn begins with them, too; what seams of uv add comes after.
  const auto& drawn = animation.surface().render_vertices;
  ASSERT_GT(drawn.size(), expected.size());
  for (std::uint32_t v = 0; v < expected.size(); ++v) EXPECT_EQ(drawn[v].welded, v);
  // The triangles are those of the file.
  std::vector<glm::dvec3> corners;
  for (const std::uint32_t corner : animation.surface().triangles)
    corners.push_back(animation.surface().bind[drawn[corner].welded]);
  EXPECT_EQ(corners, (std::vector<glm::dvec3>{{2, 1, 0},
                                              {1, 1, 0},
                                              {2, 0, 0},
                                              {2, 0, 0},
                                              {1, 1, 0},
                                              {1, 0, 0},
                                              {1, 1, 0},
                                              {0, 1, 0},
                                              {0, 0, 0},
                                              {1, 0, 0},
                                              {1, 1, 0},
                                              {0, 0, 0}}));
}

// Two squares with a fold of a right angle between them.
TEST(Animation, FlatMeshesHaveTheNormalsOfTheirTriangles) {
  io::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, -1}, {1, 1, -1}};
  mesh.triangles = {0, 2, 3, 0, 3, 1, 2, 4, 5, 2, 5, 3};
  mesh.flat = true;
  mesh.targets = {{"wide", std::vector<glm::vec3>(6, {0, 0, 2})}};
  const scene::Animation animation(model_of(mesh), {});
  const Surface& surface = animation.surface();
  // Waves cross the fold: what is welded stays so, in the file's order, with its targets.
  EXPECT_EQ(surface.bind, mesh.positions);
  EXPECT_EQ(surface.target_deltas, mesh.targets[0].position_deltas);
  EXPECT_EQ(surface.render_vertices.size(), 8U);
  for (std::size_t corner = 0; corner < surface.triangles.size(); ++corner) {
    const glm::vec3 expected = corner < 6 ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
    EXPECT_EQ(surface.render_vertices[surface.triangles[corner]].normal, expected) << corner;
  }
  mesh.flat = false;
  EXPECT_EQ(scene::Animation(model_of(mesh), {}).surface().render_vertices.size(), 6U);
}

TEST(Animation, ClipsWithoutLengthArePassedOver) {
  io::Model model = model_of(strip(1));
  model.path = "passed over";
  model.clips = {clip_of(0, {}), clip_of(0, {}), clip_of(2, {}), clip_of(3, {})};
  for (std::size_t c = 0; c < 4; ++c) model.clips[c].name = std::string(1, static_cast<char>('A' + c));
  EXPECT_EQ(scene::Animation(model, {}).clip_name(), "C");
  EXPECT_THAT(log::warnings(), testing::Contains(testing::HasSubstr(
                                   "passed over: clip 'A' has no length and is passed over; 'C' is played")));
  EXPECT_EQ(scene::Animation(model, {.clip = "A"}).clip_name(), "A");
  EXPECT_EQ(scene::Animation(model, {.clip = "A"}).timeline().frame_count, 1);
  model.clips.resize(2);
  EXPECT_EQ(scene::Animation(model, {}).clip_name(), "A");
}

// Two strips, each with an action of its own.
TEST(Animation, ClipsPlayTogether) {
  io::Model model = model_of(strip(1));
  model.path = "together";
  model.nodes.push_back(model.nodes[0]);
  const auto moving = [](int node, double to, double duration) {
    io::Channel channel;
    channel.node = node;
    channel.translation.times = {0, duration};
    channel.translation.values = {{0, 0, 0}, {0, to, 0}};
    return channel;
  };
  model.clips = {clip_of(1, {moving(0, 10, 1)}), clip_of(2, {moving(1, 20, 2)}),
                 clip_of(3, {moving(0, 99, 3)})};
  for (std::size_t c = 0; c < 3; ++c) model.clips[c].name = std::string(1, static_cast<char>('A' + c));
  const auto heights = [&](const std::string& clip) {
    scene::Animation animation(model, {.clip = clip});
    return std::pair(animation.node_matrix(0, 25)[3].y, animation.node_matrix(1, 25)[3].y);
  };
  EXPECT_EQ(heights("0"), std::pair(10.0, 0.0));
  EXPECT_EQ(heights("A,B"), std::pair(10.0, 10.0));
  EXPECT_EQ(heights("1, 2"), std::pair(33.0, 10.0));
  EXPECT_EQ(scene::Animation(model, {.clip = "A,B"}).timeline().frame_count, 2 * 24 + 1);
  EXPECT_EQ(heights("all"), std::pair(10.0, 10.0));
  EXPECT_THAT(log::warnings(),
              testing::Contains(testing::HasSubstr("move the same nodes as one before them: 'C'")));
  EXPECT_THAT(test::error_of([&] { heights("A,D"); }), testing::HasSubstr("no clip 'D'"));
  model.clips[2].name = "all";
  EXPECT_EQ(heights("all"), std::pair(33.0, 0.0));
}

// A point cache of uneven times, played at other rates: its positions are those of its own times.
TEST(Animation, CachesKeepTheirTimes) {
  io::Model model = model_of(strip(1));
  std::vector<std::vector<glm::dvec3>> frames;
  for (const double height : {0.0, 1.0, 5.0}) {
    frames.push_back(model.meshes[0].positions);
    for (glm::dvec3& x : frames.back()) x.z = height;
  }
  model.cache = io::VertexCache(std::move(frames), 4);
  const auto height = [&](double rate, int frame) {
    scene::Animation animation(model, {.frames_per_second = rate});
    return animation.pose(frame).cache[0].z;
  };
  const auto count = [&](double rate) {
    return scene::Animation(model, {.frames_per_second = rate}).timeline().frame_count;
  };
  // A sequence has no times: frame by frame at any rate.
  EXPECT_EQ(count(8), 3);
  EXPECT_EQ(height(8, 2), 1);
  model.cache.set_times({0, 0.25, 0.5});
  EXPECT_EQ(count(0), 3);
  EXPECT_EQ(height(0, 2), 1);
  EXPECT_EQ(count(8), 5);
  EXPECT_NEAR(height(8, 2), 0.5, rounding);
  EXPECT_NEAR(height(8, 4), 3, rounding);
  EXPECT_EQ(count(2), 2);
  EXPECT_EQ(height(2, 2), 5);
  model.cache.set_times({0, 0.125 + 1e-8, 0.5});  // a file's rounding is no way to the next frame
  EXPECT_EQ(height(8, 2), 1);
  EXPECT_NEAR(height(8, 3), 1 + 4 / 3.0, 1e-6);
}

}  // namespace
}  // namespace plisse
