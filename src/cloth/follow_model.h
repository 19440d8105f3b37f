// Any animated model → base surfaces that follow it (shell/follow.h), which wrinkles can stand on.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "cloth/cached_solves.h"
#include "cloth/cloth_of_surface.h"
#include "cloth/wrinkle.h"
#include "config/settings.h"
#include "io/model.h"

namespace plisse::cloth {

struct FollowRequest {
  config::SceneSettings scene;  // model, clip, rest shape, selection of parts, [solve]; wrinkles.wavelength
  std::filesystem::path cache;  // folder of bases that were found before (solved_cache.h); empty: none
  std::function<void(int done, int of)> progress;
};

struct FollowedFrame {
  int frame = 1;
  double moved_rms = 0, moved_most = 0;  // m, from the pose
  double length_kept = 1;                // median of edges' lengths over those at rest
  int iterations = 0;
  int still = 0;            // shells that are only moved or scaled as a whole: nothing was solved
  int brought_out = 0;      // vertices that the model has inside a body
  double nearest_body = 0;  // m: the smallest distance of the surface from a body; 0: there is none
  bool converged = false;
  double seconds = 0;
};

struct FollowReport {
  std::shared_ptr<const io::Model> model;
  Cloth cloth;
  int welded = 0;  // vertices of the model's surface
  // Of the first frame; topology, rest and material are those of all. No chords: facets of a given animation
  // have their full length.
  WrinkleScene first;
  std::vector<shell::Positions> bases;  // of every frame of the clip
  // The same, but that shells which are only scaled as a whole have their size at rest: what fields are for.
  std::vector<shell::Positions> strained;
  std::vector<std::vector<double>> room;  // of every frame, as WrinkleScene's; empty: no body is near
  std::vector<FollowedFrame> frames;      // the same
  std::size_t shells = 0;
  double follow = 0;      // m: Λ of the largest shell
  double wavelength = 0;  // m: what a material was chosen for, where no fabric was given
  Reuse reuse;
  bool interrupted = false;
};

// Follows the whole clip, since the cloth of a scene without a fabric depends on all of it. Throws
// Error(bad_input) for what is wrong with the model, the selection or the fabric. Warns, once, of triangles
// without area, which are left out, and of edges of three faces or more, at which sheets are parted.
FollowReport follow_model(const FollowRequest& request);

}  // namespace plisse::cloth
