// plisse render: load → weld → for each frame pose → skin → crush → relax → render → write.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "config/settings.h"
#include "gpu/context.h"
#include "io/model.h"
#include "pipeline/effort.h"
#include "scene/in_memory.h"

namespace plisse::pipeline {

using GlInfo = gpu::Info;

struct FrameReport;

struct RenderRequest {
  config::SceneSettings scene;
  scene::InMemory memory;
  bool skip_existing = false;     // keep a frame whose file is complete and whose hash is right
  std::string state_file;         // empty: none
  bool displace = false;          // the waves as geometry in place of shading
  std::optional<int> levels;      // with displace: how often edges are halved; none: as the waves need it
  std::string outside;            // with displace: a body that the waves keep out of (pipeline/outside.h)
  std::vector<std::string> aovs;  // of pipeline/aov.h
  double budget_ms = 0;           // from pose to picture in memory; 0: none
  double max_error = 0;           // the largest change by another round of relaxation, radians; 0: none
  int device = -1;                // −1: first that works
  std::string shader_folder;      // overrides the embedded shaders; empty: none
  // Takes the pictures in order, on the thread that called, and no picture is written: output.path,
  // skip_existing and aovs have no place then. What it throws ends the run.
  std::function<void(const FrameReport&, const io::Image&)> on_picture;
};

struct FrameReport {
  int frame = 0;
  double time_s = 0;
  std::string path;                  // empty: the picture was not written
  std::map<std::string, double> ms;  // skin, crush, relax, render, readback, encode, write
  bool skipped = false;
  std::vector<std::string>
      left_out;  // keys of RenderReport::skipped that this frame, or the steps before it, increased
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
  std::vector<Object> objects;  // in the order of the numbers in the AOV `object`, from 1
  std::vector<FrameReport> frames;
  double wavelength_m = 0;
  double fps = 0, wall_s = 0;  // fps: frames that were drawn, over the whole time
  std::map<std::string, int>
      skipped;  // what was left out and how often: "existing frames", "unchanged poses", …
  std::map<std::string, double> saved_s;  // estimates, where there was something to compare with
  bool interrupted = false;
  // fine; no_output: a frame or the state could not be written, and the run stopped; some_frames: there was
  // not enough memory for some, the others are complete; try_again: for all.
  ExitCode outcome = ExitCode::fine;
  std::string failure;  // the first error's text
};

// Called after every finished frame, from one thread: (done, total, report of that frame).
using FrameCallback = std::function<void(int, int, const FrameReport&)>;

RenderReport render(const RenderRequest& request, const FrameCallback& on_frame);

}  // namespace plisse::pipeline
