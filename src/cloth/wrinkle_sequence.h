// plisse wrinkle over time: base surfaces frame by frame → fields that move continuously with them → field
// files and meshes.
#pragma once

#include <functional>

#include "cloth/wrinkle.h"
#include "wrinkle/sequence.h"
#include "wrinkle/take_up.h"

namespace plisse::cloth {

struct WrinkleSequenceFrame;

struct WrinkleSequenceRequest {
  // The options of every frame; its scene is ignored. output and mesh are patterns. levels: 3 where
  // none are given, so that all frames have one mesh.
  WrinkleRequest each;
  std::filesystem::path bases;  // base_####.ply, or one base.ply, that `cache` moves
  std::filesystem::path cache;  // .pc2 or .mdd; empty: none
  // Or in memory: the places of each.scene's vertices from frame `first` on, in place of both.
  std::vector<shell::Positions> poses;
  std::vector<std::vector<double>> room;  // of each pose, as WrinkleScene's; empty: no body is near
  int first = 1;
  std::string frames;  // a selection; empty: all. Fields are the same in any selection.
  int fade = 6;        // see wrinkle::SequenceOptions
  wrinkle::Quality quality = wrinkle::Quality::final;
  // Takes each field that was asked for, in order.
  std::function<void(const WrinkleSequenceFrame&, const wrinkle::CoarseField&)> on_field;
  // After every key frame, and then after every frame: how many are done, of how many.
  std::function<void(bool keys, int done, int of)> progress;
};

struct WrinkleSequenceFrame {
  int frame = 1;
  wrinkle::SequenceFrame solved;  // its field is moved into the files
  // Radians, see wrinkle::phase_step; none where the frame before was not asked for.
  std::optional<double> phase_step;
  std::size_t wrinkle_free_faces = 0;
  double max_amplitude = 0;  // metres
  wrinkle::TakeUp taken;
  double upsample_s = 0;
};

struct WrinkleSequenceReport {
  std::size_t vertices = 0, faces = 0;
  int levels = 0;                            // of the meshes
  std::vector<WrinkleSequenceFrame> frames;  // that were asked for
  std::vector<int> keys;                     // of the whole clip
  std::size_t spans = 0;
  struct Output : WrinkleOutput {
    int frame = 1;
  };
  std::vector<Output> outputs;
  bool converged = true, interrupted = false;
  double wall_s = 0;
};

// Tells, as wrinkle_sequence does, what the base surfaces of frames 1 … last have that no field can stand on:
// each kind once, for the first frame that has it.
void warn_of_bases(const WrinkleScene& first, const std::vector<shell::Positions>& poses, int last);

// Throws Error, (bad_input) also where frames have different meshes.
WrinkleSequenceReport wrinkle_sequence(const WrinkleSequenceRequest& request);

}  // namespace plisse::cloth
