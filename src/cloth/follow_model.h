// Any animated model → base surfaces that follow it (shell/follow.h), which wrinkles can stand on.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cloth/wrinkle.h"
#include "config/settings.h"
#include "shell/follow.h"

namespace plisse::cloth {

struct FollowRequest {
  config::SceneSettings scene;   // model, clip, rest shape, selection of parts
  std::string frames;            // a selection; empty: all
  std::optional<double> follow;  // Λ, m; none: 8 mean rest edges of each shell for sequences and caches, 4
                                 // for skins and morphs; 0: the pose itself
  double tension_limit = 0.05;   // of shell::StretchingLaw; 0: none
  std::optional<shell::Material> material;  // none: one whose waves have the `wavelength`
  std::optional<double> wavelength;         // m, > 0, in the median over the clip; none: 3 mean rest edges
  std::function<void(int done, int of)> progress;
};

struct FollowedFrame {
  int frame = 1;
  double moved_rms = 0, moved_most = 0;  // m, from the pose
  double length_kept = 1;                // median of edges' lengths over those at rest
  int iterations = 0;
  int still = 0;  // shells that are only moved or scaled as a whole: nothing was solved
  bool converged = false;
  double seconds = 0;
};

struct FollowReport {
  // Of the first frame; topology, rest and material are those of all. No chords: facets of a given animation
  // have their full length.
  WrinkleScene first;
  std::vector<shell::Positions> bases;  // from the first picked frame to the last
  std::vector<FollowedFrame> frames;    // the same
  std::vector<int> picked;
  std::size_t shells = 0;
  double follow = 0;      // m: Λ of the largest shell
  double wavelength = 0;  // m: what a material was chosen for, where none was given
  bool interrupted = false;
};

// Throws Error(bad_input) for what is wrong with the model or the selection. Warns, once, of triangles
// without area, which are left out, and of faces at edges of three or more, which are cut loose.
FollowReport follow_model(const FollowRequest& request);

}  // namespace plisse::cloth
