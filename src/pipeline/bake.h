// plisse bake: the wrinkles as height and normal maps.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "pipeline/render.h"

namespace plisse::pipeline {

// Of one frame, rows from top to bottom, islands widened.
struct BakedMaps {
  int frame = 0, size = 0;          // texels a side
  glm::dvec2 corner;                // as in BakeReport
  int side = 1;                     // likewise
  std::vector<float> height;        // metres
  std::vector<glm::dvec3> normals;  // in the tangent basis, unit; y as green_up says
};

struct BakeRequest {
  config::SceneSettings scene;
  scene::InMemory memory;
  std::string output;  // a folder
  bool height = true, normal = true;
  int texture_size = 2048;
  bool green_up = true;  // of the normal map; false: DirectX's
  std::string outside;   // a body that the waves stay outside of; empty: none
  int device = -1;
  std::string shader_folder;
  // Takes both maps in place of `output`, in order; what it throws ends the run.
  std::function<void(const BakedMaps&)> on_maps;
};

struct BakeReport {
  struct Output {
    std::string path, kind;  // height | normal
    int frame = 0;
  };
  std::vector<Output> outputs;
  double scale_m = 0;  // white is this height in the height PNG, black its negative
  // The square of uv that the maps cover: from `corner` on, `side` long; (0, 0) and 1 except for repeating
  // uv.
  glm::dvec2 corner{0};
  int side = 1;
  std::size_t covered = 0, overlapping = 0;  // texels
  bool interrupted = false;
  double wall_s = 0;
};

// For a run that solves before it bakes: reads the model, and throws early what `bake_maps` would throw of
// the request, the uv among it.
void check(const BakeRequest& request);

// The wrinkles of each frame in the uv of the wrinkling parts: heights along the posed mesh's normals (EXR in
// metres, and a viewable PNG), and normals in its MikkTSpace basis. Throws Error(bad_input) where uv is
// missing or reaches over more than most_tiles; islands that overlap are a warning.
BakeReport bake_maps(const BakeRequest& request, const FrameCallback& on_frame);

}  // namespace plisse::pipeline
