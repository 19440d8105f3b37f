#include "pipeline/aov.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/atomic_file.h"
#include "base/error.h"
#include "config/suggest.h"
#include "io/exr.h"
#include "io/png.h"

namespace plisse::pipeline {
namespace {

const std::vector<std::string>& aov_names() {
  static const std::vector<std::string> names{"height",  "normal", "amplitude", "phase", "direction",
                                              "tension", "depth",  "object",    "beauty"};
  return names;
}

bool is_vector(passes::Aov aov) {
  return aov == passes::Aov::normal || aov == passes::Aov::direction;
}

// 0…1 for the picture to look at. `scale`: what counts as large for this quantity.
glm::vec3 shown(passes::Aov aov, const glm::vec3& value, float scale) {
  switch (aov) {
    case passes::Aov::normal:
    case passes::Aov::direction:
      return 0.5F * value + 0.5F;
    case passes::Aov::height:
      return glm::vec3(0.5F + 0.5F * value.x / scale);
    case passes::Aov::phase: {  // a hue circle, so that −π and π look alike
      const auto hue = [&](float shift) { return 0.5F + 0.5F * std::cos(value.x - shift); };
      const float third = 2.0F * std::numbers::pi_v<float> / 3.0F;
      return {hue(0), hue(third), hue(-third)};
    }
    case passes::Aov::tension:  // grey at rest, red where compressed, blue where stretched
      return value.x >= 0 ? glm::vec3(0.75F, 0.75F - 2 * value.x, 0.75F - 2 * value.x)
                          : glm::vec3(0.75F + 2 * value.x, 0.75F + 2 * value.x, 0.75F);
    case passes::Aov::object: {  // hues far apart for numbers that follow each other
      const float hue = 6.2831853F * std::fmod(value.x * 0.61803399F, 1.0F);
      return {0.55F + 0.4F * std::cos(hue), 0.55F + 0.4F * std::cos(hue - 2.0944F),
              0.55F + 0.4F * std::cos(hue + 2.0944F)};
    }
    case passes::Aov::amplitude:
    case passes::Aov::depth:
    case passes::Aov::beauty:
      break;
  }
  return glm::vec3(value.x / scale);
}

// "frames/frame_0001.png" → "frames/frame_0001.height".
std::string stem_of(const std::string& frame_path, passes::Aov aov) {
  return std::filesystem::path(frame_path).replace_extension().string() + "." +
         aov_names()[static_cast<std::size_t>(aov)];
}

}  // namespace

std::vector<passes::Aov> parse_aovs(const std::vector<std::string>& names) {
  std::vector<passes::Aov> aovs;
  for (const auto& name : names) {
    const auto at = std::find(aov_names().begin(), aov_names().end(), name);
    if (at == aov_names().end()) {
      throw Error(ExitCode::bad_input,
                  fmt::format("--aov {}: there is no such output{}; there are: {}", name,
                              config::did_you_mean(name, aov_names()), fmt::join(aov_names(), ", ")));
    }
    aovs.push_back(static_cast<passes::Aov>(at - aov_names().begin()));
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
    const bool length =
        aov == passes::Aov::height || aov == passes::Aov::amplitude || aov == passes::Aov::depth;
    const float unit = length ? static_cast<float>(scene_.units.metres) : 1.0F;
    const int channels = is_vector(aov) ? 3 : 1;
    std::vector<float> values;
    values.reserve(rgba.size() / 4 * static_cast<std::size_t>(channels));
    float largest = 0;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      for (int c = 0; c < channels; ++c) values.push_back(rgba[i + static_cast<std::size_t>(c)] * unit);
      largest = std::max(largest, std::abs(rgba[i]) * unit);
    }
    const float scale =
        aov == passes::Aov::depth ? std::max(largest, 1e-30F) : static_cast<float>(scene_.wavelength() / 4);
    io::Image picture{width, height, std::vector<std::uint8_t>(rgba.size())};
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      const bool covered = rgba[i + 3] > 0;
      const glm::vec3 value =
          glm::clamp(shown(aov, glm::vec3(rgba[i], rgba[i + 1], rgba[i + 2]) * unit, scale), 0.0F, 1.0F);
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
