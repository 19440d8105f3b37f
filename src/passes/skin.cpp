#include "passes/skin.h"

#include <epoxy/gl.h>

namespace plisse::passes {

SkinPass::SkinPass(std::size_t palette_size, std::size_t target_count, const std::string& shader_folder) {
  skin_ = gpu::Program({"skin.comp"}, {}, shader_folder);
  frame_ = gpu::Program({"frame.comp"}, {}, shader_folder);
  palette_ = gpu::Buffer(palette_size * 3 * sizeof(glm::vec4));
  weights_ = gpu::Buffer(target_count * sizeof(float));
}

void SkinPass::run(SurfaceBuffers& surface, const std::vector<glm::dmat4>& palette,
                   const std::vector<double>& target_weights) {
  std::vector<glm::vec4> rows;
  rows.reserve(palette.size() * 3);
  for (const auto& m : palette) {
    for (int row = 0; row < 3; ++row) rows.emplace_back(m[0][row], m[1][row], m[2][row], m[3][row]);
  }
  palette_.write(rows);
  weights_.write(std::vector<float>(target_weights.begin(), target_weights.end()));
  using Item = gpu::Buffer::Item;
  constexpr int unit = SurfaceBuffers::own_unit;
  surface.bind_places.bind_items(unit, Item::vec4);
  surface.influences.bind_items(unit + 1, Item::uvec4);
  surface.target_deltas.bind_items(unit + 2, Item::vec4);
  palette_.bind_items(unit + 3, Item::vec4);
  surface.positions.bind_storage(0);
  surface.frames.bind_storage(1);
  weights_.bind_storage(2);
  skin_.use();
  glUniform1ui(skin_.uniform("vertex_count"), static_cast<GLuint>(surface.vertex_count));
  glUniform1ui(skin_.uniform("target_count"), static_cast<GLuint>(target_weights.size()));
  gpu::dispatch(skin_, surface.vertex_count);
  frames(surface);
}

void SkinPass::run_cache(SurfaceBuffers& surface, const std::vector<glm::vec4>& positions) {
  surface.positions.write(positions);
  // Without a matrix the bind normal is the fallback where the posed triangles give none.
  std::vector<glm::vec4> fallback(2 * surface.vertex_count);
  const auto places = surface.bind_places.read<glm::vec4>();
  for (std::size_t v = 0; v < surface.vertex_count; ++v) fallback[2 * v] = places[2 * v + 1];
  surface.frames.write(fallback);
  frames(surface);
}

void SkinPass::frames(SurfaceBuffers& surface) {
  using Item = gpu::Buffer::Item;
  constexpr int unit = SurfaceBuffers::own_unit;
  surface.bind_for_reading();
  surface.corner_offsets.bind_items(unit, Item::uint);
  surface.corners.bind_items(unit + 1, Item::uvec2);
  surface.tangent_neighbours.bind_items(unit + 2, Item::uint);
  surface.frames.bind_storage(1);
  frame_.use();
  glUniform1ui(frame_.uniform("vertex_count"), static_cast<GLuint>(surface.vertex_count));
  gpu::dispatch(frame_, surface.vertex_count);
}

}  // namespace plisse::passes
