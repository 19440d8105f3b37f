// Compares the pictures of the render pass with the reference's: the surface, the backdrop, and the maps for
// the shadows of both.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu/target.h"
#include "io/picture/image.h"
#include "pipeline/reference_scene.h"
#include "pipeline/tally.h"
#include "reference/ground.h"

namespace plisse::pipeline {

class PictureComparison {
 public:
  // The scene's own size, one sample. Both outlive this.
  PictureComparison(const LoadedScene& scene, const ReferenceScene& reference,
                    const std::string& shader_folder);

  // Draws the contents of the buffers and compares; `chain`: the same moment from double precision alone.
  void compare(int frame, const passes::SurfaceBuffers& surface, const WaveSnapshot& gpu,
               const WaveSnapshot& chain);

  // Of the worst frame.
  double mean_flip() const { return flip_; }
  double chain_flip() const { return chain_flip_; }
  // The share, among pixels where the shaders or the reference show the surface, of silhouette pixels
  // (reference/render.h), which are not compared.
  double silhouette_fraction() const;
  // Over the pixels that show the surface.
  const Tally& image() const { return image_; }
  void report(std::map<std::string, PassComparison>& passes) const;

 private:
  passes::Look look() const;
  io::Image drawn(const passes::SurfaceBuffers& surface, const passes::View& view, bool transparent);
  // Compares the depth maps and the ground map of the last picture with the reference's; the reference's own
  // picture then uses the GPU's maps for its shadows (rule 6).
  reference::ShadowMap compare_shadow_map(const passes::View& view, const reference::Scene& scene);
  reference::GroundMap compare_ground_map(const passes::View& view, const reference::Scene& scene,
                                          const reference::Ground& ground, const reference::ShadowMap& key);

  const LoadedScene& scene_;
  const ReferenceScene& reference_;
  passes::RenderPass render_;
  gpu::Target target_;
  std::vector<reference::Texture> textures_;
  Tally image_, backdrop_, shadow_map_, ground_below_, ground_;
  double flip_ = 0, chain_flip_ = 0;
  std::size_t covered_ = 0, silhouettes_ = 0;
};

}  // namespace plisse::pipeline
