// A model in time: builds the welded surface of a model and poses it at any moment of a clip.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/limits.h"
#include "io/model.h"
#include "mesh/surface.h"

namespace plisse::scene {

// The data of one moment that the skin pass needs. Equal poses compare equal bit for bit.
struct Pose {
  std::vector<glm::dmat4> palette;    // Surface::bind → posed, metres of the world
  std::vector<double> morph_weights;  // one per target of the surface
  std::vector<glm::dvec3> cache;  // posed positions of the welded vertices, in place of the above; or empty
  bool operator==(const Pose&) const = default;
};

// Frame n (from 1) is at (n−1)/fps seconds from the clip's start.
struct Timeline {
  double frames_per_second = 24;
  double duration = 0;  // seconds
  int frame_count = 1;  // ⌊duration·fps + 1e-3⌋ + 1
  double time(int frame) const { return (frame - 1) / frames_per_second; }
};

struct AnimationChoice {
  // Name or index, several with commas between, or "all"; empty: the first clip that has a length.
  std::string clip = {};
  double frames_per_second = 0;  // 0: 24, or a vertex cache's own rate
  std::string rest = "auto";     // auto | bind | frame:N | uv… | path of a model with the same vertices
  bool loop = false;
  Limits limits = {};  // of a file that `rest` names
};

class Animation {
 public:
  // Welds, selects the clip, finds the rest pose. Errors (exit 2): unknown clip (names the clips there are),
  // a rest file whose vertices do not match, no triangles.
  Animation(const io::Model& model, const AnimationChoice& choice);
  ~Animation();

  const Surface& surface() const;
  Surface& surface();  // parts may be switched off by the selection
  const Timeline& timeline() const;
  const std::string& clip_name() const;  // "" where the model has none
  // The pose at a frame. An entry that is not finite is replaced by its last finite value in the frames
  // requested before (in order), with one warning.
  Pose pose(int frame);
  // World matrix of a model's node at a frame (cameras).
  glm::dmat4 node_matrix(int node, int frame) const;
  struct Bounds {
    glm::dvec3 low, high;
  };
  // Over all frames of the clip (long clips and large meshes are sampled, deterministically).
  Bounds bounds() const;
  // Posed points of the whole clip, metres: at most 5000 vertices of at most 200 frames, evenly picked.
  std::vector<glm::dvec3> samples() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

// Positions of the welded vertices in a pose, in double precision on the CPU: Σ αₖ Mₖ (bind + Σ wₜ δₜ). A
// stride of n gives every n-th vertex only.
std::vector<glm::dvec3> posed(const Surface& surface, const Pose& pose, std::size_t stride = 1);

// The same pose with vertices of a cloth in other places, metres: `welded` has the surface's vertex of each;
// where several are one there, it gets their mean.
Pose with_cloth(const Surface& surface, Pose pose, const std::vector<std::uint32_t>& welded,
                const std::vector<glm::dvec3>& places);

}  // namespace plisse::scene
