#include "pipeline/aov.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/error.h"
#include "config/suggest.h"
#include "io/picture/exr.h"
#include "io/picture/png.h"

namespace plisse::pipeline {
namespace {

std::vector<std::string> aov_names() {
  std::vector<std::string> names;
  for (const passes::AovKind& kind : passes::aov_kinds()) names.push_back(kind.name);
  return names;
}

// "frames/frame_0001.png" → "frames/frame_0001.height".
std::string stem_of(const std::string& frame_path, passes::Aov aov) {
  return std::filesystem::path(frame_path).replace_extension().string() + "." + passes::kind_of(aov).name;
}

}  // namespace

std::vector<passes::Aov> parse_aovs(const std::vector<std::string>& names) {
  std::vector<passes::Aov> aovs;
  for (const auto& name : names) {
    const auto kinds = passes::aov_kinds();
    const auto at = std::ranges::find(kinds, name, &passes::AovKind::name);
    if (at == kinds.end()) {
      throw Error(ExitCode::bad_input,
                  fmt::format("--aov {}: there is no such output{}; there are: {}", name,
                              config::did_you_mean(name, aov_names()), fmt::join(aov_names(), ", ")));
    }
    aovs.push_back(at->aov);
  }
  return aovs;
}

bool aovs_are_whole(const std::vector<passes::Aov>& aovs, const std::string& frame_path,
                    const std::string& hash) {
  return std::all_of(aovs.begin(), aovs.end(), [&](passes::Aov aov) {
    const std::string stem = stem_of(frame_path, aov);
    return std::filesystem::exists(stem + ".exr") && io::png_is_whole(stem + ".png", hash);
  });
}

AovWriter::AovWriter(const LoadedScene& scene, passes::RenderPass& pass, std::vector<passes::Aov> aovs)
    : scene_(scene),
      pass_(pass),
      aovs_(std::move(aovs)),
      target_(scene.settings.output.width, scene.settings.output.height, 1, gpu::Target::Format::rgba32f) {}

void AovWriter::write(const passes::SurfaceBuffers& surface, const passes::View& view,
                      const std::string& frame_path, const std::string& hash, Picture& frame) {
  const int width = target_.width(), height = target_.height();
  for (const passes::Aov aov : aovs_) {
    if (aov == passes::Aov::beauty) {
      write_beauty(surface, view, stem_of(frame_path, aov), hash, frame);
      continue;
    }
    pass_.draw_aov(surface, view, target_, aov);
    const std::vector<float> rgba = target_.read_rgba32f();
    const passes::AovKind& kind = passes::kind_of(aov);
    const auto metres = static_cast<float>(scene_.units.metres);
    const float unit = kind.power_of_metres > 0 ? metres : kind.power_of_metres < 0 ? 1 / metres : 1.0F;
    const int channels = kind.channels;
    std::vector<float> values;
    values.reserve(rgba.size() / 4 * static_cast<std::size_t>(channels));
    float largest = 0;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      for (int c = 0; c < channels; ++c) values.push_back(rgba[i + static_cast<std::size_t>(c)] * unit);
      largest = std::max(largest, std::abs(rgba[i]) * unit);
    }
    const float scale = kind.scale(static_cast<float>(scene_.wavelength()), largest);
    io::Image picture{width, height, std::vector<std::uint8_t>(rgba.size())};
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      const bool covered = rgba[i + 3] > 0;
      const glm::vec3 value =
          glm::clamp(kind.shown(glm::vec3(rgba[i], rgba[i + 1], rgba[i + 2]) * unit, scale), 0.0F, 1.0F);
      for (int c = 0; c < 3; ++c) {
        picture.rgba[i + static_cast<std::size_t>(c)] =
            covered ? static_cast<std::uint8_t>(std::lround(255 * value[c])) : 0;
      }
      picture.rgba[i + 3] = covered ? 255 : 0;
    }
    const std::string stem = stem_of(frame_path, aov);
    io::write_exr(stem + ".exr", width, height, channels, values);
    io::write_png(stem + ".png", picture, {.hash = hash});
  }
}

void AovWriter::write_beauty(const passes::SurfaceBuffers& surface, const passes::View& view,
                             const std::string& stem, const std::string& hash, Picture& frame) {
  const auto& output = scene_.settings.output;
  if (!beauty_) beauty_.emplace(output.width, output.height, output.samples, gpu::Target::Format::rgba32f);
  pass_.draw(surface, view, *beauty_, false);
  io::write_exr(stem + ".exr", output.width, output.height, 4, beauty_->read_rgba32f());
  write_whole_file(stem + ".png", frame.png(hash).first);
}

}  // namespace plisse::pipeline
