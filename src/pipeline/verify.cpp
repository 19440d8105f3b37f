// Shader against reference, pass by pass: each pass of the reference is fed what the GPU's own pass was fed,
// so that the error of one is not charged to the next (docs/contract.md, "State over time", rule 6). The
// drift of the whole chain is reported apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "config/frames.h"
#include "io/flip.h"
#include "pipeline.h"
#include "pipeline/reference_scene.h"
#include "pipeline/stepper.h"
#include "reference/functions.h"

namespace plisse {
namespace {

using Eigen::Index;
using pipeline::ReferenceScene;
using pipeline::WaveSnapshot;
using reference::Status;

// --- tolerances, and why
// ------------------------------------------------------------------------------------------------ Single
// precision keeps 6e-8 of a number; a sum over eight influences of products of three keeps about ten times
// that.
constexpr double skin_tolerance = 1e-6;  // of the bounding box
// n' and t' come from differences of positions, which lose the ratio of edge to box, 1e-2 and less: 1e-7 /
// 1e-2, times ten.
constexpr double frame_tolerance = 1e-4;  // of a unit vector, where the areas do not cancel below 1e-2
// The same differences, squared by the regression.
constexpr double r_tolerance = 1e-5;
// dh/dr = (W/4) r/√(1−r²): 2.5 at the edge of the default dead zone.
constexpr double height_tolerance = 1e-5;  // of W, outside the dead zone
// Inside it the easing is steep: dh/dr reaches (W/4)√(2δ) · 3/δ, 15 W at δ = .005, times errors of 1e-6 in r.
constexpr double easing_tolerance = 1e-4;  // of W
// A direction is as certain as the gap between the singular values: errors of 1e-6 over the gap, weighted by
// it again.
constexpr double wave_vector_tolerance = 1e-4;
// Ten rounds multiply errors of 1e-6 turns by the rounds and the neighbours; where |d| passes ½ the wrap may
// differ.
constexpr double phase_tolerance = 1e-3;  // rad
constexpr double phase_fraction = 0.999;  // of wrinkled vertices
constexpr int phase_rounds = 10;
// Eight bits keep ½ of 255; interpolation and texture filtering of drivers keep about eight bits themselves.
constexpr int image_tolerance = 4;  // of 255
constexpr double image_fraction = 0.9975;
constexpr double flip_tolerance = 0.02;
constexpr int largest_side = 640;  // of the pictures compared: the reference is no renderer for 4k

double wrapped_difference(double a, double b) {
  return std::remainder(a - b, 2 * reference::pi);
}

// Gathers the errors of one kind over vertices and frames.
class Tally {
 public:
  Tally(double tolerance, std::string unit) : tolerance_(tolerance), unit_(std::move(unit)) {}
  void add(double error) {
    if (!std::isfinite(error)) error = INFINITY;
    largest_ = std::max(largest_, error);
    squares_ += error * error;
    count_ += 1;
    within_ += error <= tolerance_ ? 1 : 0;
  }
  double within() const { return count_ > 0 ? within_ / count_ : 1; }
  double largest() const { return largest_; }
  // ok: every error within the tolerance, or the fraction that is asked for.
  PassComparison comparison(double fraction = 1) const {
    return {largest_, count_ > 0 ? std::sqrt(squares_ / count_) : 0, tolerance_, within() >= fraction, unit_};
  }

 private:
  double tolerance_, largest_ = 0, squares_ = 0, count_ = 0, within_ = 0;
  std::string unit_;
};

// How well the posed triangles determine a normal: |Σ areas| over Σ |e||e|.
double normal_certainty(const reference::Topology& topology, const Eigen::Matrix3Xd& positions,
                        Index vertex) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  double size = 0;
  for (const Corner& corner : reference::row(topology.corners, vertex)) {
    const Eigen::Vector3d p = positions.col(corner.second) - positions.col(vertex);
    const Eigen::Vector3d q = positions.col(corner.third) - positions.col(vertex);
    area += p.cross(q);
    size += p.norm() * q.norm();
  }
  return size > 0 ? area.norm() / size : 0;
}

io::Image to_image(const std::vector<Eigen::Vector3d>& linear, const io::Image& backdrop,
                   const std::vector<int>& triangle) {
  io::Image image = backdrop;
  for (std::size_t i = 0; i < linear.size(); ++i) {
    if (triangle[i] < 0) continue;
    for (int c = 0; c < 3; ++c) {
      image.rgba[4 * i + static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(
          std::lround(255 * reference::srgb_encode(std::clamp(linear[i][c], 0.0, 1.0))));
    }
    image.rgba[4 * i + 3] = 255;
  }
  return image;
}

class Verifier {
 public:
  Verifier(const RenderRequest& request)
      : scene_(small(request.scene)),
        reference_(scene_),
        chain_(reference_),
        context_(request.device),
        timer_(context_.info().software),
        stepper_(scene_, timer_, request.shader_folder),
        scratch_relax_(request.shader_folder),
        render_(look(), scene_.profile, scene_.draw_parts(), scene_.texture_levels(), request.shader_folder),
        target_(scene_.settings.output.width, scene_.settings.output.height, 1, gpu::Target::Format::srgb8),
        textures_(pipeline::reference_textures(scene_)) {}

  VerifyReport run(const FrameCallback& on_frame) {
    VerifyReport report;
    report.gl = context_.info();
    report.frames = picked();
    stepper_.observer = [this](pipeline::Stepper::Stage stage) { observe(stage); };
    int done = 0;
    const int last = scene_.step_of_frame(report.frames.back());
    for (int step = 1; step <= last && !interrupted(); ++step) {
      const int frame = scene_.frame_of_step(step);
      pose_ = scene_.pose(step);
      looking_ = step == scene_.step_of_frame(frame) &&
                 std::binary_search(report.frames.begin(), report.frames.end(), frame);
      before_ = looking_ ? pipeline::read_snapshot(stepper_.surface()) : WaveSnapshot{};
      chain_.step(step, pose_, stepper_.crush_runs_at(step));
      stepper_.advance_to(step);
      if (!looking_) continue;
      compare_pictures(frame);
      FrameReport entry;
      entry.frame = frame;
      entry.time_s = scene_.animation.timeline().time(frame);
      if (on_frame) on_frame(++done, static_cast<int>(report.frames.size()), entry);
    }
    finish(report);
    return report;
  }

 private:
  static SceneSettings small(SceneSettings settings) {
    auto& output = settings.output;
    const double scale =
        static_cast<double>(largest_side) / std::max({output.width, output.height, largest_side});
    output.width = std::max(1, static_cast<int>(output.width * scale));
    output.height = std::max(1, static_cast<int>(output.height * scale));
    output.transparent = false;
    return settings;
  }
  passes::Look look() const {
    passes::Look result = scene_.look();
    result.wireframe = false;  // lines over the surface are no part of the pass
    return result;
  }

  std::vector<int> picked() const {
    const int count = scene_.animation.timeline().frame_count;
    if (!scene_.settings.model.frames.empty()) return select_frames(scene_.settings.model.frames, count);
    std::vector<int> frames;
    const int wanted = std::min(8, count);
    for (int i = 0; i < wanted; ++i) frames.push_back(1 + (wanted > 1 ? i * (count - 1) / (wanted - 1) : 0));
    return frames;
  }

  void observe(pipeline::Stepper::Stage stage) {
    if (!looking_) return;
    const WaveSnapshot now = pipeline::read_snapshot(stepper_.surface());
    switch (stage) {
      case pipeline::Stepper::Stage::posed:
        compare_skin(now);
        break;
      case pipeline::Stepper::Stage::crushed:
        compare_crush(now);
        crushed_ = now;
        compare_ten_rounds();
        break;
      case pipeline::Stepper::Stage::relaxed:
        compare_relax(crushed_, now, reference_.relax, relax_);
        break;
    }
  }

  void compare_skin(const WaveSnapshot& gpu) {
    const Eigen::Matrix3Xd positions = reference_.positions(pose_);
    const double box = (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).norm();
    const reference::Frames frames = reference_.frames(pose_, gpu.positions);
    for (Index v = 0; v < positions.cols(); ++v) {
      skin_.add((positions.col(v) - gpu.positions.col(v)).norm() / std::max(box, 1e-30));
      if (normal_certainty(reference_.topology, gpu.positions, v) < 1e-2) continue;
      frame_.add((frames.normal.col(v) - gpu.frames.normal.col(v)).norm());
      // The tangent's own condition: how much of its edge lies in the tangent plane.
      const Eigen::Vector3d edge =
          gpu.positions.col(reference_.tangent_neighbour[static_cast<std::size_t>(v)]) - gpu.positions.col(v);
      const double part =
          edge.norm() > 0
              ? (edge - edge.dot(frames.normal.col(v)) * frames.normal.col(v)).norm() / edge.norm()
              : 0;
      if (part > 1e-2) frame_.add((frames.tangent.col(v) - gpu.frames.tangent.col(v)).norm());
    }
  }

  void compare_crush(const WaveSnapshot& gpu) {
    const auto expected =
        reference::crush(reference_.topology, reference_.rest_frames, gpu.positions, gpu.frames,
                         reference_.wavelength, reference_.mask, reference_.crush, before_.states);
    for (std::size_t v = 0; v < expected.size(); ++v) {
      const auto& e = expected[v];
      const auto i = static_cast<Index>(v);
      const double W = reference_.wavelength[i];
      r_.add(std::abs(1 - gpu.compression[i] - e.r) / std::max(1.0, e.r));
      (1 - e.r > reference_.crush.dead_zone ? height_ : easing_).add(std::abs(gpu.heights[i] - e.height) / W);
      if (e.direction.norm() == 0 || gpu.states[v].direction.norm() == 0) continue;
      Eigen::Vector2d own = gpu.wavenumbers.col(i) * W;
      // At its first taking a direction's sign is free.
      if (before_.states[v].direction.norm() == 0 && own.dot(e.wave_vector) < 0) own = -own;
      // A dot product of 0 decides the sign: where it is that close, either is right.
      wave_vector_.add(e.gap * std::min((own - e.wave_vector).norm(), (own + e.wave_vector).norm()) /
                       std::max(1.0, e.wave_vector.norm()));
    }
  }

  void compare_relax(const WaveSnapshot& before, const WaveSnapshot& after,
                     const reference::RelaxSettings& settings, Tally& tally) {
    reference::WaveField field = before.field();
    reference::relax(reference_.topology, field, settings);
    for (Index v = 0; v < field.phases.size(); ++v) {
      if (field.status[static_cast<std::size_t>(v)] == Status::set && field.weights[v] > 0) {
        tally.add(std::abs(wrapped_difference(field.phases[v], after.phases[v])));
      }
    }
  }

  // Ten rounds whatever the scene's own number, on a copy of the phases.
  void compare_ten_rounds() {
    auto& surface = stepper_.surface();
    const auto phases = surface.phases.read<glm::vec2>();
    std::uint32_t fresh = 0;
    surface.counter.read(&fresh, sizeof fresh);
    auto options = pipeline::relax_options(scene_.settings.relax);
    options.rounds = phase_rounds;
    scratch_relax_.run(surface, options);
    reference::RelaxSettings settings = reference_.relax;
    settings.descent_rounds = phase_rounds;
    compare_relax(crushed_, pipeline::read_snapshot(surface), settings, ten_rounds_);
    surface.phases.write(phases);
    surface.counter.write(&fresh, sizeof fresh);
  }

  reference::Picture reference_picture(const WaveSnapshot& snapshot, const passes::View& view) {
    reference::Scene scene = pipeline::picture_scene(reference_, snapshot, view, textures_);
    if (look().shadows) {
      reference::ShadowMap map;
      const glm::dmat4 to_clip =
          glm::dmat4(2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, -1, -1, -1, 1) * render_.shadow_matrix();
      for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) map.matrix(r, c) = to_clip[c][r];
      }
      map.size = passes::RenderPass::shadow_size;
      map.depth = render_.shadow_map();
      map.texel_size = render_.shadow_texel();
      scene.lighting.shadow = std::move(map);
    }
    return reference::render(scene, target_.width(), target_.height());
  }

  void compare_pictures(int frame) {
    const passes::View view = scene_.view(frame);
    render_.draw(stepper_.surface(), view, target_);
    const io::Image picture{target_.width(), target_.height(), target_.read_rgba8()};
    const WaveSnapshot gpu = pipeline::read_snapshot(stepper_.surface());
    const reference::Picture expected = reference_picture(gpu, view);
    const io::Image image = to_image(expected.colour, picture, expected.triangle);
    std::vector<std::uint8_t> mask(expected.triangle.size());
    for (std::size_t i = 0; i < mask.size(); ++i) {
      if (expected.triangle[i] < 0) continue;
      ++covered_;
      if (expected.silhouette[i]) {
        ++silhouettes_;
        continue;
      }
      mask[i] = 1;
      int largest = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        largest = std::max(largest, std::abs(int{image.rgba[4 * i + c]} - int{picture.rgba[4 * i + c]}));
      }
      image_.add(largest);
    }
    flip_ = std::max(flip_, io::flip(image, picture, mask).mean);

    // The same moment with every pass in double precision from the clip's start.
    const WaveSnapshot& chain = chain_.now();
    double squares = 0, count = 0;
    for (Index v = 0; v < chain.phases.size(); ++v) {
      const auto i = static_cast<std::size_t>(v);
      if (chain.states[i].status != Status::set || gpu.states[i].status != Status::set ||
          !(chain.weights[v] > 0))
        continue;
      // Both signs of a direction are the same wave with the phase's sign turned.
      const double sign = chain.states[i].direction.dot(gpu.states[i].direction) < 0 ? -1 : 1;
      const double difference = wrapped_difference(sign * gpu.phases[v], chain.phases[v]);
      squares += difference * difference;
      count += 1;
    }
    if (count > 0) chain_phase_ = std::max(chain_phase_, std::sqrt(squares / count));
    const reference::Picture whole = reference_picture(chain, view);
    chain_flip_ =
        std::max(chain_flip_, io::flip(to_image(whole.colour, picture, whole.triangle), picture, mask).mean);
  }

  void finish(VerifyReport& report) {
    report.passes["skin"] = skin_.comparison();
    report.passes["skin.frame"] = frame_.comparison();
    report.passes["crush.r"] = r_.comparison();
    report.passes["crush.height"] = height_.comparison();
    report.passes["crush.easing"] = easing_.comparison();
    report.passes["crush.wave_vector"] = wave_vector_.comparison();
    report.passes["relax"] = relax_.comparison(phase_fraction);
    report.passes["relax.ten_rounds"] = ten_rounds_.comparison(phase_fraction);
    PassComparison crush = report.passes["crush.r"];
    crush.ok = crush.ok && report.passes["crush.height"].ok && report.passes["crush.easing"].ok &&
               report.passes["crush.wave_vector"].ok;
    report.passes["crush"] = crush;
    report.passes["render"] = image_.comparison(image_fraction);
    report.fraction_within_4 = image_.within();
    report.mean_flip = flip_;
    report.silhouette_fraction =
        covered_ > 0 ? static_cast<double>(silhouettes_) / static_cast<double>(covered_) : 0;
    report.chain_phase_rms = chain_phase_;
    report.chain_image_flip = chain_flip_;
    for (const auto& [name, comparison] : report.passes) {
      if (comparison.ok) continue;
      report.failures.push_back(fmt::format("{}: largest error {:.3g} {}, tolerance {:.3g}", name,
                                            comparison.max_abs, comparison.unit, comparison.tolerance));
    }
    if (flip_ > flip_tolerance) {
      report.failures.push_back(fmt::format("render: mean FLIP {:.4f}, tolerance {}", flip_, flip_tolerance));
      report.passes["render"].ok = false;
    }
    report.ok = report.failures.empty();
  }

  pipeline::LoadedScene scene_;
  ReferenceScene reference_;
  pipeline::ReferenceChain chain_;
  gpu::Context context_;
  gpu::StageTimer timer_;
  pipeline::Stepper stepper_;
  passes::RelaxPass scratch_relax_;
  passes::RenderPass render_;
  gpu::Target target_;
  std::vector<reference::Texture> textures_;

  Pose pose_;
  bool looking_ = false;
  WaveSnapshot before_, crushed_;
  Tally skin_{skin_tolerance, "of the bounding box"}, frame_{frame_tolerance, "of a unit vector"};
  Tally r_{r_tolerance, ""}, height_{height_tolerance, "of W"}, easing_{easing_tolerance, "of W"},
      wave_vector_{wave_vector_tolerance, "times the gap"};
  Tally relax_{phase_tolerance, "rad"}, ten_rounds_{phase_tolerance, "rad"};
  Tally image_{image_tolerance, "of 255"};
  double flip_ = 0, chain_phase_ = 0, chain_flip_ = 0;
  std::size_t covered_ = 0, silhouettes_ = 0;
};

}  // namespace

VerifyReport verify(const RenderRequest& request, const FrameCallback& on_frame) {
  return Verifier(request).run(on_frame);
}

}  // namespace plisse
