// Geometry out: what is written, read back by the program's own readers; and what is refused.
#include "io/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/import.h"
#include "io/ply.h"
#include "io/point_cache.h"
#include "support/errors.h"
#include "support/files.h"

namespace plisse::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Two triangles of a square, a material each; uv has a seam along the diagonal, normals have none.
MeshFile square() {
  MeshFile mesh;
  mesh.positions = {{0, 0, 0.125}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0.25}};
  mesh.normals = {{0, 0, 1}, {0, 0.6, 0.8}, {0.6, 0, 0.8}, {0, 0, 1}};
  for (const std::uint32_t v : {0U, 1U, 2U})
    mesh.vertices.push_back({v, v, {0.25F * static_cast<float>(v), 0.5F}});
  for (const std::uint32_t v : {1U, 3U, 2U})
    mesh.vertices.push_back({v, v, {0.75F, 0.125F * static_cast<float>(v)}});
  mesh.triangles = {0, 1, 2, 3, 4, 5};
  mesh.parts = {{"cloth", "front side", {0.5F, 0.25F, 1, 1}, true, true, false, 0, 1},
                {"cloth", "back", {1, 1, 1, 1}, false, true, false, 1, 1}};
  return mesh;
}

Model read(const std::filesystem::path& path) {
  return import_model(path, {});
}

// The triangles of a model as places, normals and uv of their corners, whatever numbers they have.
struct Corner {
  glm::dvec3 place, normal;
  glm::vec2 uv;
};
std::vector<Corner> corners(const Model& model) {
  std::vector<Corner> result;
  for (const Mesh& mesh : model.meshes) {
    for (const std::uint32_t v : mesh.triangles)
      result.push_back({mesh.positions[v], glm::dvec3(mesh.normals[v]), mesh.uvs[v]});
  }
  return result;
}

TEST(MeshFile, WhatIsWrittenIsReadBackInEveryFormat) {
  const MeshFile mesh = square();
  const test::TemporaryFolder folder;
  for (const char* name : {"a.obj", "a.ply", "a.glb"}) {
    write_mesh(folder / name, mesh);
    const auto read_back = corners(read(folder / name));
    ASSERT_EQ(read_back.size(), 6U) << name;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto& vertex = mesh.vertices[mesh.triangles[i]];
      EXPECT_EQ(read_back[i].place, mesh.positions[vertex.position]) << name << i;  // short binary fractions
      EXPECT_NEAR(glm::distance(read_back[i].normal, mesh.normals[vertex.normal]), 0, 1e-6) << name << i;
      EXPECT_EQ(read_back[i].uv, vertex.uv) << name << i;  // whichever way v counts in the file
    }
  }
}

TEST(MeshFile, ObjKeepsTheNumbersOfPlaces) {
  const test::TemporaryFolder folder;
  write_mesh(folder / "a.obj", square());
  EXPECT_EQ(read(folder / "a.obj").file_vertex_count, 4U);  // though there are six vertices
}

TEST(MeshFile, MaterialsKeepTheirNames) {
  const test::TemporaryFolder folder;
  write_mesh(folder / "a.obj", square());
  write_mesh(folder / "a.glb", square());
  const Model glb = read(folder / "a.glb");
  ASSERT_EQ(glb.materials.size(), 2U);
  EXPECT_EQ(glb.materials[0].name, "front side");
  EXPECT_EQ(glb.materials[0].base_colour, glm::vec4(0.5F, 0.25F, 1, 1));
  EXPECT_TRUE(glb.materials[0].two_sided);
  EXPECT_FALSE(glb.materials[1].two_sided);
  EXPECT_THAT(test::read_text(folder / "a.obj"), HasSubstr("usemtl front_side\n"));
}

TEST(MeshFile, WithoutUvNoFileHasAny) {
  MeshFile mesh = square();
  for (auto& part : mesh.parts) part.has_uv = false;
  const test::TemporaryFolder folder;
  for (const char* name : {"a.obj", "a.ply", "a.glb"}) {
    write_mesh(folder / name, mesh);
    for (const Mesh& read_back : read(folder / name).meshes) EXPECT_TRUE(read_back.uvs.empty()) << name;
  }
}

TEST(MeshFile, RefusesWhatIsNotFiniteAndLeavesNothing) {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.obj", "a.ply", "a.glb"}) {
    MeshFile mesh = square();
    mesh.positions[2].y = NAN;
    const auto refusal = [&] {
      return test::error_of([&] { write_mesh(folder / name, mesh); }, ExitCode::no_output);
    };
    EXPECT_THAT(refusal(), HasSubstr("position 2 is not finite"));
    mesh = square();
    mesh.normals[1].x = INFINITY;
    EXPECT_THAT(refusal(), HasSubstr("normal 1 is not finite"));
  }
  EXPECT_THAT(test::error_of([&] { write_mesh(folder / "a.stl", square()); }),
              HasSubstr(".ply, .obj or .glb"));
  EXPECT_THAT(test::names_in(folder.path()), ElementsAre());
}

std::vector<glm::dvec3> moved(double up) {
  std::vector<glm::dvec3> places = square().positions;
  for (auto& x : places) x.z += up;
  return places;
}

TEST(PointCacheWriter, WhatIsWrittenMovesTheObj) {
  const test::TemporaryFolder folder;
  write_mesh(folder / "a.obj", square());
  const Model model = read(folder / "a.obj");
  for (const char* name : {"a.pc2", "a.mdd"}) {
    PointCacheWriter writer(folder / name, 4, {0.5, 0.75, 1.0});
    for (const double up : {0.0, 0.5, 1.0}) writer.add(moved(up));
    EXPECT_FALSE(std::filesystem::exists(folder / name));  // not before it is whole
    writer.commit();
    const VertexCache cache = read_point_cache(folder / name, model);
    EXPECT_EQ(cache.size(), 3U) << name;
    EXPECT_NEAR(cache.frames_per_second(), 4, 1e-6) << name;
    const std::vector<glm::dvec3> last = *cache.frame(2);
    std::size_t at = 0;
    for (const Mesh& mesh : model.meshes)
      for (const std::uint32_t v : mesh.file_vertices)
        EXPECT_EQ(last.at(at++), moved(1.0)[v]) << name;  // short binary fractions
  }
}

TEST(PointCacheWriter, LeavesNothingHalfWritten) {
  const test::TemporaryFolder folder;
  {
    PointCacheWriter writer(folder / "a.pc2", 4, {0, 1});
    writer.add(moved(0));
    EXPECT_THAT(test::error_of([&] { writer.commit(); }, ExitCode::no_output), HasSubstr("1 of 2 frames"));
    EXPECT_THAT(test::error_of([&] { writer.add(std::vector<glm::dvec3>(3)); }, ExitCode::no_output),
                HasSubstr("3 points"));
    EXPECT_THAT(test::error_of([&] { writer.add(moved(NAN)); }, ExitCode::no_output),
                HasSubstr("point 0 of frame 2 is not finite"));
  }
  EXPECT_THAT(test::error_of([&] {
                PointCacheWriter(folder / "b.pc2", 4, {0, 1, 3});
              }),
              HasSubstr("one step for all frames"));
  EXPECT_THAT(test::error_of([&] { PointCacheWriter(folder / "b.abc", 4, {0}); }), HasSubstr(".pc2 or .mdd"));
  EXPECT_THAT(test::names_in(folder.path()), ElementsAre());
}

}  // namespace
}  // namespace plisse::io
