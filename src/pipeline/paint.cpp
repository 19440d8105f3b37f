// plisse paint: the strokes of a paint file as vertices, as a uv texture and as a picture.
#include "pipeline/paint.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "config/paint_settings.h"
#include "config/scene_file.h"
#include "config/settings.h"
#include "io/picture/png.h"
#include "paint/bias_file.h"
#include "pipeline/loaded_scene.h"
#include "pipeline/render.h"

namespace plisse::pipeline {

namespace {

config::SceneSettings scene_to_paint(const config::PaintSettings& paint) {
  if (paint.scene.empty()) {
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: key 'scene': missing; name the scene or model to paint on", paint.file.string()));
  }
  const bool is_scene = paint.scene.extension() == ".toml" || paint.scene.extension() == ".TOML";
  config::SceneSettings settings =
      is_scene ? config::load_scene(paint.scene) : config::bare_scene(paint.scene);
  settings.bias = {};
  return settings;
}

std::size_t painted_without_uv(const Surface& surface, const std::vector<glm::dvec3>& bias) {
  std::vector<bool> has(bias.size(), false);
  for (const Part& part : surface.parts)
    for (std::size_t c = 3 * part.first_triangle; c < 3 * (part.first_triangle + part.triangle_count); ++c)
      if (part.has_uv) has[surface.render_vertices[surface.triangles[c]].welded] = true;
  std::size_t lost = 0;
  for (std::size_t v = 0; v < bias.size(); ++v) lost += bias[v] != glm::dvec3(0) && !has[v] ? 1 : 0;
  return lost;
}

}  // namespace

PaintedSurface paint_in_memory(const config::PaintSettings& paint) {
  const LoadedScene scene(scene_to_paint(paint));
  return {scene.surface().rest, scene.painted(paint).bias};
}

PaintReport paint_wrinkles(const PaintRequest& request) {
  const double started = wall_seconds();
  const config::PaintSettings& paint = request.paint;
  const config::SceneSettings settings = scene_to_paint(paint);
  const LoadedScene scene(settings);
  const paint::Painting painting = scene.painted(paint);
  const std::vector<glm::dvec3>& bias = painting.bias;

  PaintReport report;
  report.vertices = bias.size();
  for (const glm::dvec3& p : bias) {
    report.painted_vertices += p != glm::dvec3(0) ? 1 : 0;
    report.largest = std::max(report.largest, glm::length(p));
  }
  const std::filesystem::path folder = request.folder;
  const auto written = [&](const std::filesystem::path& path, const char* kind) {
    report.outputs.push_back({path.string(), kind});
  };
  const auto ply = folder / "bias.ply";
  paint::write_bias_ply(ply, scene.surface(), painting);
  written(ply, "bias");
  try {
    std::size_t moved = 0;
    const io::Image texture =
        paint::encode_bias(scene.surface(), scene.rest, bias, paint.texture_size, &moved);
    io::write_png(folder / "bias.png", texture);
    written(folder / "bias.png", "texture");
    const auto waves = paint::waves_beside(folder / "bias.png");
    if (painting.has_waves()) {
      io::write_png(waves, paint::encode_waves(scene.surface(), scene.rest, painting, paint.texture_size));
      written(waves, "waves");
    } else {
      std::filesystem::remove(waves);  // of an earlier run: it would be read with this one's bias
    }
    if (moved > 0)
      log::warn(fmt::format(
          "bias.png: {} vertices have the texel beside their own, because islands of uv overlap or {} "
          "texels a side are few; [bias] file reads it right, other programs see the first island there",
          moved, paint.texture_size));
    if (const std::size_t lost = painted_without_uv(scene.surface(), bias); lost > 0)
      log::warn(fmt::format("bias.png: {} painted vertices have no uv and are not in it; {} has them", lost,
                            ply.string()));
  } catch (const Error& error) {
    if (error.code != ExitCode::bad_input) throw;
    log::warn(fmt::format("no uv texture: {}; {} has it all", error.what(), ply.string()));
  }
  const auto laid = std::ranges::find_if(paint.strokes, [](const config::PaintStroke& stroke) {
    return stroke.kind == config::PaintStroke::Kind::field && stroke.mode == config::PaintStroke::Mode::paint;
  });
  if (laid != paint.strokes.end()) {
    const bool textured =
        std::ranges::any_of(report.outputs, [](const auto& o) { return o.kind == "texture"; });
    report.steps = field_steps(settings, laid->file, ply, textured ? folder / "bias.png" : "");
  }
  if (paint.preview_frame > 0) {
    RenderRequest preview;
    preview.scene = settings;
    preview.scene.bias.file = ply;
    preview.scene.model.frames = std::to_string(paint.preview_frame);
    preview.scene.output.path = (folder / "preview.png").string();
    preview.device = request.device;
    preview.shader_folder = request.shader_folder;
    render(preview, {});
    written(folder / "preview.png", "preview");
  }
  report.wall_s = wall_seconds() - started;
  return report;
}

}  // namespace plisse::pipeline
