#include "passes/crush.h"

#include <epoxy/gl.h>

namespace plisse::passes {

CrushPass::CrushPass(const std::string& shader_folder) : crush_({"crush.comp"}, {}, shader_folder) {}

void CrushPass::run(SurfaceBuffers& surface, double dead_zone, bool always_set, bool unstrained) {
  const std::uint32_t none_fresh_all_idle_all_flat[] = {0, always_set ? 0U : 1U, 0};
  surface.counter.write(none_fresh_all_idle_all_flat, sizeof none_fresh_all_idle_all_flat);
  surface.bind_for_reading();
  surface.rest_rows.bind_items(SurfaceBuffers::own_unit, gpu::Buffer::Item::vec4);
  surface.biases.bind_items(SurfaceBuffers::own_unit + 1, gpu::Buffer::Item::vec4);
  const bool carries = surface.carried.bytes() > 0;
  if (carries) surface.carried.bind_items(SurfaceBuffers::own_unit + 2, gpu::Buffer::Item::vec2);
  surface.states.bind_storage(0);
  surface.waves.bind_storage(1);
  surface.world_waves.bind_storage(2);
  surface.phases.bind_storage(3);
  surface.counter.bind_storage(4);
  crush_.use();
  glUniform1ui(crush_.uniform("vertex_count"), static_cast<GLuint>(surface.vertex_count));
  glUniform1f(crush_.uniform("dead_zone"), static_cast<float>(dead_zone));
  glUniform1i(crush_.uniform("always_set"), always_set);
  glUniform1i(crush_.uniform("unstrained"), unstrained);
  glUniform1i(crush_.uniform("carries"), carries);
  gpu::dispatch(crush_, surface.vertex_count);
}

}  // namespace plisse::passes
