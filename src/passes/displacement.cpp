#include "passes/displacement.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <glm/glm.hpp>
#include <numeric>
#include <utility>
#include <vector>

#include "base/error.h"

namespace plisse::passes {
namespace {

constexpr int own = SurfaceBuffers::own_unit;
using Item = gpu::Buffer::Item;

gpu::Program points_program(const Profile& profile, bool smooth_blend, bool field,
                            const std::string& folder) {
  gpu::Defines defines = wave_defines(profile, smooth_blend);
  if (field) defines.emplace_back("FIELD", "1");
  return {{"displacement.comp"}, defines, folder};
}

gpu::Program mean_program(const char* of, const std::string& folder) {
  return {{"displacement_mean.comp"}, {{of, "1"}}, folder};
}

// As displacement.comp unpacks it.
std::vector<glm::uvec2> packed_points(const Subdivision& fine) {
  std::vector<glm::uvec2> packed;
  packed.reserve(fine.points.size());
  fine.for_each_point([&](std::size_t t, const FinePoint& point) {
    packed.emplace_back(
        t, point.toward_b | std::uint32_t{point.toward_c} << 10U | std::uint32_t{point.segments} << 20U);
  });
  return packed;
}

// Offsets and items of the points by `row(point)`, in their order.
template <typename Row>
std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>> rows(const Subdivision& fine,
                                                                       std::size_t count, const Row& row) {
  std::vector<std::uint32_t> offsets(count + 1, 0), items(fine.points.size());
  for (const FinePoint& point : fine.points) ++offsets[row(point) + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
  for (std::uint32_t i = 0; i < items.size(); ++i) items[next[row(fine.points[i])]++] = i;
  return {std::move(offsets), std::move(items)};
}

}  // namespace

DisplacementPass::DisplacementPass(const Subdivision& fine, const Profile& profile, bool smooth_blend,
                                   bool field, double cavity, const std::string& shader_folder)
    : profile_(profile),
      points_program_(points_program(profile, smooth_blend, field, shader_folder)),
      places_program_(mean_program("PLACES", shader_folder)),
      normals_program_(mean_program("NORMALS", shader_folder)),
      point_count_(fine.points.size()),
      position_count_(fine.position_count),
      vertex_count_(fine.vertices.size()),
      field_(field),
      cavity_(cavity),
      points_(packed_points(fine)),
      places_(point_count_ * sizeof(glm::vec4)),
      normals_(point_count_ * sizeof(glm::vec4)),
      skies_(point_count_ * sizeof(glm::vec2)),
      counter_(sizeof(std::uint32_t)) {
  const auto position_rows = rows(fine, fine.position_count, [&](const FinePoint& point) {
    return fine.vertices[point.vertex].position;
  });
  const auto normal_rows = rows(fine, fine.normal_count,
                                [&](const FinePoint& point) { return fine.vertices[point.vertex].normal; });
  position_rows_ = {gpu::Buffer(position_rows.first), gpu::Buffer(position_rows.second)};
  normal_rows_ = {gpu::Buffer(normal_rows.first), gpu::Buffer(normal_rows.second)};
  std::vector<std::uint32_t> normal_of;
  normal_of.reserve(fine.vertices.size());
  for (const FineVertex& vertex : fine.vertices) normal_of.push_back(vertex.normal);
  shared_normals_ = gpu::Buffer(normal_of);
}

void DisplacementPass::run(const SurfaceBuffers& surface, SurfaceBuffers& fine) {
  surface.bind_for_reading();
  surface.triangle_corners.bind_items(own, Item::uvec2);
  surface.render_vertices.bind_items(own + 1, Item::vec4);
  points_.bind_items(own + 2, Item::uvec2);
  if (field_) surface.field.bind_items(own + 3, Item::vec4);
  profile_.bind();
  places_.bind_storage(0);
  normals_.bind_storage(1);
  skies_.bind_storage(2);
  points_program_.use();
  glUniform1ui(points_program_.uniform("point_count"), static_cast<GLuint>(point_count_));
  glUniform1f(points_program_.uniform("cavity"), static_cast<float>(cavity_));
  gpu::dispatch(points_program_, point_count_);
  take_together(surface, fine);
}

void DisplacementPass::take_together(const SurfaceBuffers& surface, SurfaceBuffers& fine) {
  const auto bind = [&](const Rows& rows) {
    rows.offsets.bind_items(own, Item::uint);
    rows.points.bind_items(own + 1, Item::uint);
    places_.bind_items(own + 2, Item::vec4);
    normals_.bind_items(own + 3, Item::vec4);
  };
  const auto run = [](const gpu::Program& program, std::size_t count) {
    program.use();
    glUniform1ui(program.uniform("count"), static_cast<GLuint>(count));
    gpu::dispatch(program, count);
  };
  const std::uint32_t none = 0;
  counter_.write(&none, sizeof none);
  bind(position_rows_);
  skies_.bind_items(own + 4, Item::vec2);
  surface.positions.bind_items(own + 5, Item::vec4);
  fine.positions.bind_storage(0);
  fine.relief.bind_storage(1);
  counter_.bind_storage(2);
  run(places_program_, position_count_);
  bind(normal_rows_);
  shared_normals_.bind_items(own + 4, Item::uint);
  fine.render_vertices.bind_storage(0);
  run(normals_program_, vertex_count_);

  std::uint32_t not_finite = 0;
  counter_.read(&not_finite, sizeof not_finite);
  if (not_finite > 0)
    throw Error(ExitCode::check_failed, fmt::format("{} displaced vertices are not finite", not_finite));
}

}  // namespace plisse::passes
