// plisse drape, the story: a scene → per frame what is held → equilibrium → base surface.
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

// How vertices lie beside obstacles, metres.
struct DrapeContact {
  int inside = 0;      // how many are in one
  double deepest = 0;  // how deep; 0: none is
  double nearest = 0;  // how far off the one is that comes nearest from outside
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
  std::string frames;            // a selection of the scene's frames; empty: the last alone
  std::filesystem::path output;  // base.ply, or base_####.ply: a file a frame
  DrapeProgress progress;
  std::filesystem::path cache =
      {};  // folder of equilibria that were found before (solved_cache.h); empty: none
};

struct DrapeReport {
  std::size_t vertices = 0, faces = 0;
  std::vector<DrapeFrame> frames;  // those that were asked for
  std::vector<std::filesystem::path> outputs;
  bool converged = true;  // all that were asked for
  bool interrupted = false;
  std::string failure;  // why a frame could not begin, with its number; empty: all could
  ExitCode failure_code = ExitCode::fine;
  double wall_s = 0, peak_rss_MiB = 0;
  int from_cache = 0;  // equilibria that the cache had
  double saved_s = 0;  // what they took when they were found, less looking them up
};

// Solves the frames in order from the first, each from the one before, carried to where it is held, or along
// with obstacles that move; what is
// not asked for is solved on the way: the frames are the load's steps. Several frames into one file: the
// first as base.ply, all of them as base.pc2 beside it. A solver that stops short of its rule has its last
// state written, marked in the file and the report. An interrupt ends the run after the step, with the last
// good state written; so does a frame that cannot begin
// (`failure`), once there is another to write. Throws Error.
DrapeReport drape(const DrapeRequest& request);

// The same step by step: what stands between one frame and the next, and the frame that comes after it. `n`
// counts from 1, in order. Throws Error.
struct DrapeState {
  explicit DrapeState(const DrapeScene& scene) : positions(scene.start), loads(scene.loads) {}
  shell::Positions positions;
  shell::Loads loads;
  double load = 0;
};
double load_of_frame(const DrapeScene& scene, int n);
// Free coordinates moved at random by up to the scene's `perturb`, the same way every time: a flat St.
// Venant-Kirchhoff sheet that is compressed is in equilibrium, but stays flat only if nothing disturbs it.
// What obstacles push at stays where it is.
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
