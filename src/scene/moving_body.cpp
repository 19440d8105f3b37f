#include "scene/moving_body.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/error.h"
#include "config/frames.h"
#include "config/suggest.h"
#include "io/import.h"
#include "scene/load_model.h"

namespace plisse::scene {

MovingBody::MovingBody(const config::SceneSettings& scene, const Surface& surface, const Timeline& clip,
                       const std::string& name, const std::string& option)
    : name_(name) {
  std::set<std::string> known;
  for (std::size_t p = 0; p < surface.parts.size(); ++p) {
    const Part& part = surface.parts[p];
    if (part.mesh == name || part.material_name == name) parts_.push_back(p);
    known.insert({part.mesh, part.material_name});
  }
  if (!parts_.empty()) return;
  known.erase("");
  const std::vector<std::string> names(known.begin(), known.end());
  std::error_code ignored;
  if (!std::filesystem::exists(name, ignored) && !config::names_many_files(name))
    throw Error(
        ExitCode::bad_input,
        fmt::format("{} {}: there is no such file, and the model has no such mesh or material{}; it has: {}",
                    option, name, config::did_you_mean(name, names), fmt::join(names, ", ")));
  io::ImportOptions options = import_options(scene);
  options.cache.clear();
  AnimationChoice choice;
  choice.frames_per_second = clip.frames_per_second;
  choice.limits = scene.limits;
  model_ = io::import_model(name, options);
  animation_.emplace(model_, choice);
  const int frames = animation_->timeline().frame_count;
  if (frames > 1 && frames < clip.frame_count)
    throw Error(ExitCode::bad_input,
                fmt::format("{} {}: has {} frames, the clip has {}; a body has one, or as many", option, name,
                            frames, clip.frame_count));
}

MovingBody::Triangles MovingBody::at(int frame, const Surface& scenes,
                                     const std::vector<glm::dvec3>& welded) {
  const Surface& surface = animation_ ? animation_->surface() : scenes;
  std::vector<glm::dvec3> posed_places;
  if (animation_)
    posed_places = posed(surface, animation_->pose(std::min(frame, animation_->timeline().frame_count)));
  const std::vector<glm::dvec3>& positions = animation_ ? posed_places : welded;
  // Only the vertices of the body, not those of other parts.
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> number(surface.vertex_count(), none);
  Triangles result;
  for (std::size_t p = 0; p < surface.parts.size(); ++p) {
    const Part& part = surface.parts[p];
    if (!animation_ && std::count(parts_.begin(), parts_.end(), p) == 0) continue;
    for (std::uint32_t t = part.first_triangle; t < part.first_triangle + part.triangle_count; ++t) {
      auto& triangle = result.triangles.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = surface.render_vertices[surface.triangles[3 * t + c]].welded;
        if (number[v] == none) {
          number[v] = static_cast<std::uint32_t>(result.places.size());
          result.places.push_back(positions[v]);
        }
        triangle[c] = number[v];
      }
    }
  }
  return result;
}

}  // namespace plisse::scene
