// The pictures of the render pass against the reference's.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gpu/target.h"
#include "pipeline/reference_scene.h"
#include "pipeline/tally.h"

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
  double silhouette_fraction() const;
  const Tally& image() const { return image_; }
  void report(std::map<std::string, PassComparison>& passes) const;

 private:
  passes::Look look() const;
  reference::Picture reference_picture(const WaveSnapshot& snapshot, const passes::View& view);

  const LoadedScene& scene_;
  const ReferenceScene& reference_;
  passes::RenderPass render_;
  gpu::Target target_;
  std::vector<reference::Texture> textures_;
  Tally image_;
  double flip_ = 0, chain_flip_ = 0;
  std::size_t covered_ = 0, silhouettes_ = 0;
};

}  // namespace plisse::pipeline
