// A scene for the double-precision reference: conversions from the pipeline's data and from the GPU's
// buffers, and all passes stepped together in the reference.
#pragma once

#include <optional>
#include <vector>

#include "passes/surface_buffers.h"
#include "pipeline/loaded_scene.h"
#include "reference/crush.h"
#include "reference/relax.h"
#include "reference/render.h"
#include "reference/skin.h"

namespace plisse::pipeline {

// Everything in model units, as in the passes.
struct ReferenceScene {
  explicit ReferenceScene(const LoadedScene& scene);
  // What the scene's waves have become, where each frame has its own bias.
  void take_bias();
  reference::SkinPose pose(const scene::Pose& pose) const;    // palette and morph weights
  Eigen::Matrix3Xd positions(const scene::Pose& pose) const;  // x', from bones or cache
  reference::Frames frames(const scene::Pose& pose, const Eigen::Matrix3Xd& positions) const;
  // Waves that are there from the beginning, in these frames: of the rest pose or, with a bias a frame,
  // posed.
  std::vector<reference::CrushState> first_states(const reference::Frames& frames) const;

  const LoadedScene& scene;
  reference::Topology topology;
  reference::Frames rest_frames;  // those that the passes use
  std::vector<std::uint32_t> tangent_neighbour;
  reference::SkinModel skin;
  Eigen::VectorXd wavelength, mask, first_phases;
  Eigen::Matrix2Xd wander;  // D in (t, b)
  reference::Bias bias;
  reference::CrushSettings crush;
  reference::RelaxSettings relax;
};

// The waves of one moment, from the GPU or the reference.
struct WaveSnapshot {
  Eigen::Matrix3Xd positions;
  reference::Frames frames;
  Eigen::Matrix2Xd wavenumbers;  // κ in (t', b')
  Eigen::VectorXd heights, weights, phases;
  Eigen::VectorXd compression;  // s = 1 − r
  std::vector<reference::CrushState> states;

  reference::WaveField field() const;  // world wavenumbers from the components
};
WaveSnapshot read_snapshot(const passes::SurfaceBuffers& surface);

// The surface's triangles, in their order, with the waves, the field and the normals of a snapshot; materials
// are left to picture_scene.
std::vector<reference::Triangle> reference_triangles(const ReferenceScene& scene,
                                                     const WaveSnapshot& snapshot);
reference::Profile reference_profile(const LoadedScene& scene);

// The picture of a snapshot. Textures are converted once and kept by the caller.
reference::Scene picture_scene(const ReferenceScene& scene, const WaveSnapshot& snapshot,
                               const passes::View& view, const std::vector<reference::Texture>& textures);
std::vector<reference::Texture> reference_textures(const LoadedScene& scene);

// All passes in double precision, each with the results of the one before as input.
class ReferenceChain {
 public:
  explicit ReferenceChain(const ReferenceScene& scene);
  // `step` decides where a loop's phases are stored and approached (LoadedScene). `first_directions`: k of
  // the run to compare with, an entry a vertex; a direction that is set for the first time takes the sign of
  // that one, since its sign is arbitrary and the phases of the onset depend on it.
  void step(int step, const scene::Pose& pose, bool with_crush,
            const std::vector<Eigen::Vector2d>& first_directions);
  const WaveSnapshot& now() const { return now_; }

 private:
  const ReferenceScene& scene_;
  WaveSnapshot now_;
  void crush_and_relax(bool leads);
  void lead(reference::Status which, double share);
  std::optional<scene::Pose> last_, crushed_;
  std::vector<Eigen::Vector2d> first_directions_;
  WaveSnapshot remembered_;
};

}  // namespace plisse::pipeline
