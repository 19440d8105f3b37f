#include "bench/solved.h"

#include <fmt/format.h>

#include "base/eigen_glm.h"
#include "cloth/drape_examples.h"

namespace plisse::bench {

std::vector<std::uint32_t> corners(const std::vector<shell::Face>& faces) {
  std::vector<std::uint32_t> result;
  for (const shell::Face& face : faces) result.insert(result.end(), face.begin(), face.end());
  return result;
}

Solved solve(const Setup& setup, const std::string& example, int vertices) {
  Solved solved;
  const cloth::DrapeScene scene = cloth::drape_example(example, vertices);
  const Sample began = now();
  solved.base = cloth::base_of(scene);
  solved.base_s = (now() - began).wall_s;

  const auto folder = setup.folder / "solved";
  const std::string name = fmt::format("{}_{}", example, solved.vertices());
  solved.base_file = folder / (name + "_base.ply");
  solved.field_file = folder / (name + "_field.ply");
  cloth::DrapeFrame frame;
  frame.equilibrium.converged = true;
  cloth::write_base(solved.base_file, scene, frame, solved.base.surface.positions);

  cloth::WrinkleRequest request;
  request.scene = solved.base;
  request.output = solved.field_file;
  const Sample solving = now();
  solved.field = cloth::wrinkle_field(request);
  solved.field_s = (now() - solving).wall_s;
  return solved;
}

config::SceneSettings still_life(const std::filesystem::path& base, const std::filesystem::path& field,
                                 config::FieldUse use, int width, int height) {
  config::SceneSettings settings;
  settings.model.path = base;
  settings.bias.field = field;
  settings.bias.use = use;
  settings.output.width = width;
  settings.output.height = height;
  settings.light.key_azimuth = -65;
  settings.light.key_elevation = 25;
  return settings;
}

}  // namespace plisse::bench
