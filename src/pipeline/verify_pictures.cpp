#include "pipeline/verify_pictures.h"
#include "pipeline/look.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/eigen_glm.h"
#include "io/picture/flip.h"
#include "reference/backdrop.h"
#include "reference/depth.h"

namespace plisse::pipeline {
namespace {

using Eigen::Vector3d;
using passes::RenderPass;

// --- tolerances, and why ---------------------------------------------------------------------------------
// Eight bits have an error of ½ of 255; interpolation and texture filtering of drivers have about eight bits
// themselves.
constexpr int image_tolerance = 4;  // of 255
constexpr double image_fraction = 0.9975;
// There are no textures but the ground map; at a sharp edge of a shadow, the difference of one texel.
constexpr int backdrop_tolerance = 2;  // of 255
// In addition to the uncertainty of an edge within reach of a texel's centre: single precision, as for
// positions.
constexpr double depth_tolerance = 1e-5;  // of the map's range
// Triangles seen edge on may appear or vanish by the rounding of their corners.
constexpr double depth_fraction = 0.999;
// Half floats have a relative error of 2⁻¹¹, and are written three times; a bilinear comparison with a depth
// that is equal up to rounding may have either result, of which little remains after the blur.
constexpr double ground_tolerance = 2e-3;  // of the light
constexpr double ground_fraction = 0.9975;

io::Image composed(const reference::Picture& picture, const std::vector<Vector3d>& behind) {
  io::Image image{picture.width, picture.height, {}};
  image.rgba.reserve(4 * behind.size());
  for (std::size_t i = 0; i < behind.size(); ++i) {
    const Vector3d linear = picture.colour[i] + (1 - picture.alpha[i]) * behind[i];
    for (const double channel : linear) {
      image.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * reference::srgb_encode(channel))));
    }
    image.rgba.push_back(255);
  }
  return image;
}

void compare_depths(const std::vector<float>& gpu, const reference::DepthMap& expected, Tally& tally) {
  for (std::size_t i = 0; i < gpu.size(); ++i) {
    const auto depth = static_cast<double>(gpu[i]);
    tally.add(std::max({expected.nearest[i] - depth, depth - expected.farthest[i], 0.0}));
  }
}

}  // namespace

PictureComparison::PictureComparison(const LoadedScene& scene, const ReferenceScene& reference,
                                     const std::string& shader_folder)
    : scene_(scene),
      reference_(reference),
      render_(look(), scene.profile, draw_parts(scene), texture_levels(scene), shader_folder),
      target_(scene.settings.output.width, scene.settings.output.height, 1, gpu::Target::Format::srgb8),
      textures_(reference_textures(scene)),
      image_(image_tolerance, "of 255", image_fraction),
      backdrop_(backdrop_tolerance, "of 255", image_fraction),
      shadow_map_(depth_tolerance, "of the range", depth_fraction),
      ground_below_(depth_tolerance, "of the range", depth_fraction),
      ground_(ground_tolerance, "of the light", ground_fraction) {}

passes::Look PictureComparison::look() const {
  passes::Look result = look_of(scene_);
  result.wireframe = false;  // lines on the surface do not belong to the pass
  return result;
}

io::Image PictureComparison::drawn(const passes::SurfaceBuffers& surface, const passes::View& view,
                                   bool transparent) {
  render_.set_transparent(transparent);
  render_.draw_all(surface, view, target_);
  return {target_.width(), target_.height(), target_.read_rgba8()};
}

reference::ShadowMap PictureComparison::compare_shadow_map(const passes::View& view,
                                                           const reference::Scene& scene) {
  const double radius = 1.02 * view.bounds_radius;
  reference::ShadowMap map;
  map.matrix =
      reference::parallel_view(to_eigen(view.bounds_centre), radius, -to_eigen(view.lights[0].direction));
  map.size = RenderPass::shadow_size;
  map.texel_size = 2 * radius / map.size;
  map.depth = render_.shadow_map();
  compare_depths(map.depth, reference::depth_map(scene.triangles, map.matrix, map.size), shadow_map_);
  return map;
}

reference::GroundMap PictureComparison::compare_ground_map(const passes::View& view,
                                                           const reference::Scene& scene,
                                                           const reference::Ground& ground,
                                                           const reference::ShadowMap& key) {
  reference::ShadowMap below;
  below.matrix = reference::view_from_below(ground, to_eigen(view.bounds_centre));
  below.size = RenderPass::below_size;
  below.depth = render_.map_from_below();
  compare_depths(below.depth, reference::depth_map(scene.triangles, below.matrix, below.size), ground_below_);

  const reference::GroundMap expected = reference::ground_map(ground, key, below);
  reference::GroundMap map{RenderPass::ground_size, {}};
  for (const glm::vec2& taken : render_.ground_map())
    map.taken.push_back(Eigen::Vector2f(taken.x, taken.y).cast<double>());
  for (std::size_t i = 0; i < map.taken.size(); ++i)
    ground_.add((map.taken[i] - expected.taken.at(i)).cwiseAbs().maxCoeff());
  return map;
}

void PictureComparison::compare(int frame, const passes::SurfaceBuffers& surface, const WaveSnapshot& gpu,
                                const WaveSnapshot& chain) {
  const passes::View view = scene_.view(frame);
  const io::Image coverage = drawn(surface, view, true), picture = drawn(surface, view, false);

  reference::Scene scene = picture_scene(reference_, gpu, view, textures_);
  std::vector<Vector3d> behind(coverage.rgba.size() / 4, to_eigen(look().background));
  std::optional<reference::ShadowMap> key;
  if (look().shadows || look().ground) key = compare_shadow_map(view, scene);
  if (look().ground) {
    const reference::Ground ground = reference::ground_under(to_eigen(view.bounds_centre), view.bounds_radius,
                                                             to_eigen(view.up), view.floor);
    behind =
        reference::backdrop(behind[0], scene.camera.view_projection, ground,
                            compare_ground_map(view, scene, ground, *key), picture.width, picture.height);
  }
  if (!look().shadows) key.reset();
  scene.lighting.shadow = key;

  const reference::Picture expected = reference::render(scene, picture.width, picture.height);
  const io::Image image = composed(expected, behind);
  std::vector<std::uint8_t> mask(behind.size());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    // Where either shows the surface: a pixel that only the shaders draw is as wrong as one that they leave
    // out.
    const int alpha = coverage.rgba[4 * i + 3];
    const bool seen = expected.triangle[i] >= 0 || alpha > 0;
    covered_ += seen ? 1 : 0;
    if (expected.silhouette[i]) {
      silhouettes_ += seen ? 1 : 0;
      continue;
    }
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      largest = std::max(largest, std::abs(double{1} * image.rgba[4 * i + c] - picture.rgba[4 * i + c]));
    }
    if (!seen) {
      backdrop_.add(largest);
      continue;
    }
    mask[i] = 1;
    image_.add(std::max(largest, std::abs(alpha - 255 * expected.alpha[i])));
  }
  flip_ = std::max(flip_, io::flip(image, picture, mask).mean);

  scene = picture_scene(reference_, chain, view, textures_);
  scene.lighting.shadow = key;
  const reference::Picture whole = reference::render(scene, picture.width, picture.height);
  chain_flip_ = std::max(chain_flip_, io::flip(composed(whole, behind), picture, mask).mean);
}

double PictureComparison::silhouette_fraction() const {
  return covered_ > 0 ? static_cast<double>(silhouettes_) / static_cast<double>(covered_) : 0;
}

void PictureComparison::report(std::map<std::string, PassComparison>& passes) const {
  passes["render"] = image_.comparison();
  passes["render.backdrop"] = backdrop_.comparison();
  if (shadow_map_.count() > 0) passes["render.shadow_map"] = shadow_map_.comparison();
  if (ground_.count() > 0) {
    passes["render.ground_below"] = ground_below_.comparison();
    passes["render.ground_map"] = ground_.comparison();
  }
}

}  // namespace plisse::pipeline
