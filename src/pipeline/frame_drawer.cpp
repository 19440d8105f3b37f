#include "pipeline/frame_drawer.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/colour.h"
#include "pipeline/look.h"

namespace plisse::pipeline {
namespace {

// The picture was made with premultiplied colours in linear light; PNG needs straight alpha.
void straighten_alpha(std::vector<std::uint8_t>& rgba) {
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    const std::uint8_t alpha = rgba[i + 3];
    if (alpha == 0 || alpha == 255) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double straight = srgb_to_linear(rgba[i + c] / 255.0) * 255.0 / alpha;
      rgba[i + c] = static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(std::min(1.0, straight))));
    }
  }
}

passes::Look look_of(const LoadedScene& scene, const RenderRequest& request) {
  passes::Look look = look_of(scene);
  look.displaced = request.displace;
  return look;
}

}  // namespace

FrameDrawer::Geometry::Geometry(const LoadedScene& scene, Subdivision split, const RenderRequest& request)
    : mesh(std::move(split)),
      buffers(scene.surface(), mesh),
      pass(mesh, scene.profile, scene.settings.shading.blend == config::Blend::smooth, look_of(scene).field,
           scene.settings.shading.cavity, request.shader_folder) {
  if (!request.outside.empty()) held.emplace(scene, mesh, request.outside);
}

void FrameDrawer::Geometry::move(const passes::SurfaceBuffers& posed, int frame) {
  if (!held) {
    pass.run(posed, buffers);
    return;
  }
  DisplacedSurface displaced = held->displacement.at(posed);
  held->outside.hold(frame, mesh, displaced);
  buffers.show(mesh, displaced);
}

FrameDrawer::FrameDrawer(LoadedScene& scene, const RenderRequest& request, std::optional<Subdivision> split,
                         const std::vector<passes::Aov>& aovs, const gpu::Context& context,
                         gpu::StageTimer& timer)
    : scene_(scene),
      request_(request),
      software_(context.info().software),
      timer_(timer),
      stepper_(scene, timer, request.shader_folder),
      geometry_(request.displace ? std::make_optional<Geometry>(scene, std::move(split.value()), request)
                                 : std::nullopt),
      pass_(look_of(scene, request), scene.profile, parts(), texture_levels(scene), request.shader_folder),
      samples_(scene.settings.output.samples) {
  if (!aovs.empty()) aov_writer_.emplace(scene, pass_, aovs);
  if (aovs.empty() && request.state_file.empty()) stepper_.leave_out_masked();
}

std::vector<passes::DrawPart> FrameDrawer::parts() const {
  auto parts = draw_parts(scene_);
  if (geometry_) {
    for (passes::DrawPart& part : parts) {
      const auto small = geometry_->mesh.small_triangles(part.first_triangle, part.triangle_count);
      part.first_triangle = small.first;
      part.triangle_count = small.count;
    }
  }
  return parts;
}

const gpu::Target& FrameDrawer::target() {
  const auto& output = scene_.settings.output;
  const auto found = targets_.find(samples_);
  if (found != targets_.end()) return found->second;
  return targets_
      .emplace(samples_, gpu::Target(output.width, output.height, samples_, gpu::Target::Format::srgb8))
      .first->second;
}

void FrameDrawer::set_effort(const Effort& effort) {
  if (samples_ != effort.samples) picture_.reset();
  samples_ = effort.samples;
  config::RelaxSettings relax = scene_.settings.relax;
  relax.rounds = effort.rounds;
  relax.interval = effort.interval;
  stepper_.set_relax(relax);
}

bool FrameDrawer::advance_to(int frame) {
  const int step = scene_.step_of_frame(frame), before = stepper_.step();
  if (!stepper_.advance_to(step)) return false;
  // A camera of the model may move while the pose does not change, and so may a body.
  const bool body_moves = geometry_ && geometry_->held && geometry_->held->outside.moves();
  stays_ = stepper_.unchanged() && before == step - 1 && picture_step_ == before &&
           scene_.settings.camera.name.empty() && !body_moves;
  frame_ = frame;
  return true;
}

std::shared_ptr<Picture> FrameDrawer::draw(FrameReport& entry, const std::string& hash) {
  const auto& output = scene_.settings.output;
  const passes::View view = scene_.view(frame_);
  if (stays_ && picture_) {
    ++copied_;
  } else {
    picture_.reset();
    if (geometry_) {
      timer_.begin("displace");
      geometry_->move(stepper_.surface(), frame_);
      timer_.end();
    }
    const gpu::Target& target = this->target();
    timer_.begin("render");
    pass_.draw(drawn(), view, target, software_);
    timer_.end();
    const passes::LeftOut& left_out = pass_.left_out();
    out_of_view_ += left_out.nothing_in_view ? 1 : 0;
    parts_out_of_view_ += left_out.nothing_in_view ? 0 : left_out.out_of_view;
    flat_parts_ += left_out.flat;
    fine_parts_ += left_out.too_fine;
    untextured_parts_ += left_out.untextured;
    const double read = wall_seconds();
    io::Image image{output.width, output.height, target.read_rgba8()};
    if (output.transparent) straighten_alpha(image.rgba);
    entry.ms["readback"] = 1e3 * (wall_seconds() - read);
    picture_ = std::make_shared<Picture>(std::move(image));
  }
  picture_step_ = stepper_.step();
  if (aov_writer_) aov_writer_->write(drawn(), view, entry.path, hash, *picture_);
  return picture_;
}

std::map<std::string, int> FrameDrawer::skipped() const {
  std::map<std::string, int> all{{"unchanged poses", stepper_.unchanged_steps()},
                                 {"idle relaxations", stepper_.idle_relaxations()},
                                 {"copied pictures", copied_},
                                 {"surfaces out of view", out_of_view_},
                                 {"masked surfaces", stepper_.masked_steps()},
                                 {"parts out of view", parts_out_of_view_},
                                 {"parts without waves", flat_parts_},
                                 {"parts of waves under two pixels", fine_parts_},
                                 {"parts without a texture to shift", untextured_parts_}};
  std::erase_if(all, [](const auto& item) { return item.second == 0; });
  return all;
}

}  // namespace plisse::pipeline
