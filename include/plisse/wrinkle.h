// Solved wrinkles: amplitude and phase of the waves that a thin shell takes on a base surface (Chen et al.,
// Fine Wrinkling on Coarsely Meshed Thin Shells, 2021). The height over the surface, along its normals, is
// amplitude · cos(phase). docs/wrinkle.md has the method.
#pragma once

#include <plisse/drape.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plisse {

struct WrinkleField {
  std::vector<Vector3> positions;  // of the base surface, metres
  std::vector<Triangle> triangles;
  std::vector<double> amplitude;  // one a vertex, metres, 0 or more
  // One a corner of each triangle, radians. Those of one vertex differ by multiples of 2π, but where its
  // amplitude is 0.
  std::vector<std::array<double, 3>> phase;
};

// The PLY of `plisse wrinkle`. Both throw Error(bad_input) where the field does not hold together; save_field
// also Error(no_output), and the file is whole or not there.
WrinkleField load_field(const std::filesystem::path& file);
void save_field(const std::filesystem::path& file, const WrinkleField& field);

struct WrinkleRequest {
  BaseSurface base;
  bool free_held = false;     // waves also where the surface was held; else their amplitude is 0 there
  int max_iterations = 500;   // of Newton's method
  bool mesh = false;          // the waves as geometry too
  std::optional<int> levels;  // of that mesh: how often edges are halved, 0 … 8; none: as the waves need it
  std::filesystem::path cache;  // a folder that remembers what was solved; empty: none
  MessageSink messages;
};

struct WrinkleResult {
  WrinkleField field;
  std::vector<std::array<std::uint32_t, 2>> edges;  // (smaller, larger) vertex, in lexicographic order
  std::vector<double> phase_difference;  // one an edge: phase at the larger − at the smaller, radians
  double energy = 0;                     // J, as the paper has it, before numbers of waves are made whole
  double waves = 0;                      // how many
  int iterations = 0;
  bool converged = false;
  std::string reason;  // why the solver ended
  Mesh mesh;           // where it was asked for
  int levels = 0;      // of the mesh
};

// The waves of one base surface. Throws Error: bad_input, where the surface does not hold together;
// check_failed, where the field comes out not finite.
WrinkleResult solve_wrinkles(const WrinkleRequest& request);

}  // namespace plisse
