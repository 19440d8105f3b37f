// plisse paint: strokes become wrinkles of the rest pose, as files.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "config/paint_settings.h"
#include "pipeline/field_steps.h"

namespace plisse::pipeline {

struct PaintRequest {
  config::PaintSettings paint;
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
  std::vector<FieldStep> steps;                    // of the first stroke that lays a solved field
  double wall_s = 0;
};

// Paints the rest pose of the file's scene and writes the result as vertices, as a uv texture (left out with
// a warning where the model's uv cannot carry it) and as a preview frame.
PaintReport paint_wrinkles(const PaintRequest& request);

// The welded vertices of the rest pose, metres, and what the strokes painted on each: along which cloth is
// gathered, and how much, 0 … 1. Writes no file.
struct PaintedSurface {
  std::vector<glm::dvec3> positions, bias;
};
PaintedSurface paint_in_memory(const config::PaintSettings& paint);

}  // namespace plisse::pipeline
