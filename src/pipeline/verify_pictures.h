// The pictures of the render pass against the reference's: the surface, what stands behind it, and the maps
// that both take shadows from.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu/target.h"
#include "io/image.h"
#include "pipeline/reference_scene.h"
#include "pipeline/tally.h"
#include "reference/ground.h"

namespace plisse::pipeline {

class PictureComparison {
 public:
  // The scene's own size, one sample. Both outlive this.
  PictureComparison(const LoadedScene& scene, const ReferenceScene& reference,
                    const std::string& shader_folder);

  // Draws what the buffers hold and compares; `chain`: the same moment come by in double precision alone.
  void compare(int frame, const passes::SurfaceBuffers& surface, const WaveSnapshot& gpu,
               const WaveSnapshot& chain);

  // Of the worst frame.
  double mean_flip() const { return flip_; }
  double chain_flip() const { return chain_flip_; }
  // Of the pixels where the shaders or the reference show the surface: those whose value an honest rasteriser
  // may choose (reference/render.h), so that they are not compared.
  double silhouette_fraction() const;
  // Over the pixels that show the surface.
  const Tally& image() const { return image_; }
  void report(std::map<std::string, PassComparison>& passes) const;

 private:
  passes::Look look() const;
  io::Image drawn(const passes::SurfaceBuffers& surface, const passes::View& view, bool transparent);
  // The depth maps and the ground's as the last picture left them, compared with the reference's; the
  // reference's own picture then takes its shadows from the GPU's maps (rule 6).
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
