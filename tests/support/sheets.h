// Small welded surfaces made by hand, and the passes run on them.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "mesh/model_units.h"
#include "mesh/surface.h"
#include "mesh/vertex_waves.h"
#include "passes/crush.h"
#include "passes/relax.h"
#include "passes/skin.h"
#include "passes/surface_buffers.h"

namespace plisse::test {

// A surface with what the passes want to know of it. Change the parts, then hand it to `Passes`.
struct Sheet {
  Surface surface;
  RestFrames rest;
  VertexWaves waves;
  ModelUnits units;

  std::size_t size() const { return surface.vertex_count(); }
};

// Vertices that one matrix moves, with triangles (three ids each), normals +z where no triangle says
// otherwise, wavelength W and mask 1. uv is (x, y).
Sheet sheet(const std::vector<glm::dvec3>& points, const std::vector<std::uint32_t>& triangles, double W = 1);

// columns × rows vertices in the plane z = 0, `spacing` apart and each moved by up to `jitter` spacings, the
// first at the origin; `copies` of it that know nothing of each other, each jittered its own way.
Sheet grid(int columns, int rows, double spacing, double jitter, unsigned seed, double W = 1, int copies = 1);

// Positions of all vertices under a map.
std::vector<glm::dvec3> mapped(const Sheet& sheet, const std::function<glm::dvec3(const glm::dvec3&)>& map);

// What the passes left, read back. `wave`: κ in the world, in turns per model unit.
struct Readings {
  std::vector<glm::dvec3> position, normal, tangent, wave;
  std::vector<glm::dvec2> direction;                       // k in (t, b) of the rest pose
  std::vector<double> height, weight, phase, compression;  // h in model units; s = 1 − r
  std::vector<int> status;                                 // 0 idle, 1 set, 2 fresh
};

Readings read(const passes::SurfaceBuffers& buffers);

// The passes on one sheet.
class Passes {
 public:
  explicit Passes(const Sheet& sheet, std::size_t palette_size = 1, std::uint32_t seed = 1);

  void pose(const std::vector<glm::dmat4>& palette, const std::vector<double>& target_weights = {});
  void pose(const std::vector<glm::dvec3>& positions);  // in the sheet's own unit
  void crush(double dead_zone = 0.005, bool always_set = false);
  void relax(const passes::RelaxOptions& options);
  Readings read() const { return test::read(buffers); }
  // Overwrites what relax works on: world wavenumbers with weights, and phases with status.
  void set_waves(const std::vector<glm::dvec3>& waves, const std::vector<double>& weights);
  void set_phases(const std::vector<double>& phases, const std::vector<int>& status);

  passes::SurfaceBuffers buffers;

 private:
  ModelUnits units_;
  passes::SkinPass skin_;
  passes::CrushPass crush_;
  passes::RelaxPass relax_;
};

// x − ⌈x − ½⌉: to (−½, ½].
double wrap(double turns);
double wrap_radians(double radians);

// d of docs/passes.md, "Relax", in turns, from vertex `own` to its neighbour.
double disagreement(const Readings& now, std::size_t own, std::size_t neighbour);
// E[d²] over directed edges between vertices with w > 0 that have a phase, in turns².
double misfit(const Surface& surface, const Readings& now);

}  // namespace plisse::test
