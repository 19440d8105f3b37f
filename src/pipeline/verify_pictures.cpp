#include "pipeline/verify_pictures.h"

#include <cmath>

#include "io/flip.h"

namespace plisse::pipeline {
namespace {

// Eight bits keep ½ of 255; interpolation and texture filtering of drivers keep about eight bits themselves.
constexpr int image_tolerance = 4;  // of 255
constexpr double image_fraction = 0.9975;

io::Image to_image(const std::vector<Eigen::Vector3d>& linear, const io::Image& backdrop,
                   const std::vector<int>& triangle) {
  io::Image image = backdrop;
  for (std::size_t i = 0; i < linear.size(); ++i) {
    if (triangle[i] < 0) continue;
    for (int c = 0; c < 3; ++c) {
      image.rgba[4 * i + static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(
          std::lround(255 * reference::srgb_encode(std::clamp(linear[i][c], 0.0, 1.0))));
    }
    image.rgba[4 * i + 3] = 255;
  }
  return image;
}

}  // namespace

PictureComparison::PictureComparison(const LoadedScene& scene, const ReferenceScene& reference,
                                     const std::string& shader_folder)
    : scene_(scene),
      reference_(reference),
      render_(look(), scene.profile, scene.draw_parts(), scene.texture_levels(), shader_folder),
      target_(scene.settings.output.width, scene.settings.output.height, 1, gpu::Target::Format::srgb8),
      textures_(reference_textures(scene)),
      image_(image_tolerance, "of 255", image_fraction) {}

passes::Look PictureComparison::look() const {
  passes::Look result = scene_.look();
  result.wireframe = false;  // lines over the surface are no part of the pass
  result.transparent = false;
  return result;
}

reference::Picture PictureComparison::reference_picture(const WaveSnapshot& snapshot,
                                                        const passes::View& view) {
  reference::Scene scene = picture_scene(reference_, snapshot, view, textures_);
  if (look().shadows) {
    reference::ShadowMap map;
    const glm::dmat4 to_clip =
        glm::dmat4(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, -1, -1, -1, 1) * render_.shadow_matrix();
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) map.matrix(r, c) = to_clip[c][r];
    }
    map.size = passes::RenderPass::shadow_size;
    map.depth = render_.shadow_map();
    map.texel_size = render_.shadow_texel();
    scene.lighting.shadow = std::move(map);
  }
  return reference::render(scene, target_.width(), target_.height());
}

void PictureComparison::compare(int frame, const passes::SurfaceBuffers& surface, const WaveSnapshot& gpu,
                                const WaveSnapshot& chain) {
  const passes::View view = scene_.view(frame);
  render_.draw(surface, view, target_);
  const io::Image picture{target_.width(), target_.height(), target_.read_rgba8()};
  const reference::Picture expected = reference_picture(gpu, view);
  const io::Image image = to_image(expected.colour, picture, expected.triangle);
  std::vector<std::uint8_t> mask(expected.triangle.size());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (expected.triangle[i] < 0) continue;
    ++covered_;
    if (expected.silhouette[i]) {
      ++silhouettes_;
      continue;
    }
    mask[i] = 1;
    int largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      largest = std::max(largest, std::abs(int{image.rgba[4 * i + c]} - int{picture.rgba[4 * i + c]}));
    }
    image_.add(largest);
  }
  flip_ = std::max(flip_, io::flip(image, picture, mask).mean);
  const reference::Picture whole = reference_picture(chain, view);
  chain_flip_ =
      std::max(chain_flip_, io::flip(to_image(whole.colour, picture, whole.triangle), picture, mask).mean);
}

double PictureComparison::silhouette_fraction() const {
  return covered_ > 0 ? static_cast<double>(silhouettes_) / static_cast<double>(covered_) : 0;
}

void PictureComparison::report(std::map<std::string, PassComparison>& passes) const {
  passes["render"] = image_.comparison();
}

}  // namespace plisse::pipeline
