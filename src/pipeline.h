// The story of a run: load → weld → per frame pose → skin → crush → relax → render → write.
// The commands in cli/ fill a request, call one of these and print the report.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "config/frames.h"
#include "config/paint_settings.h"
#include "config/settings.h"
#include "gpu/context.h"
#include "io/import.h"
#include "mesh/measure_waves.h"
#include "pipeline/effort.h"
#include "scene/animation.h"

namespace plisse {

using GlInfo = gpu::Info;

constexpr int most_levels = 8;  // of displaced geometry: each edge in 256

struct RenderRequest {
  SceneSettings scene;
  bool skip_existing = false;     // trust a frame whose file is whole and whose hash is right
  std::string state_file;         // empty: none
  bool displace = false;          // the waves as geometry in place of shading
  std::optional<int> levels;      // with displace: how often edges are halved; none: as the waves need it
  std::string outside;            // with displace: a body that the waves keep out of (pipeline/outside.h)
  std::vector<std::string> aovs;  // of pipeline/aov.h
  double budget_ms = 0;           // from pose to picture in memory; 0: none
  double max_error = 0;           // that another round of relaxation may leave, radians; 0: none
  int device = -1;                // −1: first that works
  std::string shader_folder;      // overrides the embedded shaders; empty: none
};

struct FrameReport {
  int frame = 0;
  double time_s = 0;
  std::string path;
  std::map<std::string, double> ms;  // skin, crush, relax, render, readback, encode, write
  bool skipped = false;
  std::vector<std::string>
      left_out;  // keys of RenderReport::skipped that this frame, or steps on the way to it, added to
  std::optional<Effort> effort;    // with a budget
  std::string error;               // empty: rendered
  ExitCode code = ExitCode::fine;  // of the error
};

struct RenderReport {
  GlInfo gl;
  std::size_t render_vertices = 0, welded_vertices = 0, triangles = 0;
  std::string timer;  // "cpu" | "gpu"
  struct Object {
    std::string mesh, material;
  };
  std::vector<Object> objects;  // in the order in which the AOV `object` counts them, from 1
  std::vector<FrameReport> frames;
  double wavelength_m = 0;
  double fps = 0, wall_s = 0;  // frames that were drawn, by all the time it took
  std::map<std::string, int>
      skipped;  // what was left out and how often: "existing frames", "unchanged poses", …
  std::map<std::string, double> saved_s;  // estimates, where there was something to compare with
  bool interrupted = false;
  // fine; no_output: a frame or the state could not be written, and the run stopped; some_frames: memory was
  // too small for some, the others stand; try_again: for all.
  ExitCode outcome = ExitCode::fine;
  std::string failure;  // the first error's text
};

// Called after every finished frame, from one thread: (done, total, report of that frame).
using FrameCallback = std::function<void(int, int, const FrameReport&)>;

RenderReport render(const RenderRequest& request, const FrameCallback& on_frame);

struct PassComparison {
  double max_abs = 0, rms = 0, tolerance = 0;
  double fraction = 1, within = 1;  // of the values that have to be, and are, within the tolerance
  std::size_t compared = 0;         // values
  bool ok = true;                   // of a pass: all its parts as well
  std::string unit;                 // of max_abs: "of the bounding box", "of W", "rad", "of 255"
};

struct VerifyReport {
  bool ok = true;            // false where interrupted: what was not compared has no verdict
  bool interrupted = false;  // by a signal
  GlInfo gl;
  std::vector<int> frames;                       // those compared
  std::map<std::string, PassComparison> passes;  // skin, crush, relax, render, and parts such as crush.r
  double fraction_within_4 = 1, mean_flip = 0, silhouette_fraction = 0;
  double chain_phase_rms = 0, chain_image_flip = 0;  // of the worst frame
  double chain_phase_tolerance = 0, chain_flip_tolerance = 0;
  bool chain_ok = true;
  std::vector<std::string> failures;  // one sentence each
};

// Shader against reference, each pass fed the GPU's own inputs (state over time, rule 6). Without a frame
// selection it takes at most eight frames spread over the clip.
VerifyReport verify(const RenderRequest& request, const FrameCallback& on_frame);

// How a scene wants its model read.
io::ImportOptions import_options(const SceneSettings& scene);

struct PaintRequest {
  PaintSettings paint;
  std::string folder;  // for bias.ply, bias.png and preview.png
  int device = -1;
  std::string shader_folder;
};

struct PaintReport {
  struct Output {
    std::string path, kind;  // bias | texture | preview
  };
  std::vector<Output> outputs;
  std::size_t vertices = 0, painted_vertices = 0;  // welded; painted: |p| > 0
  double largest = 0;                              // |p|
  double wall_s = 0;
};

// Paints the rest pose of the file's scene and writes the result as vertices, as a uv texture (left out with
// a warning where the model's uv cannot carry it) and as a preview frame.
PaintReport paint_wrinkles(const PaintRequest& request);

struct ExportRequest {
  SceneSettings scene;
  std::string output;         // mesh_####.ply|obj|glb, or CACHE.pc2|mdd
  std::optional<int> levels;  // how often edges are halved; none: as the waves need it
  std::string outside;        // a body that the waves keep out of; empty: none
  int device = -1;
  std::string shader_folder;
};

struct ExportReport {
  struct Output {
    std::string path, kind;  // mesh | cache
    int frame = 0;           // 0 for a cache
  };
  std::vector<Output> outputs;
  int levels = 0;
  std::size_t positions = 0, triangles = 0;
  bool interrupted = false;  // meshes written so far stand; a cache does not
  double wall_s = 0;
};

// The displaced surface of each frame: metres, y up. Meshes have normals, uv and the materials' names; a
// cache counts the vertices as an OBJ of the same scene and levels does.
ExportReport export_geometry(const ExportRequest& request, const FrameCallback& on_frame);

struct BakeRequest {
  SceneSettings scene;
  std::string output;  // a folder
  bool height = true, normal = true;
  int texture_size = 2048;
  bool green_up = true;  // of the normal map; false: DirectX's
  std::string outside;   // a body that the waves keep out of; empty: none
  int device = -1;
  std::string shader_folder;
};

struct BakeReport {
  struct Output {
    std::string path, kind;  // height | normal
    int frame = 0;
  };
  std::vector<Output> outputs;
  double scale_m = 0;  // the height of white in height's PNG, minus that of black
  // The square of uv that the maps cover: from `corner` on, `side` long; (0, 0) and 1 but for repeating uv.
  glm::dvec2 corner{0};
  int side = 1;
  std::size_t covered = 0, overlapping = 0;  // texels
  bool interrupted = false;
  double wall_s = 0;
};

// The wrinkles of each frame over the uv of those parts that wrinkle: heights along the posed mesh's normals
// (EXR in metres, and a PNG to look at), and normals in its MikkTSpace basis. Throws Error(bad_input) where
// uv is missing or reaches over more than most_tiles; islands that overlap are a warning.
BakeReport bake_maps(const BakeRequest& request, const FrameCallback& on_frame);

struct MeasureRequest {
  std::filesystem::path mesh, base;  // base: empty for the mesh's own shape
  io::ImportOptions options;
};

// Throws Error(bad_input).
MeshSpectrum measure(const MeasureRequest& request);

// W when the scene names none: the mean edge of the wrinkling parts, kept between 1/80 and 1/12 of the rest
// diagonal.
double default_wavelength(const Surface& surface);

}  // namespace plisse
