// Draping: the equilibrium of cloth without wrinkles, which is the base surface that wrinkles stand on (Chen
// et al., Fine Wrinkling on Coarsely Meshed Thin Shells, 2021: tension-field theory). docs/drape.md has the
// method.
#pragma once

#include <plisse/mesh.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace plisse {

struct Material {
  double young = 0;      // Young's modulus, N/m², above 0
  double poisson = 0.3;  // Poisson's ratio, 0 … 0.5
  double thickness = 0;  // metres, above 0
  double density = 0;    // kg/m³; needed for gravity only
};

struct BaseSurface {
  std::vector<Vector3> positions;  // metres
  std::vector<Triangle> triangles;
  std::vector<std::array<Vector2, 3>>
      rest;                        // corners of each triangle in the plane of its rest shape, metres
  std::vector<std::uint8_t> held;  // one a vertex, 1: held while draping; or empty: none is
  Material material;
};

// A base.ply of `plisse drape`. Throws Error(bad_input).
BaseSurface load_base(const std::filesystem::path& file, const MessageSink& messages = {});

// Cloth made in memory. Its rest shape is `rest`, flat or curved; the solver begins at `start`.
struct Cloth {
  std::vector<Vector3> rest;  // metres
  std::vector<Triangle> triangles;
  std::vector<Vector3> start;      // likewise, one a vertex; empty: `rest`
  std::vector<std::uint8_t> held;  // one a vertex, 1: held where it starts; or empty: none is
  Material material;
  Vector3 gravity{};    // m/s²
  double pressure = 0;  // Pa, along the triangles' normals
};

struct DrapeFrame {
  int frame = 1;      // counted from 1
  double load = 1;    // share of the full load, 0 … 1
  double energy = 0;  // J
  int iterations = 0;
  bool converged = false;
  std::string reason;                      // why the solver ended
  std::map<std::string, double> measures;  // of the examples that have some, by name
};

struct DrapeRequest {
  // One of these three.
  std::optional<Cloth> cloth;
  std::filesystem::path file;  // a scene file (docs/drape.md), or a set-up of the method's authors
  std::string example;         // one of `plisse drape --list-examples`

  int vertices = 0;             // of an example, about; 0: its own number
  int steps = 0;                // frames in which the load grows; 0: the scene's
  std::string frames;           // a selection such as "1-48x2"; empty: the last alone
  std::filesystem::path cache;  // a folder that remembers what was solved; empty: none
  // After each frame of the selection, in order, from the thread that made the request. What it throws ends
  // the request and comes out of it.
  std::function<void(const DrapeFrame&, const BaseSurface&)> on_frame;
  std::filesystem::path output;  // base.ply or base_####.ply, as `plisse drape -o` writes it; empty: no file
  MessageSink messages;
};

struct DrapeReport {
  std::vector<DrapeFrame> frames;  // those of the selection
  bool converged = true;           // all of them
  std::string failure;             // why a later frame could not begin; empty: all could
};

// Solves the frames in order from the first, each from the one before. Throws Error: bad_input, with all that
// is wrong; no_output. A frame that does not converge is no error: look at `converged`.
DrapeReport drape(const DrapeRequest& request);

}  // namespace plisse
