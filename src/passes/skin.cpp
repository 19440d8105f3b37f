#include "passes/skin.h"

#include <epoxy/gl.h>

namespace plisse::passes {

SkinPass::SkinPass(std::size_t palette_size, std::size_t target_count, const std::string& shader_folder) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_UNIFORM_BLOCK_SIZE, &limit);
  const std::size_t bytes = palette_size * 3 * sizeof(glm::vec4);
  in_uniforms_ = bytes <= static_cast<std::size_t>(limit);
  gpu::Defines defines;
  if (in_uniforms_) defines.emplace_back("PALETTE_IN_UNIFORMS", std::to_string(palette_size));
  skin_ = gpu::Program({"skin.comp"}, defines, shader_folder);
  frame_ = gpu::Program({"frame.comp"}, {}, shader_folder);
  palette_ = gpu::Buffer(bytes);
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
  surface.positions.bind_storage(0);
  surface.frames.bind_storage(1);
  surface.bind.bind_storage(4);
  surface.bind_normals.bind_storage(6);
  surface.influences.bind_storage(9);
  surface.target_deltas.bind_storage(11);
  weights_.bind_storage(12);
  in_uniforms_ ? palette_.bind_uniform(0) : palette_.bind_storage(13);
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
  const auto normals = surface.bind_normals.read<glm::vec4>();
  for (std::size_t v = 0; v < surface.vertex_count; ++v) fallback[2 * v] = normals[v];
  surface.frames.write(fallback);
  frames(surface);
}

void SkinPass::frames(SurfaceBuffers& surface) {
  surface.positions.bind_storage(0);
  surface.frames.bind_storage(1);
  surface.corner_offsets.bind_storage(4);
  surface.corners.bind_storage(6);
  surface.tangent_neighbours.bind_storage(9);
  frame_.use();
  glUniform1ui(frame_.uniform("vertex_count"), static_cast<GLuint>(surface.vertex_count));
  gpu::dispatch(frame_, surface.vertex_count);
}

}  // namespace plisse::passes
