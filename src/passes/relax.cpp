#include "passes/relax.h"

#include <epoxy/gl.h>

#include <glm/gtc/constants.hpp>
#include <utility>

namespace plisse::passes {
namespace {
gpu::Program program(const char* define, const std::string& shader_folder) {
  return gpu::Program({"relax.comp"}, {{define, "1"}}, shader_folder);
}
void set_count(const gpu::Program& program, std::size_t count) {
  program.use();
  glUniform1ui(program.uniform("vertex_count"), static_cast<GLuint>(count));
}
}  // namespace

RelaxPass::RelaxPass(const std::string& shader_folder)
    : descent_(program("DESCENT", shader_folder)),
      spread_(program("SPREAD", shader_folder)),
      rotors_(program("ROTORS", shader_folder)),
      smooth_(program("SMOOTH", shader_folder)),
      finish_(program("FINISH", shader_folder)),
      lead_(program("LEAD", shader_folder)) {}

bool RelaxPass::idle(const SurfaceBuffers& surface) {
  std::uint32_t idle = 0;
  surface.counter.read(&idle, sizeof idle, sizeof idle);
  return idle != 0;
}

void RelaxPass::run(SurfaceBuffers& surface, const RelaxOptions& options) {
  bind(surface);
  if (options.onset) {
    std::uint32_t fresh = 0;
    surface.counter.read(&fresh, sizeof fresh);
    if (fresh > 0) {
      set_count(spread_, surface.vertex_count);
      for (int i = 0; i < options.onset_rounds; ++i) round(spread_, surface);
      std::uint32_t left = 0;
      surface.counter.read(&left, sizeof left);
      if (left > 0) smooth(surface, options.smoothing_rounds);
    }
  }
  set_count(descent_, surface.vertex_count);
  glUniform1f(descent_.uniform("step_size"),
              static_cast<float>(options.epsilon / (2 * glm::pi<double>() * glm::pi<double>())));
  for (int i = 0; i < options.rounds; ++i) round(descent_, surface);
}

void RelaxPass::lead(SurfaceBuffers& surface, const gpu::Buffer& phases, const gpu::Buffer& states,
                     double fraction) {
  lead(surface, phases, states, fraction, false);
}

void RelaxPass::begin_as(SurfaceBuffers& surface, const gpu::Buffer& phases, const gpu::Buffer& states) {
  lead(surface, phases, states, 1, true);
}

void RelaxPass::lead(SurfaceBuffers& surface, const gpu::Buffer& phases, const gpu::Buffer& states,
                     double fraction, bool fresh_ones) {
  bind(surface);
  phases.bind_items(SurfaceBuffers::own_unit + 2, gpu::Buffer::Item::vec2);
  states.bind_items(SurfaceBuffers::own_unit + 3, gpu::Buffer::Item::vec4);
  set_count(lead_, surface.vertex_count);
  glUniform1f(lead_.uniform("fraction"), static_cast<float>(fraction));
  glUniform1i(lead_.uniform("fresh_ones"), fresh_ones);
  round(lead_, surface);
}

void RelaxPass::bind(SurfaceBuffers& surface) {
  surface.bind_for_reading();
  surface.counter.bind_storage(1);
}

void RelaxPass::round(const gpu::Program& step, SurfaceBuffers& surface) {
  surface.bind_phases_for_reading();
  surface.phases_next.bind_storage(0);
  gpu::dispatch(step, surface.vertex_count);
  std::swap(surface.phases, surface.phases_next);
}

void RelaxPass::smooth(SurfaceBuffers& surface, int rounds) {
  using Item = gpu::Buffer::Item;
  constexpr int unit = SurfaceBuffers::own_unit;
  if (numbers_.bytes() == 0) {
    numbers_ = gpu::Buffer(surface.phases.bytes());
    numbers_next_ = gpu::Buffer(surface.phases.bytes());
    rotor_list_ = gpu::Buffer(surface.neighbours.bytes() * 4);
  }
  surface.bind_phases_for_reading();
  numbers_.bind_storage(1);
  numbers_next_.bind_storage(2);
  rotor_list_.bind_storage(3);
  set_count(rotors_, surface.vertex_count);
  gpu::dispatch(rotors_, surface.vertex_count);
  rotor_list_.bind_items(unit + 1, Item::vec4);
  set_count(smooth_, surface.vertex_count);
  for (int i = 0; i < rounds; ++i) {
    numbers_.bind_items(unit, Item::vec2);
    numbers_next_.bind_storage(1);
    gpu::dispatch(smooth_, surface.vertex_count);
    std::swap(numbers_, numbers_next_);
  }
  numbers_.bind_items(unit, Item::vec2);
  surface.phases.bind_storage(0);
  set_count(finish_, surface.vertex_count);
  gpu::dispatch(finish_, surface.vertex_count);
}

}  // namespace plisse::passes
