// plisse drape: a scene → for each frame its boundary conditions → equilibrium → base surface.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cloth/cached_solves.h"
#include "cloth/drape_scene.h"

namespace plisse::cloth {

// Position of the vertices relative to obstacles, metres.
struct DrapeContact {
  int inside = 0;      // how many are in one
  double deepest = 0;  // how deep; 0: none is
  double nearest = 0;  // distance of the nearest vertex outside
};

struct DrapeFrame {
  int frame = 1;
  double load = 1;  // t
  std::string path;
  shell::Equilibrium equilibrium;  // its positions are moved into the files
  std::map<std::string, double> measures;
  std::optional<DrapeContact> contact;  // where the scene has obstacles
};

// After every step of the solver: which frame of how many, and the step.
using DrapeProgress = std::function<void(int frame, int frames, const shell::NewtonStep&)>;

struct DrapeRequest {
  DrapeScene scene;
  std::string frames;                           // a selection of the scene's frames; empty: the last alone
  std::optional<std::filesystem::path> output;  // base.ply, or base_####.ply: a file a frame; none: no file
  DrapeProgress progress;
  std::filesystem::path cache =
      {};  // folder of equilibria that were found before (solved_cache.h); empty: none
  // Takes each frame that was asked for, in order, with the positions that it came to.
  std::function<void(const DrapeFrame&, const shell::Positions&)> on_frame = {};
};

struct DrapeReport {
  std::size_t vertices = 0, faces = 0;
  std::vector<DrapeFrame> frames;  // those that were requested
  std::vector<std::filesystem::path> outputs;
  bool converged = true;  // all requested ones did
  bool interrupted = false;
  std::string failure;  // why a frame could not begin, with its number; empty: all could
  ExitCode failure_code = ExitCode::fine;
  double wall_s = 0, peak_rss_MiB = 0;
  int from_cache = 0;  // equilibria that were in the cache
  double saved_s = 0;  // time of their solves, less that of looking them up
};

// Solves the frames in order from the first. Each starts from the one before, moved to its boundary
// conditions or along with moving obstacles. Frames that are not requested are solved too, since the frames
// are the steps of the load. Several frames into one file: the first as base.ply, all of them as base.pc2
// beside it. If the solver stops before it has converged, its last state is written and marked in file and
// report. An interrupt ends the run after the current step, and the last good state is written; so does a
// frame that cannot begin (`failure`), if there is an earlier one. Throws Error.
DrapeReport drape(const DrapeRequest& request);

// The same in single steps: the start of the next frame, and its solution. `n`
// counts from 1, in order. Throws Error.
struct DrapeState {
  explicit DrapeState(const DrapeScene& scene) : positions(scene.start), loads(scene.loads) {}
  shell::Positions positions;
  shell::Loads loads;
  double load = 0;
};
double load_of_frame(const DrapeScene& scene, int n);
// Free coordinates moved at random by up to the scene's `perturb`, always with the same numbers: a flat
// compressed St. Venant-Kirchhoff sheet is in an unstable equilibrium, and would stay flat without a
// perturbation. Vertices in contact with obstacles are not moved.
shell::Positions perturbed(const DrapeScene& scene, const shell::Loads& loads,
                           const shell::Conditions& conditions, shell::Positions positions);
shell::Equilibrium solve_frame(const DrapeScene& scene, const shell::Shell& shell, int n, DrapeState& state,
                               const SolvedCache& cache, Reuse& reuse,
                               const shell::NewtonProgress& progress = {});

// Where the rest shape is curved, bending is measured from that, by mid-edge normals. Throws Error(bad_input)
// where rest and base faces do not belong together.
shell::Shell shell_of(const DrapeScene& scene);

// The base surface as PLY: `vertex` x, y, z, and held (1: all three coordinates); `face` vertex_indices and
// rest: u₀ v₀ u₁ v₁ u₂ v₂ of its corners in the plane of its rest triangle, metres. Comments carry the
// material
// ("young", "poisson", "thickness", "density", each with its SI value).
void write_base(const std::filesystem::path& path, const DrapeScene& scene, const DrapeFrame& frame,
                const shell::Positions& positions);

}  // namespace plisse::cloth
