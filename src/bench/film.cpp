#include "bench/film.h"
#include "pipeline/look.h"

namespace plisse::bench {

using gpu::Target;

Film::Film(const config::SceneSettings& settings, const std::string& name, bool software_renderer)
    : scene(settings),
      subject(subject_of(scene, name)),
      reference(scene),
      rig(subject, software_renderer),
      view(scene.view(1)),
      pass(pipeline::look_of(scene), scene.profile, pipeline::draw_parts(scene),
           pipeline::texture_levels(scene), ""),
      target(settings.output.width, settings.output.height, settings.output.samples, Target::Format::srgb8),
      floats(settings.output.width, settings.output.height, 1, Target::Format::rgba32f),
      software(software_renderer) {}

void Film::draw(const passes::SurfaceBuffers& surface) {
  pass.draw(surface, view, target, software);
  finish();
}

io::Image Film::picture(const passes::SurfaceBuffers& surface) {
  draw(surface);
  return {target.width(), target.height(), target.read_rgba8()};
}

std::vector<std::uint8_t> Film::covered() {
  pass.draw_aov(rig.surface(), view, floats, passes::Aov::depth);
  const auto values = floats.read_rgba32f();
  std::vector<std::uint8_t> mask(values.size() / 4);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = values[4 * i + 3] > 0 ? 1 : 0;
  return mask;
}

}  // namespace plisse::bench
