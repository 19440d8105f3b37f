// plisse export: the wrinkles as geometry for other programs.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/mesh_file.h"
#include "pipeline/render.h"

namespace plisse::pipeline {

struct ExportRequest {
  config::SceneSettings scene;
  scene::InMemory memory;
  std::string output;         // mesh_####.ply|obj|glb, or CACHE.pc2|mdd
  std::optional<int> levels;  // how often edges are halved; none: as the waves need it
  std::string outside;        // a body that the waves stay outside of; empty: none
  int device = -1;
  std::string shader_folder;
  // Takes the meshes in place of `output`, in order; what it throws ends the run.
  std::function<void(int frame, const io::MeshFile&)> on_mesh;
};

struct ExportReport {
  struct Output {
    std::string path, kind;  // mesh | cache
    int frame = 0;           // 0 for a cache
  };
  std::vector<Output> outputs;
  int levels = 0;
  std::size_t positions = 0, triangles = 0;
  bool interrupted = false;  // meshes written so far are kept; a cache is not
  double wall_s = 0;
};

// For a run that solves before it writes: reads the model, and throws early what `export_geometry` would
// throw of the request.
void check(const ExportRequest& request);

// The displaced surface of each frame: metres, y up. Meshes have normals, uv and the materials' names; a
// cache has the vertex order of an OBJ of the same scene and levels.
ExportReport export_geometry(const ExportRequest& request, const FrameCallback& on_frame);

}  // namespace plisse::pipeline
