// Fingerprints: hashes of everything that a frame's pixels, and the state of the passes after a step, depend
// on (docs/contract.md).
#pragma once

#include <vector>

#include "base/hash.h"
#include "mesh/solved_clip.h"
#include "mesh/vertex_waves.h"
#include "passes/render.h"
#include "scene/animation.h"

namespace plisse::pipeline {

class LoadedScene;

// Of the state before the first step: the surface, its waves, and the settings of crush and relax.
Hash start_hash(const LoadedScene& scene);
// Of what all frames have in common besides their history: materials, textures, look, size.
Hash constants_hash(const LoadedScene& scene);

void add_pose(Hash& hash, const scene::Pose& pose);
void add_field(Hash& hash, const std::vector<FieldTriangle>& field);
void add_solved(Hash& hash, const SolvedClip::Frame& frame);  // its field
void add_view(Hash& hash, const passes::View& view);

}  // namespace plisse::pipeline
